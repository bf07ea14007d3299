/* The fills with a texture: alone, or times light or vertex colours. Each is the same code with its choices made at compile
 * time, as in fill.c. */
#include "base/fixed.h"
#include "raster/depth_row.h"
#include "raster/field.h"
#include "raster/fill.h"
#include "raster/texel_row.h"
#include "raster/texture_walk.h"

#if !EL_SMALL_CODE
/* What the pixels of a triangle are drawn with. */
typedef struct brush {
    el_texels texels;
    el_texture_walk walk;
    el_slopes slopes;
    uint32_t y;
} brush;

/* The last pixel of a span, where its last knot is. */
static EL_SPECIALISED void draw_last(brush *b, uint16_t *colour)
{
    el_texture_walk_last(&b->walk);
    *colour = (uint16_t)el_texel_at(&b->texels.source, (uint32_t)b->walk.u.q16, (uint32_t)b->walk.v.q16);
}

/* Lights the texels of pixels [x, x_end), one at least. They were drawn before, so that neither loop has to keep what the
 * other needs: together they have more than any core has registers, and pieces are shorter than what light goes along. */
static __attribute__((noinline)) void light_plain(const brush *b, uint16_t *row, uint32_t x, uint32_t x_end)
{
    el_light_row(&b->slopes, b->y, x, row + x, row + x_end, EL_FILL_COLOURS);
}

static __attribute__((noinline)) void light_dithered(const brush *b, uint16_t *row, uint32_t x, uint32_t x_end)
{
    el_light_row(&b->slopes, b->y, x, row + x, row + x_end, EL_FILL_COLOURS | EL_FILL_DITHER);
}

static EL_SPECIALISED void light(const brush *b, uint16_t *row, uint32_t x, uint32_t x_end, unsigned kind)
{
    if ((kind & EL_FILL_DITHER) != 0) {
        light_dithered(b, row, x, x_end);
    } else if ((kind & EL_FILL_COLOURS) != 0) {
        light_plain(b, row, x, x_end);
    }
}

/* A span of which the first `seen` pixels are seen, and then what `depth` says, in pieces along which texture coordinates
 * are linear: the same pieces as if all were seen, up to the last pixel that is. */
static EL_SPECIALISED void draw_seen(brush *b, const el_perspective *planes, uint16_t *row, uint32_t x, uint32_t x_end,
                                     uint32_t seen, el_depth_row *depth, unsigned kind)
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
static EL_SPECIALISED void draw_all(brush *b, const el_perspective *planes, uint16_t *row, uint32_t x, uint32_t x_end,
                                    unsigned kind)
{
    const uint32_t last = x_end - 1U;
    el_texture_walk_begin(&b->walk, planes, x, x_end - x);
    el_texture_walk_draw(&b->walk, &b->texels, row + x, last - x);
    draw_last(b, row + last);
    light(b, row, x, x_end, kind);
}

static EL_SPECIALISED void draw_tested(brush *b, const el_perspective *planes, uint16_t *row, uint16_t *depth_row,
                                       uint32_t x, uint32_t x_end, unsigned kind)
{
    el_depth_row depth;
    el_depth_row_begin(&depth, depth_row + x, x_end - x, el_values_at(&b->slopes, (int32_t)x, EL_FILL_DEPTH).z,
                       b->slopes.per_column.z);
    const uint32_t seen = el_depth_row_take(&depth);
    if (seen == x_end - x) {
        draw_all(b, planes, row, x, x_end, kind);
    } else {
        draw_seen(b, planes, row, x, x_end, seen, &depth, kind);
    }
}

static EL_SPECIALISED int32_t fill(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    brush b;
    b.texels = el_texels_of(triangle->surface.texture);
    b.y = (kind & EL_FILL_DITHER) != 0 ? (uint32_t)el_screen_row(target->field, triangle->y) : 0U;
    el_texture_walk_start(&b.walk, triangle);
    const el_perspective *const planes = &triangle->perspective;
    el_cursor cursor = el_cursor_at(target, triangle->y, kind);
    el_spans spans;
    const int32_t rows = el_spans_next(triangle, target, stats, &spans);
    b.slopes = el_slopes_of(triangle, kind);
    for (int32_t i = 0; i < rows; i++) {
        const uint32_t x = spans.x[i];
        const uint32_t x_end = spans.x_end[i];
        uint16_t *const row = el_colour_at(&cursor, cursor.row);
        if (x >= x_end) {
            el_count_empty(stats);
        } else if ((kind & EL_FILL_DEPTH) != 0) {
            draw_tested(&b, planes, row, cursor.row, x, x_end, kind);
        } else {
            draw_all(&b, planes, row, x, x_end, kind);
        }
        el_values_add(&b.slopes.first, &b.slopes.per_row, kind);
        el_perspective_next_row(&triangle->perspective);
        cursor.row += target->width;
        if ((kind & EL_FILL_DITHER) != 0) {
            b.y += el_field_step(target->field);
        }
    }
    el_slopes_keep(&b.slopes, triangle, kind);
    return rows;
}

/* A function of its own for each kind, and for each with and without depth. */
#define FILLS(DO)                                                                                                      \
    DO(textured, EL_FILL_TEXTURE)                                                                                      \
    DO(textured_depth, EL_FILL_TEXTURE | EL_FILL_DEPTH)                                                                \
    DO(lit, EL_FILL_TEXTURE | EL_FILL_COLOURS)                                                                         \
    DO(lit_depth, EL_FILL_TEXTURE | EL_FILL_COLOURS | EL_FILL_DEPTH)                                                   \
    DO(lit_dithered, EL_FILL_TEXTURE | EL_FILL_COLOURS | EL_FILL_DITHER)                                               \
    DO(lit_dithered_depth, EL_FILL_TEXTURE | EL_FILL_COLOURS | EL_FILL_DITHER | EL_FILL_DEPTH)

#define DEFINE(name, kind)                                                                                             \
    static __attribute__((noinline))                                                                                   \
    int32_t fill_##name(el_triangle *triangle, const el_target *target, el_stats *stats)                               \
    {                                                                                                                  \
        return fill(triangle, target, stats, (kind));                                                                  \
    }
FILLS(DEFINE)

#define CALL(name, kind)                                                                                               \
    if (asked == (kind)) {                                                                                             \
        return fill_##name(triangle, target, stats);                                                                   \
    }

int32_t el_fill_textured(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned asked)
{
    FILLS(CALL)
#if EL_WITH_MIXED
    return el_fill_mixed(triangle, target, stats, asked);
#else
    return 0; /* there is no other */
#endif
}
#endif
