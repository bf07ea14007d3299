/* Means of four texels along a row: as el_sampler_at has them where the sampler is smooth. Private to this layer. */
#ifndef EL_RASTER_TEXEL_SMOOTH_H
#define EL_RASTER_TEXEL_SMOOTH_H

#include "raster/texel_strip.h"

#if EL_WITH_MIXED && !EL_SMALL_CODE
/* Draws the row's texels, of RGB565 that repeats with powers of two, all of which shows. */
void el_texel_smooth_repeat(const el_texel_source *source, const el_texel_row *row);

/* Draws those of any RGB565 or palette of bytes, all of which shows. */
void el_texel_smooth_draw(el_texel_strips *strips, const el_texel_row *row);
#endif

#endif
