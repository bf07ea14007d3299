/* Pictures (sprites, icons; base/image.h) drawn as they are, or turned and scaled. */
#ifndef EL_CANVAS_IMAGE_H
#define EL_CANVAS_IMAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/angle.h"
#include "base/image.h"
#include "base/status.h"
#include "canvas/canvas.h"
#include "geometry/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

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

#ifdef __cplusplus
}
#endif

#endif
