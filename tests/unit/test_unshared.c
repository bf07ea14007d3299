/* Meshes whose triangles share no vertices: where much is beside the view, triangles are looked at before their vertices.
 * With the vertices in another order, in which all of them are transformed, the same triangles have the same pixels and the
 * same counters. */
#include "frame/cull.h"
#include "recording_sink.h"
#include "seeded.h"

enum { WIDTH = 40, HEIGHT = 30, TRIANGLES = 400, VERTICES = 3 * TRIANGLES, PLENTY = 120000, SCENES = 3 + PART_OF(57) };

typedef struct cloud {
    int16_t positions[VERTICES][3];
    uint16_t triangles[TRIANGLES][3];
    recording record;
} cloud;

static cloud in_order, backwards;
static uint8_t colours[TRIANGLES][3];
static uint8_t memory[PLENTY] __attribute__((aligned(8)));

void setUp(void)
{
}

void tearDown(void)
{
}

/* Small triangles in a cube, and a few large ones. */
static void fill_clouds(seeded *s)
{
    for (unsigned i = 0; i < VERTICES; i++) {
        const unsigned first = i - i % 3;
        const bool is_near = i != first && any_below(s, 50) != 0;
        for (unsigned k = 0; k < 3; k++) {
            in_order.positions[i][k] = (int16_t)(is_near ? in_order.positions[first][k] + any_between(s, -300, 300)
                                                         : any_between(s, -8000, 8000));
            backwards.positions[VERTICES - 1 - i][k] = in_order.positions[i][k];
        }
        in_order.triangles[i / 3][i % 3] = (uint16_t)i;
        backwards.triangles[i / 3][i % 3] = (uint16_t)(VERTICES - 1 - i);
    }
    for (unsigned i = 0; i < TRIANGLES * 3; i++) {
        colours[i / 3][i % 3] = (uint8_t)any_u64(s);
    }
}

static el_camera any_camera(seeded *s)
{
    static const int32_t up[3] = {0, EL_UNIT_Q16, 0};
    const int32_t eye[3] = {(int32_t)any_between(s, -20, 20) * EL_UNIT_Q16,
                            (int32_t)any_between(s, -20, 20) * EL_UNIT_Q16,
                            (int32_t)any_between(s, 1, 30) * EL_UNIT_Q16};
    const int32_t target[3] = {(int32_t)any_between(s, -30, 30) * EL_UNIT_Q16, EL_UNIT_Q16, 0};
    el_camera camera = {.projection = any_below(s, 4) == 0 ? EL_ORTHOGRAPHIC : EL_PERSPECTIVE,
                        .fov_y = EL_DEGREES(30, 1),
                        .height_q16 = 12 * EL_UNIT_Q16,
                        .near_q16 = EL_UNIT_Q16 / 4,
                        .far_q16 = (uint32_t)any_between(s, 10, 60) * EL_UNIT_Q16};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_camera_look_at(&camera, eye, target, up));
    return camera;
}

static void draw(cloud *c, const el_camera *camera, size_t bytes)
{
    const el_mesh mesh = {.positions = (const int16_t(*)[3])c->positions,
                          .triangles = (const uint16_t(*)[3])c->triangles,
                          .triangle_colours = (const uint8_t(*)[3])colours,
                          .vertex_count = VERTICES,
                          .triangle_count = TRIANGLES,
                          .scale_log2 = -9,
                          .radius = 14500};
    const el_material material = {.shading = EL_SHADE_FLAT, .flags = EL_MATERIAL_TWO_SIDED};
    const el_pose pose = el_pose_identity();
    el_renderer renderer;
    el_sink sink = recording_sink(&c->record);
    const el_config config = {
        .width = WIDTH, .height = HEIGHT, .band_lines = 6, .memory = memory, .memory_bytes = bytes, .sinks = {&sink}};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, camera));
    int more;
    do {
        TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&renderer, &mesh, &pose, &material));
        more = el_frame_next(&renderer);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(0, more);
    } while (more > 0);
}

static void expect_same(const seeded *s, size_t bytes)
{
    const size_t pixel_bytes = WIDTH * HEIGHT * sizeof(uint16_t);
    if (memcmp(in_order.record.pixels, backwards.record.pixels, pixel_bytes) != 0 ||
        memcmp(in_order.record.depth, backwards.record.depth, pixel_bytes) != 0) {
        fail_at(s, "%zu bytes: other pixels", bytes);
    }
}

static void test_what_is_beside_the_view_is_not_transformed(void)
{
    uint32_t transformed = 0;
    uint32_t all = 0;
    for (seeded s = seeded_from(72); s.round < SCENES; s.round++) {
        const size_t bytes = s.round % 3 == 0 ? 6000 : (s.round % 3 == 1 ? 20000 : PLENTY);
        fill_clouds(&s);
        const el_camera camera = any_camera(&s);
        draw(&in_order, &camera, bytes);
        draw(&backwards, &camera, bytes);
        expect_same(&s, bytes);
        const el_stats *const a = &in_order.record.stats;
        const el_stats *const b = &backwards.record.stats;
        if (bytes == PLENTY) {
            TEST_ASSERT_EQUAL_UINT32(b->triangles_outside, a->triangles_outside);
            TEST_ASSERT_EQUAL_UINT32(b->triangles_listed, a->triangles_listed);
            TEST_ASSERT_EQUAL_UINT32(b->triangles_empty, a->triangles_empty);
            TEST_ASSERT_EQUAL_UINT32(b->triangles_clipped, a->triangles_clipped);
            transformed += a->vertices;
            all += b->vertices;
        }
    }
    TEST_ASSERT_LESS_THAN_UINT32(EL_CULLS_IN_VIEW ? all / 2 : all + 1, transformed);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_is_beside_the_view_is_not_transformed);
    return UNITY_END();
}
