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

#ifdef __cplusplus
}
#endif

#endif
