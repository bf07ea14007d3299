/* The renderer's public door: what el_init, el_frame_begin, el_draw and el_frame_next refuse, how much memory is enough,
 * and what the counters say of a scene that one can count by hand. */
#include "any_scene.h"
#include "recording_sink.h"

enum { WIDTH = 32, HEIGHT = 32, LINES = 8, BYTES = 32768 };

static const int16_t positions[][3] = {{-256, -256, 0}, {256, -256, 0}, {256, 256, 0}, {-256, 256, 0}};
static const uint16_t triangles[][3] = {{0, 1, 2}, {0, 2, 3}};
static const el_mesh quad = {.positions = positions,
                             .triangles = triangles,
                             .vertex_count = 4,
                             .triangle_count = 2,
                             .scale_log2 = -8,
                             .radius = 363};
static const el_material red = {.colour = {255, 0, 0}};

static uint8_t memory[BYTES] __attribute__((aligned(8)));
static recording record;
static el_sink sink;
static el_config config;
static el_renderer renderer;
static el_camera camera;

void setUp(void)
{
    memset(&record, 0, sizeof record);
    sink = recording_sink(&record);
    config = (el_config){.width = WIDTH,
                         .height = HEIGHT,
                         .band_lines = LINES,
                         .memory = memory,
                         .memory_bytes = sizeof memory,
                         .sinks = {NULL, &sink}};
    camera = (el_camera){.axes_q30 = {{EL_UNIT_Q30, 0, 0}, {0, EL_UNIT_Q30, 0}, {0, 0, EL_UNIT_Q30}},
                         .position_q16 = {0, 0, 2 * EL_UNIT_Q16},
                         .fov_y = EL_DEGREES(90, 1),
                         .near_q16 = EL_UNIT_Q16 / 4,
                         .far_q16 = 10 * EL_UNIT_Q16};
}

void tearDown(void)
{
}

static void expect_init(el_status status)
{
    TEST_ASSERT_EQUAL_INT(status, el_init(&renderer, &config));
}

static void test_init_refuses_bad_arguments(void)
{
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_init(NULL, &config));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_init(&renderer, NULL));
    config.memory = NULL;
    expect_init(EL_ERROR_ARGUMENT);
}

static void test_init_refuses_sizes(void)
{
    static const uint16_t bad[][3] = {{0, 8, 1}, {8, 0, 1}, {EL_MAX_WIDTH + 1, 8, 1}, {8, EL_MAX_HEIGHT + 1, 1},
                                      {8, 8, 0}, {8, 8, 9}};
    static const uint16_t good[][3] = {{1, 1, 1}, {EL_MAX_WIDTH, 8, 1}, {1, EL_MAX_HEIGHT, EL_MAX_HEIGHT}, {8, 8, 8}};
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        config.width = bad[i][0];
        config.height = bad[i][1];
        config.band_lines = bad[i][2];
        expect_init(EL_ERROR_SIZE);
    }
    for (unsigned i = 0; i < sizeof good / sizeof good[0]; i++) {
        config.width = good[i][0];
        config.height = good[i][1];
        config.band_lines = good[i][2];
        expect_init(EL_OK);
    }
}

static void test_init_refuses_texture_errors_out_of_range(void)
{
    for (uint8_t i = 0; i < 8; i++) {
        config.uv_error_log2 = i;
        expect_init(i <= 5 ? EL_OK : EL_ERROR_SIZE);
    }
}

static void test_the_least_memory_is_the_least(void)
{
    config.memory_bytes = EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, (unsigned)LINES);
    expect_init(EL_OK);
    config.memory_bytes -= 8;
    expect_init(EL_ERROR_MEMORY);
    config.memory_bytes = 0;
    expect_init(EL_ERROR_MEMORY);
}

static void test_init_refuses_numbers_of_samples(void)
{
    for (uint8_t i = 0; i < 20; i++) {
        config.samples = i;
        expect_init(i <= 1 || (EL_WITH_SAMPLES && (i == 4 || i == 8)) ? EL_OK : EL_ERROR_SIZE);
    }
    for (uint8_t i = 4; i <= 8 && EL_WITH_SAMPLES; i += 4) {
        config.samples = i;
        config.memory_bytes =
            EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, (unsigned)LINES) + EL_SAMPLES_BYTES((unsigned)WIDTH, (unsigned)LINES, i);
        expect_init(EL_OK);
        config.memory_bytes -= 8;
        expect_init(EL_ERROR_MEMORY);
        config.memory_bytes = sizeof memory;
        config.depth_prepass = EL_WITH_PREPASS;
        expect_init(EL_WITH_PREPASS ? EL_ERROR_SIZE : EL_OK);
        config.depth_prepass = false;
    }
}

/* Counting pixels is one sample's. */
static void test_overdraw_is_not_drawn_with_several_samples(void)
{
    const el_pose pose = el_pose_identity();
    el_material counting = red;
    counting.shading = EL_SHADE_OVERDRAW;
    config.samples = EL_WITH_SAMPLES ? 4 : 1;
    expect_init(EL_OK);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
    TEST_ASSERT_EQUAL_INT(EL_WITH_SAMPLES || !EL_WITH_OVERDRAW ? EL_ERROR_MATERIAL : EL_OK,
                          el_draw(&renderer, &quad, &pose, &counting));
    TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
}

/* A frame with fewer samples than there is memory for, and one with one, draw what they would without that memory. */
static void test_samples_may_be_changed_between_frames(void)
{
    static const uint8_t numbers[] = {8, 1, 4, 8};
    static uint16_t pictures[4][WIDTH * HEIGHT];
    const el_pose pose = el_pose_identity();
    for (unsigned round = 0; round < 2 && EL_WITH_SAMPLES; round++) {
        config.samples = 8;
        expect_init(EL_OK);
        for (unsigned i = 0; i < 4; i++) {
            if (round == 1) {
                config.samples = numbers[i];
                expect_init(EL_OK);
            }
            renderer.config.samples = numbers[i];
            TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
            TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&renderer, &quad, &pose, &red));
            TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
            if (round == 0) {
                memcpy(pictures[i], record.pixels, sizeof pictures[i]);
            } else {
                TEST_ASSERT_EQUAL_MEMORY(pictures[i], record.pixels, sizeof pictures[i]);
            }
        }
    }
}

static void test_calls_in_the_wrong_order(void)
{
    const el_pose pose = el_pose_identity();
    expect_init(EL_OK);
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_frame_next(NULL));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_frame_next(&renderer));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_draw(&renderer, &quad, &pose, &red));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_frame_begin(NULL, &camera));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_frame_begin(&renderer, NULL));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_frame_begin(&renderer, &camera));
    TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_frame_next(&renderer));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_draw(&renderer, &quad, &pose, &red));
    TEST_ASSERT_EQUAL_UINT32(1, record.frames);
}

static void test_a_bad_camera_begins_no_frame(void)
{
    expect_init(EL_OK);
    camera.near_q16 = 0;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_CAMERA, el_frame_begin(&renderer, &camera));
    camera.near_q16 = EL_UNIT_Q16 / 4;
    camera.position_q16[1] = INT32_MAX;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_frame_begin(&renderer, &camera));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_frame_next(&renderer));
    TEST_ASSERT_FALSE(record.in_frame);
    TEST_ASSERT_EQUAL_UINT32(0, record.frames);
}

/* What is refused leaves no trace in the picture. */
static void test_draw_refuses(void)
{
    static const uint16_t texel = 0;
    static const el_texture texture = {.texels = &texel};
    static const el_texture nothing = {.texels = NULL};
    static const el_texture wide = {.texels = &texel, .width_log2 = 11};
    static const el_texture high = {.texels = &texel, .height_log2 = 11};
    static const el_light light = {.ambient = 255};
    static const int16_t uvs[4][2] = {{0, 0}};
    const el_pose pose = el_pose_identity();
    el_mesh mesh = quad;
    el_material material = red;
    expect_init(EL_OK);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_draw(NULL, &quad, &pose, &red));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_draw(&renderer, NULL, &pose, &red));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_draw(&renderer, &quad, NULL, &red));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_draw(&renderer, &quad, &pose, NULL));
    mesh.triangle_count = EL_MESH_MAX_TRIANGLES + 1;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, el_draw(&renderer, &mesh, &pose, &red));
    mesh = quad;
    mesh.scale_log2 = 9;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_draw(&renderer, &mesh, &pose, &red));
    mesh = quad;
    mesh.positions = NULL;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_draw(&renderer, &mesh, &pose, &red));
    mesh = quad;
    mesh.triangles = NULL;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_draw(&renderer, &mesh, &pose, &red));
    material.shading = EL_SHADE_OVERDRAW + 1;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_draw(&renderer, &quad, &pose, &material));
    for (uint8_t shading = EL_SHADE_TEXTURED; shading <= EL_SHADE_TEXTURED_GOURAUD; shading++) {
        material = (el_material){.shading = shading, .texture = &texture};
        TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_draw(&renderer, &quad, &pose, &material));
        mesh = quad;
        mesh.uvs = uvs;
        material.texture = NULL;
        TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_draw(&renderer, &mesh, &pose, &material));
        material.texture = &nothing;
        TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_draw(&renderer, &mesh, &pose, &material));
        material.texture = &wide;
        TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_draw(&renderer, &mesh, &pose, &material));
        material.texture = &high;
        TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_draw(&renderer, &mesh, &pose, &material));
    }
    material = (el_material){.light = &light};
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_draw(&renderer, &quad, &pose, &material));
    TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
    TEST_ASSERT_EQUAL_UINT32(0, record.stats.triangles);
    TEST_ASSERT_EACH_EQUAL_HEX16(0, record.pixels, WIDTH * HEIGHT);
}

static void play_quad(const el_pose *pose, const el_material *material)
{
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
    do {
        TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&renderer, &quad, pose, material));
    } while (el_frame_next(&renderer) > 0);
}

/* 2 units at distance 2 and 90 degrees: half the picture's size. */
static void test_counters_of_a_quad(void)
{
    const el_pose pose = el_pose_identity();
    expect_init(EL_OK);
    play_quad(&pose, &red);
    const el_stats *const stats = el_frame_stats(&renderer);
    TEST_ASSERT_EQUAL_MEMORY(stats, &record.stats, sizeof record.stats);
    TEST_ASSERT_EQUAL_UINT32(1, stats->passes);
    TEST_ASSERT_EQUAL_UINT32(1, stats->draws);
    TEST_ASSERT_EQUAL_UINT32(4, stats->vertices);
    TEST_ASSERT_EQUAL_UINT32(2, stats->triangles);
    TEST_ASSERT_EQUAL_UINT32(2, stats->triangles_listed);
    TEST_ASSERT_EQUAL_UINT32(2, stats->setups);
    TEST_ASSERT_EQUAL_UINT32(32, stats->rows);
    TEST_ASSERT_EQUAL_UINT32(16 * 16, stats->pixels);
    TEST_ASSERT_EQUAL_UINT32(4, stats->bands);
    TEST_ASSERT_EQUAL_UINT32(0, stats->flushes);
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        const bool inside = i % WIDTH >= 8 && i % WIDTH < 24 && i / WIDTH >= 8 && i / WIDTH < 24;
        TEST_ASSERT_EQUAL_HEX16(inside ? 0xF800 : 0, record.pixels[i]);
        TEST_ASSERT_EQUAL_UINT16(inside ? 58813 : 65535, record.depth[i]); /* 65534 * (2 - 1/4) / (10 - 1/4) * 10 / 2 */
    }
}

static void test_counters_of_what_is_not_drawn(void)
{
    el_pose pose = el_pose_identity();
    expect_init(EL_OK);
    el_pose_turn(&pose, EL_AXIS_Y, EL_DEGREES(180, 1));
    play_quad(&pose, &red);
    TEST_ASSERT_EQUAL_UINT32(2, record.stats.triangles_backface);
    TEST_ASSERT_EQUAL_UINT32(0, record.stats.pixels);
    pose = el_pose_identity();
    pose.position_q16[2] = 5 * EL_UNIT_Q16;
    play_quad(&pose, &red);
    TEST_ASSERT_EQUAL_UINT32(1, record.stats.draws_culled);
    TEST_ASSERT_EQUAL_UINT32(0, record.stats.vertices);
    pose = el_pose_identity();
    pose.scale_q16 = 64; /* far below a pixel, between two centres */
    play_quad(&pose, &red);
    TEST_ASSERT_EQUAL_UINT32(2, record.stats.triangles_empty);
    pose = el_pose_identity();
    pose.position_q16[0] = 13 * EL_UNIT_Q16 / 4; /* its sphere reaches into the view, its triangles do not */
    play_quad(&pose, &red);
    TEST_ASSERT_EQUAL_UINT32(2, record.stats.triangles_outside);
}

/* A mirrored pose or camera keeps the front in front; two-sided draws both. */
static void test_fronts_of_mirrored_poses_and_cameras(void)
{
    el_pose pose = el_pose_identity();
    expect_init(EL_OK);
    pose.rotation_q30[0][0] = -EL_UNIT_Q30;
    play_quad(&pose, &red);
    TEST_ASSERT_EQUAL_UINT32(256, record.stats.pixels);
    camera.axes_q30[0][0] = -EL_UNIT_Q30;
    play_quad(&pose, &red);
    TEST_ASSERT_EQUAL_UINT32(256, record.stats.pixels);
    pose = el_pose_identity();
    play_quad(&pose, &red);
    TEST_ASSERT_EQUAL_UINT32(256, record.stats.pixels);
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(180, 1));
    play_quad(&pose, &red);
    TEST_ASSERT_EQUAL_UINT32(0, record.stats.pixels);
    play_quad(&pose, &(el_material){.flags = EL_MATERIAL_TWO_SIDED});
    TEST_ASSERT_EQUAL_UINT32(256, record.stats.pixels);
}

/* --- Memory ------------------------------------------------------------------------------------------------------- */

enum { SIDE = 12, GRID_VERTICES = (SIDE + 1) * (SIDE + 1), GRID_TRIANGLES = SIDE * SIDE * 2 };

/* A textured carpet that fills the view but for its border: every triangle is visible and none is cut. */
static void one_pass(unsigned side, unsigned draws)
{
    static int16_t grid[GRID_VERTICES][3];
    static int16_t uvs[GRID_VERTICES][2];
    static uint16_t faces[GRID_TRIANGLES][3];
    static const uint16_t texel = 0x1234;
    static const el_texture texture = {.texels = &texel};
    const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &texture};
    const unsigned row = side + 1;
    for (unsigned i = 0; i < row * row; i++) {
        grid[i][0] = (int16_t)((int)(i % row * 1000 / side) - 500);
        grid[i][1] = (int16_t)((int)(i / row * 1000 / side) - 500);
    }
    for (unsigned i = 0; i < side * side; i++) {
        const uint16_t at = (uint16_t)(i / side * row + i % side);
        faces[2 * i][0] = faces[2 * i + 1][0] = at;
        faces[2 * i][1] = (uint16_t)(at + 1);
        faces[2 * i][2] = faces[2 * i + 1][1] = (uint16_t)(at + row + 1);
        faces[2 * i + 1][2] = (uint16_t)(at + row);
    }
    const el_mesh mesh = {.positions = (const int16_t(*)[3])grid,
                          .triangles = (const uint16_t(*)[3])faces,
                          .uvs = (const int16_t(*)[2])uvs,
                          .vertex_count = (uint16_t)(row * row),
                          .triangle_count = (uint16_t)(2 * side * side),
                          .scale_log2 = -8,
                          .radius = 710};
    const el_pose pose = el_pose_identity();
    config.memory_bytes = EL_MEMORY_BYTES(WIDTH, HEIGHT, (unsigned)LINES, row * row, 2 * side * side * draws, draws);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(sizeof memory, config.memory_bytes);
    if (config.memory_bytes < EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, (unsigned)LINES)) {
        config.memory_bytes = EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, (unsigned)LINES);
    }
    expect_init(EL_OK);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
    do {
        for (unsigned i = 0; i < draws; i++) {
            TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&renderer, &mesh, &pose, &material));
        }
    } while (el_frame_next(&renderer) > 0);
    char what[60];
    snprintf(what, sizeof what, "%u draws of %u triangles in %zu bytes", draws, 2 * side * side, config.memory_bytes);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(2 * side * side * draws, record.stats.triangles_listed, what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, record.stats.passes, what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, record.stats.flushes, what);
}

static void test_the_promised_memory_takes_one_pass_for_one_draw(void)
{
    for (unsigned side = 1; side <= SIDE; side++) {
        one_pass(side, 1);
    }
}

static void test_the_promised_memory_takes_one_pass_for_many_draws(void)
{
    for (unsigned draws = 1; draws <= 40; draws++) {
        one_pass(1, draws);
        one_pass(2, draws);
    }
}

#if EL_WITH_MIXED
/* Nothing is drawn with what cannot be. */
static void expect_material(const el_material *material, el_status status)
{
    static const int16_t uvs[4][2] = {{0, 0}, {16, 0}, {16, 16}, {0, 16}};
    el_mesh mesh = quad;
    mesh.uvs = uvs;
    const el_pose pose = el_pose_identity();
    expect_init(EL_OK);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
    TEST_ASSERT_EQUAL_INT(status, el_draw(&renderer, &mesh, &pose, material));
    TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
}

static void test_materials_that_are_mixed(void)
{
    static const uint16_t texel = 0;
    const el_image one = {.width = 1, .height = 1, .pixels = &texel, .palette = &texel};
    el_image image = one;
    el_texture texture = {.image = &image};
    el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &texture};
    expect_material(&material, EL_OK);
    static const el_image bad[] = {
        {.width = 0, .height = 1, .pixels = &texel},
        {.width = 1, .height = 0, .pixels = &texel},
        {.width = EL_TEXTURE_MAX_SIDE + 1, .height = 1, .pixels = &texel},
        {.width = 1, .height = EL_TEXTURE_MAX_SIDE + 1, .pixels = &texel},
        {.width = 1, .height = 1},
        {.width = 1, .height = 1, .pixels = &texel, .palette = &texel, .format = EL_IMAGE_MASK + 1},
        {.width = 1, .height = 1, .pixels = &texel, .format = EL_IMAGE_INDEX4},
    };
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        image = bad[i];
        expect_material(&material, EL_ERROR_MATERIAL);
    }
    image = one;
    texture.wrap_u = EL_WRAP_MIRROR + 1;
    expect_material(&material, EL_ERROR_MATERIAL);
    texture.wrap_u = EL_WRAP_CLAMP;
    texture.wrap_v = EL_WRAP_MIRROR + 1;
    expect_material(&material, EL_ERROR_MATERIAL);
    texture.wrap_v = EL_WRAP_MIRROR;
    expect_material(&material, EL_OK);
    material.alpha = 100;
    material.flags = EL_MATERIAL_BLEND_DEPTH;
    expect_material(&material, EL_OK);
#if EL_WITH_PREPASS
    config.depth_prepass = true;
    expect_material(&material, EL_ERROR_MATERIAL);
    material.flags = 0;
    expect_material(&material, EL_OK);
#endif
}

static void test_fog_that_is_refused(void)
{
    static el_fog fog;
    el_material material = {.fog = &fog};
    expect_material(&material, EL_ERROR_MATERIAL);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_fog_exponential(&fog, &camera, 0, EL_UNIT_Q16));
    expect_material(&material, EL_OK);
    material.flags = EL_MATERIAL_NO_DEPTH;
    expect_material(&material, EL_ERROR_MATERIAL);
    material.flags = 0;
    camera.projection = EL_ORTHOGRAPHIC;
    camera.height_q16 = EL_UNIT_Q16;
    expect_material(&material, EL_ERROR_MATERIAL);
}
#endif

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_init_refuses_bad_arguments);
    RUN_TEST(test_init_refuses_sizes);
    RUN_TEST(test_init_refuses_texture_errors_out_of_range);
    RUN_TEST(test_the_least_memory_is_the_least);
    RUN_TEST(test_init_refuses_numbers_of_samples);
    RUN_TEST(test_overdraw_is_not_drawn_with_several_samples);
    RUN_TEST(test_samples_may_be_changed_between_frames);
    RUN_TEST(test_calls_in_the_wrong_order);
    RUN_TEST(test_a_bad_camera_begins_no_frame);
    RUN_TEST(test_draw_refuses);
    RUN_TEST(test_counters_of_a_quad);
    RUN_TEST(test_counters_of_what_is_not_drawn);
    RUN_TEST(test_fronts_of_mirrored_poses_and_cameras);
    RUN_TEST(test_the_promised_memory_takes_one_pass_for_one_draw);
    RUN_TEST(test_the_promised_memory_takes_one_pass_for_many_draws);
#if EL_WITH_MIXED
    RUN_TEST(test_materials_that_are_mixed);
    RUN_TEST(test_fog_that_is_refused);
#endif
    return UNITY_END();
}
