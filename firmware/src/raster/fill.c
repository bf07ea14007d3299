/* The fills in one colour and in the vertices' colours, and those that count. Each shading, with and without depth, is the
 * same code with its choices made at compile time, so that none pays for another; in small code one loop asks, in half the
 * memory. */
#include "raster/fill.h"

#include "base/dither.h"
#include "base/fixed.h"

static EL_SPECIALISED uint16_t coloured(const el_values *v, uint32_t threshold_q16, unsigned kind)
{
    if ((kind & EL_FILL_DITHER) != 0) {
        return (uint16_t)(el_dither(el_fraction_q16(v->red), 31, threshold_q16) << 11 |
                          el_dither(el_fraction_q16(v->green), 63, threshold_q16) << 5 |
                          el_dither(el_fraction_q16(v->blue), 31, threshold_q16));
    }
    return (uint16_t)((v->red >> 27 << 11) | (v->green >> 26 << 5) | v->blue >> 27);
}

static EL_SPECIALISED void fill(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    const uint16_t flat = triangle->surface.colour;
    const int32_t width = target->width;
    uint32_t y = (uint32_t)triangle->y;
    const int32_t offset = el_row_offset(target, triangle->y);
    uint16_t *colour = target->colour + offset;
    uint16_t *depth = target->depth + ((kind & EL_FILL_DEPTH) != 0 ? offset : 0);
    int32_t rows;
    do {
        el_span spans[EL_SPAN_ROWS];
        rows = el_spans_next(triangle, target, stats, spans);
        el_slopes s = el_slopes_of(triangle, kind);
        for (const el_span *span = spans; span < spans + rows; span++) {
            const int32_t x_end = span->x_end;
            int32_t x = span->x;
            if (x < x_end) {
                el_values v = el_values_at(&s, x, kind);
                for (; x < x_end; x++) {
                    if (el_passes(&v, depth, x, kind)) {
                        colour[x] = (kind & EL_FILL_COLOURS) != 0
                                        ? coloured(&v, el_dither_threshold_q16((uint32_t)x, y), kind)
                                        : flat;
                    }
                    el_values_add(&v, &s.per_column, kind);
                }
            } else {
                el_count_empty(stats);
            }
            el_values_add(&s.first, &s.per_row, kind);
            colour += width;
            depth += (kind & EL_FILL_DEPTH) != 0 ? width : 0;
            y++;
        }
        el_slopes_keep(&s, triangle, kind);
    } while (el_goes_on(triangle, target, rows));
}

/* Overdraw: the picture counts; with depth, a debug view, it counts what the depth test rejects. */
static void fill_count(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    const unsigned depth_kind = EL_WITH_DEBUG_VIEWS ? kind & EL_FILL_DEPTH : 0U;
    int32_t rows;
    do {
        const int32_t offset = el_row_offset(target, triangle->y);
        el_span spans[EL_SPAN_ROWS];
        rows = el_spans_next(triangle, target, stats, spans);
        el_slopes s = el_slopes_of(triangle, depth_kind);
        for (int32_t i = 0; i < rows; i++) {
            const el_span span = spans[i];
            uint16_t *const colour = target->colour + offset + i * target->width;
            uint16_t *const depth = depth_kind != 0 ? target->depth + offset + i * target->width : NULL;
            el_values v = el_values_at(&s, span.x, depth_kind);
            for (int32_t x = span.x; x < span.x_end; x++) {
                if (depth_kind == 0 || !el_passes(&v, depth, x, depth_kind)) {
                    colour[x]++;
                }
                el_values_add(&v, &s.per_column, depth_kind);
            }
            if (span.x >= span.x_end) {
                el_count_empty(stats);
            }
            el_values_add(&s.first, &s.per_row, depth_kind);
        }
        el_slopes_keep(&s, triangle, depth_kind);
    } while (el_goes_on(triangle, target, rows));
}

#if EL_SMALL_CODE
void el_fill(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    ((kind & EL_FILL_COUNT) != 0 ? fill_count : fill)(triangle, target, stats, kind);
}
#else
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
    static __attribute__((noinline)) void fill_##name(el_triangle *triangle, const el_target *target, el_stats *stats) \
    {                                                                                                                  \
        fill(triangle, target, stats, (kind));                                                                         \
    }
FILLS(DEFINE)

#define CALL(name, kind)                                                                                               \
    if (asked == (kind)) {                                                                                             \
        fill_##name(triangle, target, stats);                                                                          \
        return;                                                                                                        \
    }

void el_fill(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned asked)
{
    FILLS(CALL)
    fill_count(triangle, target, stats, asked);
}
#endif
