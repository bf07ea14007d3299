/* What is picked is what is seen: in frames whose triangles each have a colour of their own, at every pixel. */
#include "any_scene.h"
#include "recording_sink.h"

enum { WIDTH = 61, HEIGHT = 47 };

/* The least memory, and some with room for more. */
enum { LEAST = EL_PICK_BYTES(WIDTH, HEIGHT), MORE = LEAST + 20000 };

static uint8_t memory[EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, HEIGHT) + 40000];
static uint8_t pick_memory[MORE];
static recording record;
static any_scene scene;
static uint8_t colours[SCENE_MESHES][SCENE_TRIANGLES][3];

void setUp(void)
{
    memset(&record, 0, sizeof record);
}

void tearDown(void)
{
}

/* A triangle's number is its colour; 0 is the background. */
static uint32_t number_of(uint32_t draw, uint32_t triangle)
{
    return 1 + draw * SCENE_TRIANGLES + triangle;
}

/* Triangles that can be skipped in two parts, if anything of them could be. */
static const el_cluster clusters[2] = {
    {.triangle_count = SCENE_TRIANGLES / 2, .vertex_count = SCENE_VERTICES / 2, .radius = 1733, .spread = 255},
    {.triangle_count = SCENE_TRIANGLES / 2, .vertex_count = SCENE_VERTICES / 2, .radius = 1733, .spread = 255},
};

static void fill_numbered_scene(seeded *s)
{
    fill_scene(s, &scene);
    for (uint32_t i = 0; i < SCENE_MESHES; i++) {
        any_mesh *const m = &scene.meshes[i];
        for (uint32_t k = 0; k < SCENE_TRIANGLES; k++) {
            const uint32_t number = number_of(i, k);
            colours[i][k][0] = (uint8_t)(number >> 11 << 3);
            colours[i][k][1] = (uint8_t)((number >> 5 & 63U) << 2);
            colours[i][k][2] = (uint8_t)((number & 31U) << 3);
        }
        m->mesh.triangle_colours = (const uint8_t(*)[3])colours[i];
        m->material.shading = EL_SHADE_FLAT;
        m->material.light = NULL;
        if (any_below(s, 3) == 0) {
            m->mesh.clusters = clusters;
            m->mesh.cluster_count = 2;
        }
    }
    /* Ties: some triangles are there twice. */
    for (unsigned k = 0; k < 8; k++) {
        any_mesh *const m = &scene.meshes[any_below(s, SCENE_MESHES)];
        memcpy(m->triangles[any_below(s, SCENE_TRIANGLES)], m->triangles[any_below(s, SCENE_TRIANGLES)],
               sizeof m->triangles[0]);
    }
    scene.meshes[1].mesh = any_below(s, 2) == 0 ? scene.meshes[0].mesh : scene.meshes[1].mesh;
    scene.meshes[1].mesh.triangle_colours = (const uint8_t(*)[3])colours[1];
    scene.meshes[1].pose = any_below(s, 2) == 0 ? scene.meshes[0].pose : scene.meshes[1].pose;
}

static void show_scene(void)
{
    const el_sink sink = recording_sink(&record);
    const el_config config = {.width = WIDTH,
                              .height = HEIGHT,
                              .band_lines = HEIGHT,
                              .memory = memory,
                              .memory_bytes = sizeof memory,
                              .sinks = {&sink}};
    el_renderer renderer;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    play_scene(&renderer, &scene);
}

static int pick_at(uint16_t x, uint16_t y, size_t bytes, el_picked *picked)
{
    el_pick pick;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_pick_begin(&pick, &scene.camera, WIDTH, HEIGHT, x, y, pick_memory, bytes));
    for (unsigned i = 0; i < SCENE_MESHES; i++) {
        const any_mesh *const m = &scene.meshes[i];
        TEST_ASSERT_EQUAL_INT(EL_OK, el_pick_draw(&pick, &m->mesh, &m->pose, &m->material));
    }
    return el_pick_end(&pick, picked);
}

static void expect_seen(const seeded *s, uint16_t x, uint16_t y, size_t bytes)
{
    const uint32_t at = (uint32_t)y * WIDTH + x;
    el_picked picked = {0};
    const int is_found = pick_at(x, y, bytes, &picked);
    const uint32_t number = is_found != 0 ? number_of(picked.draw, picked.triangle) : 0;
    if (number != record.pixels[at] || (is_found != 0 && picked.depth != record.depth[at])) {
        fail_at(s, "pixel %u, %u: triangle %u at depth %u was picked, %u at %u is seen", x, y, (unsigned)number,
                picked.depth, record.pixels[at], record.depth[at]);
    }
}

static void test_what_is_picked_is_what_is_seen(void)
{
    uint32_t found = 0;
    for (seeded s = seeded_from(751); s.round < PART_OF(40); s.round++) {
        fill_numbered_scene(&s);
        show_scene();
        for (unsigned i = 0; i < 200; i++) {
            const uint16_t x = (uint16_t)any_below(&s, WIDTH);
            const uint16_t y = (uint16_t)any_below(&s, HEIGHT);
            expect_seen(&s, x, y, any_below(&s, 2) == 0 ? LEAST : MORE);
            found += record.pixels[y * WIDTH + x] != 0;
        }
        expect_seen(&s, 0, 0, LEAST);
        expect_seen(&s, WIDTH - 1, HEIGHT - 1, LEAST);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(1000), found);
}

/* Any shading: what is covered does not depend on it, nor does depth. */
static void test_with_every_material(void)
{
    for (seeded s = seeded_from(752); s.round < PART_OF(20); s.round++) {
        fill_numbered_scene(&s);
        any_scene numbered = scene;
        show_scene();
        for (unsigned i = 0; i < SCENE_MESHES; i++) {
            any_mesh *const m = &scene.meshes[i];
            m->material.shading = (uint8_t)any_below(&s, EL_SHADE_OVERDRAW);
            m->material.light = &m->light;
        }
        for (unsigned i = 0; i < 50; i++) {
            expect_seen(&s, (uint16_t)any_below(&s, WIDTH), (uint16_t)any_below(&s, HEIGHT), MORE);
        }
        scene = numbered;
    }
}

static void test_errors(void)
{
    seeded s = seeded_from(753);
    fill_numbered_scene(&s);
    const any_mesh *const m = &scene.meshes[0];
    el_pick pick;
    el_picked picked = {.draw = 7};
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_pick_begin(NULL, &scene.camera, 8, 8, 0, 0, pick_memory, MORE));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_pick_begin(&pick, &scene.camera, 8, 8, 8, 0, pick_memory, MORE));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_pick_begin(&pick, &scene.camera, 8, 8, 0, 8, pick_memory, MORE));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MEMORY,
                          el_pick_begin(&pick, &scene.camera, WIDTH, HEIGHT, 0, 0, pick_memory, LEAST - 16));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_pick_draw(&pick, &m->mesh, &m->pose, &m->material));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_pick_end(&pick, &picked));

    TEST_ASSERT_EQUAL_INT(EL_OK, el_pick_begin(&pick, &scene.camera, WIDTH, HEIGHT, 30, 20, pick_memory, LEAST));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_pick_draw(&pick, NULL, &m->pose, &m->material));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_pick_draw(&pick, &m->mesh, NULL, &m->material));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_pick_draw(&pick, &m->mesh, &m->pose, NULL));
    /* What a frame does not draw cannot be picked. */
    const el_material untextured = {.shading = EL_SHADE_TEXTURED};
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_pick_draw(&pick, &m->mesh, &m->pose, &untextured));
    el_mesh endless = m->mesh;
    endless.triangle_count = EL_MESH_MAX_TRIANGLES + 1;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, el_pick_draw(&pick, &endless, &m->pose, &m->material));
    el_pose outside = m->pose;
    outside.position_q16[0] = INT32_MAX;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_pick_draw(&pick, &m->mesh, &outside, &m->material));
    TEST_ASSERT_EQUAL_INT(0, el_pick_end(&pick, &picked));
    TEST_ASSERT_EQUAL_UINT32(7, picked.draw);
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_pick_end(&pick, &picked));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_is_picked_is_what_is_seen);
    RUN_TEST(test_with_every_material);
    RUN_TEST(test_errors);
    return UNITY_END();
}
