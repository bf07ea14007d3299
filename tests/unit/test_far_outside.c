/* The coarse test of bounding spheres against long double: what it calls far outside is outside, what is far outside it
 * finds, and el_draw's counters and pictures know nothing of it. */
#include "geometry/cull.h"

#include "any_setting.h"
#include "base/fixed.h"
#include "reference_view.h"

enum { PLANES = 6, WIDTH = 320, HEIGHT = 240 };

void setUp(void)
{
}

void tearDown(void)
{
}

/* A position unit in world units. */
static long double unit_of(const setting *t)
{
    return ldexpl(t->pose.scale_q16, t->mesh.scale_log2 - 16);
}

/* The most that each plane's form (positive inside, in world units at the edge of the view) can be within the sphere, times
 * `wider`, and its size there: what rounding has to do with. */
static void most_inside(const setting *t, long double wider, long double most[PLANES], long double *size)
{
    long double at[3];
    long double half[2];
    long double rows[3][3];
    reference_view_space(&t->camera, &t->mesh, &t->pose, t->mesh.centre, at);
    reference_half_size(&t->camera, WIDTH, HEIGHT, half);
    const long double unit = unit_of(t);
    for (unsigned i = 0; i < 9; i++) {
        long double sum = 0;
        for (unsigned k = 0; k < 3; k++) {
            sum += ldexpl((long double)t->camera.axes_q30[i / 3][k], -30) *
                   ldexpl((long double)t->pose.rotation_q30[k][i % 3], -30);
        }
        rows[i / 3][i % 3] = sum * unit * (i / 3 == 2 ? -1 : 1);
    }
    const bool perspective = t->camera.projection == EL_PERSPECTIVE;
    for (unsigned plane = 0; plane < PLANES; plane++) {
        const long double sign = plane % 2 == 0 ? 1 : -1;
        const long double focal = plane < 4 ? 1 / half[plane / 2] : 1;
        const long double of_w = plane < 4 && perspective ? 1 : 0;
        const long double limit = ldexpl((long double)(plane == 4 ? t->camera.near_q16 : t->camera.far_q16), -16);
        const long double constant = plane < 4 ? (perspective ? 0 : 1) : -sign * limit;
        long double squares = 0;
        for (unsigned j = 0; j < 3; j++) {
            const long double element = sign * focal * rows[plane / 2][j] + of_w * rows[2][j];
            squares += element * element;
        }
        most[plane] = sign * focal * at[plane / 2] + of_w * at[2] + constant + wider * sqrtl(squares) * t->mesh.radius;
        /* Where focal is large the edge of the view is near its middle. */
        most[plane] /= fmaxl(1, focal);
    }
    *size = fmaxl(fmaxl(fabsl(at[0]), fabsl(at[1])), fabsl(at[2])) + unit * t->mesh.radius;
}

static bool is_outside_by(const long double most[PLANES], long double margin)
{
    for (unsigned plane = 0; plane < PLANES; plane++) {
        if (most[plane] < -margin) {
            return true;
        }
    }
    return false;
}

static bool is_called_outside(const setting *t)
{
    el_view view;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &t->camera, WIDTH, HEIGHT));
    const bool called = el_cull_is_far_outside(&view, &t->mesh, &t->pose);
    if (called) {
        /* No error is hidden: no row of the transform, at most sqrt(3) units, is longer than el_transform_make allows. */
        TEST_ASSERT_TRUE(ldexpl(1.75L * unit_of(t), el_bit_length_u32(el_cull_reach(&t->mesh))) < 32768);
        el_transform transform;
        TEST_ASSERT_EQUAL_INT(EL_CULLED, el_transform_make(&transform, &view, &t->mesh, &t->pose));
    }
    return called;
}

static void run(uint64_t seed, unsigned away_bits)
{
    unsigned long called = 0;
    unsigned long found = 0;
    for (seeded s = seeded_from(seed); s.round < PART_OF(100000); s.round++) {
        const setting t = any_setting(&s, away_bits);
        long double most[PLANES];
        long double size;
        const bool outside = is_called_outside(&t);
        most_inside(&t, 1, most, &size);
        if (outside && !is_outside_by(most, 0)) {
            fail_at(&s, "called outside, and is not");
        }
        called += outside;
        /* What must be found: spheres of 7/4 * sqrt(2) times the size, with room for 14 bits of everything and for
         * eight units of the mesh. */
        most_inside(&t, 2.5L, most, &size);
        const long double unit = unit_of(&t);
        const long double reach = unit * el_cull_reach(&t.mesh);
        if (reach < 4096 && is_outside_by(most, size / 512 + reach / 256 + 16 * unit + 0.004L)) {
            found++;
            if (!outside) {
                fail_at(&s, "far outside, and not found");
            }
        }
    }
    printf("%u bits away: %lu of %d called outside, %lu had to be\n", away_bits, called, PART_OF(100000), found);
    TEST_ASSERT_GREATER_THAN_UINT64(PART_OF(20000), found);
    TEST_ASSERT_GREATER_THAN_UINT64(found - 1, called);
    TEST_ASSERT_LESS_THAN_UINT64(PART_OF(99000), called);
}

static void test_near_the_camera(void)
{
    run(30, 22);
}

static void test_far_from_the_camera(void)
{
    run(31, 29);
}

/* A matrix that makes things longer than a rotation may: its spheres are larger than they say. */
static void test_what_is_no_rotation_is_left_to_the_exact_test(void)
{
    unsigned long called = 0;
    for (seeded s = seeded_from(32); s.round < PART_OF(100000); s.round++) {
        setting t = any_setting(&s, 26);
        for (unsigned i = 0; i < 9; i++) {
            t.pose.rotation_q30[i / 3][i % 3] = (int32_t)any_between(&s, -EL_UNIT_Q30 - 16, EL_UNIT_Q30 + 16);
            if (s.round % 2 == 0) {
                t.camera.axes_q30[i / 3][i % 3] = (int32_t)any_between(&s, -EL_UNIT_Q30 - 16, EL_UNIT_Q30 + 16);
            }
        }
        long double most[PLANES];
        long double size;
        const bool outside = is_called_outside(&t);
        most_inside(&t, 1, most, &size);
        if (outside && !is_outside_by(most, 0)) {
            fail_at(&s, "called outside, and is not");
        }
        called += outside;
    }
    TEST_ASSERT_GREATER_THAN_UINT64(PART_OF(1000), called);
}

/* The corners of what it may be asked, where products are largest. */
static void test_extremes(void)
{
    static const int32_t elements[] = {-EL_UNIT_Q30 - 16, 0, EL_UNIT_Q30 + 16};
    static const uint32_t scales[] = {1, 1 << 16, 1 << 24, UINT32_MAX};
    static const int16_t centres[] = {INT16_MIN, 0, INT16_MAX};
    for (seeded s = seeded_from(33); s.round < PART_OF(200000); s.round++) {
        setting t = any_setting(&s, 29);
        t.mesh.scale_log2 = (int8_t)any_between(&s, -30, 8);
        t.pose.scale_q16 = scales[any_below(&s, 4)];
        t.mesh.radius = any_below(&s, 2) == 0 ? UINT16_MAX : 0;
        for (unsigned i = 0; i < 9; i++) {
            t.pose.rotation_q30[i / 3][i % 3] = elements[any_below(&s, 3)];
            t.camera.axes_q30[i / 3][i % 3] = elements[any_below(&s, 3)];
        }
        for (unsigned i = 0; i < 3; i++) {
            t.mesh.centre[i] = centres[any_below(&s, 3)];
            t.pose.position_q16[i] = any_below(&s, 2) == 0 ? 1 << 30 : -(1 << 30);
            t.camera.position_q16[i] = any_below(&s, 2) == 0 ? 1 << 30 : -(1 << 30);
        }
        long double most[PLANES];
        long double size;
        if (is_called_outside(&t)) {
            most_inside(&t, 1, most, &size);
            if (!is_outside_by(most, 0)) {
                fail_at(&s, "called outside, and is not");
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_near_the_camera);
    RUN_TEST(test_far_from_the_camera);
    RUN_TEST(test_what_is_no_rotation_is_left_to_the_exact_test);
    RUN_TEST(test_extremes);
    return UNITY_END();
}
