/* Division by a reciprocal is exact: against `/` and 128-bit arithmetic, for divisors of every size. */
#define EL_DIVIDE_BY_TABLE /* as on cores without a divider; all other tests divide */
#include "base/reciprocals.c"

#include <stdbool.h>

#include "seeded.h"
#include "wide.h"

enum { ROUNDS = PART_OF(200000) };

void setUp(void)
{
}

void tearDown(void)
{
}

static void expect_reciprocal(const seeded *s, uint32_t d)
{
    const el_divisor divisor = el_divisor_make(d);
    if (divisor.shift > 31 || divisor.normalised >> 31 != 1 || divisor.normalised >> divisor.shift != d ||
        divisor.normalised << (31 - divisor.shift) << 1 != 0) {
        fail_at(s, "%lu normalised is %lu << %d", (unsigned long)d, (unsigned long)divisor.normalised, divisor.shift);
    }
    const uint64_t expected = UINT64_MAX / divisor.normalised - (1ULL << 32);
    const uint64_t short_by = (1ULL << 63) / divisor.normalised - el_reciprocal_near(divisor.normalised);
    if (short_by >= EL_RECIPROCAL_ERROR) {
        fail_at(s, "2^63 / %lu is short by %llu", (unsigned long)divisor.normalised, (unsigned long long)short_by);
    }
    if (divisor.reciprocal != expected) {
        fail_at(s, "reciprocal of %lu is %llu, not %lu", (unsigned long)divisor.normalised,
                (unsigned long long)expected, (unsigned long)divisor.reciprocal);
    }
}

/* (n + fraction * 2^-32) / d in Q32, truncated towards zero, modulo 2^64. */
static uint64_t exact_q32(int64_t n, uint32_t fraction, uint64_t d)
{
    return wide_quotient(wide_sum(wide_left(wide_of(n), 32), wide_of(fraction)), (int64_t)d).low;
}

/* The wide division has the same quotients where both can divide. */
static void expect_q32(const seeded *s, int64_t n, uint32_t fraction, uint32_t d)
{
    const el_divisor divisor = el_divisor_make(d);
    const uint64_t expected = exact_q32(n, fraction, d);
    if ((uint64_t)el_divide_q32(n, fraction, &divisor) != expected ||
        (uint64_t)el_divide_wide_q32(n, fraction, d) != expected) {
        fail_at(s, "(%lld + %lu * 2^-32) / %lu in Q32", (long long)n, (unsigned long)fraction, (unsigned long)d);
    }
}

/* What is too large for its function is left out; the ends of what is not are always in. */
static void expect_quotients(const seeded *s, uint32_t d, uint64_t n)
{
    const el_divisor divisor = el_divisor_make(d);
    if (n / d <= UINT32_MAX && el_divide_u64(n, &divisor) != n / d) {
        fail_at(s, "%llu / %lu", (unsigned long long)n, (unsigned long)d);
    }
    if (n > INT64_MAX) {
        return;
    }
    for (int sign = -1; sign <= 1; sign += 2) {
        const int64_t signed_n = sign < 0 ? -(int64_t)n : (int64_t)n;
        const int64_t quotient = signed_n / d;
        const int64_t floor = quotient - (quotient * d > signed_n);
        if (floor >= INT32_MIN && floor <= INT32_MAX && el_divide_floor_i64(signed_n, &divisor) != floor) {
            fail_at(s, "floor(%lld / %lu)", (long long)signed_n, (unsigned long)d);
        }
        expect_q32(s, signed_n, 0, d);
        expect_q32(s, signed_n, 1, d);
        expect_q32(s, signed_n, 0x80000000, d);
        expect_q32(s, signed_n, UINT32_MAX, d);
    }
}

/* floor(2^32 n / d) by both ratios where the whole part fits. */
static void expect_ratios(const seeded *s, int32_t n, uint32_t d)
{
    const int64_t shifted = n * (1LL << 32);
    const int64_t floor = shifted / d - (shifted % d < 0);
    const bool fits = floor >> 32 > -(1LL << 31) && floor >> 32 < 1LL << 31;
    if (fits && d < 1U << 16 && el_ratio_q32(n, d) != floor) {
        fail_at(s, "the ratio %ld / %lu", (long)n, (unsigned long)d);
    }
    if (fits && d < 1U << 31 && el_wide_ratio_q32(n, d) != floor) {
        fail_at(s, "the wide ratio %ld / %lu", (long)n, (unsigned long)d);
    }
}

static void test_ratios(void)
{
    static const int32_t numbers[] = {0, 1, 2, 3, 0x7FFF, 0x8000, 0x10000, 0x7FFFFFFE, 0x7FFFFFFF};
    seeded s = seeded_from(8);
    for (; s.round < ROUNDS; s.round++) {
        const uint32_t d = 1U + (uint32_t)any_of_bits(&s, 32) % UINT32_MAX;
        const int32_t n = numbers[s.round % 9];
        expect_ratios(&s, n, d);
        expect_ratios(&s, -n, d);
        expect_ratios(&s, (int32_t)any_signed_of_bits(&s, 31), d);
        expect_ratios(&s, (int32_t)any_signed_of_bits(&s, 31), d % 65535 + 1);
    }
}

/* The ratios of coordinates and their products, which take more than 32 bits with more sub-pixels. */
static void test_wide_ratios(void)
{
    for (seeded s = seeded_from(9); s.round < ROUNDS; s.round++) {
        const uint32_t d = 1U + (uint32_t)any_of_bits(&s, 31) % (uint32_t)INT32_MAX;
        const int64_t n = any_between(&s, -(int64_t)d * INT32_MAX, (int64_t)d * INT32_MAX);
        const wide shifted = wide_left(wide_of(n), 32);
        /* Rounded down: for a negative number its opposite rounded up. */
        const wide floor =
            n >= 0 ? wide_quotient(shifted, d)
                   : wide_negated(wide_quotient(wide_sum(wide_negated(shifted), wide_of((int64_t)d - 1)), d));
        if ((uint64_t)el_wide_ratio_q32(n, d) != floor.low) {
            fail_at(&s, "the wide ratio %lld / %lu", (long long)n, (unsigned long)d);
        }
    }
}

static void test_reciprocals_of_short_divisors(void)
{
    for (uint32_t d = 1; d <= EL_SHORT_DIVISOR; d++) {
        TEST_ASSERT_EQUAL_HEX32(0x7FFFFFFFU / d, el_reciprocal_of_short((int32_t)d));
    }
}

/* n / d in Q32, truncated, of all signs. */
static void expect_small(const seeded *s, int32_t n, int32_t d)
{
    const el_small_divisor divisor = el_small_divisor_make(d);
    if (el_divide_small_q32(n, &divisor) != (uint64_t)(n * (1LL << 32) / d)) {
        fail_at(s, "%ld / %ld in Q32", (long)n, (long)d);
    }
}

static void test_small_divisors(void)
{
    for (seeded s = seeded_from(84); s.round < ROUNDS; s.round++) {
        const int32_t most = (1 << EL_SMALL_DIVISOR_BITS) - 1;
        const int32_t any = (int32_t)any_of_bits(&s, EL_SMALL_DIVISOR_BITS);
        const int32_t d = s.round % 8 == 0 ? most - any % 4 : (any == 0 ? 1 : any);
        const int32_t n = s.round % 8 == 1 ? (1 << 27) - 1 - any : (int32_t)any_signed_of_bits(&s, 27);
        const int32_t multiple = n / d / 2 * d; /* remainders of 0 and next to it */
        for (int32_t beside = -1; beside <= 1; beside++) {
            expect_small(&s, n, d);
            expect_small(&s, n, -d);
            expect_small(&s, multiple + beside, d);
            expect_small(&s, multiple + beside, -d);
        }
    }
}

/* With a reciprocal that is at most a unit too low, a digit is right after a few corrections. */
static void test_reciprocals_of_small_divisors(void)
{
    for (int32_t d = 1; d < 1 << 16; d++) {
        const el_small_divisor divisor = el_small_divisor_make(-d);
        const uint32_t short_by = (1U << 31) / divisor.normalised - divisor.reciprocal;
        if (divisor.normalised != (uint32_t)d << divisor.shift || divisor.normalised >> 15 != 1 || short_by > 1) {
            TEST_FAIL_MESSAGE("a reciprocal of 16 bits");
        }
    }
}

/* Where quotients change, and at the ends of the three functions' ranges. */
static void expect_edges(const seeded *s, uint32_t d)
{
    static const uint64_t quotients[] = {0, 1, 2, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF};
    expect_reciprocal(s, d);
    for (unsigned i = 0; i < sizeof quotients / sizeof quotients[0]; i++) {
        const uint64_t n = quotients[i] * d;
        expect_quotients(s, d, n);
        expect_quotients(s, d, n + 1);
        expect_quotients(s, d, n + d - 1);
        expect_quotients(s, d, n == 0 ? 0 : n - 1);
    }
    expect_quotients(s, d, INT64_MAX);
}

static void test_small_divisors_and_powers_of_two(void)
{
    seeded s = seeded_from(0);
    for (uint32_t d = 1; d <= PART_OF(2048); d++) {
        expect_edges(&s, d);
        expect_edges(&s, 0 - d);
    }
    for (int i = 1; i < 32; i++) {
        for (uint32_t d = (1U << i) - 1; d <= (1U << i) + 1; d++) {
            expect_edges(&s, d);
        }
    }
}

/* The reciprocal starts from the upper ten bits and is refined from the upper 21: divisors beside each step of these. */
static void test_divisors_beside_the_steps_of_the_first_guess(void)
{
    seeded s = seeded_from(0);
    for (uint32_t d10 = 512; d10 < 1024; d10++) {
        for (uint32_t i = 0; i < 4; i++) {
            expect_reciprocal(&s, (d10 << 22) + i);
            expect_reciprocal(&s, (d10 << 22) + 0x3FFFFF - i);
            expect_reciprocal(&s, (d10 << 22) + 0x7FF + i);
        }
    }
}

static void test_tables(void)
{
    for (uint32_t d = 512; d < 1024; d++) {
        TEST_ASSERT_EQUAL_HEX32(((1U << 24) - (1U << 14) + (1U << 9)) / d, el_first_guess(d));
    }
    for (uint32_t upper = (1U << 15) + 1U; upper <= 1U << 16; upper++) {
        TEST_ASSERT_EQUAL_HEX32((1U << 31) / upper, el_reciprocal_u16(upper));
    }
}

static void test_reciprocals_seeded(void)
{
    for (seeded s = seeded_from(5); s.round < ROUNDS; s.round++) {
        expect_reciprocal(&s, (uint32_t)any_u64(&s) | 1U);
        expect_reciprocal(&s, (uint32_t)any_of_bits(&s, 32) | 1U);
    }
}

static void test_quotients_seeded(void)
{
    for (seeded s = seeded_from(6); s.round < ROUNDS; s.round++) {
        const uint32_t d = (uint32_t)(any_of_bits(&s, 31) + 1);
        expect_quotients(&s, d, any_of_bits(&s, 63));
        const uint64_t multiple = any_of_bits(&s, 32) * d; /* remainders of 0 and of d - 1 */
        expect_quotients(&s, d, multiple);
        expect_quotients(&s, d, multiple + d - 1);
    }
}

static void test_wide_divisors_seeded(void)
{
    for (seeded s = seeded_from(83); s.round < ROUNDS; s.round++) {
        const uint64_t d = 1 + any_of_bits(&s, 47) % ((1ULL << 47) - 1);
        const int64_t n = any_signed_of_bits(&s, 63);
        const uint32_t fraction = (uint32_t)any_of_bits(&s, 32);
        if ((uint64_t)el_divide_wide_q32(n, fraction, d) != exact_q32(n, fraction, d)) {
            fail_at(&s, "(%lld + %lu * 2^-32) / %llu in Q32", (long long)n, (unsigned long)fraction,
                    (unsigned long long)d);
        }
    }
}

static void test_two_words_by_one(void)
{
    for (seeded s = seeded_from(7); s.round < ROUNDS; s.round++) {
        const el_divisor divisor = el_divisor_make((uint32_t)(any_of_bits(&s, 31) + 1));
        const uint32_t high = (uint32_t)(any_of_bits(&s, 32) % divisor.normalised);
        const uint32_t low = (uint32_t)any_of_bits(&s, 32);
        const uint64_t n = (uint64_t)high << 32 | low;
        uint32_t rest;
        const uint32_t quotient = el_divide_words(high, low, &divisor, &rest);
        if (quotient != n / divisor.normalised || rest != n % divisor.normalised) {
            fail_at(&s, "%llu / %lu", (unsigned long long)n, (unsigned long)divisor.normalised);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_small_divisors_and_powers_of_two);
    RUN_TEST(test_divisors_beside_the_steps_of_the_first_guess);
    RUN_TEST(test_tables);
    RUN_TEST(test_reciprocals_seeded);
    RUN_TEST(test_quotients_seeded);
    RUN_TEST(test_wide_divisors_seeded);
    RUN_TEST(test_two_words_by_one);
    RUN_TEST(test_small_divisors);
    RUN_TEST(test_reciprocals_of_small_divisors);
    RUN_TEST(test_ratios);
    RUN_TEST(test_wide_ratios);
    RUN_TEST(test_reciprocals_of_short_divisors);
    return UNITY_END();
}
