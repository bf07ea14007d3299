/* A frame's pixels depend on the scene alone: not on band height, arena, passes or sinks. Seeded scenes with everything in
 * them are drawn in every way that a configuration allows and compared with one band and plenty of memory. */
#include <stdlib.h>

#include "any_scene.h"
#include "recording_sink.h"

enum { WIDTH = 40, HEIGHT = 30, PLENTY = 200000, GUARD = 64, SCENES = PART_OF(40) };

static any_scene scene;
static recording whole, record, second, third;
static uint8_t memory[GUARD + PLENTY + GUARD + 8] __attribute__((aligned(8)));
static size_t arena_at; /* guards lie before and behind */
static el_renderer renderer;
static bool prepass;  /* of the frames that `start` is for */
static bool unshared; /* of the scenes that `draw_whole` draws */

void setUp(void)
{
    arena_at = GUARD;
    prepass = false;
    unshared = false;
    memset(&record, 0, sizeof record);
    memset(&second, 0, sizeof second);
    memset(&third, 0, sizeof third);
}

void tearDown(void)
{
}

static void start(recording *r, uint16_t band_lines, size_t bytes)
{
    static el_sink sink;
    sink = recording_sink(r);
    const el_config config = {.width = WIDTH,
                              .height = HEIGHT,
                              .band_lines = band_lines,
                              .background = 0x1234,
                              .depth_prepass = prepass,
                              .memory = memory + arena_at,
                              .memory_bytes = bytes,
                              .sinks = {&sink}};
    memset(memory, 0x5A, sizeof memory);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
}

static void expect_guards(size_t bytes)
{
    TEST_ASSERT_EACH_EQUAL_HEX8(0x5A, memory, arena_at);
    TEST_ASSERT_EACH_EQUAL_HEX8(0x5A, memory + arena_at + bytes, GUARD);
}

static void expect_same(const seeded *s, const char *how, uint16_t band_lines, size_t bytes)
{
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        if (record.pixels[i] != whole.pixels[i] || record.depth[i] != whole.depth[i]) {
            fail_at(s, "%s, %u lines, %zu bytes: pixel (%u, %u) is %04X at depth %u, not %04X at %u", how, band_lines,
                    bytes, i % WIDTH, i / WIDTH, record.pixels[i], record.depth[i], whole.pixels[i], whole.depth[i]);
        }
    }
}

/* Makes stretches of triangles that ask for one vertex after the other, of any length, between others; a few of them have
 * another corner. */
static void unshare(seeded *s, any_mesh *m)
{
    for (unsigned i = any_below(s, 6); i < SCENE_TRIANGLES; i += any_below(s, 4)) {
        unsigned vertex = any_below(s, SCENE_VERTICES / 2);
        for (unsigned left = any_below(s, 16); left > 0 && i < SCENE_TRIANGLES && vertex + 3 <= SCENE_VERTICES;
             left--) {
            for (unsigned k = 0; k < 3; k++) {
                m->triangles[i][k] = (uint16_t)vertex++;
            }
            i++;
        }
    }
    for (unsigned i = 0; i < 4; i++) {
        m->triangles[any_below(s, SCENE_TRIANGLES)][any_below(s, 3)] = (uint16_t)any_below(s, SCENE_VERTICES);
    }
}

/* `whole` gets the scene as one band in one pass. */
static void draw_whole(seeded *s)
{
    memset(&whole, 0, sizeof whole);
    fill_mixed_scene(s, &scene);
    for (unsigned i = 0; i < SCENE_MESHES && unshared; i++) {
        unshare(s, &scene.meshes[i]);
    }
    start(&whole, HEIGHT, PLENTY);
    play_scene(&renderer, &scene);
    TEST_ASSERT_EQUAL_UINT32(1, whole.stats.passes);
    TEST_ASSERT_EQUAL_UINT32(0, whole.stats.flushes);
    TEST_ASSERT_EQUAL_UINT32(1, whole.stats.bands);
}

static void expect_stats_add_up(const el_stats *stats)
{
    if (stats->triangles_clipped == 0) {
        TEST_ASSERT_EQUAL_UINT32(stats->triangles, stats->triangles_outside + stats->triangles_backface +
                                                       stats->triangles_empty + stats->triangles_other +
                                                       stats->triangles_listed);
    }
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(stats->rows, stats->spans);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(stats->pixels, stats->spans);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(stats->draws, stats->draws_culled);
}

/* What each way of drawing reached, so that a test cannot pass by never getting there. */
typedef struct reached {
    uint32_t passes, flushes, clipped, extra_vertices, extra_setups, waits;
} reached;

static void add_reached(reached *sums)
{
    sums->passes += record.stats.passes - 1;
    sums->flushes += record.stats.flushes;
    sums->clipped += record.stats.triangles_clipped;
    sums->extra_vertices += record.stats.vertices > whole.stats.vertices * record.stats.passes;
    sums->extra_setups += record.stats.setups > whole.stats.setups;
    sums->waits += record.waits;
}

static void draw_again(const seeded *s, const char *how, uint16_t band_lines, size_t bytes, reached *sums)
{
    start(&record, band_lines, bytes);
    for (unsigned frame = 0; frame < 2; frame++) { /* the second starts from what the first has learnt */
        play_scene(&renderer, &scene);
        finish_recording(&record);
        expect_same(s, how, band_lines, bytes);
        TEST_ASSERT_EQUAL_UINT32((HEIGHT + band_lines - 1U) / band_lines, record.stats.bands);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(bytes, record.stats.memory_peak);
        expect_stats_add_up(&record.stats);
        add_reached(sums);
    }
    expect_guards(bytes);
}

static const uint16_t band_heights[] = {1, 2, 3, 7, 8, 16, HEIGHT};
enum { BAND_HEIGHTS = sizeof band_heights / sizeof band_heights[0] };

static void test_same_pixels_for_every_band_height(void)
{
    reached sums = {0};
    for (seeded s = seeded_from(60); s.round < SCENES; s.round++) {
        draw_whole(&s);
        for (unsigned i = 0; i < BAND_HEIGHTS; i++) {
            draw_again(&s, "plenty of memory", band_heights[i], PLENTY, &sums);
        }
    }
    TEST_ASSERT_EQUAL_UINT32(0, sums.flushes);
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(1000), sums.clipped);
}

static void draw_in_every_arena(uint64_t seed)
{
    static const size_t more[] = {0, 8, 16, 40, 104, 264, 520, 1032, 2056, 4104};
    reached sums = {0};
    for (seeded s = seeded_from(seed); s.round < SCENES; s.round++) {
        draw_whole(&s);
        for (unsigned i = 0; i < BAND_HEIGHTS; i++) {
            const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)band_heights[i]);
            draw_again(&s, "little memory", band_heights[i],
                       least + more[(s.round + i) % (sizeof more / sizeof more[0])], &sums);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(100), sums.passes);
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(100), sums.flushes);
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(100), sums.extra_vertices);
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(10), sums.extra_setups);
}

static void test_same_pixels_for_every_arena(void)
{
    draw_in_every_arena(61);
}

/* Vertices that one triangle alone asks for are not looked for in the cache, and lie over it. */
static void test_same_pixels_where_no_vertex_is_shared(void)
{
    unshared = true;
    draw_in_every_arena(67);
}

/* Arenas whose size is no multiple of 8, at any address. */
static void test_odd_arenas(void)
{
    reached sums = {0};
    seeded s = seeded_from(62);
    draw_whole(&s);
    for (size_t i = 0; i < 24; i++, s.round++) {
        arena_at = GUARD + i / 3;
        draw_again(&s, "an odd arena", 8, EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, 8U) + i, &sums);
    }
}

/* A sink that keeps bands until it is waited for sees them unchanged, and every line once. */
static void test_held_bands_do_not_change(void)
{
    reached sums = {0};
    for (seeded s = seeded_from(63); s.round < PART_OF(10); s.round++) {
        draw_whole(&s);
        for (unsigned i = 0; i < BAND_HEIGHTS; i++) {
            const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)band_heights[i]);
            record.defers = true;
            draw_again(&s, "held bands", band_heights[i], s.round % 2 == 0 ? PLENTY : least, &sums);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(100), sums.waits);
}

/* The renderer waits for all of them; each gives back its own hold only. */
static void test_three_sinks_see_the_same(void)
{
    for (seeded s = seeded_from(64); s.round < 5; s.round++) {
        draw_whole(&s);
        record.defers = true;
        third.defers = true;
        const el_sink sinks[3] = {recording_sink(&record), recording_sink(&second), recording_sink(&third)};
        const el_config config = {.width = WIDTH,
                                  .height = HEIGHT,
                                  .band_lines = 7,
                                  .background = 0x1234,
                                  .memory = memory + arena_at,
                                  .memory_bytes = EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, 7U),
                                  .sinks = {&sinks[0], &sinks[1], &sinks[2]}};
        TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
        play_scene(&renderer, &scene);
        finish_recording(&record);
        finish_recording(&third);
        expect_same(&s, "three sinks", 7, config.memory_bytes);
        TEST_ASSERT_EQUAL_HEX32(recorded_crc(&whole), recorded_crc(&second));
        TEST_ASSERT_EQUAL_HEX32(recorded_crc(&whole), recorded_crc(&third));
        TEST_ASSERT_EQUAL_UINT32(s.round + 1, third.frames);
    }
}

/* Many small draws: each costs the list a run, and the last ones find it full. */
static void test_many_small_draws(void)
{
    static const int16_t positions[3][3] = {{-60, -60, 0}, {60, -50, 0}, {0, 60, 0}};
    static const uint16_t triangles[1][3] = {{0, 1, 2}};
    static const el_mesh mesh = {.positions = positions,
                                 .triangles = triangles,
                                 .vertex_count = 3,
                                 .triangle_count = 1,
                                 .scale_log2 = -8,
                                 .radius = 90};
    static const el_material materials[2] = {{.colour = {255, 80, 0}}, {.colour = {0, 80, 255}}};
    static const int32_t eye[3] = {0, 0, 4 * EL_UNIT_Q16};
    static const int32_t origin[3] = {0, 0, 0};
    static const int32_t up[3] = {0, EL_UNIT_Q16, 0};
    el_camera camera = {.fov_y = EL_DEGREES(60, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 20 * EL_UNIT_Q16};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_camera_look_at(&camera, eye, origin, up));
    seeded s = seeded_from(65);
    for (unsigned i = 0; i <= BAND_HEIGHTS; i++) {
        recording *const r = i == 0 ? &whole : &record;
        const uint16_t lines = i == 0 ? HEIGHT : band_heights[i - 1];
        const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)lines);
        start(r, lines, i == 0 ? (size_t)PLENTY : least);
        TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
        do {
            seeded places = seeded_from(66);
            for (unsigned k = 0; k < 100; k++) {
                el_pose pose = el_pose_identity();
                for (unsigned axis = 0; axis < 3; axis++) {
                    pose.position_q16[axis] = (int32_t)any_between(&places, -2 * EL_UNIT_Q16, 2 * EL_UNIT_Q16);
                }
                TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&renderer, &mesh, &pose, &materials[k % 2]));
            }
        } while (el_frame_next(&renderer) > 0);
        if (i > 0) {
            expect_same(&s, "many draws", lines, least);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, record.stats.flushes);
}

/* Without depth the last one drawn wins, whatever the bands. */
static void test_without_depth_the_last_one_wins(void)
{
    for (seeded s = seeded_from(67); s.round < PART_OF(20); s.round++) {
        reached sums = {0};
        memset(&whole, 0, sizeof whole);
        fill_mixed_scene(&s, &scene);
        for (unsigned i = 0; i < SCENE_MESHES; i++) {
            scene.meshes[i].material.flags |= EL_MATERIAL_NO_DEPTH | EL_MATERIAL_TWO_SIDED;
            scene.meshes[i].material.fog = NULL;
        }
        start(&whole, HEIGHT, PLENTY);
        play_scene(&renderer, &scene);
        TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, whole.depth, WIDTH * HEIGHT);
        for (unsigned i = 0; i < BAND_HEIGHTS; i++) {
            const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)band_heights[i]);
            draw_again(&s, "no depth", band_heights[i], least, &sums);
        }
    }
}

#if EL_WITH_PREPASS
/* Depth first: every pixel is shaded once, by the triangle that wins without a pre-pass, also where depths are equal, where
 * draws without depth lie between, and where a band is drawn in several parts. */
static void test_depth_first_draws_the_same(void)
{
    uint32_t twice = 0;
    for (seeded s = seeded_from(68); s.round < SCENES; s.round++) {
        reached sums = {0};
        prepass = false;
        draw_whole(&s);
        prepass = true;
        for (unsigned i = 0; i < BAND_HEIGHTS; i++) {
            const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)band_heights[i]);
            draw_again(&s, "depth first", band_heights[i], PLENTY, &sums);
            twice += record.stats.pixels_prepass;
            draw_again(&s, "depth first, little memory", band_heights[i], least, &sums);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(10000), twice);
}
#endif

/* A view from the same place, in depth that many triangles have in common. */
static void test_equal_depths_keep_the_first(void)
{
    static const int16_t positions[4][3] = {{-200, -200, 0}, {200, -200, 0}, {200, 200, 0}, {-200, 200, 0}};
    static const uint16_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    static const el_mesh quad = {.positions = positions,
                                 .triangles = triangles,
                                 .vertex_count = 4,
                                 .triangle_count = 2,
                                 .scale_log2 = -8,
                                 .radius = 283};
    static const el_material first = {.colour = {255, 0, 0}};
    static const el_material later = {.colour = {0, 255, 0}};
    static const int32_t eye[3] = {0, 0, 2 * EL_UNIT_Q16};
    static const int32_t origin[3] = {0, 0, 0};
    static const int32_t up[3] = {0, EL_UNIT_Q16, 0};
    const el_pose pose = el_pose_identity();
    el_camera camera = {.fov_y = EL_DEGREES(30, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 20 * EL_UNIT_Q16};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_camera_look_at(&camera, eye, origin, up));
    for (unsigned i = 0; i < 2U * BAND_HEIGHTS; i++) {
        prepass = EL_WITH_PREPASS && i % 2 != 0;
        start(&record, band_heights[i / 2], PLENTY);
        TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
        do {
            TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&renderer, &quad, &pose, &first));
            for (unsigned k = 0; k < 4; k++) {
                TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&renderer, &quad, &pose, &later));
            }
        } while (el_frame_next(&renderer) > 0);
        TEST_ASSERT_EACH_EQUAL_HEX16(0xF800, record.pixels, WIDTH * HEIGHT);
#if EL_WITH_HIDDEN
        TEST_ASSERT_EQUAL_UINT32(8U * ((HEIGHT + band_heights[i / 2] - 1U) / band_heights[i / 2]),
                                 record.stats.triangles_hidden);
#endif
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_same_pixels_for_every_band_height);
    RUN_TEST(test_same_pixels_for_every_arena);
    RUN_TEST(test_same_pixels_where_no_vertex_is_shared);
    RUN_TEST(test_odd_arenas);
    RUN_TEST(test_held_bands_do_not_change);
    RUN_TEST(test_three_sinks_see_the_same);
    RUN_TEST(test_many_small_draws);
    RUN_TEST(test_without_depth_the_last_one_wins);
#if EL_WITH_PREPASS
    RUN_TEST(test_depth_first_draws_the_same);
#endif
    RUN_TEST(test_equal_depths_keep_the_first);
    return UNITY_END();
}
