/* The fills in one colour and in the vertices' colours, and those that count. Each shading, with and without depth, is the
 * same code with its choices made at compile time, so that none pays for another; in small code one loop asks, in half the
 * memory (fill_small.c). */
#include "raster/fill.h"

#include "base/dither.h"
#include "base/fixed.h"
#include "raster/field.h"
#include "raster/small_gouraud.h"
#include "raster/small_triangle.h"

#if !EL_SMALL_CODE
static EL_SPECIALISED uint32_t coloured(const el_values *v, uint32_t threshold_q16, unsigned kind)
{
    if ((kind & EL_FILL_DITHER) != 0) {
        return el_dither(el_fraction_q16(v->red), 31, threshold_q16) << 11 |
               el_dither(el_fraction_q16(v->green), 63, threshold_q16) << 5 |
               el_dither(el_fraction_q16(v->blue), 31, threshold_q16);
    }
    return el_coloured(v);
}

static EL_SPECIALISED int32_t fill_plain(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    const uint32_t flat = triangle->surface.colour;
    const int32_t width = target->width;
    uint32_t y = (uint32_t)el_screen_row(target->field, triangle->y);
    el_cursor cursor = el_cursor_at(target, triangle->y, kind);
    el_spans spans;
    const int32_t rows = el_spans_next(triangle, target, stats, &spans);
    el_slopes s = el_slopes_of(triangle, kind);
    uint32_t i = 0;
    for (uint32_t bits = el_row_bits(rows); bits != 0; bits >>= 1, i++) {
        const int32_t x = spans.x[i];
        const int32_t x_end = spans.x_end[i];
        if (x < x_end) {
            uint16_t *at = cursor.row + x;
            const uint16_t *const end = cursor.row + x_end;
            el_values v = el_values_at(&s, x, kind);
            do {
                if (el_passes(&v, at, kind)) {
                    *el_colour_at(&cursor, at) =
                        (uint16_t)((kind & EL_FILL_COLOURS) != 0
                                       ? coloured(&v, el_dither_threshold_q16((uint32_t)(at - cursor.row), y), kind)
                                       : flat);
                }
                el_values_add(&v, &s.per_column, kind);
            } while (++at != end);
        } else {
            el_count_empty(stats);
        }
        el_values_add(&s.first, &s.per_row, kind);
        cursor.row += width;
        y += el_field_step(target->field);
    }
    el_slopes_keep(&s, triangle, kind);
    return rows;
}

/* Overdraw: the picture counts; with depth, a debug view, it counts what the depth test rejects. */
static __attribute__((noinline)) int32_t fill_count(el_triangle *triangle, const el_target *target, el_stats *stats,
                                                    unsigned kind)
{
    const unsigned depth_kind = EL_WITH_DEBUG_VIEWS ? kind & EL_FILL_DEPTH : 0U;
    el_cursor cursor = el_cursor_at(target, triangle->y, depth_kind);
    el_spans spans;
    const int32_t rows = el_spans_next(triangle, target, stats, &spans);
    el_slopes s = el_slopes_of(triangle, depth_kind);
    uint32_t i = 0;
    for (uint32_t bits = el_row_bits(rows); bits != 0; bits >>= 1, i++) {
        el_values v = el_values_at(&s, spans.x[i], depth_kind);
        for (int32_t x = spans.x[i]; x < spans.x_end[i]; x++) {
            uint16_t *const at = cursor.row + x;
            if (depth_kind == 0 || !el_passes(&v, at, depth_kind)) {
                ++*el_colour_at(&cursor, at);
            }
            el_values_add(&v, &s.per_column, depth_kind);
        }
        if (spans.x[i] >= spans.x_end[i]) {
            el_count_empty(stats);
        }
        el_values_add(&s.first, &s.per_row, depth_kind);
        cursor.row += target->width;
    }
    el_slopes_keep(&s, triangle, depth_kind);
    return rows;
}

/* A loop of its own for each kind there is, in a function of its own, so that none has the registers of another; kinds
 * that options.h makes equal have one. The most frequent first. */
#define FILLS(DO)                                                                                                      \
    DO(flat_depth, EL_FILL_DEPTH)                                                                                      \
    DO(coloured_depth, EL_FILL_COLOURS | EL_FILL_DEPTH)                                                                \
    DO(flat, 0)                                                                                                        \
    DO(coloured, EL_FILL_COLOURS)                                                                                      \
    DO(dithered_depth, EL_FILL_COLOURS | EL_FILL_DITHER | EL_FILL_DEPTH)                                               \
    DO(dithered, EL_FILL_COLOURS | EL_FILL_DITHER)

#define DEFINE(name, kind)                                                                                             \
    static __attribute__((noinline))                                                                                   \
    int32_t fill_##name(el_triangle *triangle, const el_target *target, el_stats *stats)                               \
    {                                                                                                                  \
        return fill_plain(triangle, target, stats, (kind));                                                            \
    }
FILLS(DEFINE)

#define CALL(name, kind)                                                                                               \
    if (asked == (kind)) {                                                                                             \
        return fill_##name(triangle, target, stats);                                                                   \
    }

static EL_SPECIALISED int32_t fill_rows(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned asked)
{
    FILLS(CALL)
    if (EL_WITH_TEXTURE && (asked & EL_FILL_TEXTURE) != 0) {
        return el_fill_textured(triangle, target, stats, asked);
    }
#if EL_WITH_MIXED
    if ((asked & EL_FILL_MIXED) != 0) {
        return el_fill_mixed(triangle, target, stats, asked);
    }
#endif
    return fill_count(triangle, target, stats, asked);
}

static EL_APART void fill_bands_rows(el_triangle *triangle, const el_target *target, el_stats *stats)
{
    int32_t rows;
    do {
        rows = fill_rows(triangle, target, stats, triangle->kind);
    } while (rows == EL_SPAN_ROWS && triangle->y < target->y_end && !el_triangle_is_done(triangle));
}

void el_triangle_draw(el_triangle *triangle, const el_target *target, el_stats *stats)
{
#if EL_WITH_SMALL_PLANES
    if (triangle->edges_are_short && triangle->x_begin >= 0 && triangle->x_end <= target->width) {
        if (triangle->kind == EL_FILL_DEPTH) {
            el_small_triangle_go_on(triangle, target, stats);
            return;
        }
#if EL_WITH_SMALL_GOURAUD
        if (triangle->kind == (EL_FILL_COLOURS | EL_FILL_DEPTH)) {
            el_small_gouraud_draw(triangle, target, stats);
            return;
        }
#endif
    }
#endif
    fill_bands_rows(triangle, target, stats);
}
#endif
