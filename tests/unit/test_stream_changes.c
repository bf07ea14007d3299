/* The line's CRC that is put together from its segments' CRCs, and the segments that have changed. */
#include <string.h>

#include "base/crc32.h"
#include "seeded.h"
#include "stream/changes.h"

enum { MAX_WIDTH = 2040, MAX_SEGMENTS = 32 };

#define EXPECT(seed, condition)                                                                                        \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fail_at(seed, "line %d: %s", __LINE__, #condition);                                                        \
        }                                                                                                              \
    } while (0)

void setUp(void)
{
}

void tearDown(void)
{
}

static uint16_t pixels[MAX_WIDTH];
static uint32_t crcs[MAX_SEGMENTS];

static void check(seeded *seed, uint32_t width, uint32_t segment)
{
    uint32_t line_crc;
    for (uint32_t x = 0; x < width; x++) {
        pixels[x] = (uint16_t)any_below(seed, 65536);
    }
    (void)el_changes_find(pixels, width, segment, crcs, &line_crc);
    EXPECT(seed, line_crc == el_crc32(0, pixels, 2 * width));
    EXPECT(seed, el_changes_find(pixels, width, segment, crcs, &line_crc) == 0);
    const uint32_t x = any_below(seed, width);
    pixels[x] ^= (uint16_t)(1U << any_below(seed, 16));
    EXPECT(seed, el_changes_find(pixels, width, segment, crcs, &line_crc) == 1U << x / segment);
    EXPECT(seed, line_crc == el_crc32(0, pixels, 2 * width));
}

/* Every width up to some segments and a part, so that each entry of the table has its say many times over. */
static void test_all_widths(void)
{
    seeded seed = seeded_from(5301);
    for (seed.round = 1; seed.round <= PART_OF(MAX_WIDTH); seed.round++) {
        check(&seed, seed.round, EL_SPLIT_SEGMENT_PIXELS);
        check(&seed, seed.round, seed.round);
    }
}

/* A segment's 128 bytes are 1,024 steps of the CRC's shift register, for each single bit of the line's CRC so far. */
static void test_the_table_is_the_shift_register_s(void)
{
    static const uint16_t black[2 * EL_SPLIT_SEGMENT_PIXELS];
    for (uint32_t bit = 0; bit < 16 * EL_SPLIT_SEGMENT_PIXELS; bit++) {
        uint32_t line_crc;
        memcpy(pixels, black, sizeof black);
        pixels[bit / 16] = (uint16_t)(1U << bit % 16);
        (void)el_changes_find(pixels, 2 * EL_SPLIT_SEGMENT_PIXELS, EL_SPLIT_SEGMENT_PIXELS, crcs, &line_crc);
        TEST_ASSERT_EQUAL_HEX32(el_crc32(0, pixels, sizeof black), line_crc);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_all_widths);
    RUN_TEST(test_the_table_is_the_shift_register_s);
    return UNITY_END();
}
