#include "base/dither.h"

#include <string.h>

_Static_assert((31 * EL_LUMA_RED_Q24 + 63 * EL_LUMA_GREEN_Q24 + 31 * EL_LUMA_BLUE_Q24) >> 8 == 65536, "white is white");

void el_dither_grey4(uint8_t *grey, const uint16_t *rgb565, uint32_t width, uint32_t y)
{
    memset(grey, 0, (width + 1U) / 2U);
    for (uint32_t x = 0; x < width; x++) {
        const uint32_t level = el_dither(el_luma_q16(rgb565[x]), 15, el_dither_threshold_q16(x, y));
        grey[x / 2U] |= (uint8_t)((x & 1U) != 0 ? level : level << 4);
    }
}

void el_dither_mono(uint8_t *bits, const uint16_t *rgb565, uint32_t width, uint32_t y)
{
    memset(bits, 0, (width + 7U) / 8U);
    for (uint32_t x = 0; x < width; x++) {
        const uint32_t level = el_dither(el_luma_q16(rgb565[x]), 1, el_dither_threshold_q16(x, y));
        bits[x / 8U] |= (uint8_t)(level << (7U - (x & 7U)));
    }
}
