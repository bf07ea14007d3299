/* The integer transform against long double over seeded cameras, poses and meshes: every position within 1/16 px, depth
 * within a unit, and a bounding sphere that can be seen is never culled. Prints what share is rounded correctly. */
#include <stdlib.h>

#include "reference_view.h"
#include "seeded.h"

enum { MAX_ERROR = EL_SUBPIXELS / 16, POINTS = 12 }; /* 1/16 px */

typedef struct setting {
    el_camera camera;
    el_pose pose;
    el_mesh mesh;
    uint16_t width, height;
    int16_t points[POINTS][3];
} setting;

typedef struct tally {
    unsigned long points, correct;
    long double largest; /* in sub-pixels */
    long double largest_depth;
} tally;

void setUp(void)
{
}

void tearDown(void)
{
}

static void turn_freely(seeded *s, int32_t rotation_q30[3][3])
{
    el_pose pose = el_pose_identity();
    for (unsigned i = 0; i < 3; i++) {
        el_pose_turn(&pose, (el_axis)i, (el_angle)any_u64(s));
    }
    for (unsigned i = 0; i < 9; i++) {
        rotation_q30[i / 3][i % 3] = pose.rotation_q30[i / 3][i % 3];
    }
}

/* A sphere around all points, its radius rounded up. */
static void bound(el_mesh *mesh, int16_t points[POINTS][3], seeded *s)
{
    long double largest = 0;
    for (unsigned i = 0; i < 3; i++) {
        mesh->centre[i] = (int16_t)any_signed_of_bits(s, 12);
    }
    for (unsigned i = 0; i < POINTS; i++) {
        long double squares = 0;
        for (unsigned j = 0; j < 3; j++) {
            squares += ((long double)points[i][j] - mesh->centre[j]) * ((long double)points[i][j] - mesh->centre[j]);
        }
        largest = fmaxl(largest, sqrtl(squares));
    }
    mesh->radius = (uint16_t)ceill(largest);
}

static void any_lens(seeded *s, setting *t)
{
    t->width = (uint16_t)any_between(s, 16, 640);
    t->height = (uint16_t)any_between(s, 16, 480);
    t->camera.projection = any_below(s, 4) == 0 ? EL_ORTHOGRAPHIC : EL_PERSPECTIVE;
    t->camera.fov_y = (el_angle)any_between(s, EL_DEGREES(15, 1), EL_DEGREES(120, 1));
    t->camera.height_q16 = (uint32_t)any_between(s, 1 << 14, 1 << 22);
    t->camera.aspect_q16 = any_below(s, 3) == 0 ? (uint32_t)any_between(s, 1 << 15, 1 << 17) : 0;
    t->camera.near_q16 = (uint32_t)any_between(s, 1 << 12, 1 << 17);
    t->camera.far_q16 = t->camera.near_q16 * 2 + (uint32_t)any_between(s, 0, 1 << 26);
}

/* A mesh of 2^-8 to 2^8 world units in size, in front of a camera that is anywhere within `place_bits` bits of Q16. */
static setting any_setting(seeded *s, unsigned place_bits)
{
    setting t = {.pose = el_pose_identity()};
    any_lens(s, &t);
    turn_freely(s, t.camera.axes_q30);
    turn_freely(s, t.pose.rotation_q30);
    t.mesh = (el_mesh){.vertex_count = POINTS, .scale_log2 = (int8_t)any_between(s, -14, -8)};
    const int scale_log2 = (int)any_between(s, -8, 8); /* the model's, in all: 2^scale_log2 at 12 bits of position */
    const int pose_log2 = scale_log2 - (t.mesh.scale_log2 + 12);
    t.pose.scale_q16 = (uint32_t)ldexp(65536 + (double)any_below(s, 65536), pose_log2);
    for (unsigned i = 0; i < POINTS * 3; i++) {
        t.points[i / 3][i % 3] = (int16_t)any_between(s, -4095, 4095);
    }
    bound(&t.mesh, t.points, s);
    /* Its distance is of its own size or a little more, so that most points are seen and some are beside the view. */
    const double distance = ldexp(0.5 + any_below(s, 1000) / 400.0, scale_log2 + 1);
    for (unsigned i = 0; i < 3; i++) {
        t.camera.position_q16[i] = (int32_t)any_signed_of_bits(s, place_bits);
        t.pose.position_q16[i] =
            t.camera.position_q16[i] - (int32_t)(t.camera.axes_q30[2][i] / (double)EL_UNIT_Q30 * distance * 65536);
    }
    return t;
}

static void report(const char *what, const tally *sums)
{
    printf("%s: %lu points, %.3f%% rounded correctly, at most %.3Lf sub-pixels and %.3Lf units of depth off\n", what,
           sums->points, 100.0 * (double)sums->correct / (double)sums->points, sums->largest, sums->largest_depth);
}

/* At most `allowed` sub-pixels off on either axis. */
static void check_point(const seeded *s, const setting *t, const el_transform *transform, const int16_t p[3],
                        long double allowed, tally *sums)
{
    const el_clip_vertex clip = el_transform_position(transform, p);
    if ((el_outcode(transform, &clip) & EL_CODE_CLIP) != 0) {
        return;
    }
    el_screen_vertex got = {0};
    el_project(transform, &clip, &got);
    const reference_point exact = reference_project(&t->camera, t->width, t->height, &t->mesh, &t->pose, p);
    const long double x_error = fabsl(got.x - exact.x * EL_SUBPIXELS);
    const long double y_error = fabsl(got.y - exact.y * EL_SUBPIXELS);
    const long double error = fmaxl(x_error, y_error);
    sums->points++;
    sums->correct += error <= 0.5L;
    sums->largest = fmaxl(sums->largest, error);
    sums->largest_depth = fmaxl(sums->largest_depth, fabsl(got.z - exact.depth));
    if (!(error <= allowed)) {
        fail_at(s, "(%d, %d) for (%.4Lf, %.4Lf) in sub-pixels, distance %.3Lf, scale %.6f, %.1f degrees, allowed %.3Lf",
                got.x, got.y, exact.x * EL_SUBPIXELS, exact.y * EL_SUBPIXELS, exact.distance,
                ldexp(t->pose.scale_q16, t->mesh.scale_log2 - 16), t->camera.fov_y / 11930464.7, allowed);
    }
}

static void run_accuracy(const char *what, uint64_t seed, unsigned place_bits)
{
    tally sums = {0};
    for (seeded s = seeded_from(seed); s.round < PART_OF(20000); s.round++) {
        const setting t = any_setting(&s, place_bits);
        el_view view;
        el_transform transform;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &t.camera, t.width, t.height));
        const int visibility = el_transform_make(&transform, &view, &t.mesh, &t.pose);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(EL_VISIBLE, visibility);
        for (unsigned i = 0; visibility == EL_VISIBLE && i < POINTS; i++) {
            check_point(&s, &t, &transform, t.points[i], MAX_ERROR, &sums);
        }
    }
    report(what, &sums);
    TEST_ASSERT_GREATER_THAN_UINT64(PART_OF(50000), sums.points);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64_MESSAGE(sums.points / 1000 * 999, sums.correct, "too few rounded correctly");
}

static void test_positions_near_the_origin(void)
{
    run_accuracy("near the origin", 20, 18);
}

static void test_positions_far_from_the_origin(void)
{
    run_accuracy("up to 8192 units away", 21, 29);
}

/* --- Culling ------------------------------------------------------------------------------------------------------ */

/* Whether the point is inside the view by more than rounding. */
static bool is_inside(const setting *t, const int16_t p[3])
{
    const reference_point at = reference_project(&t->camera, t->width, t->height, &t->mesh, &t->pose, p);
    return at.distance > 0 && at.depth > 0.01L && at.depth < EL_DEPTH_MAX - 0.01L && at.x > 0.001L &&
           at.x < t->width - 0.001L && at.y > 0.001L && at.y < t->height - 0.001L;
}

static void expect_seen_if_inside(const seeded *s, const setting *t, unsigned long counts[2])
{
    bool inside = false;
    for (unsigned i = 0; i < POINTS; i++) {
        inside = inside || is_inside(t, t->points[i]);
    }
    el_view view;
    el_transform transform;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &t->camera, t->width, t->height));
    const int visibility = el_transform_make(&transform, &view, &t->mesh, &t->pose);
    if (inside && visibility == EL_CULLED) {
        fail_at(s, "culled with a vertex on the screen; field of view %.1f degrees", t->camera.fov_y / 11930465.0);
    }
    counts[0] += inside;
    counts[1] += visibility == EL_CULLED;
}

static void test_what_is_seen_is_never_culled(void)
{
    unsigned long counts[2] = {0, 0};
    for (seeded s = seeded_from(22); s.round < PART_OF(20000); s.round++) {
        setting t = any_setting(&s, 24);
        for (unsigned i = 0; i < 3; i++) {
            t.pose.position_q16[i] += (int32_t)any_signed_of_bits(&s, 24); /* beside the view, more often than not */
        }
        expect_seen_if_inside(&s, &t, counts);
    }
    TEST_ASSERT_GREATER_THAN_UINT64(PART_OF(2000), counts[0]);
    TEST_ASSERT_GREATER_THAN_UINT64(PART_OF(2000), counts[1]);
}

/* The largest clip coordinate that the bounding sphere can have, in world units. */
static long double reach_of(const setting *t)
{
    long double half[2];
    long double centre[3];
    reference_half_size(&t->camera, t->width, t->height, half);
    reference_view_space(&t->camera, &t->mesh, &t->pose, t->mesh.centre, centre);
    const long double radius = t->mesh.radius * ldexpl((long double)t->pose.scale_q16 / 65536, t->mesh.scale_log2);
    const long double sides = fmaxl((fabsl(centre[0]) + radius) / half[0], (fabsl(centre[1]) + radius) / half[1]);
    const bool perspective = t->camera.projection == EL_PERSPECTIVE;
    return fmaxl(sides, fmaxl(fabsl(centre[2]) + radius, perspective ? 0 : 1));
}

/* What the unit of clip coordinates costs at the point's distance: 2^-29 of their reach, twice, for the sum of products
 * and the factor. */
static long double subpixels_per_two_units(const setting *t, const int16_t p[3])
{
    long double point[3];
    reference_view_space(&t->camera, &t->mesh, &t->pose, p, point);
    const long double size = t->width > t->height ? t->width : t->height;
    const long double w = t->camera.projection == EL_PERSPECTIVE ? point[2] : 1;
    return ldexpl(reach_of(t), -28) / w * size / 2 * EL_SUBPIXELS;
}

/* A point that is beside the view by more than a few units is so on the same side here. */
static void expect_same_side(const seeded *s, const setting *t, const el_transform *transform, const int16_t p[3])
{
    long double half[2];
    long double point[3];
    reference_half_size(&t->camera, t->width, t->height, half);
    reference_view_space(&t->camera, &t->mesh, &t->pose, p, point);
    const long double margin = ldexpl(reach_of(t), -25);
    const long double w = t->camera.projection == EL_PERSPECTIVE ? point[2] : 1;
    const long double x = point[0] / half[0];
    const long double y = point[1] / half[1];
    unsigned wanted = 0;
    wanted |= x < -w - margin ? EL_CODE_LEFT : 0U;
    wanted |= x > w + margin ? EL_CODE_RIGHT : 0U;
    wanted |= y < -w - margin ? EL_CODE_BELOW : 0U;
    wanted |= y > w + margin ? EL_CODE_ABOVE : 0U;
    wanted |= point[2] < (long double)t->camera.near_q16 / 65536 - margin ? EL_CODE_NEAR : 0U;
    const el_clip_vertex clip = el_transform_position(transform, p);
    const unsigned code = el_outcode(transform, &clip);
    if ((code & wanted) != wanted) {
        fail_at(s, "code %02X lacks some of %02X; x %.4Lf, y %.4Lf, w %.4Lf, reach %.1Lf", code, wanted, x, y, w,
                reach_of(t));
    }
}

static void expect_not_torn(const seeded *s, const setting *t, const el_transform *transform, const int16_t p[3],
                            tally *sums)
{
    check_point(s, t, transform, p, MAX_ERROR + subpixels_per_two_units(t, p), sums);
}

/* Landscapes as large as the world through telescopes as narrow as they come, pointed at one of their corners, which has
 * others around it. */
static setting any_extreme(seeded *s)
{
    static const int32_t up[3] = {0, EL_UNIT_Q16, 0};
    setting t = any_setting(s, 28);
    t.pose.scale_q16 = EL_UNIT_Q16 / 2 + any_below(s, EL_UNIT_Q16 / 2);
    t.mesh.scale_log2 = (int8_t)any_between(s, -10, -1);
    int32_t eye[3];
    int32_t target[3];
    for (unsigned i = 0; i < POINTS * 3; i++) {
        const int64_t beside = t.points[0][i % 3] + any_signed_of_bits(s, 13);
        const int64_t anywhere = any_between(s, INT16_MIN, INT16_MAX);
        const int64_t value = i < 3 || i >= POINTS * 3 / 2 ? anywhere : beside;
        t.points[i / 3][i % 3] = (int16_t)(value > INT16_MAX ? INT16_MAX : (value < INT16_MIN ? INT16_MIN : value));
    }
    bound(&t.mesh, t.points, s);
    for (unsigned i = 0; i < 3; i++) {
        t.pose.position_q16[i] = (int32_t)any_signed_of_bits(s, 28);
        double world = t.pose.position_q16[i];
        for (unsigned j = 0; j < 3; j++) {
            world +=
                ldexp((double)t.pose.rotation_q30[i][j] * t.pose.scale_q16 * t.points[0][j], t.mesh.scale_log2 - 30);
        }
        eye[i] = (int32_t)any_signed_of_bits(s, 30);
        target[i] = (int32_t)fmax(fmin(world, 1 << 30), -(1 << 30));
    }
    (void)el_camera_look_at(&t.camera, eye, target, up);
    const el_angle most = any_below(s, 2) == 0 ? EL_DEGREES(179, 1) : EL_DEGREES(5, 1);
    t.camera.fov_y = (el_angle)any_between(s, EL_DEGREES(1, 1), most);
    t.camera.height_q16 = 256U << any_below(s, 24);
    t.camera.aspect_q16 = any_below(s, 2) == 0 ? 0 : 256U << any_below(s, 17);
    t.camera.near_q16 = 16 + (uint32_t)any_of_bits(s, 20);
    t.camera.far_q16 = 16384U * EL_UNIT_Q16;
    return t;
}

static void test_extreme_settings_are_neither_culled_nor_torn(void)
{
    unsigned long counts[2] = {0, 0};
    tally sums = {0};
    for (seeded s = seeded_from(23); s.round < PART_OF(30000); s.round++) {
        const setting t = any_extreme(&s);
        expect_seen_if_inside(&s, &t, counts);
        el_view view;
        el_transform transform;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &t.camera, t.width, t.height));
        if (el_transform_make(&transform, &view, &t.mesh, &t.pose) != EL_VISIBLE) {
            continue;
        }
        for (unsigned i = 0; i < POINTS; i++) {
            expect_same_side(&s, &t, &transform, t.points[i]);
            if (is_inside(&t, t.points[i])) {
                expect_not_torn(&s, &t, &transform, t.points[i], &sums);
            }
        }
    }
    report("extreme settings", &sums);
    TEST_ASSERT_GREATER_THAN_UINT64(PART_OF(500), counts[0]);
}

static void test_the_obvious_is_culled(void)
{
    static const int32_t beside[][3] = {{0, 0, 5},     {0, 0, -110}, {60, 0, -40},
                                        {-60, 0, -40}, {0, 50, -40}, {0, -50, -40}};
    const el_camera camera = plain_camera();
    const el_mesh mesh = {.vertex_count = 1, .scale_log2 = -4, .radius = 16};
    el_view view;
    el_transform transform;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, 320, 240));
    for (unsigned i = 0; i < 6; i++) {
        el_pose pose = el_pose_identity();
        for (unsigned j = 0; j < 3; j++) {
            pose.position_q16[j] = beside[i][j] * EL_UNIT_Q16;
        }
        TEST_ASSERT_EQUAL_INT(EL_CULLED, el_transform_make(&transform, &view, &mesh, &pose));
        pose.position_q16[0] = pose.position_q16[1] = 0;
        pose.position_q16[2] = -40 * EL_UNIT_Q16;
        TEST_ASSERT_EQUAL_INT(EL_VISIBLE, el_transform_make(&transform, &view, &mesh, &pose));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_positions_near_the_origin);
    RUN_TEST(test_positions_far_from_the_origin);
    RUN_TEST(test_what_is_seen_is_never_culled);
    RUN_TEST(test_extreme_settings_are_neither_culled_nor_torn);
    RUN_TEST(test_the_obvious_is_culled);
    return UNITY_END();
}
