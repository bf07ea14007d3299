/* Sines, cosines and directions against the mathematics library, and the exact values that every rotation leans on. */
#include "base/angle.h"

#include <math.h>

#include "seeded.h"

enum { ONE = 1 << 30, TOLERANCE = 2 };

#define QUARTER 0x40000000U

void setUp(void)
{
}

void tearDown(void)
{
}

static void expect_near(const seeded *s, el_angle angle)
{
    const long double turn = 6.28318530717958647692528676655900577L;
    const long double radians = (long double)angle / 4294967296.0L * turn;
    const long double sine_error = fabsl((long double)el_sin_q30(angle) - sinl(radians) * (long double)ONE);
    const long double cosine_error = fabsl((long double)el_cos_q30(angle) - cosl(radians) * (long double)ONE);
    if (sine_error > (long double)TOLERANCE || cosine_error > (long double)TOLERANCE) {
        fail_at(s, "angle %08lX: sine off by %.2Lf units, cosine by %.2Lf", (unsigned long)angle, sine_error,
                cosine_error);
    }
}

static void test_quarter_turns_are_exact(void)
{
    static const int32_t sines[] = {0, ONE, 0, -ONE};
    for (uint32_t i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT32(sines[i], el_sin_q30(i * QUARTER));
        TEST_ASSERT_EQUAL_INT32(sines[(i + 1) % 4], el_cos_q30(i * QUARTER));
    }
}

static void test_degrees(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, EL_DEGREES(0, 1));
    TEST_ASSERT_EQUAL_HEX32(QUARTER, EL_DEGREES(90, 1));
    TEST_ASSERT_EQUAL_HEX32(3 * QUARTER, EL_DEGREES(270, 1));
    TEST_ASSERT_EQUAL_HEX32(0, EL_DEGREES(360, 1));
    TEST_ASSERT_EQUAL_HEX32(QUARTER / 2, EL_DEGREES(90, 2));
    TEST_ASSERT_EQUAL_HEX32(11930465, EL_DEGREES(1, 1)); /* 2^32 / 360 = 11930464.7 */
}

static void test_all_around(void)
{
    seeded s = seeded_from(0);
    for (uint32_t i = 0; i < 1U << 16; i += EL_TEST_PART, s.round++) {
        expect_near(&s, i << 16);
        expect_near(&s, (i << 16) + 0xFFFF);
    }
}

/* Where the fold changes: each eighth of a turn. */
static void test_beside_each_eighth(void)
{
    seeded s = seeded_from(0);
    for (uint32_t i = 0; i < 8; i++) {
        for (uint32_t k = 0; k < 200; k++) {
            expect_near(&s, i * (QUARTER / 2) + k);
            expect_near(&s, i * (QUARTER / 2) - k);
        }
    }
}

static void test_seeded(void)
{
    for (seeded s = seeded_from(8); s.round < PART_OF(100000); s.round++) {
        expect_near(&s, (el_angle)any_u64(&s));
    }
}

/* A quarter turn twice gives the same to the bit, so opposite directions are opposite. */
static void test_symmetries_are_exact(void)
{
    for (seeded s = seeded_from(9); s.round < PART_OF(100000); s.round++) {
        const el_angle angle = (el_angle)any_u64(&s);
        if (el_sin_q30(0 - angle) != -el_sin_q30(angle) || el_cos_q30(0 - angle) != el_cos_q30(angle) ||
            el_sin_q30(angle + 2 * QUARTER) != -el_sin_q30(angle)) {
            fail_at(&s, "angle %08lX", (unsigned long)angle);
        }
    }
}

/* Eight units for any magnitudes; axes and diagonals are exact, and so is the mirror image. */
static void expect_direction(const seeded *s, int64_t y, int64_t x)
{
    const long double turns = atan2l((long double)y, (long double)x) / 6.28318530717958647692528676655900577L;
    const el_angle got = el_atan2(y, x);
    const long double error = fabsl(remainderl((long double)got - turns * 4294967296.0L, 4294967296.0L));
    if (error > 8) {
        fail_at(s, "atan2(%lld, %lld) is %08lX, off by %.2Lf units", (long long)y, (long long)x, (unsigned long)got,
                error);
    }
    if (y > 0 && el_atan2(-y, x) != 0U - got) {
        fail_at(s, "atan2(%lld, %lld) is not the mirror image", (long long)y, (long long)x);
    }
}

static void test_directions(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, el_atan2(0, 0));
    TEST_ASSERT_EQUAL_HEX32(0, el_atan2(0, 1));
    TEST_ASSERT_EQUAL_HEX32(QUARTER / 2, el_atan2(INT64_MAX, INT64_MAX));
    TEST_ASSERT_EQUAL_HEX32(QUARTER, el_atan2(5, 0));
    TEST_ASSERT_EQUAL_HEX32(2 * QUARTER, el_atan2(0, INT64_MIN));
    TEST_ASSERT_EQUAL_HEX32(3 * QUARTER, el_atan2(INT64_MIN, 0));
    for (seeded s = seeded_from(3); s.round < PART_OF(200000); s.round++) {
        const unsigned bits = 1 + any_below(&s, 63);
        expect_direction(&s, any_signed_of_bits(&s, bits), any_signed_of_bits(&s, bits));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_quarter_turns_are_exact);
    RUN_TEST(test_degrees);
    RUN_TEST(test_all_around);
    RUN_TEST(test_beside_each_eighth);
    RUN_TEST(test_seeded);
    RUN_TEST(test_symmetries_are_exact);
    RUN_TEST(test_directions);
    return UNITY_END();
}
