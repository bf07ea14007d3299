/* From the model to the snapped screen: conventions by example, exact where they can be, and errors. The seeded
 * comparison with long double is in test_transform_accuracy.c. */
#include <string.h>

#include "reference_view.h"
#include "seeded.h"

enum { WIDTH = 320, HEIGHT = 240, UNIT = 256 }; /* position units per world unit of the mesh below */

static const int16_t corner_points[][3] = {{0, 0, 0}};
static const el_mesh mesh = {
    .positions = corner_points, .vertex_count = 1, .scale_log2 = -8, .centre = {0, 0, 0}, .radius = 32767};

static el_view view;
static el_transform transform;

void setUp(void)
{
}

void tearDown(void)
{
}

static void prepare(const el_camera *camera, const el_pose *pose)
{
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, camera, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL_INT(EL_VISIBLE, el_transform_make(&transform, &view, &mesh, pose));
}

/* A point in 1/256 world units. */
static el_screen_vertex see(int16_t x, int16_t y, int16_t z)
{
    const el_clip_vertex clip = el_transform_position(&transform, (const int16_t[3]){x, y, z});
    el_screen_vertex screen = {.code = el_outcode(&transform, &clip)};
    if ((screen.code & EL_CODE_CLIP) == 0) {
        el_project(&transform, &clip, &screen);
    }
    return screen;
}

static void expect_at(el_screen_vertex vertex, int32_t x, int32_t y)
{
    TEST_ASSERT_EQUAL_HEX8(0, vertex.code & EL_CODE_CLIP);
    TEST_ASSERT_EQUAL_INT32(x, vertex.x);
    TEST_ASSERT_EQUAL_INT32(y, vertex.y);
}

/* At 90 degrees and distance 2, the picture is 4 units high: 60 px per unit. */
static void test_x_is_right_and_y_is_up(void)
{
    const el_camera camera = plain_camera();
    const el_pose pose = el_pose_identity();
    prepare(&camera, &pose);
    expect_at(see(0, 0, -2 * UNIT), 160 * EL_SUBPIXELS, 120 * EL_SUBPIXELS);
    expect_at(see(UNIT, 0, -2 * UNIT), 220 * EL_SUBPIXELS, 120 * EL_SUBPIXELS);
    expect_at(see(0, UNIT, -2 * UNIT), 160 * EL_SUBPIXELS, 60 * EL_SUBPIXELS);
    expect_at(see(0, 2 * UNIT, -2 * UNIT), 160 * EL_SUBPIXELS, 0);
    expect_at(see(0, -2 * UNIT, -2 * UNIT), 160 * EL_SUBPIXELS, 240 * EL_SUBPIXELS);
    TEST_ASSERT_EQUAL_UINT8(0, transform.mirrored);
}

/* The picture's sides belong to the view; a unit beyond does not. */
static void test_outcodes_at_the_sides(void)
{
    const el_camera camera = plain_camera();
    const el_pose pose = el_pose_identity();
    prepare(&camera, &pose);
    TEST_ASSERT_EQUAL_HEX8(0, see(0, 3 * UNIT, -3 * UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_ABOVE, see(0, 3 * UNIT + 1, -3 * UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_BELOW, see(0, -3 * UNIT - 1, -3 * UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(0, see(4 * UNIT - 1, 0, -3 * UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_RIGHT, see(4 * UNIT + 1, 0, -3 * UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_LEFT, see(-4 * UNIT - 1, 0, -3 * UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_LEFT | EL_CODE_ABOVE, see(-4 * UNIT - 1, 3 * UNIT + 1, -3 * UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(0, see(0, 0, -UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_NEAR, see(0, 0, 1 - UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(0, see(0, 0, -100 * UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_FAR, see(0, 0, -100 * UNIT - 1).code);
}

/* 320 px: half a picture is 160 px, the guard band 8 times that beyond the middle; 240 px: 16 times 120. */
static void test_outcodes_at_the_guard_band(void)
{
    const el_camera camera = plain_camera();
    const el_pose pose = el_pose_identity();
    prepare(&camera, &pose);
    TEST_ASSERT_EQUAL_UINT8(3, transform.guard_shift[0]);
    TEST_ASSERT_EQUAL_UINT8(4, transform.guard_shift[1]);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_RIGHT, see(32 * UNIT / 3, 0, -UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_RIGHT | EL_CODE_GUARD, see(32 * UNIT / 3 + 1, 0, -UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_LEFT | EL_CODE_GUARD, see(-32 * UNIT / 3 - 1, 0, -UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_ABOVE, see(0, 16 * UNIT, -UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_ABOVE | EL_CODE_GUARD, see(0, 16 * UNIT + 1, -UNIT).code);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_BELOW | EL_CODE_GUARD, see(0, -16 * UNIT - 1, -UNIT).code);
    expect_at(see(0, 16 * UNIT, -UNIT), 160 * EL_SUBPIXELS, (120 - 16 * 120) * EL_SUBPIXELS);
}

/* Every size keeps its guard band within the range of a screen coordinate. */
static void test_guard_bands_of_all_sizes(void)
{
    const el_camera camera = plain_camera();
    for (unsigned size = 1; size <= EL_MAX_WIDTH; size++) {
        TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, (uint16_t)size, (uint16_t)size));
        const unsigned far_side = size + (size << view.guard_shift[0]); /* twice the distance from the origin */
        TEST_ASSERT_LESS_OR_EQUAL_UINT(2 * EL_GUARD_PX, far_side);
        TEST_ASSERT_GREATER_THAN_UINT(2 * EL_GUARD_PX, size + (2 * size << view.guard_shift[0]));
        TEST_ASSERT_EQUAL_UINT8(view.guard_shift[0], view.guard_shift[1]);
    }
}

static void test_depth_is_0_at_near_and_65534_at_far(void)
{
    el_camera camera = plain_camera();
    const el_pose pose = el_pose_identity();
    for (unsigned i = 0; i < 2; i++) {
        camera.projection = i == 0 ? EL_PERSPECTIVE : EL_ORTHOGRAPHIC;
        camera.height_q16 = 10 * EL_UNIT_Q16;
        prepare(&camera, &pose);
        TEST_ASSERT_EQUAL_UINT16(0, see(0, 0, -UNIT).z);
        TEST_ASSERT_EQUAL_UINT16(65534, see(0, 0, -100 * UNIT).z);
    }
    /* Orthographic: half way is half the depth. Perspective: at twice near it is 65534 * (100 / 99) / 2. */
    TEST_ASSERT_EQUAL_UINT16(32767, see(0, 0, -(101 * UNIT) / 2).z);
    camera.projection = EL_PERSPECTIVE;
    prepare(&camera, &pose);
    TEST_ASSERT_EQUAL_UINT16(33098, see(0, 0, -2 * UNIT).z);
}

/* 1/w is w * 2^-w_shift in one unit for the whole draw: times the distance it is a constant, within half a unit of
 * 16 bits at either end. */
static void test_inverse_w(void)
{
    const el_camera camera = plain_camera();
    const el_pose pose = el_pose_identity();
    prepare(&camera, &pose);
    const el_screen_vertex first = see(0, 0, -UNIT);
    const long double constant = ldexpl(first.w, -first.w_shift);
    for (int16_t z = -UNIT; z >= -100 * UNIT; z = (int16_t)(z - 37)) {
        const el_screen_vertex vertex = see(0, 0, z);
        TEST_ASSERT_TRUE(vertex.w >= 0x8000 && vertex.w_shift <= 31);
        const long double ratio = ldexpl(vertex.w, -vertex.w_shift) * (-z / (long double)UNIT) / constant;
        TEST_ASSERT_TRUE_MESSAGE(fabsl(ratio - 1) <= 0x1p-15L, "1/w times the distance");
    }
}

/* 20 units high on 240 lines: 12 px per unit, at any distance. */
static void test_orthographic(void)
{
    el_camera camera = plain_camera();
    camera.projection = EL_ORTHOGRAPHIC;
    camera.height_q16 = 20 * EL_UNIT_Q16;
    const el_pose pose = el_pose_identity();
    prepare(&camera, &pose);
    for (int distance = 1; distance <= 100; distance += 33) {
        const int16_t z = (int16_t)(-distance * UNIT);
        expect_at(see(0, 0, z), 160 * EL_SUBPIXELS, 120 * EL_SUBPIXELS);
        expect_at(see(UNIT, 0, z), 172 * EL_SUBPIXELS, 120 * EL_SUBPIXELS);
        expect_at(see(0, 10 * UNIT, z), 160 * EL_SUBPIXELS, 0);
        TEST_ASSERT_EQUAL_HEX8(EL_CODE_ABOVE, see(0, 10 * UNIT + 1, z).code);
    }
}

static void test_aspect_stretches_x(void)
{
    el_camera camera = plain_camera();
    camera.aspect_q16 = 2 * EL_UNIT_Q16; /* the picture shows twice as much sideways as upwards */
    const el_pose pose = el_pose_identity();
    prepare(&camera, &pose);
    expect_at(see(4 * UNIT, 2 * UNIT, -2 * UNIT), 320 * EL_SUBPIXELS, 0);
    camera.aspect_q16 = EL_UNIT_Q16 / 2;
    prepare(&camera, &pose);
    expect_at(see(UNIT, 0, -2 * UNIT), 320 * EL_SUBPIXELS, 120 * EL_SUBPIXELS);
}

/* EL_SUBPIXELS world units on 256 lines: one position unit is one sub-pixel, exactly, and the scale makes fractions of
 * it. */
static void prepare_fractions(uint32_t scale_q16)
{
    el_camera camera = plain_camera();
    camera.projection = EL_ORTHOGRAPHIC;
    camera.height_q16 = EL_SUBPIXELS * EL_UNIT_Q16;
    el_pose pose = el_pose_identity();
    pose.scale_q16 = scale_q16;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, 256, 256));
    TEST_ASSERT_EQUAL_INT(EL_VISIBLE, el_transform_make(&transform, &view, &mesh, &pose));
}

static void test_snapping_is_to_the_nearest_and_ties_go_right(void)
{
    static const int x_of[] = {-2, -1, -1, -1, -1, 0, 0, 0, 0, 1, 1, 1, 1, 2}; /* of -7/4 to 6/4 */
    prepare_fractions(EL_UNIT_Q16 / 4);
    for (int i = 0; i < 14; i++) {
        TEST_ASSERT_EQUAL_INT(128 * EL_SUBPIXELS + x_of[i], see((int16_t)(i - 7), 0, -16 * UNIT).x);
    }
}

/* On the screen y is down, and ties go down too. */
static void test_ties_in_y_go_down(void)
{
    prepare_fractions(EL_UNIT_Q16 / 2);
    TEST_ASSERT_EQUAL_INT(128 * EL_SUBPIXELS - 0, see(0, 1, -8 * UNIT).y);
    TEST_ASSERT_EQUAL_INT(128 * EL_SUBPIXELS + 1, see(0, -1, -8 * UNIT).y);
    TEST_ASSERT_EQUAL_INT(128 * EL_SUBPIXELS - 1, see(0, 3, -8 * UNIT).y);
    TEST_ASSERT_EQUAL_INT(128 * EL_SUBPIXELS + 2, see(0, -3, -8 * UNIT).y);
}

static void test_pose_scales_turns_and_moves(void)
{
    const el_camera camera = plain_camera();
    el_pose pose = el_pose_identity();
    pose.scale_q16 = 2 * EL_UNIT_Q16;
    pose.position_q16[2] = -4 * EL_UNIT_Q16;
    el_pose_turn(&pose, EL_AXIS_Z, EL_DEGREES(90, 1));
    prepare(&camera, &pose);
    expect_at(see(UNIT, 0, 0), 160 * EL_SUBPIXELS,
              60 * EL_SUBPIXELS); /* x points up now: 2 units at distance 4, 30 px each */
    expect_at(see(0, UNIT, 0), 100 * EL_SUBPIXELS, 120 * EL_SUBPIXELS);
}

static void test_reflections_are_mirrored(void)
{
    el_camera camera = plain_camera();
    el_pose pose = el_pose_identity();
    pose.rotation_q30[0][0] = -EL_UNIT_Q30;
    prepare(&camera, &pose);
    TEST_ASSERT_EQUAL_UINT8(1, transform.mirrored);
    expect_at(see(UNIT, 0, -2 * UNIT), 100 * EL_SUBPIXELS, 120 * EL_SUBPIXELS);
    camera.axes_q30[0][0] = -EL_UNIT_Q30;
    prepare(&camera, &pose);
    TEST_ASSERT_EQUAL_UINT8(0, transform.mirrored);
    expect_at(see(UNIT, 0, -2 * UNIT), 220 * EL_SUBPIXELS, 120 * EL_SUBPIXELS);
    pose.rotation_q30[0][0] = EL_UNIT_Q30;
    prepare(&camera, &pose);
    TEST_ASSERT_EQUAL_UINT8(1, transform.mirrored);
}

/* --- Errors ------------------------------------------------------------------------------------------------------- */

static void expect_view_refused(el_status status, const el_camera *camera, uint16_t width, uint16_t height)
{
    el_view got;
    el_view before;
    memset(&got, 0xA5, sizeof got);
    memcpy(&before, &got, sizeof before);
    TEST_ASSERT_EQUAL_INT(status, el_view_make(&got, camera, width, height));
    TEST_ASSERT_EQUAL_MEMORY(&before, &got, sizeof got);
}

static void test_sizes_at_their_limits(void)
{
    const el_camera camera = plain_camera();
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, 1, 1));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, EL_MAX_WIDTH, EL_MAX_HEIGHT));
    expect_view_refused(EL_ERROR_SIZE, &camera, 0, 1);
    expect_view_refused(EL_ERROR_SIZE, &camera, 1, 0);
    expect_view_refused(EL_ERROR_SIZE, &camera, EL_MAX_WIDTH + 1, 1);
    expect_view_refused(EL_ERROR_SIZE, &camera, 1, EL_MAX_HEIGHT + 1);
}

/* One member at a time: the ends of its range are taken, the values beside them are not. */
static void expect_range(uint32_t *member, el_camera *camera, el_status status, uint32_t least, uint32_t most)
{
    const uint32_t kept = *member;
    *member = least;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, camera, WIDTH, HEIGHT));
    *member = most;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, camera, WIDTH, HEIGHT));
    *member = least - 1;
    expect_view_refused(status, camera, WIDTH, HEIGHT);
    *member = most + 1;
    expect_view_refused(status, camera, WIDTH, HEIGHT);
    *member = kept;
}

static void test_camera_members_at_their_limits(void)
{
    el_camera camera = plain_camera();
    expect_range(&camera.fov_y, &camera, EL_ERROR_CAMERA, EL_DEGREES(1, 1), EL_DEGREES(179, 1));
    expect_range(&camera.near_q16, &camera, EL_ERROR_CAMERA, 16, 100U * EL_UNIT_Q16 * 8 / 9);
    expect_range(&camera.far_q16, &camera, EL_ERROR_CAMERA, EL_UNIT_Q16 / 8 * 9, 16384U * EL_UNIT_Q16);
    expect_range(&camera.aspect_q16, &camera, EL_ERROR_CAMERA, 256, 256 * EL_UNIT_Q16);
    camera.projection = EL_ORTHOGRAPHIC;
    expect_range(&camera.height_q16, &camera, EL_ERROR_CAMERA, 256, 32768U * EL_UNIT_Q16);
}

static void test_camera_places_at_their_limits(void)
{
    static const int32_t farthest[] = {-(1 << 30), 1 << 30};
    static const int32_t too_far[] = {-(1 << 30) - 1, (1 << 30) + 1, INT32_MIN, INT32_MAX};
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = 0; k < 4; k++) {
            el_camera camera = plain_camera();
            camera.position_q16[i] = farthest[k % 2];
            TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, WIDTH, HEIGHT));
            camera.position_q16[i] = too_far[k];
            expect_view_refused(EL_ERROR_RANGE, &camera, WIDTH, HEIGHT);
        }
    }
}

/* Rounding may carry an element of a rotation a few units beyond 1, not further. */
static void test_camera_axes_at_their_limits(void)
{
    static const int32_t longest[] = {-EL_UNIT_Q30 - 16, EL_UNIT_Q30 + 16};
    static const int32_t too_long[] = {-EL_UNIT_Q30 - 17, EL_UNIT_Q30 + 17, INT32_MIN, INT32_MAX};
    for (unsigned i = 0; i < 9; i++) {
        for (unsigned k = 0; k < 4; k++) {
            el_camera camera = plain_camera();
            camera.axes_q30[i / 3][i % 3] = longest[k % 2];
            TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, WIDTH, HEIGHT));
            camera.axes_q30[i / 3][i % 3] = too_long[k];
            expect_view_refused(EL_ERROR_CAMERA, &camera, WIDTH, HEIGHT);
        }
    }
}

static void expect_draw_refused(const el_mesh *m, const el_pose *pose)
{
    el_transform got;
    el_transform before;
    memset(&got, 0xA5, sizeof got);
    memcpy(&before, &got, sizeof before);
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_transform_make(&got, &view, m, pose));
    TEST_ASSERT_EQUAL_MEMORY(&before, &got, sizeof got);
}

static void test_draws_out_of_range_are_refused(void)
{
    const el_camera camera = plain_camera();
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, WIDTH, HEIGHT));
    for (unsigned i = 0; i < 3; i++) {
        el_pose pose = el_pose_identity();
        pose.position_q16[i] = (1 << 30) + 1;
        expect_draw_refused(&mesh, &pose);
        pose.position_q16[i] = -(1 << 30) - 1;
        expect_draw_refused(&mesh, &pose);
        pose.position_q16[i] = INT32_MIN;
        expect_draw_refused(&mesh, &pose);
        pose = el_pose_identity();
        pose.rotation_q30[i][2 - i] = EL_UNIT_Q30 + 17;
        expect_draw_refused(&mesh, &pose);
        pose.rotation_q30[i][2 - i] = INT32_MIN;
        expect_draw_refused(&mesh, &pose);
    }
    el_pose pose = el_pose_identity();
    pose.scale_q16 = 0;
    expect_draw_refused(&mesh, &pose);
    pose.scale_q16 = UINT32_MAX;
    expect_draw_refused(&mesh, &pose); /* a radius of 128 units, 65536 times */
    pose = el_pose_identity();
    el_mesh other = mesh;
    other.scale_log2 = 9;
    expect_draw_refused(&other, &pose);
    other.scale_log2 = -31;
    expect_draw_refused(&other, &pose);
}

/* A mesh of whole world units is an ordinary mesh: it is its size that the world limits, not its unit. */
static void test_coarse_units_are_fine_for_small_meshes(void)
{
    const el_camera camera = plain_camera();
    el_pose pose = el_pose_identity();
    pose.position_q16[2] = -50 * EL_UNIT_Q16;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, WIDTH, HEIGHT));
    for (int8_t scale = -30; scale <= 8; scale++) {
        const el_mesh small = {.positions = corner_points, .vertex_count = 1, .scale_log2 = scale, .radius = 2};
        TEST_ASSERT_EQUAL_INT_MESSAGE(EL_VISIBLE, el_transform_make(&transform, &view, &small, &pose), "scale_log2");
    }
}

/* However small its sphere and however far from it its origin, a mesh's rows are what el_transform_set_rows asks for. */
static void test_rows_of_the_smallest_meshes(void)
{
    el_camera camera = plain_camera();
    camera.near_q16 = 16;
    for (seeded s = seeded_from(70); s.round < PART_OF(20000); s.round++) {
        const el_mesh small = {.positions = corner_points,
                               .vertex_count = 1,
                               .scale_log2 = -1,
                               .centre = {32000, 32000, 32000},
                               .radius = (uint16_t)(s.round % 4)};
        el_pose pose = el_pose_identity();
        pose.scale_q16 = (uint32_t)any_between(&s, EL_UNIT_Q16 / 4, EL_UNIT_Q16);
        for (unsigned i = 0; i < 3; i++) {
            pose.position_q16[i] = -16000 * (int32_t)pose.scale_q16;
        }
        /* It looks along the space's diagonal, to which a row's three elements are alike. */
        static const int32_t axes_q30[3][3] = {
            {759250125, -759250125, 0}, {438353264, 438353264, -876706528}, {619925131, 619925131, 619925131}};
        memcpy(camera.axes_q30, axes_q30, sizeof axes_q30);
        for (unsigned i = 0; i < 3; i++) {
            camera.position_q16[i] = (int32_t)any_below(&s, EL_UNIT_Q16 / 2);
        }
        camera.fov_y = (el_angle)any_between(&s, EL_DEGREES(1, 1), EL_DEGREES(179, 1));
        TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, WIDTH, HEIGHT));
        if (el_transform_make(&transform, &view, &small, &pose) != EL_VISIBLE) {
            continue;
        }
        for (unsigned i = 0; i < 3; i++) {
            uint64_t sum = 0;
            for (unsigned j = 0; j < 3; j++) {
                sum += el_abs_u64(el_transform_element(&transform, i, j));
            }
            if (sum > EL_ROW_MOST) {
                fail_at(&s, "row %u adds up to %llu", i, (unsigned long long)sum);
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rows_of_the_smallest_meshes);
    RUN_TEST(test_x_is_right_and_y_is_up);
    RUN_TEST(test_outcodes_at_the_sides);
    RUN_TEST(test_outcodes_at_the_guard_band);
    RUN_TEST(test_guard_bands_of_all_sizes);
    RUN_TEST(test_depth_is_0_at_near_and_65534_at_far);
    RUN_TEST(test_inverse_w);
    RUN_TEST(test_orthographic);
    RUN_TEST(test_aspect_stretches_x);
    RUN_TEST(test_snapping_is_to_the_nearest_and_ties_go_right);
    RUN_TEST(test_ties_in_y_go_down);
    RUN_TEST(test_pose_scales_turns_and_moves);
    RUN_TEST(test_reflections_are_mirrored);
    RUN_TEST(test_sizes_at_their_limits);
    RUN_TEST(test_camera_members_at_their_limits);
    RUN_TEST(test_camera_places_at_their_limits);
    RUN_TEST(test_camera_axes_at_their_limits);
    RUN_TEST(test_draws_out_of_range_are_refused);
    RUN_TEST(test_coarse_units_are_fine_for_small_meshes);
    return UNITY_END();
}
