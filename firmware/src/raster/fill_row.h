/* A row of any shading's pixels in one loop: that of small code, and of what is rare. Private to this layer. */
#ifndef EL_RASTER_FILL_ROW_H
#define EL_RASTER_FILL_ROW_H

#include "raster/texel.h"
#include "raster/texture_walk.h"

/* What a textured triangle is drawn with. */
typedef struct el_row_brush {
    el_texel_source source;
    el_texture_walk walk;
} el_row_brush;

static inline void el_row_brush_begin(el_row_brush *brush, const el_triangle *triangle)
{
    if ((triangle->kind & EL_FILL_TEXTURE) != 0) {
        brush->source = el_texel_source_of(triangle->surface.texture);
        el_texture_walk_start(&brush->walk, triangle);
    }
}

#if EL_WITH_SAMPLES
/* Draws pixels [x, x_end) of the triangle's next row, one at least, in pieces along which texture coordinates are linear. */
void el_fill_row(const el_triangle *triangle, el_row_brush *brush, const el_cursor *cursor, uint32_t x, uint32_t x_end);
#endif

#endif
