/* Ordered dithering: fewer levels per pixel, the right mean over each 4x4 block of the screen.
 *
 * Bayer, "An optimum method for two-level rendition of continuous-tone pictures", ICC 1973: a pixel's threshold depends on
 * its place only. A value between two levels is rounded up where its fraction exceeds the threshold; the 16 thresholds are
 * the middles of sixteenths, so the mean over a block is within 1/32 of a level of the value. */
#ifndef EL_BASE_DITHER_H
#define EL_BASE_DITHER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The order of a block's pixels, by row and column. */
static const uint8_t el_dither_order[4][4]
    __attribute__((aligned(4))) = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};

/* The threshold of pixel (x, y) as a fraction of a level, Q16: (2 k + 1) / 32 for k = 0..15. */
static inline uint32_t el_dither_threshold_q16(uint32_t x, uint32_t y)
{
    return ((uint32_t)el_dither_order[y & 3U][x & 3U] << 12) + 2048U;
}

/* The thresholds of a row from a pixel on, a byte each, the next one in the second; they repeat. */
typedef struct el_dither_row {
    uint32_t next;
} el_dither_row;

static inline el_dither_row el_dither_row_at(uint32_t x, uint32_t y)
{
    const uint8_t *const order = el_dither_order[y & 3U];
    const uint32_t all =
        (uint32_t)order[0] | (uint32_t)order[1] << 8 | (uint32_t)order[2] << 16 | (uint32_t)order[3] << 24;
    const unsigned turn = (unsigned)((x - 1U) & 3U) * 8U;
    const uint32_t q8 = all * 16U + 0x08080808U;
    const el_dither_row row = {q8 >> turn | q8 << (-turn & 31U)};
    return row;
}

/* Of the next pixel, as el_dither_threshold_q16 has it. */
static inline uint32_t el_dither_row_next_q16(el_dither_row *row)
{
    const uint32_t threshold_q16 = row->next & 0xFF00U;
    row->next = row->next >> 8 | row->next << 24;
    return threshold_q16;
}

/* A value, 0..1 in Q16 (65536 is full), as one of `levels` + 1 levels, 0..levels. levels <= 255. */
static inline uint32_t el_dither(uint32_t value_q16, uint32_t levels, uint32_t threshold_q16)
{
    return (value_q16 * levels + threshold_q16) >> 16; /* below 2^24 + 2^16 */
}

/* Luma by ITU-R BT.601, 3.5.1: 0.299 R + 0.587 G + 0.114 B. The weights over the channels' largest values. */
enum { EL_LUMA_RED_Q24 = 161819, EL_LUMA_GREEN_Q24 = 156321, EL_LUMA_BLUE_Q24 = 61697 };

/* 0..1 in Q16. */
static inline uint32_t el_luma_q16(uint16_t rgb565)
{
    const uint32_t sum_q24 = (uint32_t)(rgb565 >> 11) * EL_LUMA_RED_Q24 + ((rgb565 >> 5) & 63U) * EL_LUMA_GREEN_Q24 +
                             (rgb565 & 31U) * EL_LUMA_BLUE_Q24;
    return sum_q24 >> 8;
}

/* One line of RGB565 as 4-bit grey, two pixels per byte, the left one in the upper half. `grey` takes
 * (width + 1) / 2 bytes; `y` is the line on the screen. */
void el_dither_grey4(uint8_t *grey, const uint16_t *rgb565, uint32_t width, uint32_t y);

/* One line of RGB565 as single bits, 1 is light, the left pixel in the highest bit; `bits` takes (width + 7) / 8 bytes.
 * With one bit and 16 thresholds, a block's mean is within 1/32 of white, 8 of 255: no pattern of 16 pixels is nearer. */
void el_dither_mono(uint8_t *bits, const uint16_t *rgb565, uint32_t width, uint32_t y);

#ifdef __cplusplus
}
#endif

#endif
