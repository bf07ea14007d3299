/* Ordered dithering: the mean of each 4x4 block is that of the colour, for every colour and wherever the block lies. */
#include <stdlib.h>
#include <string.h>

#include "base/dither.h"
#include "raster/triangle.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

enum { SIDE = 8 };

/* A square of one colour, Gouraud, dithered, on a screen of 8x8 whose first row is `y`. */
static void draw(uint16_t *pixels, const uint16_t rgb_q8[3], int32_t y, const el_texture *texture)
{
    const el_surface surface = {
        .shading = texture != NULL ? EL_SHADE_TEXTURED_GOURAUD : EL_SHADE_GOURAUD,
        .finish = EL_FINISH_DITHER,
        .uv_error_log2 = 3,
        .texture = texture,
    };
    const el_target target = {.colour = pixels, .width = SIDE, .y = y, .y_end = y + SIDE};
    const int32_t size = SIDE * EL_SUBPIXELS;
    const int32_t top = y * EL_SUBPIXELS;
    const int32_t places[4][2] = {{0, top}, {size, top}, {size, top + size}, {0, top + size}};
    el_stats stats = {0};
    for (int half = 0; half < 2; half++) {
        el_corner corners[3];
        for (int i = 0; i < 3; i++) {
            const int32_t *const place = places[i == 0 ? 0 : half + i];
            corners[i] = (el_corner){.x = place[0], .y = place[1], .w = 1};
            memcpy(corners[i].rgb_q8, rgb_q8, sizeof corners[i].rgb_q8);
        }
        el_triangle triangle;
        TEST_ASSERT_TRUE(el_triangle_setup(&triangle, corners, &surface, y));
        el_triangle_draw(&triangle, &target, &stats);
    }
    TEST_ASSERT_EQUAL_UINT32(SIDE * SIDE, stats.pixels);
}

/* Sum of a channel over the block of 16 pixels at (x, y). */
static unsigned block_sum(const uint16_t *pixels, unsigned x, unsigned y, int channel)
{
    static const unsigned shifts[3] = {11, 5, 0};
    static const unsigned masks[3] = {31, 63, 31};
    unsigned sum = 0;
    for (unsigned i = 0; i < 16; i++) {
        sum += ((unsigned)pixels[(y + i / 4) * SIDE + x + i % 4] >> shifts[channel]) & masks[channel];
    }
    return sum;
}

/* |mean - colour| < 1 of 255; in sixteenths of levels: |sum * 255 / (16 * levels) - colour| < 1. */
static void assert_mean(unsigned sum, unsigned levels, unsigned colour_q8)
{
    const long off = labs((long)sum * 255 * 256 - (long)colour_q8 * 16 * (long)levels);
    TEST_ASSERT_LESS_THAN(256L * 16 * (long)levels, off);
}

static void test_mean_of_each_block_is_the_colour(void)
{
    for (unsigned colour_q8 = 0; colour_q8 <= 0xFF00; colour_q8 += 64) {
        const uint16_t rgb_q8[3] = {(uint16_t)colour_q8, (uint16_t)(0xFF00 - colour_q8), (uint16_t)(colour_q8 / 2)};
        uint16_t pixels[SIDE * SIDE];
        draw(pixels, rgb_q8, 0, NULL);
        for (unsigned block = 0; block < 25; block++) { /* blocks need not begin at multiples of 4 */
            const unsigned x = block % 5;
            const unsigned y = block / 5;
            assert_mean(block_sum(pixels, x, y, 0), 31, rgb_q8[0]);
            assert_mean(block_sum(pixels, x, y, 1), 63, rgb_q8[1]);
            assert_mean(block_sum(pixels, x, y, 2), 31, rgb_q8[2]);
        }
    }
}

static void test_black_and_white_stay(void)
{
    uint16_t pixels[SIDE * SIDE];
    const uint16_t black[3] = {0, 0, 0};
    const uint16_t white[3] = {0xFF00, 0xFF00, 0xFF00};
    draw(pixels, black, 0, NULL);
    TEST_ASSERT_EACH_EQUAL_HEX16(0x0000, pixels, SIDE * SIDE);
    draw(pixels, white, 0, NULL);
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, pixels, SIDE * SIDE);
}

static void test_pattern_belongs_to_the_screen(void)
{
    /* The same rows, drawn as part of another band. */
    const uint16_t grey[3] = {0x8000, 0x8000, 0x8000};
    uint16_t first[SIDE * SIDE];
    uint16_t second[SIDE * SIDE];
    draw(first, grey, 0, NULL);
    draw(second, grey, 2, NULL);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(first + 2 * SIDE, second, (SIDE - 2) * SIDE);
}

static void test_lit_texels_have_the_right_mean(void)
{
    static const uint16_t texel = 20 << 11 | 50 << 5 | 10;
    const el_texture texture = {.texels = &texel};
    for (unsigned light_q8 = 0; light_q8 <= 0xFF00; light_q8 += 128) {
        const uint16_t rgb_q8[3] = {(uint16_t)light_q8, (uint16_t)light_q8, (uint16_t)light_q8};
        uint16_t pixels[SIDE * SIDE];
        draw(pixels, rgb_q8, 0, &texture);
        assert_mean(block_sum(pixels, 0, 0, 0), 31, light_q8 * 20 / 31);
        assert_mean(block_sum(pixels, 0, 0, 1), 63, light_q8 * 50 / 63);
        assert_mean(block_sum(pixels, 0, 0, 2), 31, light_q8 * 10 / 31);
    }
}

/* 0.299 R + 0.587 G + 0.114 B of an RGB565 pixel, times 1000 * 31 * 63. */
static long luma(uint16_t pixel)
{
    return 299L * 63 * (pixel >> 11) + 587L * 31 * ((pixel >> 5) & 63) + 114L * 63 * (pixel & 31);
}

static void test_grey_has_the_right_mean_for_every_colour(void)
{
    for (unsigned pixel = 0; pixel <= 0xFFFF; pixel++) {
        const uint16_t line[4] = {(uint16_t)pixel, (uint16_t)pixel, (uint16_t)pixel, (uint16_t)pixel};
        long sum = 0;
        for (uint32_t y = 0; y < 4; y++) {
            uint8_t grey[2];
            el_dither_grey4(grey, line, 4, y);
            sum += (grey[0] >> 4) + (grey[0] & 15) + (grey[1] >> 4) + (grey[1] & 15);
        }
        /* within 1 of 255: |sum / (16 * 15) - luma| * 255 < 1 */
        const long full = 1000L * 31 * 63;
        TEST_ASSERT_LESS_THAN(16L * 15 * full / 100, labs(sum * full - 16L * 15 * luma((uint16_t)pixel)) * 255 / 100);
    }
}

static void test_bits_are_within_a_sixteenths_half(void)
{
    for (unsigned pixel = 0; pixel <= 0xFFFF; pixel++) {
        const uint16_t line[4] = {(uint16_t)pixel, (uint16_t)pixel, (uint16_t)pixel, (uint16_t)pixel};
        long sum = 0;
        for (uint32_t y = 0; y < 4; y++) {
            uint8_t bits;
            el_dither_mono(&bits, line, 4, y);
            for (int bit = 4; bit < 8; bit++) {
                sum += (bits >> bit) & 1;
            }
        }
        const long full = 1000L * 31 * 63;
        TEST_ASSERT_LESS_OR_EQUAL(full * 16 / 32 + full / 4096, labs(sum * full - 16 * luma((uint16_t)pixel)));
    }
}

static void test_layout_of_bytes(void)
{
    const uint16_t line[9] = {0xFFFF, 0, 0xFFFF, 0xFFFF, 0, 0, 0, 0xFFFF, 0xFFFF};
    uint8_t grey[5];
    uint8_t bits[2];
    el_dither_grey4(grey, line, 9, 0);
    el_dither_mono(bits, line, 9, 0);
    const uint8_t expected_grey[5] = {0xF0, 0xFF, 0x00, 0x0F, 0xF0};
    const uint8_t expected_bits[2] = {0xB1, 0x80};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected_grey, grey, 5);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected_bits, bits, 2);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_mean_of_each_block_is_the_colour);
    RUN_TEST(test_black_and_white_stay);
    RUN_TEST(test_pattern_belongs_to_the_screen);
    RUN_TEST(test_lit_texels_have_the_right_mean);
    RUN_TEST(test_grey_has_the_right_mean_for_every_colour);
    RUN_TEST(test_bits_are_within_a_sixteenths_half);
    RUN_TEST(test_layout_of_bytes);
    return UNITY_END();
}
