/* A band of an interlaced frame (raster/field.h). Private to painter.c. */
#ifndef EL_FRAME_PAINTER_FIELD_H
#define EL_FRAME_PAINTER_FIELD_H

#include "frame/renderer.h"
#include "raster/triangle.h"

#if EL_WITH_INTERLACED
/* Draws the triangles of the chains that begin with `fresh`, the band's own, and `carried` into the target, and leaves those
 * that are carried on in the painter. */
void el_painter_draw_field(el_painter *painter, const el_renderer *renderer, const el_target *target, uint16_t fresh,
                           uint16_t carried);
#endif

#endif
