/* A camera is turned about its focus, comes nearer, moves aside, and remains one that a frame can begin with. */
#include <math.h>
#include <string.h>

#include "geometry/orbit.h"
#include "geometry/transform.h"
#include "seeded.h"

#define WORLD_Q16 (1 << 30)

void setUp(void)
{
}

void tearDown(void)
{
}

static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};

static el_camera looking(const int32_t eye_q16[3], const int32_t target_q16[3])
{
    el_camera camera = {.fov_y = EL_DEGREES(50, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 200 * EL_UNIT_Q16};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_camera_look_at(&camera, eye_q16, target_q16, up_q16));
    return camera;
}

/* Where a point of the world is before the camera: right, up and backward, in units. */
static void see(const el_camera *camera, const double point[3], double seen[3])
{
    for (unsigned axis = 0; axis < 3; axis++) {
        seen[axis] = 0;
        for (unsigned i = 0; i < 3; i++) {
            seen[axis] += camera->axes_q30[axis][i] / 1073741824.0 * (point[i] - camera->position_q16[i] / 65536.0);
        }
    }
}

static void expect_near(const seeded *s, const char *what, double expected, double is, double slack)
{
    if (!(fabs(expected - is) <= slack)) {
        fail_at(s, "%s is %.6f, not %.6f", what, is, expected);
    }
}

/* Any camera that el_frame_begin takes. */
static el_camera any_camera(seeded *s)
{
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Y, (el_angle)any_u64(s));
    el_pose_turn(&pose, EL_AXIS_X, (el_angle)any_u64(s));
    el_pose_turn(&pose, EL_AXIS_Z, (el_angle)any_u64(s));
    const uint32_t near_q16 = (uint32_t)any_between(s, 16, 1 + (int64_t)(15 + any_of_bits(s, 29)));
    const uint32_t least_far_q16 = near_q16 + (near_q16 + 7) / 8;
    el_camera camera = {.projection = any_below(s, 3) == 0 ? EL_ORTHOGRAPHIC : EL_PERSPECTIVE,
                        .fov_y = (el_angle)any_between(s, EL_DEGREES(1, 1), EL_DEGREES(179, 1)),
                        .height_q16 = (uint32_t)any_between(s, 256, 256 + (int64_t)any_of_bits(s, 30)),
                        .near_q16 = near_q16,
                        .far_q16 = (uint32_t)any_between(s, least_far_q16, WORLD_Q16)};
    memcpy(camera.axes_q30, pose.rotation_q30, sizeof camera.axes_q30);
    for (unsigned i = 0; i < 3; i++) {
        camera.position_q16[i] = (int32_t)any_between(s, -WORLD_Q16, WORLD_Q16);
    }
    return camera;
}

/* Mostly ends of the ranges. */
static int16_t any_offset(seeded *s, int32_t most)
{
    const uint32_t kind = any_below(s, 4);
    return (int16_t)(kind == 0 ? 0 : (kind == 1 ? most : (kind == 2 ? -most : any_between(s, -most, most))));
}

static el_orbit any_orbit(seeded *s)
{
    return (el_orbit){.yaw = (uint16_t)any_u64(s),
                      .pitch = any_offset(s, EL_ORBIT_QUARTER_TURN),
                      .zoom_q8 = any_offset(s, EL_ORBIT_MAX_ZOOM_Q8),
                      .pan_q8 = {any_offset(s, EL_ORBIT_MAX_PAN_Q8), any_offset(s, EL_ORBIT_MAX_PAN_Q8)}};
}

static void test_no_offsets_leave_the_camera_to_the_last_bit(void)
{
    static const el_orbit none = {0};
    for (seeded s = seeded_from(520); s.round < PART_OF(1000); s.round++) {
        const el_camera before = any_camera(&s);
        el_camera camera = before;
        el_orbit_apply(&none, (uint32_t)any_between(&s, 1, WORLD_Q16), &camera);
        TEST_ASSERT_EQUAL_MEMORY(&before, &camera, sizeof camera);
    }
}

static void test_a_frame_can_begin_with_any_camera_that_is_moved(void)
{
    for (seeded s = seeded_from(521); s.round < PART_OF(20000); s.round++) {
        const el_camera before = any_camera(&s);
        const el_orbit orbit = any_orbit(&s);
        const uint32_t focus_q16 =
            any_below(&s, 2) == 0 ? el_orbit_focus_q16(&before) : 1 + (uint32_t)any_below(&s, WORLD_Q16);
        el_camera camera = before;
        el_view view;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &before, 320, 240));
        TEST_ASSERT_GREATER_THAN_UINT32(0, focus_q16);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(WORLD_Q16, focus_q16);
        el_orbit_apply(&orbit, focus_q16, &camera);
        const el_status status = el_view_make(&view, &camera, 320, 240);
        if (status != EL_OK) {
            fail_at(&s, "status %d: near %u, far %u, height %u", status, (unsigned)camera.near_q16,
                    (unsigned)camera.far_q16, (unsigned)camera.height_q16);
        }
    }
}

/* The focus stays in the middle of the picture at its distance, however it is turned. */
static void test_it_turns_about_the_focus(void)
{
    for (seeded s = seeded_from(522); s.round < PART_OF(500); s.round++) {
        const int32_t eye_q16[3] = {(int32_t)any_between(&s, 1, 40) * EL_UNIT_Q16,
                                    (int32_t)any_between(&s, -40, 40) * EL_UNIT_Q16,
                                    (int32_t)any_between(&s, -40, 40) * EL_UNIT_Q16};
        const int32_t target_q16[3] = {(int32_t)any_between(&s, -40, 0) * EL_UNIT_Q16, 0,
                                       (int32_t)any_between(&s, -40, 40) * EL_UNIT_Q16};
        const double target[3] = {target_q16[0] / 65536.0, 0, target_q16[2] / 65536.0};
        double before[3];
        double after[3];
        const el_camera scene = looking(eye_q16, target_q16);
        el_camera camera = scene;
        const el_orbit orbit = {.yaw = (uint16_t)any_u64(&s), .pitch = any_offset(&s, EL_ORBIT_QUARTER_TURN)};
        see(&scene, target, before);
        el_orbit_apply(&orbit, (uint32_t)(-before[2] * 65536), &camera);
        see(&camera, target, after);
        expect_near(&s, "right", 0, after[0], 0.001);
        expect_near(&s, "up", 0, after[1], 0.001);
        expect_near(&s, "distance", -before[2], -after[2], 0.001);
        TEST_ASSERT_EQUAL_UINT32(scene.near_q16, camera.near_q16);
        TEST_ASSERT_EQUAL_UINT32(scene.far_q16, camera.far_q16);
    }
}

/* From +z: a quarter turn to the right is +x, and upwards is +y. */
static void test_right_and_up_are_where_one_expects_them(void)
{
    static const int32_t eye_q16[3] = {0, 0, 8 * EL_UNIT_Q16};
    static const int32_t origin[3] = {0, 0, 0};
    static const struct {
        el_orbit orbit;
        int position[3];
    } cases[] = {
        {{.yaw = 16384}, {8, 0, 0}},
        {{.yaw = 49152}, {-8, 0, 0}},
        {{.yaw = 32768}, {0, 0, -8}},
        {{.pitch = 16384}, {0, 8, 0}},
        {{.pitch = -16384}, {0, -8, 0}},
        {{.zoom_q8 = 256}, {0, 0, 4}},
        {{.zoom_q8 = -512}, {0, 0, 32}},
        {{.pan_q8 = {256, 0}}, {8, 0, 8}},
        {{.pan_q8 = {0, 128}}, {0, 4, 8}},
        {{.zoom_q8 = 256, .pan_q8 = {256, 0}}, {4, 0, 4}},
        {{.yaw = 16384, .pan_q8 = {256, 0}}, {8, 0, -8}},
    };
    seeded s = seeded_from(523);
    for (; s.round < sizeof cases / sizeof cases[0]; s.round++) {
        el_camera camera = looking(eye_q16, origin);
        el_orbit_apply(&cases[s.round].orbit, 8 * EL_UNIT_Q16, &camera);
        for (unsigned i = 0; i < 3; i++) {
            expect_near(&s, "position", cases[s.round].position[i], camera.position_q16[i] / 65536.0, 0.001);
        }
    }
}

static void test_zoom_divides_the_distance_by_powers_of_two(void)
{
    static const int32_t eye_q16[3] = {0, 0, 100 * EL_UNIT_Q16};
    static const int32_t origin[3] = {0, 0, 0};
    seeded s = seeded_from(524);
    for (int32_t zoom = -EL_ORBIT_MAX_ZOOM_Q8; zoom <= EL_ORBIT_MAX_ZOOM_Q8; zoom++, s.round++) {
        el_camera camera = looking(eye_q16, origin);
        const el_orbit orbit = {.zoom_q8 = (int16_t)zoom};
        const double factor = pow(2, -zoom / 256.0);
        el_orbit_apply(&orbit, 100 * EL_UNIT_Q16, &camera);
        expect_near(&s, "distance", 100 * factor, camera.position_q16[2] / 65536.0, 0.0001 * factor + 0.0001);
        expect_near(&s, "near", factor, camera.near_q16 / 65536.0, 0.0001);
        expect_near(&s, "far", 200 * (factor > 1 ? factor : 1), camera.far_q16 / 65536.0, 0.001 * factor + 0.0001);
    }
}

static void test_an_orthographic_picture_grows_instead(void)
{
    static const int32_t eye_q16[3] = {0, 0, 8 * EL_UNIT_Q16};
    static const int32_t origin[3] = {0, 0, 0};
    el_camera camera = looking(eye_q16, origin);
    camera.projection = EL_ORTHOGRAPHIC;
    camera.height_q16 = 6 * EL_UNIT_Q16;
    const el_orbit orbit = {.zoom_q8 = 256};
    el_orbit_apply(&orbit, 8 * EL_UNIT_Q16, &camera);
    TEST_ASSERT_EQUAL_UINT32(3 * EL_UNIT_Q16, camera.height_q16);
    TEST_ASSERT_EQUAL_INT32(8 * EL_UNIT_Q16, camera.position_q16[2]);
    TEST_ASSERT_EQUAL_UINT32(EL_UNIT_Q16, camera.near_q16);
}

static void test_the_focus_is_the_point_nearest_to_the_origin(void)
{
    static const int32_t eye_q16[3] = {3 * EL_UNIT_Q16, 0, 10 * EL_UNIT_Q16};
    static const int32_t ahead[3] = {3 * EL_UNIT_Q16, 0, 0};
    static const int32_t behind[3] = {3 * EL_UNIT_Q16, 0, 20 * EL_UNIT_Q16};
    el_camera camera = looking(eye_q16, ahead);
    TEST_ASSERT_EQUAL_UINT32(10 * EL_UNIT_Q16, el_orbit_focus_q16(&camera));
    camera.far_q16 = 7 * EL_UNIT_Q16;
    TEST_ASSERT_EQUAL_UINT32(7 * EL_UNIT_Q16, el_orbit_focus_q16(&camera));
    camera = looking(eye_q16, behind);
    TEST_ASSERT_EQUAL_UINT32(2 * EL_UNIT_Q16, el_orbit_focus_q16(&camera));
}

/* --- el_orbit_camera --------------------------------------------------------------------------------------------------- */

static const int32_t at_q16[3] = {EL_UNIT_Q16, 2 * EL_UNIT_Q16, -3 * EL_UNIT_Q16};

static void expect_position(int32_t x, int32_t y, int32_t z, const int32_t position_q16[3])
{
    const int32_t expected[3] = {x * EL_UNIT_Q16, y * EL_UNIT_Q16, z * EL_UNIT_Q16};
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_INT32_WITHIN(1, expected[i], position_q16[i]);
    }
}

/* It begins on +z, looks along -z; to the right is +x, and upwards +y. */
static void test_it_stands_where_one_expects_it(void)
{
    el_orbit_camera orbit = el_orbit_camera_at(at_q16, 10 * EL_UNIT_Q16);
    el_camera camera = {.fov_y = 7};
    el_orbit_camera_place(&orbit, &camera);
    expect_position(1, 2, 7, camera.position_q16);
    TEST_ASSERT_EQUAL_INT32(EL_UNIT_Q30, camera.axes_q30[0][0]);
    TEST_ASSERT_EQUAL_INT32(EL_UNIT_Q30, camera.axes_q30[2][2]);
    TEST_ASSERT_EQUAL_UINT32(7, camera.fov_y);
    el_orbit_camera_turn(&orbit, (int32_t)EL_DEGREES(90, 1), 0);
    el_orbit_camera_place(&orbit, &camera);
    expect_position(11, 2, -3, camera.position_q16);
    orbit.most_pitch = (int32_t)EL_DEGREES(90, 1);
    el_orbit_camera_turn(&orbit, 0, INT32_MAX);
    el_orbit_camera_place(&orbit, &camera);
    expect_position(1, 12, -3, camera.position_q16);
}

static void test_its_limits(void)
{
    el_orbit_camera orbit = el_orbit_camera_at(at_q16, EL_UNIT_Q16);
    el_orbit_camera_turn(&orbit, INT32_MIN, INT32_MIN);
    TEST_ASSERT_EQUAL_INT32(-(int32_t)EL_DEGREES(89, 1), orbit.pitch);
    el_orbit_camera_turn(&orbit, INT32_MIN, INT32_MAX);
    el_orbit_camera_turn(&orbit, 0, INT32_MAX);
    TEST_ASSERT_EQUAL_INT32(EL_DEGREES(89, 1), orbit.pitch);
    TEST_ASSERT_EQUAL_HEX32(0, orbit.yaw);
    el_orbit_camera_zoom(&orbit, 256);
    TEST_ASSERT_EQUAL_UINT32(EL_UNIT_Q16 / 2, orbit.distance_q16);
    el_orbit_camera_zoom(&orbit, INT32_MAX);
    TEST_ASSERT_EQUAL_UINT32(EL_UNIT_Q16 / 16, orbit.distance_q16);
    el_orbit_camera_zoom(&orbit, INT32_MIN);
    TEST_ASSERT_EQUAL_UINT32(EL_UNIT_Q16, orbit.distance_q16);
    el_orbit_camera_zoom(&orbit, INT32_MIN);
    el_orbit_camera_zoom(&orbit, INT32_MIN);
    TEST_ASSERT_EQUAL_UINT32(16 * EL_UNIT_Q16, orbit.distance_q16);
    TEST_ASSERT_EQUAL_UINT32(WORLD_Q16, el_orbit_camera_at(at_q16, WORLD_Q16).most_distance_q16);
}

/* Turned to the right by a quarter, the picture's right is -z and into it is -x. */
static void test_it_pans_and_walks(void)
{
    el_orbit_camera orbit = el_orbit_camera_at(at_q16, 4 * EL_UNIT_Q16);
    el_camera camera;
    el_orbit_camera_turn(&orbit, (int32_t)EL_DEGREES(90, 1), 0);
    el_orbit_camera_pan(&orbit, 256, 128);
    expect_position(1, 4, -7, orbit.target_q16);
    el_orbit_camera_turn(&orbit, 0, (int32_t)EL_DEGREES(40, 1));
    el_orbit_camera_walk(&orbit, 3 * EL_UNIT_Q16, 2 * EL_UNIT_Q16);
    expect_position(-2, 4, -9, orbit.target_q16);
    orbit.distance_q16 = 0; /* its own eyes */
    el_orbit_camera_place(&orbit, &camera);
    expect_position(-2, 4, -9, camera.position_q16);
}

/* Whatever it is told, a frame can begin with it, and its target is in the middle of the picture. */
static void test_a_frame_can_begin_with_any_orbit(void)
{
    for (seeded s = seeded_from(761); s.round < PART_OF(5000); s.round++) {
        const int32_t target_q16[3] = {(int32_t)any_signed_of_bits(&s, 30), (int32_t)any_signed_of_bits(&s, 30),
                                       (int32_t)any_signed_of_bits(&s, 30)};
        el_orbit_camera orbit = el_orbit_camera_at(target_q16, (uint32_t)any_of_bits(&s, 30));
        el_camera camera = any_camera(&s);
        el_view view;
        for (unsigned i = 0; i < 4; i++) {
            el_orbit_camera_turn(&orbit, (int32_t)any_u64(&s), (int32_t)any_u64(&s));
            el_orbit_camera_zoom(&orbit, (int32_t)any_signed_of_bits(&s, 31));
            el_orbit_camera_pan(&orbit, (int32_t)any_signed_of_bits(&s, 31), (int32_t)any_signed_of_bits(&s, 31));
            el_orbit_camera_walk(&orbit, (int32_t)any_signed_of_bits(&s, 31), (int32_t)any_signed_of_bits(&s, 31));
        }
        el_orbit_camera_place(&orbit, &camera);
        const el_status status = el_view_make(&view, &camera, 320, 240);
        if (status != EL_OK) {
            fail_at(&s, "status %d", status);
        }
        bool is_cut = false;
        double target[3];
        double seen[3];
        for (unsigned i = 0; i < 3; i++) {
            target[i] = orbit.target_q16[i] / 65536.0;
            is_cut = is_cut || camera.position_q16[i] == WORLD_Q16 || camera.position_q16[i] == -WORLD_Q16;
        }
        see(&camera, target, seen);
        for (unsigned i = 0; i < 3 && !is_cut; i++) {
            expect_near(&s, "the target", i < 2 ? 0 : -(orbit.distance_q16 / 65536.0), seen[i],
                        3 / 65536.0 + orbit.distance_q16 / 65536.0 / (1 << 26));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_offsets_leave_the_camera_to_the_last_bit);
    RUN_TEST(test_a_frame_can_begin_with_any_camera_that_is_moved);
    RUN_TEST(test_it_turns_about_the_focus);
    RUN_TEST(test_right_and_up_are_where_one_expects_them);
    RUN_TEST(test_zoom_divides_the_distance_by_powers_of_two);
    RUN_TEST(test_an_orthographic_picture_grows_instead);
    RUN_TEST(test_the_focus_is_the_point_nearest_to_the_origin);
    RUN_TEST(test_it_stands_where_one_expects_it);
    RUN_TEST(test_its_limits);
    RUN_TEST(test_it_pans_and_walks);
    RUN_TEST(test_a_frame_can_begin_with_any_orbit);
    return UNITY_END();
}
