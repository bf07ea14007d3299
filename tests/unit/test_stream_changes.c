/* The line's CRC that is put together from its segments' CRCs, and the segments that have changed. */
#include <string.h>

#include "base/crc32.h"
#include "seeded.h"
#include "stream/changes.h"

enum { MAX_WIDTH = 2040, MAX_SEGMENTS = 32 };

void setUp(void)
{
}

void tearDown(void)
{
}

static uint16_t pixels[MAX_WIDTH];
static uint32_t crcs[MAX_SEGMENTS];
static uint32_t fresh[MAX_SEGMENTS];

/* The segments that have changed since the last look, whose CRCs are kept from then on. */
static uint32_t look(uint32_t width, uint32_t segment)
{
    const uint32_t changed = el_changes_find(pixels, width, segment, crcs, fresh);
    memcpy(crcs, fresh, sizeof crcs);
    return changed;
}

static void check(seeded *seed, uint32_t width, uint32_t segment)
{
    for (uint32_t x = 0; x < width; x++) {
        pixels[x] = (uint16_t)any_below(seed, 65536);
    }
    (void)look(width, segment);
    const uint32_t before = el_crc32(0, pixels, 2 * width);
    EXPECT(seed, el_changes_line_crc(crcs, width, segment) == before);
    EXPECT(seed, look(width, segment) == 0);
    const uint32_t x = any_below(seed, width);
    pixels[x] ^= (uint16_t)(1U << any_below(seed, 16));
    EXPECT(seed, el_changes_find(pixels, width, segment, crcs, fresh) == 1U << x / segment);
    EXPECT(seed, el_changes_line_crc(crcs, width, segment) == before); /* a line that is left out */
    EXPECT(seed, el_changes_line_crc(fresh, width, segment) == el_crc32(0, pixels, 2 * width));
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
        memcpy(pixels, black, sizeof black);
        pixels[bit / 16] = (uint16_t)(1U << bit % 16);
        (void)look(2 * EL_SPLIT_SEGMENT_PIXELS, EL_SPLIT_SEGMENT_PIXELS);
        TEST_ASSERT_EQUAL_HEX32(el_crc32(0, pixels, sizeof black),
                                el_changes_line_crc(crcs, 2 * EL_SPLIT_SEGMENT_PIXELS, EL_SPLIT_SEGMENT_PIXELS));
    }
}

/* The same wrong pixel in two lines, two pixels further to the left in the lower one: CRCs alone would not show it. */
static void test_the_digest_sees_a_slanted_edge(void)
{
    uint16_t lines[2][8] = {{1, 2, 3, 4, 5, 6, 7, 8}, {8, 7, 6, 5, 4, 3, 2, 1}};
    uint32_t plain[2] = {0, 0};
    uint32_t digest[2] = {0, 0};
    for (int wrong = 0; wrong < 2; wrong++) {
        lines[0][5] ^= (uint16_t)(wrong * 0x1234);
        lines[1][3] ^= (uint16_t)(wrong * 0x1234);
        for (int y = 0; y < 2; y++) {
            const uint32_t line_crc = el_crc32(0, lines[y], sizeof lines[y]);
            plain[wrong] = el_crc32(plain[wrong], &line_crc, sizeof line_crc);
            digest[wrong] = el_changes_digest(digest[wrong], line_crc);
        }
    }
    TEST_ASSERT_EQUAL_HEX32(plain[0], plain[1]);
    TEST_ASSERT_TRUE(digest[0] != digest[1]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_all_widths);
    RUN_TEST(test_the_table_is_the_shift_register_s);
    RUN_TEST(test_the_digest_sees_a_slanted_edge);
    return UNITY_END();
}
