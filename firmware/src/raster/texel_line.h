/* Texels of any texture along a piece of a row, in a line of their own: each property of a texture is a loop over the line,
 * so that loops add up where properties would multiply. Which loops a texture needs is asked once per triangle. The texels
 * are those of raster/sampler.h, which finds one at a time. Private to this layer. */
#ifndef EL_RASTER_TEXEL_LINE_H
#define EL_RASTER_TEXEL_LINE_H

#include "raster/sampler.h"
#include "raster/texel_row.h"
#include "raster/texture_walk.h"

#if EL_WITH_MIXED && !EL_SMALL_CODE
/* How they are found. */
typedef enum el_texel_way {
    EL_TEXELS_PLAIN,    /* RGB565 that repeats with powers of two, all of which shows: as by fill_texture.c */
    EL_TEXELS_SMOOTH,   /* of such, the mean of four */
    EL_TEXELS_REPEATED, /* anything else that repeats so */
    EL_TEXELS_FOUND,    /* places first: of y * width + x there is a texel */
    EL_TEXELS_ANY       /* what is left: one at a time */
} el_texel_way;

typedef struct el_texel_line {
    const el_sampler *sampler;
    el_texel_way way;
    bool repeats; /* with powers of two, in both directions: `texels` are those */
    bool has_alpha_apart;
    uint8_t loop;
    el_texels texels;
} el_texel_line;

/* The sampler stays the caller's. */
void el_texel_line_make(el_texel_line *line, const el_sampler *sampler);

/* Draws the row's texels, EL_MAX_PIECE at most. Where the sampler is open, shown[] becomes how much of each shows,
 * 0..256; of 0 the colour is any. */
void el_texel_line_draw(const el_texel_line *line, const el_texel_row *row, uint16_t *shown);
#endif

#endif
