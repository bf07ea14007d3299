/* Debug views: frames that show what the renderer did instead of the picture. el_config.view chooses one; with
 * EL_WITH_DEBUG_VIEWS only (base/options.h), and then at the cost of a few tests per draw, triangle and band.
 *
 * A view's frame goes to the sinks like any other, and has the same pixels for every band height, arena and number of
 * passes, and on every core: counts and depths do not depend on them. EL_DEBUG_BANDS alone does, by its nature.
 *
 * Colours are those of el_debug_heat: 0 is black, and each further one is lighter by the same amount (8 of CIE L*), so
 * that the order can be seen, on a grey panel too.
 *
 *     heat    0     1     2     3     4     5     6     7     8     9    10    11
 *     565  0000  018C  2957  9015  C012  E810  FA8D  FC0D  FD2E  FE30  FF34  FFFF
 *
 * el_config.shading_off is for the same purpose: what is the picture, and the work, without textures or vertex colours?
 * Each surface is shaded as if its material did without these bits of el_shading. One that had nothing but its texture
 * shows each triangle in the colour of the texel in its middle. */
#ifndef EL_FRAME_DEBUG_VIEW_H
#define EL_FRAME_DEBUG_VIEW_H

#include <stdint.h>

#include "base/options.h"
#include "raster/material.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The values are the stream's, too (WIRE.md, VIEW). */
typedef enum el_debug_view {
    EL_DEBUG_PICTURE = 0,
    /* How often a pixel was drawn, depth not asked: heat n for n times, 11 for 11 and more. */
    EL_DEBUG_OVERDRAW = 1,
    /* Grey, from 255 at the near plane to 32 at the far plane, by the logarithm of the distance (in orthographic projection
     * by the distance); black where nothing was drawn with depth. */
    EL_DEBUG_DEPTH = 2,
    /* Each triangle in a colour made from its number in the mesh and that of its draw call in the pass. */
    EL_DEBUG_TRIANGLES = 3,
    /* The picture at a quarter of its brightness, and a bar from the left in each band: its work, in pixels drawn flat with
     * depth, per pixel of the band. The whole width stands for 6 and more; the colour is heat n from n/2 on. */
    EL_DEBUG_BANDS = 4,
    /* How often a pixel was tested and found hidden: heat n for n times, 11 for 11 and more. */
    EL_DEBUG_REJECTED = 5,
    EL_DEBUG_VIEWS = EL_WITH_DEBUG_VIEWS ? 6 : 1 /* how many there are */
} el_debug_view;

enum {
    EL_DEBUG_HEATS = 12,
    EL_DEBUG_SHADINGS = EL_WITH_DEBUG_VIEWS ? EL_SHADE_TEXTURED_GOURAUD : 0, /* what shading_off may have */
    /* A set-up and a row of a triangle, in flat pixels with depth: 389, 37 and 12 instructions on Cortex-M0+. */
    EL_DEBUG_SETUP_WORK = 32,
    EL_DEBUG_ROW_WORK = 3
};

/* With EL_WITH_DEBUG_VIEWS only. */
extern const uint16_t el_debug_heat[EL_DEBUG_HEATS];

#ifdef __cplusplus
}
#endif

#endif
