/* A band whose pixels have several samples (raster/samples.h). Private to painter.c. */
#ifndef EL_FRAME_PAINTER_SAMPLED_H
#define EL_FRAME_PAINTER_SAMPLED_H

#include "frame/renderer.h"
#include "raster/triangle.h"

#if EL_WITH_SAMPLES
/* Draws the triangles of the chains that begin with `fresh`, the band's own, and `carried` into the target, and leaves those
 * that are carried on in the painter. */
void el_painter_draw_samples(el_painter *painter, const el_renderer *renderer, const el_target *target, uint16_t fresh,
                             uint16_t carried);

/* One colour and depth for each pixel of the band, if there were several. */
void el_painter_resolve_samples(el_painter *painter, const el_renderer *renderer);
#endif

#endif
