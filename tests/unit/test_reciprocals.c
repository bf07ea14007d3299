/* The table of reciprocals, which cores without a divider have, against its formula. The table is compiled here as it is
 * for them: its source is included with their macro. */
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_reciprocal);
    return UNITY_END();
}
