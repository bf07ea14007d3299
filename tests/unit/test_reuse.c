/* What the renderer leaves out because the frame before has it changes no pixel of any sink, however the sinks answer;
 * and it is left out. Seeded courses of frames, in which some things change and others do not, are drawn beside a renderer
 * that makes each frame anew. */
#include <stdlib.h>

#include "any_scene.h"
#include "recording_sink.h"

/* Each height of bands at least once, with plenty of memory and with the least. */
enum { WIDTH = 40, HEIGHT = 70, PLENTY = 60000, COURSES = 14 + PART_OF(26), FRAMES = 6 + PART_OF(34) };

#if EL_WITH_REUSE

static any_scene scene;
static recording anew, record, second;
static uint8_t memory[2][PLENTY] __attribute__((aligned(8)));
static el_renderer plain, sparing;
static seeded answers;

/* Nothing is known before the first frame. */
static void forget_all(void)
{
    memset(&anew, 0, sizeof anew);
    memset(&record, 0, sizeof record);
    memset(&second, 0, sizeof second);
    answers = seeded_from(1);
}

static void start(el_renderer *renderer, void *arena, size_t bytes, uint16_t band_lines, uint8_t reuse,
                  const el_sink *a, const el_sink *b)
{
    const el_config config = {.width = WIDTH,
                              .height = HEIGHT,
                              .band_lines = band_lines,
                              .background = 0x1234,
                              .reuse = reuse,
                              .memory = arena,
                              .memory_bytes = bytes,
                              .sinks = {a, NULL, b}};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(renderer, &config));
}

/* The sinks stay where they are for as long as the renderers. */
static void start_both(uint16_t band_lines, size_t bytes, uint8_t reuse)
{
    static el_sink sinks[3];
    sinks[0] = recording_sink(&anew);
    sinks[1] = recording_sink(&record);
    sinks[2] = recording_sink(&second);
    start(&plain, memory[0], PLENTY, HEIGHT, 0, &sinks[0], NULL);
    start(&sparing, memory[1], bytes, band_lines, reuse, &sinks[1], &sinks[2]);
}

/* Meshes small and on one side, so that there is background above and below. */
static void make_small(seeded *s)
{
    for (unsigned i = 0; i < SCENE_MESHES; i++) {
        scene.meshes[i].pose.scale_q16 = EL_UNIT_Q16 / 16;
        scene.meshes[i].pose.position_q16[1] = (int32_t)any_between(s, -2 * EL_UNIT_Q16, 2 * EL_UNIT_Q16);
    }
}

/* Something that the next frame has otherwise; often nothing. */
static void change_something(seeded *s)
{
    any_mesh *const m = &scene.meshes[any_below(s, SCENE_MESHES)];
    switch (any_below(s, 14)) {
    case 0:
        fill_mixed_scene(s, &scene);
        make_small(s);
        el_frame_forget(&sparing); /* its vertices are others */
        break;
    case 1:
        el_pose_turn(&m->pose, EL_AXIS_Y, (el_angle)any_u64(s));
        break;
    case 2:
        plain.config.background = sparing.config.background = (uint16_t)any_u64(s);
        break;
    case 3:
        m->material.colour[any_below(s, 3)] ^= 1U;
        break;
    case 4:
        m->light.ambient = (uint8_t)any_u64(s);
        break;
    case 5:
        scene.camera.position_q16[any_below(s, 3)] += (int32_t)any_between(s, -100, 100);
        break;
    case 6:
        m->positions[any_below(s, SCENE_VERTICES)][0] = (int16_t)any_between(s, -1000, 1000);
        el_frame_forget(&sparing);
        break;
    case 7:
        make_small(s); /* moved up or down: bands become background, others cease to be */
        break;
    default:
        break;
    }
}

static void expect_same(const seeded *s, const recording *r, const char *what)
{
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        if (r->pixels[i] != anew.pixels[i] || r->depth[i] != anew.depth[i]) {
            fail_at(s, "%s: pixel (%u, %u) is %04X at %u, not %04X at %u", what, i % WIDTH, i / WIDTH, r->pixels[i],
                    r->depth[i], anew.pixels[i], anew.depth[i]);
        }
    }
}

static void test_courses_of_frames_show_the_same(void)
{
    static const uint16_t band_heights[] = {1, 2, 3, 8, 16, 33, HEIGHT};
    uint32_t unchanged = 0;
    uint32_t background = 0;
    uint32_t passes = 0;
    for (seeded s = seeded_from(71); s.round < COURSES; s.round++) {
        const uint16_t lines = band_heights[s.round % 7];
        const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)lines);
        forget_all();
        record.answers = &answers;
        second.answers = s.round % 3 == 0 ? NULL : &answers;
        start_both(lines, s.round % 2 == 0 ? PLENTY : least, (uint8_t)any_below(&s, 4));
        fill_mixed_scene(&s, &scene);
        make_small(&s);
        for (unsigned frame = 0; frame < FRAMES; frame++) {
            play_scene(&plain, &scene);
            play_scene(&sparing, &scene);
            expect_same(&s, &record, "first sink");
            expect_same(&s, &second, "third sink");
            unchanged += record.stats.frames_unchanged;
            background += record.stats.lines_background;
            passes += record.stats.passes > 2;
            change_something(&s);
        }
    }
    /* Of that many frames. */
    const uint32_t frames = COURSES * FRAMES;
    TEST_ASSERT_GREATER_THAN_UINT32(frames / 32, unchanged);
    TEST_ASSERT_GREATER_THAN_UINT32(frames * 5 / 8, background);
    TEST_ASSERT_GREATER_THAN_UINT32(frames / 80, passes);
}

/* A seeded fault: without el_frame_forget a change behind a pointer is not seen, as el_config.reuse says. */
static void test_a_change_that_is_not_told_is_not_seen(void)
{
    seeded s = seeded_from(71);
    unsigned stale = 0;
    while (s.round < 20) {
        forget_all();
        record.answers = &answers;
        start_both(8, PLENTY, EL_REUSE_FRAME);
        fill_mixed_scene(&s, &scene);
        play_scene(&sparing, &scene);
        for (unsigned i = 0; i < SCENE_VERTICES; i++) {
            scene.meshes[0].positions[i][0] = (int16_t)-scene.meshes[0].positions[i][0];
        }
        play_scene(&plain, &scene);
        sparing.config.sinks[2] = NULL; /* it would say no */
        play_scene(&sparing, &scene);
        stale += memcmp(record.pixels, anew.pixels, sizeof record.pixels) != 0;
        s.round++;
    }
    TEST_ASSERT_GREATER_THAN_UINT(5, stale);
}

static bool always(void *context, uint16_t y, uint16_t lines)
{
    recording *const r = context;
    (void)lines;
    r->next_line = (uint16_t)(y + lines);
    r->bands++;
    return true;
}

/* One sink, which does without whatever it is asked about. */
static void start_willing(uint8_t reuse)
{
    static el_sink sink;
    forget_all();
    sink = recording_sink(&record);
    sink.unchanged = always;
    record.answers = &answers; /* never asked; the count of bands is not the renderer's */
    start(&sparing, memory[1], PLENTY, 8, reuse, &sink, NULL);
}

/* The second frame looks at each draw once and draws nothing. */
static void test_an_unchanged_frame_costs_a_look(void)
{
    seeded s = seeded_from(72);
    el_stats stats[2];
    start_willing(EL_REUSE_FRAME);
    fill_mixed_scene(&s, &scene);
    for (unsigned frame = 0; frame < 2; frame++) {
        play_scene(&sparing, &scene);
        stats[frame] = *el_frame_stats(&sparing);
    }
    TEST_ASSERT_EQUAL_UINT32(2, stats[0].passes);
    TEST_ASSERT_EQUAL_UINT32(0, stats[0].frames_unchanged);
    TEST_ASSERT_EQUAL_UINT32(9, stats[0].bands);
    TEST_ASSERT_EQUAL_UINT32(1, stats[1].passes);
    TEST_ASSERT_EQUAL_UINT32(1, stats[1].frames_unchanged);
    TEST_ASSERT_EQUAL_UINT32(SCENE_MESHES, stats[1].draws);
    TEST_ASSERT_EQUAL_UINT32(0, stats[1].vertices);
    TEST_ASSERT_EQUAL_UINT32(0, stats[1].bands);
    TEST_ASSERT_EQUAL_UINT32(2, record.frames);
}

/* One triangle in the middle: the bands above and below are left out from the second frame on, until the background's
 * colour changes; and where it was a frame ago they are not. */
static void test_background_is_left_out_where_it_was_background(void)
{
    static const int16_t positions[3][3] = {{-60, -60, 0}, {60, -50, 0}, {0, 60, 0}};
    static const uint16_t triangles[1][3] = {{0, 1, 2}};
    static const el_mesh mesh = {.positions = positions,
                                 .triangles = triangles,
                                 .vertex_count = 3,
                                 .triangle_count = 1,
                                 .scale_log2 = -8,
                                 .radius = 90};
    static const el_material material = {.colour = {255, 80, 0}};
    static const int32_t eye[3] = {0, 0, 4 * EL_UNIT_Q16};
    static const int32_t origin[3] = {0, 0, 0};
    static const int32_t up[3] = {0, EL_UNIT_Q16, 0};
    static const struct {
        int32_t y_q16;
        uint16_t background;
        uint32_t lines_background;
    } frames[] = {
        {0, 1, 0},
        {0, 1, 54},           /* of 70 lines; the triangle is in two bands of 8 */
        {EL_UNIT_Q16, 1, 46}, /* moved up: those that it leaves are drawn once more, and so is one that it comes to */
        {EL_UNIT_Q16, 1, 62},
        {EL_UNIT_Q16, 2, 0},
        {EL_UNIT_Q16, 2, 62},
    };
    el_camera camera = {.fov_y = EL_DEGREES(60, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 20 * EL_UNIT_Q16};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_camera_look_at(&camera, eye, origin, up));
    start_willing(EL_REUSE_BACKGROUND);
    for (unsigned i = 0; i < sizeof frames / sizeof frames[0]; i++) {
        el_pose pose = el_pose_identity();
        pose.position_q16[1] = frames[i].y_q16;
        sparing.config.background = frames[i].background;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&sparing, &camera));
        TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&sparing, &mesh, &pose, &material));
        TEST_ASSERT_EQUAL_INT(0, el_frame_next(&sparing));
        TEST_ASSERT_EQUAL_UINT32(frames[i].lines_background, record.stats.lines_background);
        TEST_ASSERT_EQUAL_UINT32(HEIGHT, record.next_line);
    }
}

/* A draw that is refused in the pass that draws, not in the one that looks: each frame says so. */
static void test_a_frame_with_an_error_is_drawn_again(void)
{
    seeded s = seeded_from(73);
    start_willing(EL_REUSE_FRAME);
    fill_mixed_scene(&s, &scene);
    scene.meshes[0].pose.position_q16[0] = INT32_MAX;
    for (unsigned frame = 0; frame < 3; frame++) {
        unsigned refusals = 0;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&sparing, &scene.camera));
        do {
            refusals += el_draw(&sparing, &scene.meshes[0].mesh, &scene.meshes[0].pose, &scene.meshes[0].material) ==
                        EL_ERROR_RANGE;
        } while (el_frame_next(&sparing) > 0);
        TEST_ASSERT_GREATER_THAN_UINT(0, refusals);
    }
}

#endif

/* Bits that do not exist, or that base/options.h leaves out. */
static void test_what_cannot_be_reused_is_refused(void)
{
    static uint8_t arena[EL_MIN_MEMORY_BYTES(8U, 8U, 8U)];
    el_renderer renderer;
    el_config config = {.width = 8, .height = 8, .band_lines = 8, .memory = arena, .memory_bytes = sizeof arena};
    for (unsigned reuse = 0; reuse < 256; reuse++) {
        config.reuse = (uint8_t)reuse;
        TEST_ASSERT_EQUAL_INT((reuse & ~(unsigned)EL_REUSES) == 0 ? EL_OK : EL_ERROR_SIZE, el_init(&renderer, &config));
    }
}

void setUp(void)
{
}

void tearDown(void)
{
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_cannot_be_reused_is_refused);
#if EL_WITH_REUSE
    RUN_TEST(test_courses_of_frames_show_the_same);
    RUN_TEST(test_a_change_that_is_not_told_is_not_seen);
    RUN_TEST(test_an_unchanged_frame_costs_a_look);
    RUN_TEST(test_background_is_left_out_where_it_was_background);
    RUN_TEST(test_a_frame_with_an_error_is_drawn_again);
#endif
    return UNITY_END();
}
