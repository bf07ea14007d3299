/* Pictures (sprites, icons) drawn as they are, or turned and scaled.
 *
 * Rows follow each other without gaps; rows of 4 bits and of single bits begin with a byte of their own. The data is the
 * caller's, in flash as a rule. */
#ifndef EL_CANVAS_IMAGE_H
#define EL_CANVAS_IMAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/angle.h"
#include "base/status.h"
#include "canvas/canvas.h"
#include "geometry/limits.h"

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

/* Draws `image` with its upper left pixel at (x, y); `alpha` 0..255 is its own, which alpha and key come to. */
void el_canvas_image(const el_canvas *canvas, const el_image *image, int32_t x, int32_t y, uint8_t alpha);

typedef struct el_image_place {
    int32_t x, y;       /* where the image's middle comes to lie, 1/EL_SUBPIXELS px, within +-EL_GUARD_SUB */
    el_angle angle;     /* turned clockwise on the screen */
    uint32_t scale_q16; /* 65536 is its own size; 1/256 to 256 of it */
    bool smooth;        /* of the four nearest pixels in sixteenths of their distance, rather than of the one below the
                           middle; beyond the border is nothing */
    uint8_t alpha;      /* as above */
} el_image_place;

/* Draws it so. A pixel's place in the image is a whole number of 1/65536 pixel, linear in x and y and rounded once for all
 * of the screen, so it does not depend on bands. EL_ERROR_RANGE: a place or scale out of range; EL_ERROR_SIZE: an image
 * of no or too large a size. Nothing is drawn then. */
el_status el_canvas_image_turned(const el_canvas *canvas, const el_image *image, const el_image_place *place);

/* --- For the other files of canvas/ ------------------------------------------------------------------------------------ */

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

#ifdef __cplusplus
}
#endif

#endif
