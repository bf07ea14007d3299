/* Sizes on the screen against doubles, and levels that do not flicker. */
#include "geometry/detail.h"

#include <math.h>

#include "seeded.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static const int32_t up[3] = {0, 1, 0};

/* A sphere of radius 1 ten units before a camera of 90 degrees: 2 / 10 of half of 240 lines. */
static void test_by_hand(void)
{
    const el_mesh mesh = {.scale_log2 = -4, .radius = 16};
    const el_pose pose = el_pose_identity();
    el_camera camera = {.fov_y = EL_DEGREES(90, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 100 * EL_UNIT_Q16};
    el_view view;
    TEST_ASSERT_EQUAL_INT(
        EL_OK, el_camera_look_at(&camera, (const int32_t[]){0, 0, 10 * EL_UNIT_Q16}, (const int32_t[]){0, 0, 0}, up));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, 320, 240));
    TEST_ASSERT_EQUAL_UINT32(24 * 16, el_screen_size_q4(&view, &mesh, &pose));
    camera.projection = EL_ORTHOGRAPHIC;
    camera.height_q16 = 20 * EL_UNIT_Q16;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, 320, 240));
    TEST_ASSERT_EQUAL_UINT32(24 * 16, el_screen_size_q4(&view, &mesh, &pose));
}

/* What is behind the camera counts as at the near plane, and what is too large for a number as the largest. */
static void test_near_and_huge(void)
{
    const el_mesh mesh = {.scale_log2 = 0, .radius = 2};
    const el_mesh huge = {.scale_log2 = 8, .radius = 65535};
    el_pose pose = el_pose_identity();
    el_camera camera = {.fov_y = EL_DEGREES(90, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 100 * EL_UNIT_Q16};
    el_view view;
    TEST_ASSERT_EQUAL_INT(
        EL_OK, el_camera_look_at(&camera, (const int32_t[]){0, 0, 0}, (const int32_t[]){0, 0, -EL_UNIT_Q16}, up));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, 320, 240));
    pose.position_q16[2] = 50 * EL_UNIT_Q16;
    TEST_ASSERT_EQUAL_UINT32(480 * 16, el_screen_size_q4(&view, &mesh, &pose));
    pose.scale_q16 = UINT32_MAX;
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, el_screen_size_q4(&view, &huge, &pose));
}

static void test_sizes_seeded(void)
{
    for (seeded s = seeded_from(741); s.round < PART_OF(50000); s.round++) {
        el_mesh mesh = {.scale_log2 = (int8_t)any_between(&s, -16, -4), .radius = (uint16_t)any_of_bits(&s, 16)};
        el_pose pose = el_pose_identity();
        el_camera camera = {.fov_y = (el_angle)any_between(&s, EL_DEGREES(5, 1), EL_DEGREES(150, 1)),
                            .height_q16 = (uint32_t)any_between(&s, 256, 1 << 24),
                            .projection = any_below(&s, 4) == 0 ? EL_ORTHOGRAPHIC : EL_PERSPECTIVE,
                            .near_q16 = (uint32_t)any_between(&s, 256, 1 << 20),
                            .far_q16 = 1 << 30};
        int32_t eye[3];
        int32_t target[3];
        for (unsigned i = 0; i < 3; i++) {
            el_pose_turn(&pose, (el_axis)i, (el_angle)any_u64(&s));
            mesh.centre[i] = (int16_t)any_u64(&s);
            pose.position_q16[i] = (int32_t)any_signed_of_bits(&s, 25);
            eye[i] = (int32_t)any_signed_of_bits(&s, 25);
            target[i] = (int32_t)any_signed_of_bits(&s, 25);
        }
        pose.scale_q16 = 1 + (uint32_t)any_of_bits(&s, 18);
        el_view view;
        if (el_camera_look_at(&camera, eye, target, up) != EL_OK) {
            continue;
        }
        const uint16_t height = (uint16_t)any_between(&s, 16, 480);
        TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, 320, height));
        const double unit = pose.scale_q16 / 65536.0 * pow(2, mesh.scale_log2);
        double distance = 0;
        for (unsigned i = 0; i < 3; i++) {
            double middle = pose.position_q16[i] / 65536.0;
            for (unsigned j = 0; j < 3; j++) {
                middle += pose.rotation_q30[i][j] / 1073741824.0 * unit * mesh.centre[j];
            }
            distance += camera.axes_q30[2][i] / 1073741824.0 * (camera.position_q16[i] / 65536.0 - middle);
        }
        const bool is_flat = camera.projection == EL_ORTHOGRAPHIC;
        const double half = camera.fov_y / 4294967296.0 * 3.14159265358979323846;
        const double lines = is_flat ? 2 * mesh.radius * unit / (camera.height_q16 / 65536.0) * height
                                     : mesh.radius * unit / tan(half) * height;
        const double off = is_flat ? 0 : 1.0 / 16384;
        const double near = camera.near_q16 / 65536.0;
        const double least = lines / (is_flat ? 1 : fmax(distance + off, near)) * (1 - 1.0 / 65536) - 1.0 / 16;
        const double most = lines / (is_flat ? 1 : fmax(distance - off, near)) * (1 + 1.0 / 65536) + 1.0 / 16;
        const double got = el_screen_size_q4(&view, &mesh, &pose) / 16.0;
        if (got < least || got > most) {
            fail_at(&s, "%.4f lines, not %.4f to %.4f", got, least, most);
        }
    }
}

static const el_level levels[3] = {{.least_px = 100}, {.least_px = 40}, {.least_px = 7}};

static void test_levels_by_hand(void)
{
    TEST_ASSERT_EQUAL_UINT8(2, el_level_choose(levels, 3, 0, 0));
    TEST_ASSERT_EQUAL_UINT8(0, el_level_choose(levels, 3, UINT32_MAX, 2));
    TEST_ASSERT_EQUAL_UINT8(0, el_level_choose(levels, 3, 100 * 16, 0)); /* it stays ... */
    TEST_ASSERT_EQUAL_UINT8(1, el_level_choose(levels, 3, 100 * 16 - 1, 0));
    TEST_ASSERT_EQUAL_UINT8(1, el_level_choose(levels, 3, 112 * 16, 1)); /* ... and comes back later */
    TEST_ASSERT_EQUAL_UINT8(0, el_level_choose(levels, 3, 112 * 16 + 8, 1));
    TEST_ASSERT_EQUAL_UINT8(1, el_level_choose(levels, 3, 45 * 16, 2));
    TEST_ASSERT_EQUAL_UINT8(2, el_level_choose(levels, 3, 45 * 16 - 1, 2));
    TEST_ASSERT_EQUAL_UINT8(2, el_level_choose(levels, 3, 1, 255));
    TEST_ASSERT_EQUAL_UINT8(0, el_level_choose(levels, 1, 0, 3));
}

/* A pass that is asked for again draws the same. */
static void test_asked_again_it_says_the_same(void)
{
    for (seeded s = seeded_from(742); s.round < 20000; s.round++) {
        const uint32_t size_q4 = (uint32_t)any_of_bits(&s, 12);
        const uint8_t level = el_level_choose(levels, 3, size_q4, (uint8_t)any_u64(&s));
        TEST_ASSERT_EQUAL_UINT8(level, el_level_choose(levels, 3, size_q4, level));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_by_hand);
    RUN_TEST(test_near_and_huge);
    RUN_TEST(test_sizes_seeded);
    RUN_TEST(test_levels_by_hand);
    RUN_TEST(test_asked_again_it_says_the_same);
    return UNITY_END();
}
