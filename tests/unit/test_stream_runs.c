/* Run lengths: tokens that can be read off, lengths at every limit, and the smallest size by exhaustive search. */
#include "stream/runs.h"

#include "fake_link.h"

enum { MAX_WIDTH = 2040, GUARD = 0xA5 };

static uint32_t seed;

void setUp(void)
{
    seed = 20261121;
}

void tearDown(void)
{
}

/* Decodes by the format's definition and compares; returns the bytes of tokens and literals. */
static size_t check(const uint16_t *pixels, uint32_t width)
{
    uint8_t tokens[MAX_WIDTH + 1];
    uint8_t again[MAX_WIDTH + 1];
    uint32_t literals;
    uint32_t x = 0;
    uint32_t used = 0;

    memset(tokens, GUARD, sizeof tokens);
    int32_t count = el_runs_encode(pixels, width, EL_RUNS_LINE_MAX_BYTES(width), tokens, &literals);
    TEST_ASSERT_GREATER_THAN_INT32(0, count);
    TEST_ASSERT_EQUAL_UINT8(GUARD, tokens[count]);
    for (int32_t i = 0; i < count; i++) {
        uint32_t length = tokens[i] < 128 ? tokens[i] + 1U : tokens[i] - 126U;
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(width, x + length);
        for (uint32_t k = 1; k < length && tokens[i] >= 128; k++) {
            TEST_ASSERT_EQUAL_HEX16(pixels[x], pixels[x + k]);
        }
        used += tokens[i] < 128 ? length : 1;
        x += length;
    }
    TEST_ASSERT_EQUAL_UINT32(width, x);
    TEST_ASSERT_EQUAL_UINT32(used, literals);

    size_t size = (size_t)count + 2 * (size_t)literals;
    memset(again, GUARD, sizeof again);
    TEST_ASSERT_EQUAL_INT32(count, el_runs_encode(pixels, width, size, again, &literals));
    memset(again, GUARD, sizeof again);
    TEST_ASSERT_EQUAL_INT32(EL_RUNS_TOO_LONG, el_runs_encode(pixels, width, size - 1, again, &literals));
    TEST_ASSERT_EQUAL_UINT8(GUARD, again[(size - 1) / 3]);
    return size;
}

static void check_tokens(const char *line, const char *expected_hex)
{
    uint16_t pixels[64];
    uint8_t expected[64];
    uint8_t tokens[64];
    uint32_t literals;
    uint32_t width = (uint32_t)strlen(line);

    for (uint32_t x = 0; x < width; x++) {
        pixels[x] = (uint16_t)(line[x] * 257);
    }
    size_t count = from_hex(expected_hex, expected);
    TEST_ASSERT_EQUAL_INT32((int32_t)count, el_runs_encode(pixels, width, 999, tokens, &literals));
    TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(expected, tokens, count, line);
    check(pixels, width);
}

/* One letter is one pixel. */
static void test_tokens(void)
{
    check_tokens("a", "00");
    check_tokens("aa", "80");
    check_tokens("ab", "01");
    check_tokens("abc", "02");
    check_tokens("aab", "80 00");
    check_tokens("baa", "00 80");
    check_tokens("aabb", "80 80");
    check_tokens("abccde", "01 80 01");
    check_tokens("aaaaabcdeeef", "83 02 81 00");
}

/* A run of r between stretches of a and b pixels, for all lengths around the limits of the tokens. */
static void test_lengths_around_the_limits(void)
{
    static const uint32_t runs[] = {1, 2, 3, 127, 128, 129, 130, 131, 257, 258, 259, 260, 387, 388};
    static const uint32_t stretches[] = {0, 1, 2, 126, 127, 128, 129, 130, 255, 256, 257};
    static uint16_t pixels[1024];

    for (size_t a = 0; a < sizeof stretches / sizeof stretches[0]; a++) {
        for (size_t r = 0; r < sizeof runs / sizeof runs[0]; r++) {
            for (size_t b = 0; b < sizeof stretches / sizeof stretches[0]; b++) {
                uint32_t width = 0;
                for (uint32_t i = 0; i < stretches[a]; i++) {
                    pixels[width++] = (uint16_t)i;
                }
                for (uint32_t i = 0; i < runs[r]; i++) {
                    pixels[width++] = 0xFFFF;
                }
                for (uint32_t i = 0; i < stretches[b]; i++) {
                    pixels[width++] = (uint16_t)i;
                }
                check(pixels, width);
            }
        }
    }
}

static void test_seeded_lines(void)
{
    static uint16_t pixels[MAX_WIDTH];

    for (int round = 0; round < 3000; round++) {
        uint32_t width = 1 + random_below(&seed, round % 10 == 0 ? MAX_WIDTH : 300);
        uint32_t colours = 1 + random_below(&seed, 5);
        uint32_t longest = 1 + random_below(&seed, 300);
        for (uint32_t x = 0; x < width;) {
            uint16_t colour = (uint16_t)random_below(&seed, colours);
            for (uint32_t i = random_below(&seed, longest) + 1; i > 0 && x < width; i--) {
                pixels[x++] = colour;
            }
        }
        check(pixels, width);
    }
}

/* Noise, which is the worst that a line can hold. */
static void test_the_largest_line(void)
{
    static uint16_t pixels[MAX_WIDTH];

    for (uint32_t x = 0; x < MAX_WIDTH; x++) {
        pixels[x] = (uint16_t)x;
    }
    for (uint32_t width = 1; width <= MAX_WIDTH; width++) {
        TEST_ASSERT_EQUAL_UINT32(EL_RUNS_LINE_MAX_BYTES(width), check(pixels, width));
    }
}

/* No encoding of a line shorter than a stretch is smaller: all lines of 9 pixels in 3 colours against the best of all
 * ways to cut them. */
static void test_no_encoding_is_smaller(void)
{
    enum { WIDTH = 9, LINES = 19683 };

    for (uint32_t line = 0; line < LINES; line++) {
        uint16_t pixels[WIDTH];
        size_t best[WIDTH + 1] = {0}; /* of the first x pixels */
        uint32_t digits = line;
        for (uint32_t x = 0; x < WIDTH; x++, digits /= 3) {
            pixels[x] = (uint16_t)(digits % 3);
        }
        for (uint32_t end = 1; end <= WIDTH; end++) {
            bool equal = true;
            best[end] = best[end - 1] + 3;
            for (uint32_t from = end - 1; from-- > 0;) {
                size_t stretch = best[from] + 1 + 2 * (size_t)(end - from);
                equal = equal && pixels[from] == pixels[end - 1];
                size_t here = equal ? best[from] + 3 : stretch;
                best[end] = here < best[end] ? here : best[end];
            }
        }
        TEST_ASSERT_EQUAL_UINT32(best[WIDTH], check(pixels, WIDTH));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_tokens);
    RUN_TEST(test_lengths_around_the_limits);
    RUN_TEST(test_seeded_lines);
    RUN_TEST(test_the_largest_line);
    RUN_TEST(test_no_encoding_is_smaller);
    return UNITY_END();
}
