/* What is drawn into each band beside the triangles: under them, a sky or a map; over them, a HUD.
 *
 * A layer keeps no picture: it is asked for each band anew, and draws what of it lies there (canvas/canvas.h does, clipped
 * to the band, the same in bands of any height). */
#ifndef EL_BASE_LAYER_H
#define EL_BASE_LAYER_H

#include <stdbool.h>
#include <stdint.h>

#include "base/sink.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct el_layer {
    void *context;
    /* Draws into `band`, once per frame for each band that is made: any of its pixels, none beside them. With several
     * workers it is called on each of them, at the same time for different bands. */
    void (*draw)(void *context, el_band *band);
    /* Whether `draw` would do to lines [y, y + lines) what it did to them in the frame before: only then el_config.reuse
     * leaves them out. May be asked for lines in any order, and again. NULL: never. */
    bool (*unchanged)(void *context, uint16_t y, uint16_t lines);
} el_layer;

#ifdef __cplusplus
}
#endif

#endif
