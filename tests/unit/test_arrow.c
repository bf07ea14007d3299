/* Arrows against vectors in floating point. */
#include <math.h>
#include <stdlib.h>

#include "geometry/arrow.h"

#include "seeded.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* That the arrow is `vector` within `off` of its greatest part, and what was measured of it. */
static void expect_arrow(const seeded *s, el_arrow *arrow, const double vector[3], double off)
{
    int32_t greatest = 0;
    double own[3];
    for (unsigned i = 0; i < 3; i++) {
        own[i] = arrow->v[i];
        greatest = abs(arrow->v[i]) > greatest ? abs(arrow->v[i]) : greatest;
        if (fabs(own[i] - ldexp(vector[i], arrow->shift)) > off * (1 << 30)) {
            fail_at(s, "part %u is %d, shifted by %d", i, (int)arrow->v[i], arrow->shift);
        }
    }
    el_arrow_measure(arrow);
    const double length = length_of(own);
    const double less = ldexp(length * length, -32) - arrow->square;
    int32_t unit_q30[3];
    el_arrow_direction(arrow, unit_q30);
    if (greatest < 1 << 30 || less < -0.001 || less >= 3 ||
        fabs(ldexp(arrow->to_unit * length, -62) - 1) > ldexp(1, -26)) {
        fail_at(s, "square %u, to_unit %u", (unsigned)arrow->square, (unsigned)arrow->to_unit);
    }
    for (unsigned i = 0; i < 3; i++) {
        if (fabs(ldexp(unit_q30[i], -30) - own[i] / length) > ldexp(1, -26)) {
            fail_at(s, "direction %u is %d", i, (int)unit_q30[i]);
        }
    }
}

static void test_vectors_of_any_length(void)
{
    for (seeded s = seeded_from(961); s.round < PART_OF(100000U); s.round++) {
        int32_t vector[3];
        double expected[3];
        for (unsigned i = 0; i < 3; i++) {
            vector[i] = (int32_t)any_signed_of_bits(&s, 31);
            expected[i] = vector[i];
        }
        el_arrow arrow;
        TEST_ASSERT_EQUAL((vector[0] | vector[1] | vector[2]) != 0, el_arrow_make(&arrow, vector));
        if (length_of(expected) > 0) {
            expect_arrow(&s, &arrow, expected, 0);
        }
    }
}

/* Near and far; and ways of which one word alone looks like a short one. */
static void test_ways_of_any_length(void)
{
    for (seeded s = seeded_from(962); s.round < PART_OF(100000U); s.round++) {
        int64_t from[3];
        int32_t to[3];
        double expected[3];
        const unsigned bits = any_below(&s, 2) == 0 ? 31 : 59;
        for (unsigned i = 0; i < 3; i++) {
            to[i] = (int32_t)any_signed_of_bits(&s, 31);
            from[i] =
                any_below(&s, 4) == 0 ? to[i] + any_signed_of_bits(&s, 2) * (1LL << 30) : any_signed_of_bits(&s, bits);
            expected[i] = (double)(to[i] - from[i]);
        }
        el_arrow arrow;
        TEST_ASSERT_EQUAL(length_of(expected) > 0, el_arrow_between(&arrow, from, to));
        if (length_of(expected) > 0) {
            expect_arrow(&s, &arrow, expected, ldexp(1, -28));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_vectors_of_any_length);
    RUN_TEST(test_ways_of_any_length);
    return UNITY_END();
}
