/* Strips of a texture's axes, in which texels follow each other evenly: within them there is nothing to wrap, to clamp or to
 * turn around, whatever the border and the size. A row of pixels goes on linearly, so where it begins and ends in a strip it
 * was nowhere else; a row that leaves its strips is cut there. Private to this layer. */
#ifndef EL_RASTER_TEXEL_STRIP_H
#define EL_RASTER_TEXEL_STRIP_H

#include "raster/sampler.h"
#include "raster/texel_row.h"

#if EL_WITH_MIXED && !EL_SMALL_CODE
/* Of whole texels that are looked for, `begin` + i is the picture's column or row place + i * step, where step is 1, 0 or -1,
 * and its right or lower neighbour is so much `more`; all modulo 2^32. */
typedef struct el_texel_strip {
    uint32_t begin_q16, length_q16; /* length 0: there is none yet */
    uint32_t place, step, more;
} el_texel_strip;

/* Those that the last part of a row was in, one of each axis: the next is in the same mostly. */
typedef struct el_texel_strips {
    const el_sampler *sampler;
    uint32_t pitch; /* texels from a row of the picture to the next, with what fills up its last byte */
    el_texel_strip u, v;
    uint32_t first, right, down; /* texel (x, y) of both strips is at first + x * right + y * down, modulo 2^32 */
} el_texel_strips;

/* The sampler stays the caller's. If it is smooth, each strip has its texels' right or lower neighbours as well. */
void el_texel_strips_make(el_texel_strips *strips, const el_sampler *sampler);

/* Makes `part` of the row's first pixels, as many as are in one strip of each axis; u and v of it count from there. Returns
 * how many, one at least. */
uint32_t el_texel_strips_enter(el_texel_strips *strips, const el_texel_row *row, el_texel_row *part);
#endif

#endif
