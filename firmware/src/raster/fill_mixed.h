/* What mixed triangles are drawn with, for a row or a pixel at a time. Private to this layer. */
#ifndef EL_RASTER_FILL_MIXED_H
#define EL_RASTER_FILL_MIXED_H

#include "raster/fill.h"
#include "raster/fog.h"
#include "raster/sampler.h"
#include "raster/texture_walk.h"

#if EL_WITH_MIXED
/* What the pixels of a triangle are drawn with. */
typedef struct el_mixed_brush {
    unsigned kind;
    uint16_t flat;
    bool is_tested; /* texels show or do not */
    bool writes_depth;
    uint32_t alpha; /* 0..256 */
    const el_fog *fog;
    el_slopes slopes;
#if EL_WITH_TEXTURE
    el_sampler sampler;
    el_texture_walk walk;
#endif
} el_mixed_brush;

/* What it points to stays the triangle's. */
void el_mixed_brush_begin(el_mixed_brush *b, const el_triangle *triangle);

#if EL_WITH_SAMPLES
/* Draws pixels [x, x_end) of the triangle's next row, one at least, into `row` and `depth`, which begin in column 0. */
void el_mixed_draw_row(el_mixed_brush *b, const el_triangle *triangle, uint32_t x, uint32_t x_end, uint16_t *row,
                       uint16_t *depth);

/* The colour of pixel x of the triangle's next row, at depth z, and how much of it shows, 0..256; nothing else is known if
 * that is 0. */
uint32_t el_mixed_pixel(el_mixed_brush *b, const el_triangle *triangle, uint32_t x, uint32_t z, uint16_t *colour);
#endif
#endif

#endif
