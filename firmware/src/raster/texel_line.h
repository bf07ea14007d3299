/* Texels of any texture along a piece of a row, in a line of their own: each property of a texture is a loop over the line,
 * so that loops add up where properties would multiply. Which loops a texture needs is asked once per triangle. The texels
 * are those of raster/sampler.h, which finds one at a time. Private to this layer. */
#ifndef EL_RASTER_TEXEL_LINE_H
#define EL_RASTER_TEXEL_LINE_H

#include "raster/sampler.h"
#include "raster/texel_row.h"
#include "raster/texel_smooth.h"
#include "raster/texture_walk.h"

#if EL_WITH_MIXED && !EL_SMALL_CODE
/* How they are drawn. */
typedef enum el_texel_way {
    EL_TEXELS_PLAIN,           /* RGB565 that repeats with powers of two, all of which shows: as by fill_texture.c */
    EL_TEXELS_SMOOTH_REPEATED, /* of such, the mean of four */
    EL_TEXELS_SMOOTH,  /* of other RGB565 and of palettes of bytes, all of which shows: the same, strip by strip */
    EL_TEXELS_STRIPS,  /* any, strip by strip */
    EL_TEXELS_MEANS,   /* of any, the mean of four */
    EL_TEXELS_REPEATED /* what repeats with powers of two; from here on a way for each loop */
} el_texel_way;

typedef struct el_texel_line {
    const el_sampler *sampler;
    uint8_t way;  /* el_texel_way */
    uint8_t loop; /* which looks up its texels */
    bool has_alpha_apart;
    uint32_t key;            /* what no texel is, if there is none */
    uint32_t u_mask, v_mask; /* of whole texels: all bits but where they repeat with powers of two, */
    el_texels texels;        /* which are these then, if they are RGB565 */
    el_texel_strips strips;
} el_texel_line;

/* The sampler stays the caller's. */
void el_texel_line_make(el_texel_line *line, const el_sampler *sampler);

/* Those of EL_TEXELS_PLAIN, and all others: for el_texel_line_draw alone. */
void el_texel_line_draw_plain(const el_texel_line *line, const el_texel_row *row);
void el_texel_line_draw_other(el_texel_line *line, const el_texel_row *row, uint16_t *shown);

/* Draws the row's texels, EL_MAX_PIECE at most. shown[], of as many, becomes how much of each shows, 0..256, where the sampler
 * is open, and of 0 the colour is any; where it is not, it is left with anything. */
static inline void el_texel_line_draw(el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    if (line->way == EL_TEXELS_PLAIN) {
        el_texel_line_draw_plain(line, row);
    } else {
        el_texel_line_draw_other(line, row, shown);
    }
}
#endif

#endif
