/* Integer arithmetic against 128-bit arithmetic, at the ends of every range and in seeded loops. */
#define EL_PRODUCTS_IN_HALVES /* as on cores without long products; all other tests have these */
#include "base/fixed.h"

#include "seeded.h"
#include "wide.h"

static const int64_t edges[] = {0,
                                1,
                                2,
                                3,
                                0x7FFFFFFF,
                                0x80000000,
                                0xFFFFFFFF,
                                0x100000000,
                                0x3FFFFFFFFFFFFFFF,
                                0x4000000000000000,
                                INT64_MAX - 1,
                                INT64_MAX,
                                -1,
                                -2,
                                -3,
                                -0x80000000LL,
                                -0x100000000,
                                -INT64_MAX,
                                INT64_MIN};
enum { EDGES = sizeof edges / sizeof edges[0] };

void setUp(void)
{
}

void tearDown(void)
{
}

static int64_t saturated(wide value)
{
    if (wide_less(wide_of(INT64_MAX), value)) {
        return INT64_MAX;
    }
    return wide_less(value, wide_of(-INT64_MAX)) ? -INT64_MAX : (int64_t)value.low;
}

/* value / 2^shift, rounded to nearest, ties up: floor(value / 2^shift + 1/2). */
static wide rounded(wide value, unsigned shift)
{
    return shift == 0 ? value : wide_right(wide_sum(value, wide_left(wide_of(1), shift - 1)), shift);
}

static void test_bit_lengths(void)
{
    TEST_ASSERT_EQUAL_INT(0, el_bit_length_u32(0));
    TEST_ASSERT_EQUAL_INT(0, el_bit_length_u64(0));
    for (int i = 0; i < 64; i++) {
        const uint64_t lowest = 1ULL << i;
        TEST_ASSERT_EQUAL_INT(i + 1, el_bit_length_u64(lowest));
        TEST_ASSERT_EQUAL_INT(i + 1, el_bit_length_u64(lowest | (lowest - 1)));
        if (i < 32) {
            TEST_ASSERT_EQUAL_INT(i + 1, el_bit_length_u32((uint32_t)lowest));
            TEST_ASSERT_EQUAL_INT(i + 1, el_bit_length_u32((uint32_t)(lowest | (lowest - 1))));
        }
    }
}

static void test_magnitudes_and_the_smaller_and_larger(void)
{
    TEST_ASSERT_EQUAL_UINT64(0x8000000000000000, el_abs_u64(INT64_MIN));
    TEST_ASSERT_EQUAL_UINT64(INT64_MAX, el_abs_u64(-INT64_MAX));
    TEST_ASSERT_EQUAL_UINT64(0, el_abs_u64(0));
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, el_min_i32(INT32_MIN, INT32_MAX));
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, el_min_i32(INT32_MAX, INT32_MIN));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, el_max_i32(INT32_MIN, INT32_MAX));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, el_max_i32(INT32_MAX, INT32_MIN));
}

/* Half words at their ends and in between: where a product in parts carries. */
static void expect_products(const seeded *s, uint64_t a, int32_t b)
{
    const uint32_t low = (uint32_t)a;
    const uint32_t other = (uint32_t)(a >> 32);
    const int32_t factor = b % 65536;
    const uint32_t positive = (uint32_t)b & 0xFFFFU;
    if (el_multiply_u64(a, factor) != a * (uint64_t)(int64_t)factor) {
        fail_at(s, "%llu * %ld", (unsigned long long)a, (long)factor);
    }
    if (el_product_u64(low, other) != (uint64_t)low * other) {
        fail_at(s, "%lu * %lu", (unsigned long)low, (unsigned long)other);
    }
    if (el_product_high_u32(low, other) != (uint32_t)((uint64_t)low * other >> 32)) {
        fail_at(s, "%lu * %lu / 2^32", (unsigned long)low, (unsigned long)other);
    }
    if (el_multiply_u16(a, positive) != a * positive || el_product_u32_u16(low, positive) != (uint64_t)low * positive) {
        fail_at(s, "%llu * %lu", (unsigned long long)a, (unsigned long)positive);
    }
    const int64_t product = (int64_t)(int32_t)low * (int32_t)other;
    if (el_product_i32((int32_t)low, (int32_t)other) != product) {
        fail_at(s, "%ld * %ld", (long)(int32_t)low, (long)(int32_t)other);
    }
    const uint32_t upper = (uint32_t)((uint64_t)low * other >> 32);
    if (upper - el_product_near_u32(low, other) >= EL_PRODUCT_ERROR) {
        fail_at(s, "%lu * %lu / 2^32, nearly", (unsigned long)low, (unsigned long)other);
    }
    if (el_product_high_u16(low, other & 0xFFFF) != (uint32_t)((uint64_t)low * (other & 0xFFFF) >> 16)) {
        fail_at(s, "%lu * %lu / 2^16", (unsigned long)low, (unsigned long)other & 0xFFFF);
    }
    if (el_product_i32_u32((int32_t)low, other) != (int64_t)(int32_t)low * other) {
        fail_at(s, "%ld times %lu", (long)(int32_t)low, (unsigned long)other);
    }
    if (el_multiply_high_i32_u32((int32_t)low, other) != (int32_t)((int64_t)(int32_t)low * other >> 32)) {
        fail_at(s, "%ld * %lu / 2^32", (long)(int32_t)low, (unsigned long)other);
    }
}

static void test_products(void)
{
    static const uint16_t halves[] = {0, 1, 0x7FFF, 0x8000, 0xFFFF};
    seeded s = seeded_from(10);
    for (unsigned i = 0; i < 625; i++) {
        const uint64_t a = (uint64_t)halves[i % 5] << 48 | (uint64_t)halves[i / 5 % 5] << 32 |
                           (uint64_t)halves[i / 25 % 5] << 16 | halves[i / 125];
        for (unsigned k = 0; k < 5; k++) {
            expect_products(&s, a, halves[k]);
            expect_products(&s, a, -halves[k]);
        }
    }
    for (; s.round < PART_OF(200000); s.round++) {
        expect_products(&s, any_of_bits(&s, 64), (int32_t)any_signed_of_bits(&s, 31));
    }
}

static void test_normalising(void)
{
    for (seeded s = seeded_from(11); s.round < PART_OF(100000); s.round++) {
        const uint32_t first = 0x80000000U >> s.round % 32; /* alone, with all bits below it, with any */
        const uint32_t below = (first - 1U) & (s.round / 32 % 3 == 0   ? 0U
                                               : s.round / 32 % 3 == 1 ? ~0U
                                                                       : (uint32_t)any_u64(&s));
        uint32_t x = first | below;
        const unsigned zeros = el_normalise(&x);
        if (zeros != s.round % 32 || x != (first | below) << zeros || zeros != el_leading_zeros(first | below)) {
            fail_at(&s, "%lx moved up by %u: %lx", (unsigned long)(first | below), zeros, (unsigned long)x);
        }
    }
}

/* By its definition: root^2 <= x < (root + 1)^2. */
static void expect_root(const seeded *s, uint64_t x)
{
    const uint32_t root = el_sqrt_u64(x);
    const uint64_t next = (uint64_t)root + 1; /* the square of 2^32 is more than any x */
    if ((uint64_t)root * root > x || (next <= UINT32_MAX && next * next <= x)) {
        fail_at(s, "sqrt(%llu) = %lu", (unsigned long long)x, (unsigned long)root);
    }
}

static void test_square_roots(void)
{
    seeded s = seeded_from(1);
    for (uint64_t x = 0; x < 1000; x++) {
        expect_root(&s, x);
    }
    expect_root(&s, UINT64_MAX);
    for (; s.round < PART_OF(20000); s.round++) {
        const uint64_t root = any_of_bits(&s, 32);
        expect_root(&s, root * root);
        expect_root(&s, root * root + 1);
        expect_root(&s, root == 0 ? 0 : root * root - 1);
        expect_root(&s, any_of_bits(&s, 64));
    }
}

static void expect_scaled(const seeded *s, int64_t value, uint32_t factor, int shift)
{
    const int64_t expected = saturated(rounded(wide_product(value, factor), (unsigned)shift));
    const int64_t got = el_scale_i64(value, factor, shift);
    if (got != expected) {
        fail_at(s, "%lld * %lu >> %d is %lld, not %lld", (long long)value, (unsigned long)factor, shift,
                (long long)expected, (long long)got);
    }
}

static void test_scale_at_the_edges(void)
{
    static const uint32_t factors[] = {0, 1, 2, 3, 0x40000000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
    seeded s = seeded_from(0);
    for (unsigned i = 0; i < EDGES; i++) {
        for (unsigned k = 0; k < sizeof factors / sizeof factors[0]; k++) {
            for (int shift = 0; shift <= 94; shift++) {
                expect_scaled(&s, edges[i], factors[k], shift);
            }
        }
    }
}

static void test_scale_ties_go_up(void)
{
    TEST_ASSERT_EQUAL_INT64(2, el_scale_i64(3, 1, 1));   /* 1.5 */
    TEST_ASSERT_EQUAL_INT64(-1, el_scale_i64(-3, 1, 1)); /* -1.5 */
    TEST_ASSERT_EQUAL_INT64(0, el_scale_i64(-1, 1, 1));  /* -0.5 */
    TEST_ASSERT_EQUAL_INT64(-1, el_scale_i64(-(3LL << 31), 1, 32));
    TEST_ASSERT_EQUAL_INT64(-1, el_scale_i64(-(3LL << 32), 1, 33));
    TEST_ASSERT_EQUAL_INT64(-2, el_scale_i64(-(3LL << 32) - 1, 1, 33));
}

static void test_scale_seeded(void)
{
    for (seeded s = seeded_from(2); s.round < PART_OF(200000); s.round++) {
        const int64_t value = any_signed_of_bits(&s, 63);
        const uint32_t factor = (uint32_t)any_of_bits(&s, 32);
        expect_scaled(&s, value, factor, (int)any_between(&s, 0, 94));
    }
}

/* A product whose discarded part is exactly one half, or one unit beside it. */
static void test_scale_next_to_ties(void)
{
    for (seeded s = seeded_from(3); s.round < PART_OF(100000); s.round++) {
        const int shift = (int)any_between(&s, 1, 62);
        const int64_t odd = any_signed_of_bits(&s, (unsigned)(63 - shift)) | 1;
        const int64_t tie = odd * (1LL << (shift - 1));
        expect_scaled(&s, tie, 1, shift);
        expect_scaled(&s, tie + 1, 1, shift);
        expect_scaled(&s, tie - 1, 1, shift);
    }
}

/* 64 places are already more than any value has, so the reference stays within 128 bits. */
static void expect_shifted(const seeded *s, int64_t value, int shift)
{
    const wide exact = shift >= 0 ? rounded(wide_of(value), shift > 100 ? 100 : (unsigned)shift)
                                  : wide_left(wide_of(value), shift < -64 ? 64 : (unsigned)-shift);
    const int64_t expected = saturated(exact);
    const int64_t got = el_shift_i64(value, shift);
    if (got != expected) {
        fail_at(s, "%lld >> %d is %lld, not %lld", (long long)value, shift, (long long)expected, (long long)got);
    }
}

static void test_shift_at_the_edges(void)
{
    seeded s = seeded_from(0);
    for (unsigned i = 0; i < EDGES; i++) {
        for (int shift = -62; shift <= 100; shift++) {
            expect_shifted(&s, edges[i], shift);
        }
    }
}

static void test_shift_of_nothing_is_nothing(void)
{
    for (int shift = -100; shift <= 100; shift++) {
        TEST_ASSERT_EQUAL_INT64(0, el_shift_i64(0, shift));
    }
}

static void test_shift_saturates(void)
{
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, el_shift_i64(1, -63));
    TEST_ASSERT_EQUAL_INT64(-INT64_MAX, el_shift_i64(-1, -63));
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, el_shift_i64(1, -1000));
    TEST_ASSERT_EQUAL_INT64(-INT64_MAX, el_shift_i64(INT64_MIN, 0));
}

static void test_shift_seeded(void)
{
    for (seeded s = seeded_from(4); s.round < PART_OF(200000); s.round++) {
        const int64_t value = any_signed_of_bits(&s, 63);
        expect_shifted(&s, value, (int)any_between(&s, -62, 70));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bit_lengths);
    RUN_TEST(test_magnitudes_and_the_smaller_and_larger);
    RUN_TEST(test_products);
    RUN_TEST(test_normalising);
    RUN_TEST(test_square_roots);
    RUN_TEST(test_scale_at_the_edges);
    RUN_TEST(test_scale_ties_go_up);
    RUN_TEST(test_scale_seeded);
    RUN_TEST(test_scale_next_to_ties);
    RUN_TEST(test_shift_at_the_edges);
    RUN_TEST(test_shift_of_nothing_is_nothing);
    RUN_TEST(test_shift_saturates);
    RUN_TEST(test_shift_seeded);
    return UNITY_END();
}
