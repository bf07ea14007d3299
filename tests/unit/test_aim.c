/* Models look at things, billboards face the camera, and what has no direction is refused without a trace. */
#include "geometry/aim.h"

#include <math.h>
#include <string.h>

#include "seeded.h"

enum { ONE = EL_UNIT_Q30 };

#define UNITS 1073741824.0

void setUp(void)
{
}

void tearDown(void)
{
}

static void expect_matrix(const int32_t expected[3][3], const el_pose *pose)
{
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT32_ARRAY(expected[i], pose->rotation_q30[i], 3);
    }
}

/* Columns of length 1, at right angles, right-handed. */
static void expect_rotation(const seeded *s, const el_pose *pose)
{
    double m[3][3];
    for (unsigned i = 0; i < 9; i++) {
        m[i / 3][i % 3] = pose->rotation_q30[i / 3][i % 3] / UNITS;
    }
    for (unsigned i = 0; i < 3; i++) {
        const unsigned j = (i + 1) % 3;
        const unsigned k = (i + 2) % 3;
        for (unsigned r = 0; r < 3; r++) {
            const unsigned p = (r + 1) % 3;
            const unsigned q = (r + 2) % 3;
            const double crossed = m[p][j] * m[q][k] - m[q][j] * m[p][k];
            if (fabs(crossed - m[r][i]) > 16 / UNITS) {
                fail_at(s, "column %u is not the product of the others: row %u is off by %.2g", i, r,
                        crossed - m[r][i]);
            }
        }
    }
}

static el_pose placed(const int32_t position_q16[3])
{
    el_pose pose = el_pose_identity();
    memcpy(pose.position_q16, position_q16, sizeof pose.position_q16);
    pose.scale_q16 = 777;
    return pose;
}

static void any_point(seeded *s, int32_t point_q16[3])
{
    const unsigned bits = 4 + any_below(s, 27);
    for (unsigned i = 0; i < 3; i++) {
        point_q16[i] = (int32_t)any_signed_of_bits(s, bits);
    }
}

static void test_along_the_axes(void)
{
    static const int32_t unit[3][3] = {{ONE, 0, 0}, {0, ONE, 0}, {0, 0, ONE}};
    static const int32_t along_x[3][3] = {{0, 0, ONE}, {0, ONE, 0}, {-ONE, 0, 0}};
    el_pose pose = placed((const int32_t[]){4, 5, 6});
    TEST_ASSERT_EQUAL_INT(EL_OK, el_pose_look_at(&pose, (const int32_t[]){4, 5, 99}, (const int32_t[]){0, 2, 0}));
    expect_matrix(unit, &pose);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_pose_look_at(&pose, (const int32_t[]){99, 5, 6}, (const int32_t[]){1, 2, 0}));
    expect_matrix(along_x, &pose);
    TEST_ASSERT_EQUAL_UINT32(777, pose.scale_q16);
    TEST_ASSERT_EQUAL_INT32_ARRAY(((const int32_t[]){4, 5, 6}), pose.position_q16, 3);
}

static void test_models_look_at_their_target(void)
{
    for (seeded s = seeded_from(711); s.round < PART_OF(20000); s.round++) {
        int32_t target[3];
        int32_t up[3];
        int32_t position[3];
        any_point(&s, target);
        any_point(&s, up);
        any_point(&s, position);
        el_pose pose = placed(position);
        const el_pose before = pose;
        if (el_pose_look_at(&pose, target, up) != EL_OK) {
            TEST_ASSERT_EQUAL_MEMORY(&before, &pose, sizeof pose);
            continue;
        }
        expect_rotation(&s, &pose);
        double length = 0;
        double upwards = 0;
        for (unsigned i = 0; i < 3; i++) {
            length += ((double)target[i] - position[i]) * ((double)target[i] - position[i]);
            upwards += (double)up[i] * pose.rotation_q30[i][1];
        }
        for (unsigned i = 0; i < 3; i++) {
            const double towards = ((double)target[i] - position[i]) / sqrt(length);
            if (fabs(pose.rotation_q30[i][2] / UNITS - towards) > 8 / UNITS || upwards <= 0) {
                fail_at(&s, "z is off by %.2g, up by %.2g", pose.rotation_q30[i][2] / UNITS - towards, upwards);
            }
        }
    }
}

static void test_what_has_no_direction_is_refused(void)
{
    static const int32_t here[3] = {10, 20, 30};
    static const int32_t there[3] = {10, 20, 31};
    static const int32_t none[3] = {0, 0, 0};
    static const int32_t along[3] = {0, 0, -5};
    static const int32_t up[3] = {0, 1, 0};
    el_camera camera = {.axes_q30 = {{ONE, 0, 0}, {0, ONE, 0}, {0, 0, ONE}}, .position_q16 = {10, 20, 31}};
    el_pose pose = placed(here);
    const el_pose before = pose;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_pose_look_at(&pose, here, up));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_pose_look_at(&pose, there, none));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_pose_look_at(&pose, there, along));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_billboard_about(&pose, &camera, none));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_billboard_about(&pose, &camera, along));
    camera.position_q16[2] = 30;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_billboard_about(&pose, &camera, up));
    camera.projection = EL_ORTHOGRAPHIC; /* sees it from its own side, wherever it stands */
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_billboard_about(&pose, &camera, along));
    TEST_ASSERT_EQUAL_MEMORY(&before, &pose, sizeof pose);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_billboard_about(&pose, &camera, up));
    TEST_ASSERT_EQUAL_MEMORY(&before, &pose, sizeof pose);
}

static el_camera any_camera(seeded *s)
{
    static const int32_t up[3] = {1, 50, 3};
    el_camera camera = {.projection = any_below(s, 2) == 0 ? EL_PERSPECTIVE : EL_ORTHOGRAPHIC};
    int32_t eye[3];
    int32_t target[3];
    do {
        any_point(s, eye);
        any_point(s, target);
    } while (el_camera_look_at(&camera, eye, target, up) != EL_OK);
    return camera;
}

/* x and y of the screen and of the quad are the same. */
static void test_billboards_face_the_screen(void)
{
    for (seeded s = seeded_from(712); s.round < PART_OF(2000); s.round++) {
        const el_camera camera = any_camera(&s);
        el_pose pose = placed((const int32_t[]){1, 2, 3});
        el_billboard_face(&pose, &camera);
        for (unsigned i = 0; i < 9; i++) {
            TEST_ASSERT_EQUAL_INT32(camera.axes_q30[i / 3][i % 3], pose.rotation_q30[i % 3][i / 3]);
        }
    }
}

/* y is the axis; x lies across the way to the camera; z looks to the camera's side. */
static void test_billboards_about_an_axis(void)
{
    for (seeded s = seeded_from(713); s.round < PART_OF(20000); s.round++) {
        const el_camera camera = any_camera(&s);
        int32_t axis[3];
        int32_t position[3];
        any_point(&s, axis);
        any_point(&s, position);
        el_pose pose = placed(position);
        if (el_billboard_about(&pose, &camera, axis) != EL_OK) {
            continue;
        }
        expect_rotation(&s, &pose);
        const double length = sqrt((double)axis[0] * axis[0] + (double)axis[1] * axis[1] + (double)axis[2] * axis[2]);
        double away = 0;
        double across = 0;
        double towards = 0;
        for (unsigned i = 0; i < 3; i++) {
            const double way = camera.projection == EL_ORTHOGRAPHIC ? camera.axes_q30[2][i]
                                                                    : (double)camera.position_q16[i] - position[i];
            away += way * way;
            across += way * pose.rotation_q30[i][0] / UNITS;
            towards += way * pose.rotation_q30[i][2] / UNITS;
            if (fabs(pose.rotation_q30[i][1] / UNITS - axis[i] / length) > 8 / UNITS) {
                fail_at(&s, "y is not the axis");
            }
        }
        /* The shorter the product of axis and view, the coarser its direction: 2^-20 at least, of 2^-28. */
        if (fabs(across) > sqrt(away) / 200 || towards <= 0) {
            fail_at(&s, "x is %.2g towards the camera, z %.2g", across / sqrt(away), towards / sqrt(away));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_along_the_axes);
    RUN_TEST(test_models_look_at_their_target);
    RUN_TEST(test_what_has_no_direction_is_refused);
    RUN_TEST(test_billboards_face_the_screen);
    RUN_TEST(test_billboards_about_an_axis);
    return UNITY_END();
}
