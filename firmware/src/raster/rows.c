/* A triangle's rows in a band: its edges give their spans (spans.h), the fill of its shading the pixels (fill.h), a few rows
 * at a time. */
#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/texture_walk.h"

static unsigned kind_of(const el_surface *surface)
{
    _Static_assert(EL_SHADE_GOURAUD << 1 == 2 && EL_SHADE_TEXTURED << 1 == 4 && EL_SHADE_OVERDRAW << 1 == 8,
                   "a shading's bits are those of its fill");
    const unsigned kind = (unsigned)surface->shading << 1 & (EL_FILL_COLOURS | EL_FILL_TEXTURE | EL_FILL_COUNT);
    const bool dithers = surface->dither && (kind & EL_FILL_COLOURS) != 0;
    const bool depth = surface->depth && (EL_WITH_DEBUG_VIEWS || (kind & EL_FILL_COUNT) == 0);
    return kind | (dithers ? EL_FILL_DITHER : 0U) | (depth ? EL_FILL_DEPTH : 0U);
}

void el_triangle_draw(el_triangle *triangle, const el_target *target, el_stats *stats)
{
    const unsigned kind = kind_of(&triangle->surface);
    const int32_t y_end = el_min_i32(triangle->y_end, target->y_end);
    uint32_t pixels = 0;
    uint32_t empty = 0;
    int32_t y = triangle->y;
    el_count(&stats->rows, (uint32_t)(y_end - y));
    el_count(&stats->spans, (uint32_t)(y_end - y));
    while (y < y_end) {
        const int32_t offset = (y - target->y) * target->width;
        el_span spans[EL_SPAN_ROWS];
        const el_fill_rows rows = {
            .spans = spans,
            .count = el_min_i32(y_end - y, EL_SPAN_ROWS),
            .y = y,
            .colour = target->colour + offset,
            .depth = (kind & EL_FILL_DEPTH) != 0 ? target->depth + offset : NULL,
            .width = target->width,
        };
        pixels += el_spans_next(triangle, rows.count, rows.width, spans);
        empty += EL_WITH_TEXTURE && (kind & EL_FILL_TEXTURE) != 0 ? el_fill_textured(triangle, &rows, kind)
                                                                  : el_fill(triangle, &rows, kind);
        y += rows.count;
    }
    el_count(&stats->spans, 0U - empty);
    el_count(&stats->pixels, pixels);
}

void el_triangle_next_row(el_triangle *triangle)
{
    const unsigned kind = kind_of(&triangle->surface);
    el_span span;
    (void)el_spans_next(triangle, 1, 0, &span);
    el_slopes slopes = el_slopes_of(triangle, kind);
    el_values_add(&slopes.first, &slopes.per_row, kind);
    el_slopes_keep(&slopes, triangle, kind);
    if ((kind & EL_FILL_TEXTURE) != 0) {
        el_perspective_next_row(&triangle->perspective);
    }
}

void el_triangle_sample(const el_triangle *triangle, int32_t x, int32_t width, el_sample *sample)
{
    const unsigned kind = kind_of(&triangle->surface);
    const int32_t begin = el_max_i32(el_edge_x(&triangle->left), 0);
    const int32_t end = el_min_i32(el_edge_x(&triangle->right), width);
    const el_slopes slopes = el_slopes_of(triangle, kind);
    el_values values = el_values_at(&slopes, (uint32_t)(begin - triangle->x_at), kind);
    for (int32_t at = begin; at < x; at++) {
        el_values_add(&values, &slopes.per_column, kind);
    }
    *sample = (el_sample){.z_plus_half_q16 = (kind & EL_FILL_DEPTH) != 0 ? (uint32_t)(values.z >> 16) : 0U};
    if ((kind & EL_FILL_COLOURS) != 0) {
        sample->rgb_plus_half_q24[0] = values.red;
        sample->rgb_plus_half_q24[1] = values.green;
        sample->rgb_plus_half_q24[2] = values.blue;
    }
    if ((kind & EL_FILL_TEXTURE) == 0) {
        return;
    }
    el_texture_walk walk;
    el_texture_walk_begin(&walk, triangle, begin - triangle->x_at);
    int32_t at = begin;
    int32_t length = el_texture_walk_piece(&walk, end - at);
    while (x >= at + length) {
        at += length;
        length = el_texture_walk_piece(&walk, end - at);
    }
    sample->u_q16 = walk.u_q16 + (x - at) * walk.u_step_q16;
    sample->v_q16 = walk.v_q16 + (x - at) * walk.v_step_q16;
}
