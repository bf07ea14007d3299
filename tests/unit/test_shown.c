/* What a display shows, as hashes: no change of one pixel is missed, what has changed is found with the smallest rectangle
 * of whole segments around it, and a rectangle's lines are moved together as they are. */
#include <string.h>

#include "panel/shown.h"
#include "seeded.h"

enum { MAX_WIDTH = 330, LINES = 8, MAX_PIXELS = MAX_WIDTH * LINES };

static uint16_t pixels[MAX_PIXELS + 1] __attribute__((aligned(4)));
static uint32_t hashes[EL_SHOWN_BYTES(MAX_WIDTH, LINES) / 4];

/* Even and odd, whole segments and not. */
static const unsigned widths[] = {1, 2, 31, 32, 33, 64, 127, 240, 320, 330};
enum { WIDTHS = sizeof widths / sizeof widths[0] };

void setUp(void)
{
    memset(hashes, 0, sizeof hashes);
}

void tearDown(void)
{
}

static void make_noise(seeded *s)
{
    for (unsigned i = 0; i <= MAX_PIXELS; i++) {
        pixels[i] = (uint16_t)any_u64(s);
    }
}

static void expect_part(const el_shown_part *part, unsigned left, unsigned right, unsigned top, unsigned bottom)
{
    const unsigned expected[4] = {left, right, top, bottom};
    const unsigned found[4] = {part->left, part->right, part->top, part->bottom};
    TEST_ASSERT_EQUAL_UINT_ARRAY(expected, found, 4);
}

static unsigned end_of_segment(unsigned x, unsigned width)
{
    const unsigned end = (x / EL_SHOWN_SEGMENT + 1) * EL_SHOWN_SEGMENT;
    return end < width ? end : width;
}

static void test_what_was_there_is_not_found_again(void)
{
    seeded s = seeded_from(1);
    make_noise(&s);
    for (unsigned i = 0; i < WIDTHS; i++) {
        setUp();
        el_shown_part part = el_shown_update(hashes, pixels, widths[i], LINES);
        expect_part(&part, 0, widths[i], 0, LINES);
        part = el_shown_update(hashes, pixels, widths[i], LINES);
        TEST_ASSERT_TRUE(el_shown_is_empty(&part));
    }
}

/* Each bit of each pixel. */
static void test_one_pixel_is_found(void)
{
    seeded s = seeded_from(2);
    make_noise(&s);
    for (unsigned i = 0; i < WIDTHS; i++) {
        const unsigned width = widths[i];
        (void)el_shown_update(hashes, pixels, width, LINES);
        for (unsigned at = 0; at < width * LINES; at += EL_TEST_PART) {
            const unsigned x = at % width;
            pixels[at] = (uint16_t)(pixels[at] ^ 1U << at * 7 % 16);
            const el_shown_part part = el_shown_update(hashes, pixels, width, LINES);
            expect_part(&part, x / EL_SHOWN_SEGMENT * EL_SHOWN_SEGMENT, end_of_segment(x, width), at / width,
                        at / width + 1);
        }
    }
}

/* Any two words of one bit each, which weak hashes undo: in particular the same bit in two neighbours. */
static void test_two_bits_are_found(void)
{
    seeded s = seeded_from(3);
    make_noise(&s);
    for (unsigned a = 0; a < 31 * 16; a += EL_TEST_PART) {
        for (unsigned b = a + 1; b < 32 * 16; b++) {
            (void)el_shown_update(hashes, pixels, 32, 1);
            pixels[a / 16] = (uint16_t)(pixels[a / 16] ^ 1U << a % 16);
            pixels[b / 16] = (uint16_t)(pixels[b / 16] ^ 1U << b % 16);
            const el_shown_part part = el_shown_update(hashes, pixels, 32, 1);
            expect_part(&part, 0, 32, 0, 1);
        }
    }
}

/* The rectangle of several changes against one that is found pixel by pixel, at even and odd addresses. */
static void test_the_smallest_part_around_all_changes(void)
{
    for (seeded s = seeded_from(4); s.round < PART_OF(2000); s.round++) {
        const unsigned width = widths[s.round % WIDTHS];
        uint16_t *const band = pixels + s.round / WIDTHS % 2;
        unsigned left = width;
        unsigned right = 0;
        unsigned top = LINES;
        unsigned bottom = 0;
        make_noise(&s);
        (void)el_shown_update(hashes, band, width, LINES);
        for (unsigned changes = any_below(&s, 4) + 1; changes > 0; changes--) {
            const unsigned x = any_below(&s, width);
            const unsigned y = any_below(&s, LINES);
            band[y * width + x]++; /* never what it was */
            const unsigned begin = x / EL_SHOWN_SEGMENT * EL_SHOWN_SEGMENT;
            left = begin < left ? begin : left;
            right = end_of_segment(x, width) > right ? end_of_segment(x, width) : right;
            top = y < top ? y : top;
            bottom = y + 1 > bottom ? y + 1 : bottom;
        }
        const el_shown_part part = el_shown_update(hashes, band, width, LINES);
        expect_part(&part, left, right, top, bottom);
    }
}

static void test_lines_are_added(void)
{
    el_shown_part part = {0};
    el_shown_add_lines(&part, 100, 3, 5);
    expect_part(&part, 0, 100, 3, 5);
    part = (el_shown_part){32, 64, 6, 7};
    el_shown_add_lines(&part, 100, 2, 4);
    expect_part(&part, 0, 100, 2, 7);
}

static void test_packed_lines_are_the_part(void)
{
    static uint16_t before[MAX_PIXELS];
    for (seeded s = seeded_from(5); s.round < PART_OF(500); s.round++) {
        const unsigned width = widths[s.round % WIDTHS];
        make_noise(&s);
        memcpy(before, pixels, sizeof before);
        const unsigned left = any_below(&s, width);
        const unsigned top = any_below(&s, LINES);
        const el_shown_part part = {.left = (uint16_t)left,
                                    .right = (uint16_t)any_between(&s, left + 1, width),
                                    .top = (uint16_t)top,
                                    .bottom = (uint16_t)any_between(&s, top + 1, LINES)};
        const uint16_t *packed = el_shown_pack(pixels, width, &part);
        for (unsigned y = part.top; y < part.bottom; y++) {
            for (unsigned x = part.left; x < part.right; x++) {
                TEST_ASSERT_EQUAL_HEX16(before[y * width + x], *packed++);
            }
        }
        TEST_ASSERT_EQUAL_INT(0, memcmp(before + LINES * width, pixels + LINES * width,
                                        sizeof before - LINES * width * sizeof before[0]));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_was_there_is_not_found_again);
    RUN_TEST(test_one_pixel_is_found);
    RUN_TEST(test_two_bits_are_found);
    RUN_TEST(test_the_smallest_part_around_all_changes);
    RUN_TEST(test_lines_are_added);
    RUN_TEST(test_packed_lines_are_the_part);
    return UNITY_END();
}
