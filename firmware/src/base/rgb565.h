/* RGB565, the pixel format of the displays: red in bits 15..11, green in 10..5, blue in 4..0. */
#ifndef EL_BASE_RGB565_H
#define EL_BASE_RGB565_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Keeps the upper bits of each channel, as every stage of Edgeline does. */
static inline uint16_t el_rgb565(uint8_t red, uint8_t green, uint8_t blue)
{
    return (uint16_t)(((red >> 3) << 11) | ((green >> 2) << 5) | (blue >> 3));
}

/* A pixel with gaps between its channels, each of which takes the sum of 31 pixels: green in bits 31..21, red in 20..11, blue in
 * 10..0. Of what is above a pixel's 16 bits nothing is left. */
#define EL_RGB565_SPREAD 0x07E0F81FU
static inline uint32_t el_rgb565_spread(uint32_t pixel)
{
    return (pixel << 16 | (pixel & 0xFFFFU)) & EL_RGB565_SPREAD;
}

/* 0..255 as 0..256. */
static inline uint32_t el_alpha_256(uint8_t alpha)
{
    return alpha + (alpha >> 7);
}

/* Sixteen times the colour between two that are spread, so many sixteenths of the way: below 2^9, 2^9 and 2^10 from bits 0, 11
 * and 21 on; modulo 2^32 in between. */
static inline uint32_t el_rgb565_between(uint32_t from, uint32_t to, uint32_t sixteenths)
{
    return (from << 4) + (to - from) * sixteenths;
}

/* The mean of four pixels, the upper two and the lower two, each from the left, at so many sixteenths of their distance to the
 * right of the left ones and below the upper ones, 0 to 15; each channel is rounded to nearest. 256 times the mean is a sum of
 * products by parts of 256, whichever way they are added up. */
static inline uint16_t el_rgb565_mean(const uint16_t four[4], uint32_t right, uint32_t down)
{
    const uint32_t above = el_rgb565_between(el_rgb565_spread(four[0]), el_rgb565_spread(four[1]), right);
    const uint32_t below = el_rgb565_between(el_rgb565_spread(four[2]), el_rgb565_spread(four[3]), right);
    /* Red from bit 16 on: sums below 2^13, 2^13 and 2^14. */
    const uint32_t rb_above = (above & 0x1FFU) | (above & 0xFF800U) << 5;
    const uint32_t rb_below = (below & 0x1FFU) | (below & 0xFF800U) << 5;
    const uint32_t rb = el_rgb565_between(rb_above, rb_below, down) + 0x00800080U;
    const uint32_t g = el_rgb565_between(above >> 21, below >> 21, down) + 0x80U;
    return (uint16_t)((rb >> 24 << 11) | (g >> 3 & 0x07E0U) | (rb >> 8 & 0x1FU));
}

/* `over` over `under`, of which it hides alpha / 256, 0..256: each channel is rounded to nearest, ties up, so that 0 leaves
 * `under` as it is and 256 is `over`. The sums of red and blue lie 16 bits apart, below 31 * 256 + 128 each. */
static inline uint16_t el_rgb565_blend(uint16_t under, uint16_t over, uint32_t alpha)
{
    const uint32_t under_rb = (under & 0xF800U) << 5 | (under & 0x1FU);
    const uint32_t over_rb = (over & 0xF800U) << 5 | (over & 0x1FU);
    const uint32_t under_g = under & 0x07E0U;
    const uint32_t over_g = over & 0x07E0U;
    /* under * (256 - alpha) + over * alpha in one product, modulo 2^32: what is below 0 in between is made up for. */
    const uint32_t rb = ((under_rb << 8) + (over_rb - under_rb) * alpha + 0x00800080U) >> 8;
    const uint32_t g = ((under_g << 8) + (over_g - under_g) * alpha + 0x1000U) >> 8; /* half a unit is 2^5 * 128 */
    return (uint16_t)((rb >> 5 & 0xF800U) | (g & 0x07E0U) | (rb & 0x1FU));
}

/* The same for two pixels that lie side by side in a word. Their channels are 16 bits apart, sums below 63 * 256 + 128. */
static inline uint32_t el_rgb565_blend_pair(uint32_t under, uint32_t over, uint32_t alpha)
{
    const uint32_t under_r = under >> 11 & 0x001F001FU;
    const uint32_t under_g = under >> 5 & 0x003F003FU;
    const uint32_t under_b = under & 0x001F001FU;
    const uint32_t r = (under_r << 8) + ((over >> 11 & 0x001F001FU) - under_r) * alpha + 0x00800080U;
    const uint32_t g = (under_g << 8) + ((over >> 5 & 0x003F003FU) - under_g) * alpha + 0x00800080U;
    const uint32_t b = (under_b << 8) + ((over & 0x001F001FU) - under_b) * alpha + 0x00800080U;
    return (r >> 8 & 0x001F001FU) << 11 | (g >> 8 & 0x003F003FU) << 5 | (b >> 8 & 0x001F001FU);
}

/* A channel's part of both pixels of a pair, with the half that rounds. */
static inline uint32_t el_rgb565_share(uint32_t channel, uint32_t alpha)
{
    return channel * alpha * 0x10001U + 0x00800080U;
}

/* el_rgb565_blend_pair with the same colour in both pixels, of which these are the shares, with alpha = 256 - rest. */
static inline uint32_t el_rgb565_blend_shares(uint32_t under, uint32_t rest, uint32_t red, uint32_t green,
                                              uint32_t blue)
{
    const uint32_t r = (under >> 11 & 0x001F001FU) * rest + red;
    const uint32_t g = (under >> 5 & 0x003F003FU) * rest + green;
    const uint32_t b = (under & 0x001F001FU) * rest + blue;
    return (r >> 8 & 0x001F001FU) << 11 | (g >> 8 & 0x003F003FU) << 5 | (b >> 8 & 0x001F001FU);
}

#ifdef __cplusplus
}
#endif

#endif
