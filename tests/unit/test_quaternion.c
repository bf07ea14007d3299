/* Quaternions: exact where the numbers are, against double where they are not; always of length 1. */
#include "geometry/quaternion.h"

#include <math.h>
#include <string.h>

#include "seeded.h"

enum { ONE = EL_UNIT_Q30 };

#define UNITS 1073741824.0
#define PI 3.14159265358979323846

void setUp(void)
{
}

void tearDown(void)
{
}

typedef struct rotation {
    double q[4];
} rotation;

static rotation of(const el_quaternion *q)
{
    rotation r;
    for (unsigned i = 0; i < 4; i++) {
        r.q[i] = q->q30[i] / UNITS;
    }
    return r;
}

static double length(const rotation *r)
{
    return sqrt(r->q[0] * r->q[0] + r->q[1] * r->q[1] + r->q[2] * r->q[2] + r->q[3] * r->q[3]);
}

static rotation product(const rotation *a, const rotation *b)
{
    const double *const p = a->q;
    const double *const q = b->q;
    return (rotation){
        {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3], p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
         p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1], p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]}};
}

/* By how much one must be turned to be the other, in radians; whether it is q or -q does not matter. */
static double turn_between(const rotation *a, const rotation *b)
{
    double apart = 0;
    double together = 0;
    for (unsigned i = 0; i < 4; i++) {
        apart += (a->q[i] - b->q[i]) * (a->q[i] - b->q[i]);
        together += (a->q[i] + b->q[i]) * (a->q[i] + b->q[i]);
    }
    const double half = 2 * atan2(sqrt(apart), sqrt(together));
    return 2 * fmin(half, PI - half);
}

static void expect_length_1(const seeded *s, const el_quaternion *q)
{
    const rotation r = of(q);
    const double error = fabs(length(&r) - 1) * UNITS;
    if (error > 2) {
        fail_at(s, "a length is off by %.2f units of 2^-30", error);
    }
}

static void expect_turn(const seeded *s, const char *what, const rotation *expected, const el_quaternion *got,
                        double most)
{
    const rotation r = of(got);
    const double error = turn_between(expected, &r);
    expect_length_1(s, got);
    if (!(error <= most)) {
        fail_at(s, "%s is off by %.3g radians, %.3g are allowed", what, error, most);
    }
}

/* Also those whose numbers are nearly 0 or equal. */
static el_quaternion any_rotation(seeded *s)
{
    el_quaternion q;
    do {
        for (unsigned i = 0; i < 4; i++) {
            q.q30[i] = (int32_t)any_signed_of_bits(s, 30);
        }
    } while ((q.q30[0] | q.q30[1] | q.q30[2] | q.q30[3]) == 0);
    return el_quaternion_normalise(&q);
}

static el_quaternion any_words(seeded *s)
{
    el_quaternion q;
    for (unsigned i = 0; i < 4; i++) {
        q.q30[i] = any_below(s, 4) == 0 ? INT32_MIN : (int32_t)any_u64(s);
    }
    return q;
}

static void expect_numbers(int32_t w, int32_t x, int32_t y, int32_t z, el_quaternion q)
{
    const int32_t numbers[4] = {w, x, y, z};
    TEST_ASSERT_EQUAL_INT32_ARRAY(numbers, q.q30, 4);
}

static void test_half_turns_and_none_are_exact(void)
{
    expect_numbers(ONE, 0, 0, 0, el_quaternion_identity());
    expect_numbers(ONE, 0, 0, 0, el_quaternion_about((const int32_t[]){0, 0, 0}, 12345));
    expect_numbers(ONE, 0, 0, 0, el_quaternion_about((const int32_t[]){1, 2, 3}, 0));
    expect_numbers(0, ONE, 0, 0, el_quaternion_about((const int32_t[]){7, 0, 0}, EL_DEGREES(180, 1)));
    expect_numbers(0, 0, -ONE, 0, el_quaternion_about((const int32_t[]){0, INT32_MIN, 0}, EL_DEGREES(180, 1)));
    expect_numbers(ONE, 0, 0, 0, el_quaternion_normalise(&(el_quaternion){{0, 0, 0, 0}}));
    expect_numbers(0, 0, 0, -ONE, el_quaternion_normalise(&(el_quaternion){{0, 0, 0, INT32_MIN}}));
    expect_numbers(ONE / 2, ONE / 2, -ONE / 2, ONE / 2, el_quaternion_normalise(&(el_quaternion){{1, 1, -1, 1}}));
}

/* Counter-clockwise seen from the axis' tip, as el_pose_turn has it: about z, x goes to y. */
static void test_turns_are_those_of_poses(void)
{
    static const int32_t axes[3][3] = {{ONE, 0, 0}, {0, ONE, 0}, {0, 0, ONE}};
    int32_t rotated[3];
    const el_quaternion quarter = el_quaternion_about(axes[2], EL_DEGREES(90, 1));
    el_quaternion_rotate(&quarter, (const int32_t[]){1000, 0, -7}, rotated);
    TEST_ASSERT_EQUAL_INT32_ARRAY(((const int32_t[]){0, 1000, -7}), rotated, 3);
    for (seeded s = seeded_from(701); s.round < PART_OF(3000); s.round++) {
        const el_axis axis = (el_axis)any_below(&s, 3);
        const el_angle angle = (el_angle)any_u64(&s);
        const el_quaternion q = el_quaternion_about(axes[axis], angle);
        el_pose pose = el_pose_identity();
        int32_t rotation_q30[3][3];
        el_pose_turn(&pose, axis, angle);
        el_quaternion_to_rotation(&q, rotation_q30);
        for (unsigned i = 0; i < 9; i++) {
            TEST_ASSERT_INT32_WITHIN(8, pose.rotation_q30[i / 3][i % 3], rotation_q30[i / 3][i % 3]);
        }
    }
}

static void test_axis_and_angle(void)
{
    for (seeded s = seeded_from(702); s.round < PART_OF(20000); s.round++) {
        const unsigned bits = 1 + any_below(&s, 31);
        int32_t axis[3];
        rotation expected = {{0}};
        double sum = 0;
        for (unsigned i = 0; i < 3; i++) {
            axis[i] = (int32_t)any_signed_of_bits(&s, bits);
            sum += (double)axis[i] * axis[i];
        }
        if (sum == 0) {
            continue;
        }
        const el_angle angle = (el_angle)any_u64(&s);
        const double half = angle / 4294967296.0 * PI;
        expected.q[0] = cos(half);
        for (unsigned i = 0; i < 3; i++) {
            expected.q[1 + i] = sin(half) * axis[i] / sqrt(sum);
        }
        const el_quaternion q = el_quaternion_about(axis, angle);
        expect_turn(&s, "a turn about an axis", &expected, &q, 10 / UNITS);
    }
}

static void test_products(void)
{
    for (seeded s = seeded_from(703); s.round < PART_OF(20000); s.round++) {
        const el_quaternion a = any_rotation(&s);
        const el_quaternion b = any_rotation(&s);
        const rotation exact_a = of(&a);
        const rotation exact_b = of(&b);
        const rotation expected = product(&exact_a, &exact_b);
        const rotation unit = {{expected.q[0] / length(&expected), expected.q[1] / length(&expected),
                                expected.q[2] / length(&expected), expected.q[3] / length(&expected)}};
        const el_quaternion ab = el_quaternion_multiply(&a, &b);
        expect_turn(&s, "a product", &unit, &ab, 4 / UNITS);

        const el_quaternion back = el_quaternion_conjugate(&ab);
        const el_quaternion none = el_quaternion_multiply(&ab, &back);
        const el_quaternion identity = el_quaternion_identity();
        const rotation exact = of(&identity);
        expect_turn(&s, "a turn and back", &exact, &none, 4 / UNITS);
    }
}

/* A million products by the same turn: the length stays, and the angle is a million times the turn's but for rounding. */
static void test_a_million_products_do_not_drift(void)
{
    enum { ROUNDS = PART_OF(1000000) };
    const int32_t axis[3] = {3, -5, 11};
    const el_quaternion step = el_quaternion_about(axis, EL_DEGREES(1237, 100));
    const rotation exact = of(&step);
    rotation expected = {{1, 0, 0, 0}};
    el_quaternion q = el_quaternion_identity();
    seeded s = seeded_from(704);
    for (; s.round < ROUNDS; s.round++) {
        q = el_quaternion_multiply(&q, &step);
        expected = product(&expected, &exact);
        const double scale = 1 / length(&expected);
        for (unsigned i = 0; i < 4; i++) {
            expected.q[i] *= scale;
        }
        expect_length_1(&s, &q);
    }
    expect_turn(&s, "the product of all", &expected, &q, ROUNDS / UNITS / 8); /* 4 units each would be allowed */
}

static void test_rotating_and_the_matrix(void)
{
    for (seeded s = seeded_from(705); s.round < PART_OF(20000); s.round++) {
        const el_quaternion q = any_rotation(&s);
        const rotation r = of(&q);
        const double *const p = r.q;
        const double exact[3][3] = {
            {1 - 2 * (p[2] * p[2] + p[3] * p[3]), 2 * (p[1] * p[2] - p[0] * p[3]), 2 * (p[1] * p[3] + p[0] * p[2])},
            {2 * (p[1] * p[2] + p[0] * p[3]), 1 - 2 * (p[1] * p[1] + p[3] * p[3]), 2 * (p[2] * p[3] - p[0] * p[1])},
            {2 * (p[1] * p[3] - p[0] * p[2]), 2 * (p[2] * p[3] + p[0] * p[1]), 1 - 2 * (p[1] * p[1] + p[2] * p[2])}};
        const int32_t v[3] = {(int32_t)any_signed_of_bits(&s, 31), (int32_t)any_signed_of_bits(&s, 31),
                              (int32_t)any_signed_of_bits(&s, 31)};
        const double size = sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
        int32_t rotation_q30[3][3];
        int32_t rotated[3];
        el_quaternion_to_rotation(&q, rotation_q30);
        el_quaternion_rotate(&q, v, rotated);
        for (unsigned i = 0; i < 3; i++) {
            double expected = 0;
            for (unsigned j = 0; j < 3; j++) {
                if (fabs(rotation_q30[i][j] - exact[i][j] * UNITS) > 4) {
                    fail_at(&s, "element %u, %u is off by %.2f", i, j, rotation_q30[i][j] - exact[i][j] * UNITS);
                }
                expected += exact[i][j] * v[j];
            }
            expected = fmax(fmin(expected, INT32_MAX), INT32_MIN);
            if (fabs(rotated[i] - expected) > 0.5 + size * 8 / UNITS) {
                fail_at(&s, "coordinate %u is %ld, not %.2f", i, (long)rotated[i], expected);
            }
        }
        const el_quaternion again = el_quaternion_from_rotation((const int32_t(*)[3])rotation_q30);
        expect_turn(&s, "the matrix' quaternion", &r, &again, 12 / UNITS);
    }
}

/* Half turns, where three of the four ways to take a quaternion from a matrix would divide by nothing. */
static void test_half_turns_come_back_from_their_matrix(void)
{
    for (unsigned i = 0; i < 3; i++) {
        el_quaternion half = {{0}};
        int32_t rotation_q30[3][3];
        half.q30[1 + i] = ONE;
        el_quaternion_to_rotation(&half, rotation_q30);
        const el_quaternion again = el_quaternion_from_rotation((const int32_t(*)[3])rotation_q30);
        TEST_ASSERT_EQUAL_INT32_ARRAY(half.q30, again.q30, 4);
    }
}

static rotation slerp(const rotation *a, const rotation *b, double part)
{
    double cosine = 0;
    for (unsigned i = 0; i < 4; i++) {
        cosine += a->q[i] * b->q[i];
    }
    const double sign = cosine < 0 ? -1 : 1;
    double apart = 0;
    double together = 0;
    for (unsigned i = 0; i < 4; i++) {
        apart += (a->q[i] - sign * b->q[i]) * (a->q[i] - sign * b->q[i]);
        together += (a->q[i] + sign * b->q[i]) * (a->q[i] + sign * b->q[i]);
    }
    const double angle = 2 * atan2(sqrt(apart), sqrt(together));
    rotation r = *a;
    for (unsigned i = 0; i < 4 && angle > 0; i++) {
        r.q[i] = (a->q[i] * sin((1 - part) * angle) + sign * b->q[i] * sin(part * angle)) / sin(angle);
    }
    return r;
}

static void test_slerp_keeps_within_a_millionth_of_a_degree(void)
{
    for (seeded s = seeded_from(706); s.round < PART_OF(50000); s.round++) {
        const el_quaternion a = any_rotation(&s);
        /* Any distance, down to a few units. */
        const el_quaternion turn =
            el_quaternion_about((const int32_t[]){(int32_t)any_u64(&s), (int32_t)any_u64(&s), (int32_t)any_u64(&s)},
                                (el_angle)any_signed_of_bits(&s, 32));
        el_quaternion b = el_quaternion_multiply(&turn, &a);
        for (unsigned i = 0; i < 4 && (s.round & 1U) != 0; i++) {
            b.q30[i] = -b.q30[i]; /* the same rotation, the long way round */
        }
        const uint32_t part_q30 = any_below(&s, EL_UNIT_Q30);
        const rotation exact_a = of(&a);
        const rotation exact_b = of(&b);
        const rotation expected = slerp(&exact_a, &exact_b, part_q30 / UNITS);
        const el_quaternion got = el_quaternion_slerp(&a, &b, part_q30);
        expect_turn(&s, "slerp", &expected, &got, 1e-6 / 180 * PI);
    }
}

static void test_slerp_is_exact_at_its_ends(void)
{
    for (seeded s = seeded_from(707); s.round < 1000; s.round++) {
        const el_quaternion a = any_rotation(&s);
        const el_quaternion b = any_rotation(&s);
        el_quaternion got = el_quaternion_slerp(&a, &b, 0);
        TEST_ASSERT_EQUAL_INT32_ARRAY(a.q30, got.q30, 4);
        got = el_quaternion_slerp(&a, &b, EL_UNIT_Q30);
        TEST_ASSERT_EQUAL_INT32_ARRAY(b.q30, got.q30, 4);
        got = el_quaternion_slerp(&a, &b, UINT32_MAX);
        TEST_ASSERT_EQUAL_INT32_ARRAY(b.q30, got.q30, 4);
        got = el_quaternion_slerp(&a, &a, any_below(&s, EL_UNIT_Q30));
        TEST_ASSERT_EQUAL_INT32_ARRAY(a.q30, got.q30, 4);
    }
}

/* Sanitizers look at what these do. */
static void test_any_words_do_no_harm(void)
{
    for (seeded s = seeded_from(708); s.round < PART_OF(20000); s.round++) {
        const el_quaternion a = any_words(&s);
        const el_quaternion b = any_words(&s);
        int32_t rotation_q30[3][3];
        int32_t rotated[3];
        const el_quaternion unit = el_quaternion_normalise(&a);
        expect_length_1(&s, &unit);
        (void)el_quaternion_multiply(&a, &b);
        (void)el_quaternion_conjugate(&a);
        (void)el_quaternion_slerp(&a, &b, (uint32_t)any_u64(&s));
        el_quaternion_to_rotation(&a, rotation_q30);
        el_quaternion_rotate(&a, b.q30, rotated);
        for (unsigned i = 0; i < 9; i++) {
            rotation_q30[i / 3][i % 3] = i < 4 ? b.q30[i] : (int32_t)any_u64(&s);
        }
        const el_quaternion of_any = el_quaternion_from_rotation((const int32_t(*)[3])rotation_q30);
        expect_length_1(&s, &of_any);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_half_turns_and_none_are_exact);
    RUN_TEST(test_turns_are_those_of_poses);
    RUN_TEST(test_axis_and_angle);
    RUN_TEST(test_products);
    RUN_TEST(test_a_million_products_do_not_drift);
    RUN_TEST(test_rotating_and_the_matrix);
    RUN_TEST(test_half_turns_come_back_from_their_matrix);
    RUN_TEST(test_slerp_keeps_within_a_millionth_of_a_degree);
    RUN_TEST(test_slerp_is_exact_at_its_ends);
    RUN_TEST(test_any_words_do_no_harm);
    return UNITY_END();
}
