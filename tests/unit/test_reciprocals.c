/* The tables of reciprocals and of leading zeros, which cores have that have no instruction for them, against what they
 * stand for. They are compiled here as they are for those: their source is included with their macro. */
#define __ARM_ARCH_6M__ 1
#undef __OPTIMIZE_SIZE__
#include "base/reciprocals.c"

#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_each_reciprocal(void)
{
    for (int32_t d = 1; d <= EL_SHORT_DIVISOR; d++) {
        TEST_ASSERT_EQUAL_HEX32(INT32_MAX / d, el_reciprocals[d]);
        TEST_ASSERT_EQUAL_HEX32(el_reciprocals[d], el_reciprocal_of_short(d));
    }
}

/* All numbers of 16 bits, moved up to where each bit of theirs is that counts. */
static void test_each_number_of_leading_zeros(void)
{
    for (uint32_t x = 1; x < 1U << 16; x++) {
        const unsigned zeros = (unsigned)__builtin_clz(x);
        TEST_ASSERT_EQUAL(zeros, el_leading_zeros(x));
        TEST_ASSERT_EQUAL(zeros - 16U, el_leading_zeros(x << 16 | 0xFFFFU));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_reciprocal);
    RUN_TEST(test_each_number_of_leading_zeros);
    return UNITY_END();
}
