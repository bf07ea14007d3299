/* UTF-8 against the Unicode standard's own table, and a font of two letters as pictures. */
#include "canvas_picture.h"
#include "seeded.h"

enum { INK = 0xFFFF };

void setUp(void)
{
}
void tearDown(void)
{
}

static void expect_characters(const char *text, unsigned count, const uint32_t *wanted)
{
    const char *at = text;
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(wanted[i], el_utf8_next(&at), text);
    }
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, el_utf8_next(&at), text);
    TEST_ASSERT_EQUAL_PTR_MESSAGE(text + strlen(text), at, text);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, el_utf8_next(&at), text); /* it stays */
}

#define EXPECT_CHARACTERS(text, ...)                                                                                   \
    expect_characters(text, sizeof((const uint32_t[]){__VA_ARGS__}) / sizeof(uint32_t), (const uint32_t[]){__VA_ARGS__})

static void test_characters_of_every_length_are_read(void)
{
    EXPECT_CHARACTERS("A\x7F", 'A', 0x7F);
    EXPECT_CHARACTERS("\xC2\x80\xDF\xBF", 0x80, 0x7FF);
    EXPECT_CHARACTERS("\xE0\xA0\x80\xED\x9F\xBF\xEE\x80\x80\xEF\xBF\xBF", 0x800, 0xD7FF, 0xE000, 0xFFFF);
    EXPECT_CHARACTERS("\xF0\x90\x80\x80\xF4\x8F\xBF\xBF", 0x10000, 0x10FFFF);
}

/* Tables 3-8 to 3-11 of the Unicode Standard 15.0, chapter 3. */
static void test_malformed_bytes_become_replacements(void)
{
    enum { R = 0xFFFD };
    EXPECT_CHARACTERS("\xC0\xAF\xE0\x80\xBF\xF0\x81\x82\x41", R, R, R, R, R, R, R, R, 'A');
    EXPECT_CHARACTERS("\xED\xA0\x80\xED\xBF\xBF\xED\xAF\x41", R, R, R, R, R, R, R, R, 'A');
    EXPECT_CHARACTERS("\xF4\x91\x92\x93\xFF\x41\x80\xBF\x42", R, R, R, R, R, 'A', R, R, 'B');
    EXPECT_CHARACTERS("\xE1\x80\xE2\xF0\x91\x92\xF1\xBF\x41", R, R, R, R, 'A');
    EXPECT_CHARACTERS("\xC2", R); /* the end in the middle of a character */
    EXPECT_CHARACTERS("\xF0\x9F\x92", R);
}

/* Any bytes end where they end, and every one of them is taken. */
static void test_no_byte_beyond_the_end_is_read(void)
{
    seeded s = seeded_from(1);
    for (s.round = 0; s.round < PART_OF(100000); s.round++) {
        char text[9];
        const uint32_t length = any_below(&s, 8);
        for (uint32_t i = 0; i < length; i++) {
            text[i] = (char)(1U + any_below(&s, 255));
        }
        text[length] = 0;
        text[8] = 'X';
        const char *at = text;
        while (el_utf8_next(&at) != 0) {
        }
        if (at != text + length) {
            fail_at(&s, "ended %d bytes from the end", (int)(at - text) - (int)length);
        }
    }
}

/* 'A' and 'B' as an 'L' and a dot, and U+20AC, a bar below the base line; A is moved to B. */
static const uint8_t bits[] = {0x92, 0x70, 0x80, 0xFC};
static const el_glyph glyphs[] = {{0, 3, 4, 0, 4, 4}, {2, 1, 1, 1, 4, 3}, {3, 3, 2, -1, 0, 3}};
static const el_font_range ranges[] = {{'A', 2, 0}, {0x20AC, 1, 2}};
static const el_font_kern kerns[] = {{0, 1, -1}, {1, 0, 2}};
static const el_font font = {.glyphs = glyphs,
                             .ranges = ranges,
                             .bits = bits,
                             .kerns = kerns,
                             .range_count = 2,
                             .kern_count = 2,
                             .bits_per_pixel = 1,
                             .ascent = 4,
                             .descent = 2,
                             .line_height = 7};

typedef struct words {
    const char *text;
    const el_font *font;
    int16_t x, y;
    el_align align;
} words;

static void draw_words(void *context, el_band *band)
{
    const words *const w = context;
    const el_canvas canvas = el_canvas_of(band);
    el_canvas_text(&canvas, w->font, w->x, w->y, w->align, w->text, el_solid(INK));
}

static canvas_picture picture_of(words w, uint16_t width, uint16_t height)
{
    canvas_picture p = canvas_picture_of(width, height);
    paint_any_bands(&p, draw_words, &w);
    return p;
}

static void test_letters_stand_on_the_base_line(void)
{
    canvas_picture p = picture_of((words){"AAB\xE2\x82\xAC", &font, 1, 5, EL_ALIGN_LEFT}, 16, 8);
    EXPECT_CANVAS(&p, "................", ".#...#...#......", ".#...#..........", ".#...#..........",
                  ".###.###........", "..........###...", "..........###...", "................");
    TEST_ASSERT_EQUAL_INT32(4 + 4 - 1 + 3 + 3, el_text_width(&font, "AAB\xE2\x82\xAC"));
    TEST_ASSERT_EQUAL_INT32(3 + 2 + 4, el_text_width(&font, "A\nBA\nB"));
    TEST_ASSERT_EQUAL_INT32(0, el_text_width(&font, ""));
}

static void test_lines_are_aligned_each_for_itself(void)
{
    canvas_picture p = picture_of((words){"AA\nA", &font, 10, 4, EL_ALIGN_RIGHT}, 12, 12);
    EXPECT_CANVAS(&p, "..#...#.....", "..#...#.....", "..#...#.....", "..###.###...", "............", "............",
                  "............", "......#.....", "......#.....", "......#.....", "......###...", "............");
    p = picture_of((words){"AA\nA", &font, 6, 4, EL_ALIGN_CENTRE}, 12, 12);
    EXPECT_CANVAS(&p, "..#...#.....", "..#...#.....", "..#...#.....", "..###.###...", "............", "............",
                  "............", "....#.......", "....#.......", "....#.......", "....###.....", "............");
}

static void test_a_missing_letter_is_a_box(void)
{
    canvas_picture p = picture_of((words){"AxA", &font, 0, 5, EL_ALIGN_LEFT}, 12, 6);
    EXPECT_CANVAS(&p, "............", "#...###.#...", "#...#.#.#...", "#...#.#.#...", "###.###.###.", "............");
    TEST_ASSERT_EQUAL_INT32(12, el_text_width(&font, "AxA"));
}

/* Values of 2 and 4 bits are as much coverage. */
static void test_smooth_letters_cover_in_parts(void)
{
    static const uint8_t two[] = {0x1B};
    static const uint8_t four[] = {0x07, 0x8F};
    static const uint8_t depths[] = {2, 4};
    static const uint32_t parts[2][4] = {{0, 85, 171, 256}, {0, 119, 137, 256}};
    for (unsigned k = 0; k < 2; k++) {
        static const el_glyph glyph = {0, 4, 1, 0, 1, 4};
        static const el_font_range range = {'A', 1, 0};
        const el_font smooth = {.glyphs = &glyph,
                                .ranges = &range,
                                .bits = k == 0 ? two : four,
                                .range_count = 1,
                                .bits_per_pixel = depths[k],
                                .ascent = 1,
                                .line_height = 1};
        const canvas_picture p = picture_of((words){"A", &smooth, 0, 1, EL_ALIGN_LEFT}, 4, 1);
        for (unsigned i = 0; i < 4; i++) {
            TEST_ASSERT_EQUAL_HEX16(el_rgb565_blend(0, INK, parts[k][i]), p.pixels[i]);
        }
    }
}

/* At any place, text ends at the canvas' borders; what paint_any_bands checks. */
static void test_text_is_clipped_everywhere(void)
{
    seeded s = seeded_from(2);
    for (s.round = 0; s.round < PART_OF(500); s.round++) {
        const bool far = any_below(&s, 5) == 0;
        const words w = {"BA\xE2\x82\xAC\xE2\x82\xACx\nB", &font,
                         (int16_t)(far ? any_between(&s, INT16_MIN, INT16_MAX) : any_between(&s, -20, 20)),
                         (int16_t)(far ? any_between(&s, INT16_MIN, INT16_MAX) : any_between(&s, -12, 20)),
                         (el_align)any_below(&s, 3)};
        (void)picture_of(w, 13, 11);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_characters_of_every_length_are_read);
    RUN_TEST(test_malformed_bytes_become_replacements);
    RUN_TEST(test_no_byte_beyond_the_end_is_read);
    RUN_TEST(test_letters_stand_on_the_base_line);
    RUN_TEST(test_lines_are_aligned_each_for_itself);
    RUN_TEST(test_a_missing_letter_is_a_box);
    RUN_TEST(test_smooth_letters_cover_in_parts);
    RUN_TEST(test_text_is_clipped_everywhere);
    return UNITY_END();
}
