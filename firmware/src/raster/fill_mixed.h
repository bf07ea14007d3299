/* What mixed triangles are drawn with, for a row or a pixel at a time. Private to this layer. */
#ifndef EL_RASTER_FILL_MIXED_H
#define EL_RASTER_FILL_MIXED_H

#include "raster/fill.h"
#include "raster/fog.h"
#include "raster/texel_line.h"
#include "raster/texture_walk.h"

#if EL_WITH_MIXED
/* How pixels come to the screen. */
typedef enum el_mixed_way {
    EL_MIXED_OPAQUE,
    EL_MIXED_BLENDED, /* with one alpha for all */
    EL_MIXED_TESTED,  /* texels show or do not */
    EL_MIXED_SHOWN    /* texels have an alpha each */
} el_mixed_way;

/* What the pixels of a triangle are drawn with. */
typedef struct el_mixed_brush {
    unsigned kind;
    el_mixed_way way;
    uint16_t flat;
    bool writes_depth;
    uint32_t alpha; /* 0..256 */
    const el_fog *fog;
    el_slopes slopes;
    el_texture_walk walk;
    el_sampler sampler;
#if !EL_SMALL_CODE
    el_texel_line texels; /* the sampler's */
#endif
} el_mixed_brush;

/* What it points to stays the triangle's. */
void el_mixed_brush_begin(el_mixed_brush *b, const el_triangle *triangle);

/* Pixels [x, x_end) of a row, one at least. */
typedef struct el_mixed_span {
    uint32_t y, x, x_end;
    uint16_t *row, *depth; /* from column 0 on */
} el_mixed_span;

/* Draws it, in the row that the brush's slopes and these planes are at. */
void el_mixed_draw_span(el_mixed_brush *b, const el_mixed_span *span, const el_perspective *planes);

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
