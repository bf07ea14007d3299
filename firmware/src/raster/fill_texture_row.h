/* Rows of a textured triangle's pixels, alone, or times light or vertex colours: depth first, then texels in pieces along which
 * texture coordinates are linear, then light. Private to this layer, and for its two callers: the fills, and the inner parts of
 * rows where pixels have several samples. */
#ifndef EL_RASTER_FILL_TEXTURE_ROW_H
#define EL_RASTER_FILL_TEXTURE_ROW_H

#include "raster/depth_row.h"
#include "raster/fill.h"
#include "raster/texel_row.h"
#include "raster/texture_walk.h"

#if !EL_SMALL_CODE
/* What the pixels of a triangle are drawn with. */
typedef struct el_texture_brush {
    el_texels texels;
    el_texture_walk walk;
    el_slopes slopes;
    uint32_t y;
} el_texture_brush;

/* The last pixel of a span, where its last knot is. */
static EL_SPECIALISED void draw_last(el_texture_brush *b, uint16_t *colour)
{
    el_texture_walk_last(&b->walk);
    *colour = (uint16_t)el_texel_at(&b->texels.source, (uint32_t)b->walk.u.q16, (uint32_t)b->walk.v.q16);
}

/* Lights the texels of pixels [x, x_end), one at least. They were drawn before, so that neither loop has to keep what the
 * other needs: together they have more than any core has registers, and pieces are shorter than what light goes along. */
static __attribute__((noinline)) void light_plain(const el_texture_brush *b, uint16_t *row, uint32_t x, uint32_t x_end)
{
    el_light_row(&b->slopes, b->y, x, row + x, row + x_end, EL_FILL_COLOURS);
}

static __attribute__((noinline)) void light_dithered(const el_texture_brush *b, uint16_t *row, uint32_t x,
                                                     uint32_t x_end)
{
    el_light_row(&b->slopes, b->y, x, row + x, row + x_end, EL_FILL_COLOURS | EL_FILL_DITHER);
}

static EL_SPECIALISED void light(const el_texture_brush *b, uint16_t *row, uint32_t x, uint32_t x_end, unsigned kind)
{
    if ((kind & EL_FILL_DITHER) != 0) {
        light_dithered(b, row, x, x_end);
    } else if ((kind & EL_FILL_COLOURS) != 0) {
        light_plain(b, row, x, x_end);
    }
}

/* A span of which the first `seen` pixels are seen, and then what `depth` says, in pieces along which texture coordinates
 * are linear: the same pieces as if all were seen, up to the last pixel that is. */
static EL_SPECIALISED void draw_seen(el_texture_brush *b, const el_perspective *planes, uint16_t *row, uint32_t x,
                                     uint32_t x_end, uint32_t seen, el_depth_row *depth, unsigned kind)
{
    /* A run of pixels that are seen; none is left of it. */
    uint32_t run = x;
    uint32_t run_end = x + seen;
    if (seen == 0) {
        run += el_depth_row_skip(depth);
        if (run == x_end) {
            return;
        }
        run_end = run + el_depth_row_take(depth);
    }
    uint32_t run_begin = run;
    const uint32_t last = x_end - 1U;
    uint32_t at = 0;
    el_texture_walk_begin(&b->walk, planes, x, x_end - x);
    while (x < last && run < x_end) {
        const uint32_t piece_end = x + el_texture_walk_piece(&b->walk, at, last - x);
        uint32_t begun = x;
        while (run < piece_end) {
            const uint32_t end = run_end < piece_end ? run_end : piece_end;
            el_texture_walk_skip(&b->walk, run - begun);
            el_texture_walk_draw_part(&b->walk, &b->texels, row + run, end - run);
            begun = run;
            run = end;
            if (run == run_end && run < x_end) {
                light(b, row, run_begin, run, kind);
                run += el_depth_row_skip(depth);
                run_end = run + el_depth_row_take(depth);
                run_begin = run;
            }
        }
        at += piece_end - x;
        x = piece_end;
    }
    if (run < x_end) {
        draw_last(b, row + last);
        light(b, row, run_begin, x_end, kind);
    }
}

/* A span all of which is seen. */
static EL_SPECIALISED void el_texture_draw_all(el_texture_brush *b, const el_perspective *planes, uint16_t *row,
                                               uint32_t x, uint32_t x_end, unsigned kind)
{
    const uint32_t last = x_end - 1U;
    el_texture_walk_begin(&b->walk, planes, x, x_end - x);
    el_texture_walk_draw(&b->walk, &b->texels, row + x, last - x);
    draw_last(b, row + last);
    light(b, row, x, x_end, kind);
}

/* The same, of which is seen what `slopes` have nearer than depth_row. */
static EL_SPECIALISED void el_texture_draw_tested(el_texture_brush *b, const el_perspective *planes,
                                                  const el_slopes *slopes, uint16_t *row, uint16_t *depth_row,
                                                  uint32_t x, uint32_t x_end, unsigned kind)
{
    el_depth_row depth;
    el_depth_row_begin(&depth, depth_row + x, x_end - x, el_values_at(slopes, (int32_t)x, EL_FILL_DEPTH).z,
                       slopes->per_column.z);
    const uint32_t seen = el_depth_row_take(&depth);
    if (seen == x_end - x) {
        el_texture_draw_all(b, planes, row, x, x_end, kind);
    } else {
        draw_seen(b, planes, row, x, x_end, seen, &depth, kind);
    }
}

#if EL_WITH_SAMPLES
/* The texel of a place in column x that has so much more of 1/w, u/w and v/w than the pixel's centre, Q32. */
static EL_SPECIALISED uint32_t el_texture_texel_at(el_texture_brush *b, const el_perspective *planes, uint32_t x,
                                                   const uint64_t wuv[3])
{
    el_texture_walk_point(&b->walk, planes, x, wuv);
    el_texture_walk_last(&b->walk);
    return el_texel_at(&b->texels.source, (uint32_t)b->walk.u.q16, (uint32_t)b->walk.v.q16);
}
#endif
#endif

#endif
