/* Pictures in memory: sprites of canvas/, textures of meshes (geometry/mesh.h).
 *
 * Rows follow each other without gaps; rows of 4 bits and of single bits begin with a byte of their own. The data is the
 * caller's, in flash as a rule. */
#ifndef EL_BASE_IMAGE_H
#define EL_BASE_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/rgb565.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum el_image_format {
    EL_IMAGE_RGB565, /* uint16_t per pixel */
    EL_IMAGE_INDEX8, /* a byte per pixel, into a palette of 256 */
    EL_IMAGE_INDEX4, /* the left pixel of two in the upper half of a byte, into a palette of 16 */
    EL_IMAGE_MASK    /* the left pixel of eight in the highest bit: 1 has the palette's first colour, 0 none */
} el_image_format;

enum { EL_IMAGE_MAX = 32767 }; /* pixels, of a side */

typedef struct el_image {
    uint16_t width, height; /* 1..EL_IMAGE_MAX */
    uint8_t format;         /* el_image_format */
    bool has_key;           /* pixels of value `key` are not drawn */
    uint16_t key;           /* a colour of EL_IMAGE_RGB565, else an index */
    const void *pixels;     /* aligned as its values are */
    const uint16_t *palette;
    const uint8_t *alpha; /* a byte per pixel, 255 hides what is below; NULL: all do */
} el_image;

/* --- For the layers that draw them -------------------------------------------------------------------------------------- */

/* The pixel at (x, y), within the image: its colour, and how much of it shows, 0..256. */
static inline uint32_t el_image_at(const el_image *image, el_image_format format, uint32_t x, uint32_t y,
                                   uint16_t *colour)
{
    const uint8_t *const bytes = (const uint8_t *)image->pixels;
    uint16_t value;
    uint32_t shown = 256;
    switch (format) {
    case EL_IMAGE_RGB565:
        value = ((const uint16_t *)image->pixels)[y * image->width + x];
        *colour = value;
        break;
    case EL_IMAGE_INDEX8:
        value = bytes[y * image->width + x];
        *colour = image->palette[value];
        break;
    case EL_IMAGE_INDEX4:
        value = (uint16_t)((uint32_t)bytes[y * ((image->width + 1U) / 2U) + x / 2U] >> ((x & 1U) != 0 ? 0 : 4) & 15U);
        *colour = image->palette[value];
        break;
    default:
        value = (uint16_t)((uint32_t)bytes[y * ((image->width + 7U) / 8U) + x / 8U] >> (7U - (x & 7U)) & 1U);
        *colour = image->palette[0];
        shown = value != 0 ? 256 : 0;
        break;
    }
    if (image->has_key && value == image->key) {
        return 0;
    }
    return image->alpha == NULL ? shown : shown * el_alpha_256(image->alpha[y * image->width + x]) >> 8;
}

/* Four pixels whose centres lie around a place: the upper two, the lower two, each from the left. */
typedef struct el_image_four {
    uint16_t colour[4];
    uint32_t shown[4]; /* 0..256; of 0 the colour is any */
} el_image_four;

/* Their mean by distance and by what they show, each channel rounded to nearest, at so many sixteenths of their distance to
 * the right of the left ones and below the upper ones, 0 to 15; and how much shows, 0..256. Where that is 0 there is no
 * colour. */
uint32_t el_image_mean(const el_image_four *four, uint32_t right, uint32_t down, uint16_t *colour);

/* Where a smooth pixel is looked up: the columns and rows of those four, and how far it is from the first of them. */
typedef struct el_image_spot {
    uint32_t x[2], y[2];  /* beyond the image there is nothing */
    uint32_t right, down; /* as above */
} el_image_spot;

/* The mean of those four of the image, as el_image_mean has it; how much shows, 0..256. */
uint32_t el_image_smooth_at(const el_image *image, const el_image_spot *spot, uint16_t *colour);

#ifdef __cplusplus
}
#endif

#endif
