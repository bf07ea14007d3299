/* The guide's examples of the scene's parts, each as it stands there, and that it does what is said there. */
#include <string.h>

#include "edgeline.h"
#include "unity.h"

enum { WIDTH = 64, HEIGHT = 48 };

static el_renderer r;
static uint8_t memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, 8, 8, 64, 8)];

/* A square of 2 x 2 units in x and y, and a triangle in its place. */
static const int16_t corners[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
static const uint16_t halves[2][3] = {{0, 1, 2}, {0, 2, 3}};
static const el_mesh fine = {
    .positions = corners, .triangles = halves, .vertex_count = 4, .triangle_count = 2, .radius = 2};
static const el_mesh coarse = {
    .positions = corners, .triangles = halves, .vertex_count = 4, .triangle_count = 1, .radius = 2};
static const el_material red = {.colour = {255, 0, 0}, .flags = EL_MATERIAL_TWO_SIDED};

static el_camera camera;

void setUp(void)
{
    const el_config config = {
        .width = WIDTH, .height = HEIGHT, .band_lines = 8, .memory = memory, .memory_bytes = sizeof memory};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&r, &config));
    camera = (el_camera){.fov_y = EL_DEGREES(60, 1), .near_q16 = EL_UNIT_Q16 / 4, .far_q16 = 100 * EL_UNIT_Q16};
    const el_orbit_camera orbit = el_orbit_camera_at((const int32_t[]){0, 0, 0}, 5 * EL_UNIT_Q16);
    el_orbit_camera_place(&orbit, &camera);
}

void tearDown(void)
{
}

/* An orbit camera that a stick turns, -1 to 1; `ms` have passed since the last frame, 1,000 at most. */
static void turn_camera(el_orbit_camera *orbit, int32_t stick_x, int32_t stick_y, int32_t ms)
{
    const int32_t per_ms = (int32_t)EL_DEGREES(90, 1000); /* 90 degrees in a second */
    el_orbit_camera_turn(orbit, stick_x * ms * per_ms, stick_y * ms * per_ms);
    el_orbit_camera_place(orbit, &camera);
}

static void test_orbit_camera(void)
{
    el_orbit_camera orbit = el_orbit_camera_at((const int32_t[]){0, 0, 0}, 5 * EL_UNIT_Q16);
    turn_camera(&orbit, 1, 0, 1000);
    TEST_ASSERT_INT32_WITHIN(8, 5 * EL_UNIT_Q16, camera.position_q16[0]);
}

/* First person: an orbit without a distance walks. */
static void walk(el_orbit_camera *eyes, int32_t forward_mm, int32_t ms)
{
    eyes->distance_q16 = 0;
    el_orbit_camera_walk(eyes, forward_mm * EL_UNIT_Q16 / 1000 * ms / 1000, 0);
    el_orbit_camera_place(eyes, &camera);
}

static void test_walking(void)
{
    el_orbit_camera eyes = el_orbit_camera_at((const int32_t[]){0, EL_UNIT_Q16, 0}, 0);
    walk(&eyes, 2000, 500);
    TEST_ASSERT_INT32_WITHIN(64, -EL_UNIT_Q16, camera.position_q16[2]);
    TEST_ASSERT_EQUAL_INT32(EL_UNIT_Q16, camera.position_q16[1]);
}

/* Two turns, one after the other, and half of the way there. */
static void turn_half(el_pose *pose)
{
    const el_quaternion yaw = el_quaternion_about((const int32_t[]){0, 1, 0}, EL_DEGREES(120, 1));
    const el_quaternion roll = el_quaternion_about((const int32_t[]){0, 0, 1}, EL_DEGREES(30, 1));
    const el_quaternion both = el_quaternion_multiply(&yaw, &roll); /* first the roll */
    const el_quaternion none = el_quaternion_identity();
    const el_quaternion half = el_quaternion_slerp(&none, &both, EL_UNIT_Q30 / 2);
    el_quaternion_to_rotation(&half, pose->rotation_q30);
}

static void test_quaternions(void)
{
    el_pose pose = el_pose_identity();
    turn_half(&pose);
    const el_quaternion half = el_quaternion_from_rotation((const int32_t(*)[3])pose.rotation_q30);
    const el_quaternion whole = el_quaternion_multiply(&half, &half);
    TEST_ASSERT_INT32_WITHIN(16, 518577479, whole.q30[0]); /* cos 60 cos 15 */
}

/* A ball that bounces for ever: keys in flash. */
static const uint32_t bounce_ms[] = {0, 400, 800};
static const int32_t bounce_q16[][3] = {{0, 0, 0}, {0, EL_UNIT_Q16, 0}, {0, 0, 0}};
static const el_animation bounce = {
    .position = {.keys = {.at_ms = bounce_ms, .count = 3, .between = EL_BETWEEN_SMOOTH}, .values_q16 = bounce_q16},
    .length_ms = 800,
    .repeat = EL_REPEAT_LOOP,
};

static void test_animations(void)
{
    el_pose pose = el_pose_identity();
    el_animation_pose(&bounce, 800 * 1000 + 400, &pose);
    TEST_ASSERT_EQUAL_INT32(EL_UNIT_Q16, pose.position_q16[1]);
}

/* A moon around an earth around the sun: parents before children. */
static el_status place_planets(uint32_t ms, el_pose world[3])
{
    el_node nodes[3] = {{EL_NO_PARENT, el_pose_identity()}, {0, el_pose_identity()}, {1, el_pose_identity()}};
    el_pose_turn(&nodes[0].local, EL_AXIS_Y, ms * (EL_DEGREES(36, 1) / 1000)); /* in ten seconds */
    nodes[1].local.position_q16[0] = 4 * EL_UNIT_Q16;
    el_pose_turn(&nodes[1].local, EL_AXIS_Y, ms * (EL_DEGREES(360, 1000)));
    nodes[2].local.position_q16[0] = EL_UNIT_Q16;
    nodes[2].local.scale_q16 = EL_UNIT_Q16 / 4;
    return el_hierarchy_update(nodes, world, 3);
}

static void test_hierarchies(void)
{
    el_pose world[3];
    TEST_ASSERT_EQUAL_INT(EL_OK, place_planets(0, world));
    TEST_ASSERT_EQUAL_INT32(5 * EL_UNIT_Q16, world[2].position_q16[0]);
    TEST_ASSERT_EQUAL_UINT32(EL_UNIT_Q16 / 4, world[2].scale_q16);
}

/* Trees: a model near by, a picture farther away, drawn from a list; and what is under the finger. */
static const el_level tree_levels[] = {{&fine, 10}, {&coarse, 0}};
static el_pose tree_poses[2];
static el_instance trees[2] = {
    {.levels = tree_levels, .level_count = 2, .pose = &tree_poses[0], .material = &red},
    {.levels = tree_levels, .level_count = 2, .pose = &tree_poses[1], .material = &red},
};

static void show_trees(void)
{
    for (unsigned i = 0; i < 2; i++) {
        (void)el_billboard_about(&tree_poses[i], &camera, (const int32_t[]){0, 1, 0}); /* or el_billboard_face */
    }
    el_frame_begin(&r, &camera);
    do {
        el_instances_draw(&r, trees, 2);
    } while (el_frame_next(&r) > 0);
}

static uint8_t pick_memory[EL_PICK_BYTES(WIDTH, HEIGHT)];

static int32_t touch(uint16_t x, uint16_t y)
{
    el_pick pick;
    el_picked picked;
    el_pick_begin(&pick, &camera, WIDTH, HEIGHT, x, y, pick_memory, sizeof pick_memory);
    el_instances_pick(&pick, trees, 2);
    return el_pick_end(&pick, &picked) > 0 ? (int32_t)picked.draw : -1;
}

static void test_instances(void)
{
    for (unsigned i = 0; i < 2; i++) {
        tree_poses[i] = el_pose_identity();
    }
    tree_poses[1].position_q16[2] = -40 * EL_UNIT_Q16;
    tree_poses[1].position_q16[0] = 20 * EL_UNIT_Q16;
    show_trees();
    TEST_ASSERT_EQUAL_UINT8(0, trees[0].level);
    TEST_ASSERT_EQUAL_UINT8(1, trees[1].level);
    TEST_ASSERT_EQUAL_UINT32(3, el_frame_stats(&r)->triangles);
    TEST_ASSERT_EQUAL_INT32(0, touch(WIDTH / 2, HEIGHT / 2));
    TEST_ASSERT_EQUAL_INT32(-1, touch(0, 0));
}

/* A turret that follows its target. */
static void test_looking_at(void)
{
    el_pose turret = el_pose_identity();
    const int32_t target_q16[3] = {0, 0, 9 * EL_UNIT_Q16};
    if (el_pose_look_at(&turret, target_q16, (const int32_t[]){0, 1, 0}) != EL_OK) {
        TEST_FAIL_MESSAGE("the target is where the turret is, or straight above it: it stays as it is");
    }
    TEST_ASSERT_EQUAL_INT32(EL_UNIT_Q30, turret.rotation_q30[2][2]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_orbit_camera);
    RUN_TEST(test_walking);
    RUN_TEST(test_quaternions);
    RUN_TEST(test_animations);
    RUN_TEST(test_hierarchies);
    RUN_TEST(test_instances);
    RUN_TEST(test_looking_at);
    return UNITY_END();
}
