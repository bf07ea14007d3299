/* Reciprocal roots: their table against what it stands for, and what is made of it, on this core, against its square in
 * 128 bits. tests/proofs has the same of every number there is. */
#include <math.h>
#include <stdbool.h>

#include "base/root.c"

#include "seeded.h"
#include "unity.h"
#include "wide.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_each_guess(void)
{
    for (int i = 0; i < 96; i++) {
        /* As far below the one end as above the other. */
        const double middle = 512 / (sqrt((32 + i) / 32.0) + sqrt((33 + i) / 32.0));
        TEST_ASSERT_EQUAL_UINT8((uint8_t)floor(middle + 0.5), first_guesses[i]);
    }
}

/* Whether a^2 x is at most 2^94. */
static bool is_at_most(int64_t a, uint32_t x)
{
    return !wide_less(wide_quotient((wide){.high = 1U << 30, .low = 0}, x), wide_product(a, a));
}

static void expect_near(const seeded *s, uint32_t x)
{
    const uint32_t root = el_reciprocal_root(x);
    if (root >> 31 == 0 || !is_at_most((int64_t)root - EL_ROOT_ERROR, x) ||
        is_at_most((int64_t)root + EL_ROOT_ERROR, x)) {
        fail_at(s, "1 / sqrt(%u) is not %u", (unsigned)x, (unsigned)root);
    }
}

static void test_roots(void)
{
    for (seeded s = seeded_from(951); s.round < PART_OF(100000U); s.round++) {
        expect_near(&s, (uint32_t)any_between(&s, 1LL << 30, UINT32_MAX));
    }
}

/* Where one entry ends and the next one begins. */
static void test_borders(void)
{
    seeded s = seeded_from(952);
    for (uint64_t border = 1ULL << 30; border <= 1ULL << 32; border += 1U << 25, s.round++) {
        for (uint32_t i = 0; i < 50; i++) {
            expect_near(&s, border >> 32 == 0 ? (uint32_t)border + i : UINT32_MAX - i);
            expect_near(&s, border > 1ULL << 30 ? (uint32_t)(border - 1U - i) : (1U << 30) + i);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_guess);
    RUN_TEST(test_roots);
    RUN_TEST(test_borders);
    return UNITY_END();
}
