#include "raster/spans.h"

#include "base/fixed.h"

/* Cuts off what is beside the screen. Returns the pixels that are left. */
static uint32_t clamp(el_spans *spans, int32_t rows, int32_t width)
{
    uint32_t pixels = 0;
    for (int32_t i = 0; i < rows; i++) {
        const int32_t x = el_max_i32((int16_t)spans->x[i], 0);
        const int32_t x_end = el_max_i32(el_min_i32((int16_t)spans->x_end[i], width), 0);
        spans->x[i] = (uint16_t)el_min_i32(x, width);
        spans->x_end[i] = (uint16_t)x_end;
        pixels += x < x_end ? (uint32_t)(x_end - x) : 0U;
    }
    return pixels;
}

/* Walks one side of a part. Returns the sum of its columns. */
static uint32_t walk(el_edge *edge, uint16_t *x, int32_t rows)
{
    el_edge at = *edge;
    uint32_t sum = 0;
    unsigned i = 0;
    for (uint32_t bits = el_row_bits(rows); bits != 0; bits >>= 1) {
        const uint32_t column = (uint32_t)el_edge_x(&at);
        x[i] = (uint16_t)(column & 0xFFFFU);
        i++;
        sum += column;
        el_edge_next_row(&at);
    }
    edge->x_q32 = at.x_q32;
    return sum;
}

/* The side that has a corner in its middle: that of the upper part, and where the lower part begins, its other edge. */
static uint32_t walk_bent(el_triangle *triangle, el_edge *edge, uint16_t *x, int32_t rows, int32_t upper)
{
    if (rows < upper) {
        return walk(edge, x, rows);
    }
    const uint32_t sum = walk(edge, x, upper) + walk(&triangle->lower, x + upper, rows - upper);
    if (!el_triangle_is_done(triangle)) {
        edge->x_q32 = triangle->lower.x_q32;
        edge->step_q32 = triangle->lower.step_q32;
        triangle->y_middle = INT16_MAX;
    }
    return sum;
}

int32_t el_spans_next(el_triangle *triangle, const el_target *target, el_stats *stats, el_spans *spans)
{
    const int32_t y = triangle->y;
    const int32_t rows = el_min_i32(el_min_i32(triangle->y_end, target->y_end) - y, EL_SPAN_ROWS);
    if (rows <= 0) {
        return 0;
    }
    triangle->y = (int16_t)(y + rows);
    /* Crossings with both sides are rounded up alike, so the right one is never left of the left one: no span is shorter than
     * 0, and the sums' difference is that of pixels. */
    uint32_t pixels;
    const int32_t upper = triangle->y_middle - y;
    if (triangle->short_is_left) {
        pixels =
            walk(&triangle->right, spans->x_end, rows) - walk_bent(triangle, &triangle->left, spans->x, rows, upper);
    } else {
        pixels =
            walk_bent(triangle, &triangle->right, spans->x_end, rows, upper) - walk(&triangle->left, spans->x, rows);
    }
    if (!EL_TRIANGLE_HAS_COLUMNS || triangle->x_begin < 0 || triangle->x_end > target->width) {
        pixels = clamp(spans, rows, target->width);
    }
    el_count(&stats->rows, (uint32_t)rows);
    el_count(&stats->spans, (uint32_t)rows);
    el_count(&stats->pixels, pixels);
    return rows;
}
