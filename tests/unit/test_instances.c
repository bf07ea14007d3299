/* A scene of everything: an arm of three nodes that an animation moves, a sign that faces the camera, a ball of two levels;
 * drawn as instances, seen at three times, and picked. The pictures are there to be looked at: a letter per instance. */
#include "recording_sink.h"

enum { WIDTH = 32, HEIGHT = 20, BAND_LINES = 4 };

static uint8_t memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, BAND_LINES, 8, 200, 8)];
static uint8_t pick_memory[EL_PICK_BYTES(WIDTH, HEIGHT)];
static recording record;

void setUp(void)
{
    memset(&record, 0, sizeof record);
}

void tearDown(void)
{
}

/* --- the models ------------------------------------------------------------------------------------------------------ */

/* From (0, -1/4) to (2, 1/4), in units of 1/4. */
static const int16_t bar_positions[4][3] = {{0, -1, 0}, {8, -1, 0}, {8, 1, 0}, {0, 1, 0}};
static const uint16_t quad_triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
static const el_mesh bar = {.positions = bar_positions,
                            .triangles = quad_triangles,
                            .vertex_count = 4,
                            .triangle_count = 2,
                            .scale_log2 = -2,
                            .centre = {4, 0, 0},
                            .radius = 5};

/* An octahedron of radius 1, and the quad across its view. */
static const int16_t ball_positions[6][3] = {{4, 0, 0}, {-4, 0, 0}, {0, 4, 0}, {0, -4, 0}, {0, 0, 4}, {0, 0, -4}};
static const uint16_t ball_triangles[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                              {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
static const el_mesh ball = {.positions = ball_positions,
                             .triangles = ball_triangles,
                             .vertex_count = 6,
                             .triangle_count = 8,
                             .scale_log2 = -2,
                             .radius = 4};
static const int16_t sign_positions[4][3] = {{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}};
static const el_mesh sign = {.positions = sign_positions,
                             .triangles = quad_triangles,
                             .vertex_count = 4,
                             .triangle_count = 2,
                             .scale_log2 = -2,
                             .radius = 6};

static const el_level bar_levels[1] = {{.mesh = &bar}};
static const el_level sign_levels[1] = {{.mesh = &sign}};
static const el_level ball_levels[2] = {{.mesh = &ball, .least_px = 6}, {.mesh = &sign}};

/* --- the scene ------------------------------------------------------------------------------------------------------- */

enum { UPPER_ARM, LOWER_ARM, SIGN, BALL, THINGS };

static const uint32_t swing_ms[3] = {0, 1000, 2000};
static const el_quaternion swing_turns[3] = {
    {{EL_UNIT_Q30, 0, 0, 0}},
    {{992008094, 0, 0, 410903207}}, /* 45 degrees about z */
    {{759250125, 0, 0, 759250125}}, /* 90 */
};
static const uint32_t away_ms[2] = {0, 2000};
/* Beside the corners of pixels, so that snapping decides nothing. */
static const int32_t away_q16[2][3] = {{341000, -190000, 0}, {460000, -190000, -20 * EL_UNIT_Q16}};

static const el_animation swing = {
    .rotation = {.keys = {.at_ms = swing_ms, .count = 3, .between = EL_BETWEEN_SMOOTH}, .values = swing_turns},
    .length_ms = 2000,
    .repeat = EL_REPEAT_PING_PONG};
static const el_animation away = {
    .position = {.keys = {.at_ms = away_ms, .count = 2, .between = EL_BETWEEN_LINEAR}, .values_q16 = away_q16},
    .length_ms = 2000};

/* A letter each. */
static const el_material materials[THINGS] = {
    {.colour = {8, 0, 0}}, {.colour = {16, 0, 0}}, {.colour = {24, 0, 0}}, {.colour = {32, 0, 0}}};

typedef struct stage {
    el_camera camera;
    el_node nodes[2];
    el_pose poses[THINGS];
    el_instance instances[THINGS];
} stage;

static stage stage_made(void)
{
    static const int32_t middle_q16[3] = {0, 0, 0};
    stage s = {.camera = {.fov_y = EL_DEGREES(53, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 100 * EL_UNIT_Q16}};
    const el_orbit_camera orbit = el_orbit_camera_at(middle_q16, 10 * EL_UNIT_Q16);
    el_orbit_camera_place(&orbit, &s.camera);
    s.nodes[0] = (el_node){.parent = EL_NO_PARENT, .local = el_pose_identity()};
    s.nodes[0].local.position_q16[0] = -2 * EL_UNIT_Q16;
    s.nodes[1] = (el_node){.parent = 0, .local = el_pose_identity()};
    s.nodes[1].local.position_q16[0] = 2 * EL_UNIT_Q16;
    for (unsigned i = 0; i < THINGS; i++) {
        static const el_level *const levels[THINGS] = {bar_levels, bar_levels, sign_levels, ball_levels};
        s.poses[i] = el_pose_identity();
        s.instances[i] =
            (el_instance){.levels = levels[i], .level_count = i == BALL ? 2 : 1, .material = &materials[i]};
    }
    s.poses[BALL].scale_q16 = 2 * EL_UNIT_Q16;
    s.poses[SIGN].position_q16[0] = -5 * EL_UNIT_Q16;
    s.poses[SIGN].position_q16[1] = 3 * EL_UNIT_Q16;
    return s;
}

/* Both arms turn; the sign faces the camera; the ball goes away. */
static void move_to(stage *s, uint32_t time_ms)
{
    for (unsigned i = 0; i < 2; i++) {
        el_animation_pose(&swing, time_ms, &s->nodes[i].local);
    }
    TEST_ASSERT_EQUAL_INT(EL_OK, el_hierarchy_update(s->nodes, s->poses, 2));
    el_animation_pose(&away, time_ms, &s->poses[BALL]);
    el_billboard_face(&s->poses[SIGN], &s->camera);
    for (unsigned i = 0; i < THINGS; i++) {
        s->instances[i].pose = &s->poses[i];
    }
}

static void show(stage *s)
{
    const el_sink sink = recording_sink(&record);
    const el_config config = {.width = WIDTH,
                              .height = HEIGHT,
                              .band_lines = BAND_LINES,
                              .memory = memory,
                              .memory_bytes = sizeof memory,
                              .sinks = {&sink}};
    el_renderer renderer;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &s->camera));
    do {
        TEST_ASSERT_EQUAL_INT(EL_OK, el_instances_draw(&renderer, s->instances, THINGS));
    } while (el_frame_next(&renderer) > 0);
}

/* 'A' is the first instance; '.' is the background. */
static char letter_at(unsigned x, unsigned y)
{
    const uint16_t pixel = record.pixels[y * WIDTH + x];
    return pixel == 0 ? '.' : (char)('A' - 1 + (pixel >> 11));
}

static void expect_picture(const char *expected)
{
    char got[HEIGHT * (WIDTH + 1) + 1];
    char *at = got;
    for (unsigned y = 0; y < HEIGHT; y++) {
        for (unsigned x = 0; x < WIDTH; x++) {
            *at++ = letter_at(x, y);
        }
        *at++ = '\n';
    }
    *at = '\0';
    TEST_ASSERT_EQUAL_STRING(expected, got);
}

/* Each pixel's instance, and a triangle of the mesh that it has there. */
static void expect_picked(const stage *s)
{
    for (uint16_t y = 0; y < HEIGHT; y++) {
        for (uint16_t x = 0; x < WIDTH; x += 1 + (EL_TEST_PART > 1) * 4) {
            el_pick pick;
            el_picked picked;
            TEST_ASSERT_EQUAL_INT(
                EL_OK, el_pick_begin(&pick, &s->camera, WIDTH, HEIGHT, x, y, pick_memory, sizeof pick_memory));
            TEST_ASSERT_EQUAL_INT(EL_OK, el_instances_pick(&pick, s->instances, THINGS));
            const int is_found = el_pick_end(&pick, &picked);
            TEST_ASSERT_EQUAL_INT(letter_at(x, y), is_found == 0 ? '.' : (char)('A' + picked.draw));
            TEST_ASSERT_TRUE(is_found == 0 || picked.triangle < 8);
        }
    }
}

/* At that time the ball has that level of detail, the picture is as expected, and what is seen is what is picked. */
static void expect_stage(uint32_t time_ms, uint8_t ball_level, const char *picture)
{
    stage s = stage_made();
    move_to(&s, time_ms);
    show(&s);
    TEST_ASSERT_EQUAL_UINT8(ball_level, s.instances[BALL].level);
    expect_picture(picture);
    expect_picked(&s);
}

/* --- what it looks like ---------------------------------------------------------------------------------------------- */

/* Both arms lie along x; the ball is near. */
static void test_at_the_beginning(void)
{
    expect_stage(0, 0,
                 "................................\n"
                 "................................\n"
                 "....CCCC........................\n"
                 "....CCCC........................\n"
                 "....CCCC........................\n"
                 "....CCCC........................\n"
                 "................................\n"
                 "................................\n"
                 "................................\n"
                 "............AAAABBBB............\n"
                 "................................\n"
                 "................................\n"
                 "..........................D.....\n"
                 ".........................DDD....\n"
                 "........................DDDDD...\n"
                 ".......................DDDDDDD..\n"
                 ".......................DDDDDDD..\n"
                 "........................DDDDD...\n"
                 ".........................DDD....\n"
                 "..........................D.....\n");
}

/* Each arm is turned by 45 degrees, the lower one by both; the ball is farther, and a square now. */
static void test_half_way(void)
{
    expect_stage(1000, 1,
                 "................................\n"
                 "................................\n"
                 "....CCCC........................\n"
                 "....CCCC......B.................\n"
                 "....CCCC......B.................\n"
                 "....CCCC......B.................\n"
                 "..............B.................\n"
                 "..............A.................\n"
                 ".............A..................\n"
                 "............A...................\n"
                 "................................\n"
                 "....................DDDD........\n"
                 "....................DDDD........\n"
                 "....................DDDD........\n"
                 "....................DDDD........\n"
                 "................................\n"
                 "................................\n"
                 "................................\n"
                 "................................\n"
                 "................................\n");
}

/* A quarter turn each: the lower arm points back. */
static void test_at_the_end(void)
{
    expect_stage(2000, 1,
                 "................................\n"
                 "................................\n"
                 "....CCCC........................\n"
                 "....CCCC........................\n"
                 "....CCCC........................\n"
                 "....CCCCBBBB....................\n"
                 "...........A....................\n"
                 "...........A....................\n"
                 "...........A....................\n"
                 "...........A....................\n"
                 "................................\n"
                 "...................DDD..........\n"
                 "...................DDD..........\n"
                 "................................\n"
                 "................................\n"
                 "................................\n"
                 "................................\n"
                 "................................\n"
                 "................................\n"
                 "................................\n");
}

/* A light without normals: the others are drawn all the same, and picked, by their own numbers. */
static void test_an_error_stops_nothing_but_its_own(void)
{
    static const el_light light = {.ambient = 255};
    static const el_material lit = {.light = &light};
    el_config config = {
        .width = WIDTH, .height = HEIGHT, .band_lines = BAND_LINES, .memory = memory, .memory_bytes = sizeof memory};
    stage s = stage_made();
    el_renderer renderer;
    el_pick pick;
    el_picked picked;
    move_to(&s, 0);
    s.instances[LOWER_ARM].material = &lit;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &s.camera));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_instances_draw(&renderer, s.instances, THINGS));
    TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
    TEST_ASSERT_EQUAL_UINT32(THINGS - 1, el_frame_stats(&renderer)->draws);
    TEST_ASSERT_EQUAL_INT(EL_OK,
                          el_pick_begin(&pick, &s.camera, WIDTH, HEIGHT, 26, 15, pick_memory, sizeof pick_memory));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, el_instances_pick(&pick, s.instances, THINGS));
    TEST_ASSERT_EQUAL_INT(1, el_pick_end(&pick, &picked));
    TEST_ASSERT_EQUAL_UINT32(BALL, picked.draw);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_at_the_beginning);
    RUN_TEST(test_half_way);
    RUN_TEST(test_at_the_end);
    RUN_TEST(test_an_error_stops_nothing_but_its_own);
    return UNITY_END();
}
