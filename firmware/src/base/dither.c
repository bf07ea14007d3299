#include "base/dither.h"

#include <string.h>

/* 0..1 in Q16: the weights over the channels' largest values. */
static uint32_t luma_q16(uint16_t rgb565)
{
    enum { RED_Q8 = 161819, GREEN_Q8 = 156321, BLUE_Q8 = 61697 };
    _Static_assert((31 * RED_Q8 + 63 * GREEN_Q8 + 31 * BLUE_Q8) >> 8 == 65536, "white is white");
    const uint32_t sum =
        (uint32_t)(rgb565 >> 11) * RED_Q8 + ((rgb565 >> 5) & 63U) * GREEN_Q8 + (rgb565 & 31U) * BLUE_Q8;
    return sum >> 8;
}

void el_dither_grey4(uint8_t *grey, const uint16_t *rgb565, uint32_t width, uint32_t y)
{
    memset(grey, 0, (width + 1U) / 2U);
    for (uint32_t x = 0; x < width; x++) {
        const uint32_t level = el_dither(luma_q16(rgb565[x]), 15, el_dither_threshold_q16(x, y));
        grey[x / 2U] |= (uint8_t)((x & 1U) != 0 ? level : level << 4);
    }
}

void el_dither_mono(uint8_t *bits, const uint16_t *rgb565, uint32_t width, uint32_t y)
{
    memset(bits, 0, (width + 7U) / 8U);
    for (uint32_t x = 0; x < width; x++) {
        const uint32_t level = el_dither(luma_q16(rgb565[x]), 1, el_dither_threshold_q16(x, y));
        bits[x / 8U] |= (uint8_t)(level << (7U - (x & 7U)));
    }
}
