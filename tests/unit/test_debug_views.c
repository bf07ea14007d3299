/* The debug views show what the renderer did, and the same for every band height, arena and number of passes.
 *
 * What they must show is found out apart from them: each triangle of a seeded scene is drawn alone, which gives the pixels
 * that it covers and its depth there; a depth test written down here then says which are drawn, hidden and in front. */
#include <math.h>

#include "any_scene.h"
#include "frame/debug_hooks.h"
#include "recording_sink.h"

enum {
    WIDTH = 40,
    HEIGHT = 30,
    PIXELS = WIDTH * HEIGHT,
    PLENTY = 200000,
    SCENES = 2 + PART_OF(10),
    BACKGROUND = 0x1234
};

static any_scene scene;
static recording record;
static uint8_t memory[PLENTY] __attribute__((aligned(8)));
static el_renderer renderer;

void setUp(void)
{
    memset(&record, 0, sizeof record);
}

void tearDown(void)
{
}

static el_status start(uint16_t band_lines, size_t bytes, uint8_t view)
{
    static el_sink sink;
    sink = recording_sink(&record);
    return el_init(&renderer, &(el_config){.width = WIDTH,
                                           .height = HEIGHT,
                                           .band_lines = band_lines,
                                           .background = BACKGROUND,
                                           .view = view,
                                           .memory = memory,
                                           .memory_bytes = bytes,
                                           .sinks = {&sink}});
}

static void draw(uint16_t band_lines, size_t bytes, uint8_t view)
{
    TEST_ASSERT_EQUAL_INT(EL_OK, start(band_lines, bytes, view));
    play_scene(&renderer, &scene);
}

static void test_a_view_that_is_not_there_is_refused(void)
{
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, start(8, PLENTY, EL_DEBUG_VIEWS));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, start(8, PLENTY, 255));
    el_config config = {.width = 8, .height = 8, .band_lines = 8, .memory = memory, .memory_bytes = PLENTY};
    config.shading_off = EL_DEBUG_SHADINGS;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    config.shading_off = EL_DEBUG_SHADINGS + 1;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, el_init(&renderer, &config));
}

#if EL_WITH_DEBUG_VIEWS

/* --- what the scene's pixels are, by drawing each triangle alone ------------------------------------------------------ */

typedef struct pixel {
    uint16_t drawn;   /* times covered */
    uint16_t hidden;  /* times tested and found behind */
    uint16_t nearest; /* depth, 65535: nothing with depth */
    int16_t front;    /* number of the triangle that is seen, over all meshes; -1: none */
} pixel;

static pixel expected[PIXELS];

/* Draws triangle `index` of the scene's mesh alone. */
static void draw_alone(const any_mesh *m, unsigned index, uint8_t shading)
{
    el_mesh mesh = m->mesh;
    mesh.triangles = (const uint16_t(*)[3]) & m->triangles[index];
    mesh.triangle_count = 1;
    el_material material = {.shading = shading, .flags = m->material.flags & EL_MATERIAL_TWO_SIDED};
    TEST_ASSERT_EQUAL_INT(EL_OK, start(HEIGHT, PLENTY, EL_DEBUG_PICTURE));
    renderer.config.background = 0;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &scene.camera));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&renderer, &mesh, &m->pose, &material));
    TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
}

static void add_triangle(const any_mesh *m, unsigned index, int16_t number)
{
    static uint16_t depth[PIXELS];
    const bool has_depth = (m->material.flags & EL_MATERIAL_NO_DEPTH) == 0;
    draw_alone(m, index, EL_SHADE_FLAT);
    memcpy(depth, record.depth, sizeof depth);
    draw_alone(m, index, EL_SHADE_OVERDRAW);
    for (unsigned i = 0; i < PIXELS; i++) {
        pixel *const p = &expected[i];
        p->drawn = (uint16_t)(p->drawn + record.pixels[i]);
        if (record.pixels[i] == 0) {
            continue;
        }
        if (has_depth && depth[i] >= p->nearest) {
            p->hidden++;
            continue;
        }
        p->nearest = has_depth ? depth[i] : p->nearest;
        p->front = number;
    }
}

static void expect_of_scene(seeded *s)
{
    fill_scene(s, &scene);
    for (unsigned i = 0; i < PIXELS; i++) {
        expected[i] = (pixel){.nearest = 0xFFFF, .front = -1};
    }
    for (unsigned k = 0; k < SCENE_MESHES; k++) {
        for (unsigned i = 0; i < SCENE_TRIANGLES; i++) {
            add_triangle(&scene.meshes[k], i, (int16_t)(k * SCENE_TRIANGLES + i));
        }
    }
}

static uint16_t heat(unsigned count)
{
    return el_debug_heat[count < EL_DEBUG_HEATS ? count : EL_DEBUG_HEATS - 1];
}

/* --- the views -------------------------------------------------------------------------------------------------------- */

static void test_overdraw_counts_every_pixel_drawn(void)
{
    unsigned most = 0;
    for (seeded s = seeded_from(501); s.round < SCENES; s.round++) {
        expect_of_scene(&s);
        draw(7, PLENTY, EL_DEBUG_OVERDRAW);
        for (unsigned i = 0; i < PIXELS; i++) {
            if (record.pixels[i] != heat(expected[i].drawn)) {
                fail_at(&s, "pixel (%u, %u) is %04X after %u times", i % WIDTH, i / WIDTH, record.pixels[i],
                        expected[i].drawn);
            }
            most = expected[i].drawn > most ? expected[i].drawn : most;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(EL_DEBUG_HEATS, most);
}

static void test_rejected_counts_what_is_hidden(void)
{
    unsigned hidden = 0;
    for (seeded s = seeded_from(502); s.round < SCENES; s.round++) {
        expect_of_scene(&s);
        draw(7, PLENTY, EL_DEBUG_REJECTED);
        for (unsigned i = 0; i < PIXELS; i++) {
            if (record.pixels[i] != heat(expected[i].hidden)) {
                fail_at(&s, "pixel (%u, %u) is %04X, hidden %u times", i % WIDTH, i / WIDTH, record.pixels[i],
                        expected[i].hidden);
            }
            hidden += expected[i].hidden;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(20 * SCENES, hidden);
}

/* The grey of a depth by the header's words, in floating point; the view's logarithm is off by 0.09 of a power of two. */
static void test_depth_is_grey_by_distance(void)
{
    unsigned drawn = 0;
    for (seeded s = seeded_from(503); s.round < SCENES; s.round++) {
        expect_of_scene(&s);
        draw(7, PLENTY, EL_DEBUG_DEPTH);
        const double near = scene.camera.near_q16;
        const double far = scene.camera.far_q16;
        const double range = log2(far / near);
        for (unsigned i = 0; i < PIXELS; i++) {
            const double part = expected[i].nearest / (double)EL_DEPTH_MAX;
            const double distance = near / (1 - part * (far - near) / far);
            const bool flat = scene.camera.projection == EL_ORTHOGRAPHIC;
            const double grey = 255 - 223 * (flat ? part : log2(distance / near) / range);
            const double slack = (flat ? 0 : 223 * 0.09 / range) + 8;
            const double is = (record.pixels[i] >> 5 & 63) * 255.0 / 63;
            if (expected[i].nearest == 0xFFFF) {
                TEST_ASSERT_EQUAL_HEX16(0, record.pixels[i]);
            } else if (fabs(is - grey) > slack) {
                fail_at(&s, "depth %u is grey %d, not %d", expected[i].nearest, (int)is, (int)grey);
            }
            drawn += expected[i].nearest != 0xFFFF;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(40 * SCENES, drawn);
}

/* Near and far plane have the ends of the scale, and no step to a larger depth is lighter. */
static void test_depth_never_gets_lighter_with_distance(void)
{
    enum { DEPTHS = EL_DEPTH_MAX / 62 + 1 };
    static const uint32_t planes_q16[][2] = {{16, 1 << 30}, {65536, 73728}, {65536, 20 * 65536}, {16, 18}};
    static uint16_t depth[DEPTHS];
    static uint16_t pixels[DEPTHS];
    const el_painter painter = {.bands = {{.pixels = pixels, .depth = depth, .width = DEPTHS, .lines = 1}}};
    for (unsigned i = 0; i < DEPTHS; i++) {
        depth[i] = (uint16_t)(i * 62U);
    }
    for (unsigned k = 0; k < sizeof planes_q16 / sizeof planes_q16[0]; k++) {
        const el_camera camera = {
            .fov_y = EL_DEGREES(60, 1), .near_q16 = planes_q16[k][0], .far_q16 = planes_q16[k][1]};
        renderer.config.view = EL_DEBUG_DEPTH;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&renderer.view, &camera, WIDTH, HEIGHT));
        el_debug_finish_band(&renderer, &painter);
        TEST_ASSERT_EQUAL_HEX16(0xFFFF, pixels[0]);
        TEST_ASSERT_EQUAL_HEX16(el_rgb565(32, 32, 32), pixels[DEPTHS - 1]);
        for (unsigned i = 1; i < DEPTHS; i++) {
            TEST_ASSERT_LESS_OR_EQUAL_HEX16(pixels[i - 1], pixels[i]);
        }
    }
}

/* Of the triangles that are seen, each has one colour, and almost each one of its own. */
static void test_triangles_have_colours_of_their_own(void)
{
    unsigned seen = 0;
    unsigned shared = 0;
    for (seeded s = seeded_from(504); s.round < SCENES; s.round++) {
        enum { TRIANGLES = SCENE_MESHES * SCENE_TRIANGLES };
        uint32_t colours[TRIANGLES];
        memset(colours, 0xFF, sizeof colours);
        expect_of_scene(&s);
        draw(7, PLENTY, EL_DEBUG_TRIANGLES);
        for (unsigned i = 0; i < PIXELS; i++) {
            const int front = expected[i].front;
            if (front < 0) {
                TEST_ASSERT_EQUAL_HEX16(BACKGROUND, record.pixels[i]);
            } else if (colours[front] == UINT32_MAX) {
                colours[front] = record.pixels[i];
                TEST_ASSERT_EQUAL_HEX16(0x4208, record.pixels[i] & 0x4208U); /* no channel is dark */
                seen++;
                for (int k = 0; k < TRIANGLES; k++) {
                    shared += k != front && colours[k] == colours[front];
                }
            } else {
                TEST_ASSERT_EQUAL_HEX16(colours[front], record.pixels[i]);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(10 * SCENES, seen);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(seen / 50 + 1, shared);
}

/* The work of each band is the difference that it made to the counters; a picture that ends with that band says them. */
static void test_bands_have_bars_as_long_as_their_work(void)
{
    static uint16_t picture[PIXELS];
    for (seeded s = seeded_from(505); s.round < SCENES; s.round++) {
        fill_scene(&s, &scene);
        draw(HEIGHT, PLENTY, EL_DEBUG_PICTURE);
        memcpy(picture, record.pixels, sizeof picture);
        const el_stats stats = record.stats;
        const uint32_t work = stats.pixels + EL_DEBUG_ROW_WORK * stats.rows + EL_DEBUG_SETUP_WORK * stats.setups;
        const uint32_t end = work / (6 * HEIGHT) < WIDTH ? work / (6 * HEIGHT) : WIDTH;
        draw(HEIGHT, PLENTY, EL_DEBUG_BANDS);
        for (unsigned i = 0; i < PIXELS; i++) {
            const uint16_t bar = i % WIDTH < end ? heat(work * 2 / PIXELS) >> 1 & 0x7BEFU : 0;
            TEST_ASSERT_EQUAL_HEX16((picture[i] >> 2 & 0x39E7) + bar, record.pixels[i]);
        }
        /* In low bands: nothing to do, no bar; all work is in the others. */
        draw(1, PLENTY, EL_DEBUG_BANDS);
        unsigned longest = 0;
        for (unsigned y = 0; y < HEIGHT; y++) {
            unsigned x = 0;
            while (x < WIDTH && record.pixels[y * WIDTH + x] != (picture[y * WIDTH + x] >> 2 & 0x39E7)) {
                x++;
            }
            longest = x > longest ? x : longest;
        }
        TEST_ASSERT_GREATER_OR_EQUAL_UINT(end, longest);
    }
}

/* --- the same, whatever the frame is made of -------------------------------------------------------------------------- */

static const uint8_t invariant_views[] = {EL_DEBUG_OVERDRAW, EL_DEBUG_DEPTH, EL_DEBUG_TRIANGLES, EL_DEBUG_REJECTED};
enum { INVARIANT_VIEWS = sizeof invariant_views };

static void test_same_pixels_for_every_band_height_and_arena(void)
{
    static const uint16_t heights[] = {1, 2, 7, 8, HEIGHT};
    static const size_t more[] = {0, 40, 264, 1032, 4104};
    static uint16_t whole[PIXELS];
    uint32_t passes = 0;
    uint32_t flushes = 0;
    for (seeded s = seeded_from(506); s.round < SCENES; s.round++) {
        fill_scene(&s, &scene);
        for (unsigned v = 0; v < INVARIANT_VIEWS; v++) {
            draw(HEIGHT, PLENTY, invariant_views[v]);
            memcpy(whole, record.pixels, sizeof whole);
            for (unsigned i = 0; i < sizeof heights / sizeof heights[0]; i++) {
                const unsigned lines = heights[i];
                const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, lines);
                draw(heights[i], least + more[(s.round + i) % 5], invariant_views[v]);
                if (memcmp(whole, record.pixels, sizeof whole) != 0) {
                    fail_at(&s, "view %u differs in bands of %u lines", invariant_views[v], lines);
                }
                passes += record.stats.passes - 1;
                flushes += record.stats.flushes;
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(100), passes);
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(100), flushes);
}

/* On every core that these tests run on, the same pixels as on the computer where they were looked at. */
static void test_every_core_draws_the_same(void)
{
    static const uint32_t crcs[][EL_DEBUG_VIEWS] = {
        {0x0D384395, 0xF43DEC1C, 0x9A9E4207, 0x6C5A26FD, 0x7CE0EAC1, 0xCDB4E8A8}, /* with 4 bits of sub-pixels */
        {0x5FCBA16E, 0xD0AB8B59, 0x14B620E2, 0x69762B64, 0xBDF04187, 0x73805894}, /* 6 */
        {0x449B819F, 0xCD5D2563, 0x14B620E2, 0x26F26CEC, 0x27C16152, 0x9CAF3362}, /* 8 */
    };
    seeded s = seeded_from(507);
    fill_scene(&s, &scene);
    scene.camera.projection = EL_PERSPECTIVE;
    for (uint8_t view = 0; view < EL_DEBUG_VIEWS; view++) {
        draw(7, PLENTY, view);
        TEST_ASSERT_EQUAL_HEX32(crcs[EL_SUBPIXEL_BITS / 2 - 2][view], recorded_crc(&record));
    }
}

/* --- switching -------------------------------------------------------------------------------------------------------- */

static void test_a_view_is_over_with_its_frame(void)
{
    for (seeded s = seeded_from(508); s.round < SCENES; s.round++) {
        fill_scene(&s, &scene);
        const size_t bytes = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, 7U) + 500;
        draw(7, bytes, EL_DEBUG_PICTURE);
        const uint32_t picture = recorded_crc(&record);
        for (uint8_t view = 1; view < EL_DEBUG_VIEWS; view++) {
            renderer.config.view = view;
            play_scene(&renderer, &scene);
            TEST_ASSERT_TRUE(picture != recorded_crc(&record));
            renderer.config.view = EL_DEBUG_PICTURE;
            play_scene(&renderer, &scene);
            TEST_ASSERT_EQUAL_HEX32(picture, recorded_crc(&record));
        }
    }
}

/* Without some bits of a shading: as if the materials did not have them. */
static void test_shadings_are_left_out(void)
{
    for (seeded s = seeded_from(509); s.round < SCENES; s.round++) {
        fill_scene(&s, &scene);
        for (unsigned i = 0; i < SCENE_MESHES; i++) {
            /* Of any shading but textures alone, of which more below. */
            scene.meshes[i].material.shading =
                (uint8_t[]){EL_SHADE_FLAT, EL_SHADE_GOURAUD, EL_SHADE_TEXTURED_GOURAUD}[any_below(&s, 3)];
        }
        for (uint8_t off = 1; off <= EL_DEBUG_SHADINGS; off++) {
            const any_scene before = scene;
            TEST_ASSERT_EQUAL_INT(EL_OK, start(7, PLENTY, EL_DEBUG_PICTURE));
            renderer.config.shading_off = off;
            play_scene(&renderer, &scene);
            const uint32_t left_out = recorded_crc(&record);
            for (unsigned i = 0; i < SCENE_MESHES; i++) {
                scene.meshes[i].material.shading &= (uint8_t)~off;
            }
            draw(7, PLENTY, EL_DEBUG_PICTURE);
            TEST_ASSERT_EQUAL_HEX32(recorded_crc(&record), left_out);
            scene = before;
        }
    }
}

/* A texture of one colour leaves that colour; one with a border leaves what is in the middle. */
static void test_a_texture_leaves_the_colour_of_its_middle(void)
{
    static const int16_t positions[3][3] = {{-900, -900, 0}, {900, -900, 0}, {0, 900, 0}};
    static const int16_t uvs[3][2] = {{0, 0}, {7 * 16, 0}, {3 * 16, 7 * 16}}; /* the middle is (3.33, 2.33) */
    static const uint16_t triangles[1][3] = {{0, 1, 2}};
    static uint16_t texels[64];
    static const el_texture texture = {.texels = texels, .width_log2 = 3, .height_log2 = 3};
    static const el_mesh mesh = {.positions = positions,
                                 .triangles = triangles,
                                 .uvs = uvs,
                                 .vertex_count = 3,
                                 .triangle_count = 1,
                                 .scale_log2 = -8,
                                 .radius = 1300};
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &texture};
    const el_camera camera = {.axes_q30 = {{EL_UNIT_Q30, 0, 0}, {0, EL_UNIT_Q30, 0}, {0, 0, EL_UNIT_Q30}},
                              .position_q16 = {0, 0, 8 * EL_UNIT_Q16},
                              .fov_y = EL_DEGREES(60, 1),
                              .near_q16 = EL_UNIT_Q16,
                              .far_q16 = 20 * EL_UNIT_Q16};
    const el_pose pose = el_pose_identity();
    memset(texels, 0, sizeof texels);
    texels[2 * 8 + 3] = 0xBEEF;
    TEST_ASSERT_EQUAL_INT(EL_OK, start(7, PLENTY, EL_DEBUG_PICTURE));
    renderer.config.shading_off = EL_SHADE_TEXTURED;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&renderer, &mesh, &pose, &material));
    TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
    unsigned covered = 0;
    for (unsigned i = 0; i < PIXELS; i++) {
        covered += record.pixels[i] == 0xBEEF;
        TEST_ASSERT_TRUE(record.pixels[i] == 0xBEEF || record.pixels[i] == BACKGROUND);
    }
    TEST_ASSERT_GREATER_THAN_UINT(100, covered);
}

#endif

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_view_that_is_not_there_is_refused);
#if EL_WITH_DEBUG_VIEWS
    RUN_TEST(test_overdraw_counts_every_pixel_drawn);
    RUN_TEST(test_rejected_counts_what_is_hidden);
    RUN_TEST(test_depth_is_grey_by_distance);
    RUN_TEST(test_depth_never_gets_lighter_with_distance);
    RUN_TEST(test_triangles_have_colours_of_their_own);
    RUN_TEST(test_bands_have_bars_as_long_as_their_work);
    RUN_TEST(test_same_pixels_for_every_band_height_and_arena);
    RUN_TEST(test_every_core_draws_the_same);
    RUN_TEST(test_a_view_is_over_with_its_frame);
    RUN_TEST(test_shadings_are_left_out);
    RUN_TEST(test_a_texture_leaves_the_colour_of_its_middle);
#endif
    return UNITY_END();
}
