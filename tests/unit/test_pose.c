/* Poses and cameras follow the conventions of edgeline.h: right-handed, counter-clockwise turns, the camera looks along
 * -z with y up. Exact where the numbers are, against long double where they are not. */
#include "geometry/pose.h"

#include <math.h>
#include <string.h>

#include "seeded.h"

enum { ONE = EL_UNIT_Q30 };

void setUp(void)
{
}

void tearDown(void)
{
}

static void expect_matrix(const int32_t expected[3][3], const int32_t got[3][3])
{
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT32_ARRAY(expected[i], got[i], 3);
    }
}

static void test_identity(void)
{
    static const int32_t unit[3][3] = {{ONE, 0, 0}, {0, ONE, 0}, {0, 0, ONE}};
    const el_pose pose = el_pose_identity();
    expect_matrix(unit, pose.rotation_q30);
    TEST_ASSERT_EACH_EQUAL_INT32(0, pose.position_q16, 3);
    TEST_ASSERT_EQUAL_UINT32(65536, pose.scale_q16);
}

/* Columns are where the model's axes go: a quarter turn about z takes x to y, about x takes y to z, about y z to x. */
static void test_quarter_turns_are_counter_clockwise(void)
{
    static const int32_t about_x[3][3] = {{ONE, 0, 0}, {0, 0, -ONE}, {0, ONE, 0}};
    static const int32_t about_y[3][3] = {{0, 0, ONE}, {0, ONE, 0}, {-ONE, 0, 0}};
    static const int32_t about_z[3][3] = {{0, -ONE, 0}, {ONE, 0, 0}, {0, 0, ONE}};
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(90, 1));
    expect_matrix(about_x, pose.rotation_q30);
    pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Y, EL_DEGREES(90, 1));
    expect_matrix(about_y, pose.rotation_q30);
    pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Z, EL_DEGREES(90, 1));
    expect_matrix(about_z, pose.rotation_q30);
}

/* The second turn is about the model's own axis: after z, the model's x points along the world's y. */
static void test_turns_are_about_the_own_axes(void)
{
    static const int32_t expected[3][3] = {{0, 0, ONE}, {ONE, 0, 0}, {0, ONE, 0}};
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Z, EL_DEGREES(90, 1));
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(90, 1));
    expect_matrix(expected, pose.rotation_q30);
}

static void test_a_turn_leaves_position_and_scale(void)
{
    el_pose pose = el_pose_identity();
    pose.position_q16[1] = -12345;
    pose.scale_q16 = 7;
    el_pose_turn(&pose, EL_AXIS_Y, EL_DEGREES(33, 1));
    TEST_ASSERT_EQUAL_INT32(-12345, pose.position_q16[1]);
    TEST_ASSERT_EQUAL_UINT32(7, pose.scale_q16);
}

/* Rows of length 1 and at right angles, within `tolerance` units of Q30; elements never beyond 1. */
static void expect_rotation(const seeded *s, const int32_t m[3][3], long double tolerance)
{
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = 0; k < 3; k++) {
            long double dot = 0;
            for (unsigned j = 0; j < 3; j++) {
                dot += (long double)m[i][j] * m[k][j] / ONE;
            }
            const long double error = fabsl(dot - (i == k ? ONE : 0));
            if (error > tolerance || m[i][k] > ONE || m[i][k] < -ONE) {
                fail_at(s, "rows %u and %u: product off by %.1Lf units, element %ld", i, k, error, (long)m[i][k]);
            }
        }
    }
}

/* Each turn rounds by half a unit and inherits two units of the sine: a thousand stay near. */
static void test_many_turns_stay_a_rotation(void)
{
    el_pose pose = el_pose_identity();
    for (seeded s = seeded_from(10); s.round < 1000; s.round++) {
        el_pose_turn(&pose, (el_axis)any_below(&s, 3), (el_angle)any_u64(&s));
        expect_rotation(&s, pose.rotation_q30, 6.0L * (s.round + 1));
    }
}

static void test_a_turn_and_back_seeded(void)
{
    for (seeded s = seeded_from(11); s.round < 2000; s.round++) {
        const el_axis axis = (el_axis)any_below(&s, 3);
        const el_angle angle = (el_angle)any_u64(&s);
        el_pose pose = el_pose_identity();
        el_pose_turn(&pose, axis, angle);
        el_pose_turn(&pose, axis, 0 - angle);
        for (unsigned i = 0; i < 9; i++) {
            TEST_ASSERT_INT32_WITHIN(8, i % 4 == 0 ? ONE : 0, pose.rotation_q30[i / 3][i % 3]);
        }
    }
}

static void test_looking_along_minus_z_is_the_identity(void)
{
    static const int32_t unit[3][3] = {{ONE, 0, 0}, {0, ONE, 0}, {0, 0, ONE}};
    static const int32_t eye[3] = {5, -6, 7 * EL_UNIT_Q16};
    static const int32_t target[3] = {5, -6, -EL_UNIT_Q16};
    static const int32_t up[3] = {0, 3, 0};
    el_camera camera = {.fov_y = 77, .near_q16 = 88};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_camera_look_at(&camera, eye, target, up));
    expect_matrix(unit, camera.axes_q30);
    TEST_ASSERT_EQUAL_INT32_ARRAY(eye, camera.position_q16, 3);
    TEST_ASSERT_EQUAL_UINT32(77, camera.fov_y);
    TEST_ASSERT_EQUAL_UINT32(88, camera.near_q16);
}

/* From the tip of x, with z up: right is y. From above, with -z up: right is x. */
static void test_looking_along_other_axes(void)
{
    static const int32_t from_x[3][3] = {{0, ONE, 0}, {0, 0, ONE}, {ONE, 0, 0}};
    static const int32_t from_above[3][3] = {{ONE, 0, 0}, {0, 0, -ONE}, {0, ONE, 0}};
    static const int32_t origin[3] = {0, 0, 0};
    el_camera camera = {0};
    TEST_ASSERT_EQUAL_INT(
        EL_OK, el_camera_look_at(&camera, (const int32_t[]){EL_UNIT_Q16, 0, 0}, origin, (const int32_t[]){0, 0, 1}));
    expect_matrix(from_x, camera.axes_q30);
    TEST_ASSERT_EQUAL_INT(
        EL_OK, el_camera_look_at(&camera, (const int32_t[]){0, EL_UNIT_Q16, 0}, origin, (const int32_t[]){0, 0, -1}));
    expect_matrix(from_above, camera.axes_q30);
}

static void unit_ld(long double v[3])
{
    const long double length = sqrtl(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (unsigned i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

static void cross_ld(const long double a[3], const long double b[3], long double product[3])
{
    for (unsigned i = 0; i < 3; i++) {
        product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

/* Against the definition in long double, wherever `up` is more than about 6 degrees off the view. */
static void test_look_at_seeded(void)
{
    for (seeded s = seeded_from(12); s.round < 5000; s.round++) {
        int32_t eye[3];
        int32_t target[3];
        int32_t up[3];
        long double back[3];
        long double up_ld[3];
        for (unsigned i = 0; i < 3; i++) {
            eye[i] = (int32_t)any_signed_of_bits(&s, 30);
            target[i] = (int32_t)any_signed_of_bits(&s, 30);
            up[i] = (int32_t)any_signed_of_bits(&s, 31);
            back[i] = (long double)eye[i] - target[i];
            up_ld[i] = up[i];
        }
        unit_ld(back);
        unit_ld(up_ld);
        long double right[3];
        cross_ld(up_ld, back, right);
        if (!(right[0] * right[0] + right[1] * right[1] + right[2] * right[2] > 0.01L)) {
            continue; /* also where a vector has no length: then it is not a number */
        }
        unit_ld(right);
        cross_ld(back, right, up_ld);
        el_camera camera = {0};
        TEST_ASSERT_EQUAL_INT(EL_OK, el_camera_look_at(&camera, eye, target, up));
        expect_rotation(&s, camera.axes_q30, 64);
        const long double *const expected[3] = {right, up_ld, back};
        for (unsigned i = 0; i < 9; i++) {
            const long double error = fabsl(camera.axes_q30[i / 3][i % 3] - expected[i / 3][i % 3] * ONE);
            if (error > 64) {
                fail_at(&s, "axis %u off by %.1Lf units", i / 3, error);
            }
        }
    }
}

static void expect_refused(const int32_t eye[3], const int32_t target[3], const int32_t up[3])
{
    el_camera camera;
    el_camera before;
    memset(&camera, 0xA5, sizeof camera);
    memcpy(&before, &camera, sizeof before);
    TEST_ASSERT_EQUAL_INT(EL_ERROR_CAMERA, el_camera_look_at(&camera, eye, target, up));
    TEST_ASSERT_EQUAL_MEMORY(&before, &camera, sizeof camera);
}

static void test_impossible_views_are_refused(void)
{
    static const int32_t origin[3] = {0, 0, 0};
    static const int32_t y[3] = {0, 70000, 0};
    static const int32_t minus_y[3] = {0, -5, 0};
    static const int32_t almost_y[3] = {1, 1 << 30, 0}; /* what is left of it is rounding, not a direction */
    static const int32_t slanted[3] = {300, -500, 700};
    static const int32_t twice_slanted[3] = {600, -1000, 1400};
    expect_refused(origin, origin, y);
    expect_refused(slanted, slanted, y);
    expect_refused(slanted, origin, origin);
    expect_refused(y, origin, y);
    expect_refused(y, origin, minus_y);
    expect_refused(y, origin, almost_y);
    expect_refused(slanted, origin, twice_slanted);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_identity);
    RUN_TEST(test_quarter_turns_are_counter_clockwise);
    RUN_TEST(test_turns_are_about_the_own_axes);
    RUN_TEST(test_a_turn_leaves_position_and_scale);
    RUN_TEST(test_many_turns_stay_a_rotation);
    RUN_TEST(test_a_turn_and_back_seeded);
    RUN_TEST(test_looking_along_minus_z_is_the_identity);
    RUN_TEST(test_looking_along_other_axes);
    RUN_TEST(test_look_at_seeded);
    RUN_TEST(test_impossible_views_are_refused);
    return UNITY_END();
}
