/* The tests' own 128-bit integers: known results, and the compiler's own 128-bit integers where it has them. */
#include "wide.h"

#include "seeded.h"

enum { ROUNDS = 20000 };

void setUp(void)
{
}

void tearDown(void)
{
}

static void expect(uint64_t high, uint64_t low, wide got)
{
    TEST_ASSERT_EQUAL_HEX64(high, got.high);
    TEST_ASSERT_EQUAL_HEX64(low, got.low);
}

static void test_sums_carry_and_negatives_borrow(void)
{
    expect(1, 0, wide_sum((wide){0, UINT64_MAX}, (wide){0, 1}));
    expect(UINT64_MAX, UINT64_MAX, wide_of(-1));
    expect(UINT64_MAX, 0, wide_negated((wide){1, 0}));
    expect(0, 0, wide_negated(wide_of(0)));
}

static void test_products(void)
{
    expect(0, 0, wide_product(0, INT64_MIN));
    expect(UINT64_MAX, 0xFFFFFFFFFFFFFFFA, wide_product(-2, 3));
    expect(0x3FFFFFFFFFFFFFFF, 1, wide_product(INT64_MAX, INT64_MAX));
    expect(0x4000000000000000, 0, wide_product(INT64_MIN, INT64_MIN));
    expect(0xC000000000000000, 0x8000000000000000, wide_product(INT64_MIN, INT64_MAX));
}

static void test_quotients_are_rounded_towards_zero(void)
{
    expect(0, 2, wide_quotient(wide_of(8), 3));
    expect(UINT64_MAX, UINT64_MAX - 1, wide_quotient(wide_of(-8), 3));
    expect(0x4000000000000000, 0, wide_quotient((wide){0x8000000000000000, 0}, -2));
    expect(0, INT64_MAX, wide_quotient((wide){0x3FFFFFFFFFFFFFFF, 1}, INT64_MAX));
    expect(UINT64_MAX, 0x8000000000000001, wide_quotient((wide){0x3FFFFFFFFFFFFFFF, 1}, -INT64_MAX));
}

static void test_shifts_round_down_and_comparison_knows_signs(void)
{
    expect(UINT64_MAX, UINT64_MAX, wide_right(wide_of(-1), 127));
    expect(UINT64_MAX, UINT64_MAX - 1, wide_right(wide_of(-3), 1));
    expect(0, 0x10, wide_right((wide){0x1000, 5}, 72));
    expect(0x1000, 0, wide_left(wide_of(0x10), 72));
    expect(0x80, 1ULL << 63, wide_left((wide){0x40, 1ULL << 62}, 1));
    TEST_ASSERT_TRUE(wide_less(wide_of(-1), wide_of(0)));
    TEST_ASSERT_TRUE(wide_less(wide_of(-2), wide_of(-1)));
    TEST_ASSERT_TRUE(wide_less((wide){0, UINT64_MAX}, (wide){1, 0}));
    TEST_ASSERT_FALSE(wide_less(wide_of(7), wide_of(7)));
}

/* A quotient by its definition; and all of it by the compiler's arithmetic, where it has such. */
static void test_seeded(void)
{
    for (seeded s = seeded_from(90); s.round < ROUNDS; s.round++) {
        const int64_t a = any_signed_of_bits(&s, 63);
        const int64_t b = any_signed_of_bits(&s, 62) | 1;
        const int64_t rest = any_signed_of_bits(&s, 62) % b;
        const unsigned shift = any_below(&s, 128);
        const wide product = wide_product(a, b);
        const wide n = (a < 0) != (b < 0) ? wide_sum(product, wide_of(rest < 0 ? rest : -rest))
                                          : wide_sum(product, wide_of(rest < 0 ? -rest : rest));
        const wide quotient = wide_quotient(n, b);
        bool good = a == 0 || (quotient.low == (uint64_t)a && wide_is_negative(quotient) == (a < 0));
#ifdef __SIZEOF_INT128__
        __extension__ typedef __int128 whole;
        const whole n_whole = (whole)((unsigned __int128)n.high << 64 | n.low);
        const whole right = n_whole >> shift, left = (whole)((unsigned __int128)n_whole << shift);
        good = good && product.low == (uint64_t)((whole)a * b) && product.high == (uint64_t)((whole)a * b >> 64);
        good = good && quotient.low == (uint64_t)(n_whole / b) && quotient.high == (uint64_t)(n_whole / b >> 64);
        good = good && wide_right(n, shift).low == (uint64_t)right;
        good = good && wide_right(n, shift).high == (uint64_t)(right >> 64);
        good = good && wide_left(n, shift).low == (uint64_t)left && wide_left(n, shift).high == (uint64_t)(left >> 64);
#endif
        if (!good) {
            fail_at(&s, "%lld, %lld, rest %lld, shift %u", (long long)a, (long long)b, (long long)rest, shift);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_sums_carry_and_negatives_borrow);
    RUN_TEST(test_products);
    RUN_TEST(test_quotients_are_rounded_towards_zero);
    RUN_TEST(test_shifts_round_down_and_comparison_knows_signs);
    RUN_TEST(test_seeded);
    return UNITY_END();
}
