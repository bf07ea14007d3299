#include "raster/spans.h"

#include "base/fixed.h"

/* Cuts off what is beside the screen. Returns the pixels that are left. */
static uint32_t clamp(el_span *spans, int32_t rows, int32_t width)
{
    uint32_t pixels = 0;
    for (int32_t i = 0; i < rows; i++) {
        const int32_t x = el_max_i32(spans[i].x, 0);
        const int32_t x_end = el_min_i32(spans[i].x_end, width);
        spans[i].x = (int16_t)x;
        spans[i].x_end = (int16_t)x_end;
        pixels += x < x_end ? (uint32_t)(x_end - x) : 0U;
    }
    return pixels;
}

/* Walks the sides of one part for `rows` rows, down to 0. The crossings with both are rounded up alike, so the right one is
 * never left of the left one, and no span shorter than 0. Returns the pixels between them. */
static EL_SPECIALISED int32_t walk(el_edge *left, el_edge *right, el_span *span, int32_t rows)
{
    int32_t pixels = 0;
    /* One bit per row, shifted out: of rows counted down, a compiler knows beforehand where the edges arrive, and makes a
     * long product of each. */
    for (uint32_t bits = 1U << rows >> 1; bits != 0; bits >>= 1) {
        const int32_t x = el_edge_x(left);
        const int32_t x_end = el_edge_x(right);
        *span++ = (el_span){(int16_t)x, (int16_t)x_end};
        pixels += x_end - x;
        el_edge_next_row(left);
        el_edge_next_row(right);
    }
    return pixels;
}

/* The lower part begins: one side goes on along another edge. */
static EL_SPECIALISED void bend(el_triangle *triangle, el_edge *left, el_edge *right)
{
    if (triangle->short_is_left) {
        *left = triangle->lower;
    } else {
        *right = triangle->lower;
    }
    triangle->y_middle = INT16_MAX;
}

int32_t el_spans_next(el_triangle *triangle, const el_target *target, el_stats *stats, el_span spans[EL_SPAN_ROWS])
{
    const int32_t rows = el_min_i32(el_min_i32(triangle->y_end, target->y_end) - triangle->y, EL_SPAN_ROWS);
    const int32_t upper = triangle->y_middle - triangle->y;
    triangle->y = (int16_t)(triangle->y + rows);
    el_edge left = triangle->left;
    el_edge right = triangle->right;
    uint32_t pixels = (uint32_t)walk(&left, &right, spans, el_min_i32(rows, upper));
    if (upper <= rows) {
        bend(triangle, &left, &right);
        pixels += (uint32_t)walk(&left, &right, spans + upper, rows - upper);
    }
    if (triangle->y < triangle->y_end) {
        triangle->left = left;
        triangle->right = right;
    }
    if (triangle->x_begin < 0 || triangle->x_end > target->width) {
        pixels = clamp(spans, rows, target->width);
    }
    el_count(&stats->rows, (uint32_t)rows);
    el_count(&stats->spans, (uint32_t)rows);
    el_count(&stats->pixels, pixels);
    return rows;
}
