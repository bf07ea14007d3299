/* Filling half words: every count up to a few blocks, and nothing beside them. */
#include "base/fill.h"

#include "unity.h"

enum { MOST = 200, GUARD = 8 };

void setUp(void)
{
}

void tearDown(void)
{
}

static void expect_filled(uint32_t count, uint32_t at)
{
    _Alignas(4) uint16_t memory[MOST + 2 * GUARD];
    for (uint32_t i = 0; i < MOST + 2 * GUARD; i++) {
        memory[i] = (uint16_t)~i;
    }
    el_fill_u16(memory + at, 0xA5C3, count);
    for (uint32_t i = 0; i < MOST + 2 * GUARD; i++) {
        TEST_ASSERT_EQUAL_HEX16(i >= at && i < at + count ? 0xA5C3 : (uint16_t)~i, memory[i]);
    }
}

static void test_every_count_and_nothing_beside_it(void)
{
    for (uint32_t count = 0; count <= MOST; count++) {
        expect_filled(count, 0);
        expect_filled(count, GUARD);
        expect_filled(count, GUARD - 2); /* aligned to 4 bytes, not to 16 */
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_count_and_nothing_beside_it);
    return UNITY_END();
}
