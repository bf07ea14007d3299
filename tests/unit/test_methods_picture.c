/* The picture of small multiples: its letters, and that its cells show what they are for. */
#include "methods/picture.h"

#include "test_methods_hits.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_letters(void)
{
    hits_picture picture;
    const el_hits hits = hits_clear(&picture);
    el_sheet canvas = {HITS_ACROSS, HITS_DOWN, hits.counts};
    el_sheet_write(&canvas, 0, 0, 1, 1, "eL4");
    el_sheet_write(&canvas, 4, 5, 1, 2, "?-:");
    EXPECT_HITS(&picture, "text", "111.1...1.1.", "1...1...1.1.", "11..1...111.", "1...1.....1.", "111.111...1.",
                "............", "............", "........222.");
}

/* Twice as large, and beyond every side. */
static void test_letters_are_clipped(void)
{
    hits_picture picture;
    const el_hits hits = hits_clear(&picture);
    el_sheet canvas = {HITS_ACROSS, HITS_DOWN, hits.counts};
    el_sheet_write(&canvas, -3, -3, 2, 1, "L");
    el_sheet_write(&canvas, 9, 5, 2, 2, "L");
    EXPECT_HITS(&picture, "text", "............", "............", "............", "............", "............",
                "111......22.", "111......22.", ".........22.", ".........22.", ".........22.");
}

/* All letters differ, so that no title reads as another. */
static void test_letters_differ(void)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789,.-: ";
    static uint16_t glyphs[sizeof letters][4 * 5];
    for (size_t i = 0; i + 1 < sizeof letters; i++) {
        const char text[] = {letters[i], '\0'};
        el_sheet canvas = {4, 5, glyphs[i]};
        el_sheet_write(&canvas, 0, 0, 1, 1, text);
        for (size_t k = 0; k < i; k++) {
            TEST_ASSERT_TRUE_MESSAGE(memcmp(glyphs[i], glyphs[k], sizeof glyphs[i]) != 0, text);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_letters);
    RUN_TEST(test_letters_are_clipped);
    RUN_TEST(test_letters_differ);
    return UNITY_END();
}
