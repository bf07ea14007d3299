#include "raster/spans.h"

#include "base/fixed.h"

/* Rows of one part, between two edges. The edges' crossings are rounded up alike, so the right one is never left of the left
 * one: no span is shorter than 0. */
static EL_SPECIALISED uint32_t walk(el_triangle *triangle, el_span *spans, int32_t rows)
{
    int64_t left_q32 = triangle->left.x_q32;
    int64_t right_q32 = triangle->right.x_q32;
    const int64_t left_step_q32 = triangle->left.step_q32;
    const int64_t right_step_q32 = triangle->right.step_q32;
    int32_t pixels = 0;
    for (const el_span *const end = spans + rows; spans < end; spans++) {
        const int32_t x = (int32_t)(left_q32 >> 32);
        const int32_t x_end = (int32_t)(right_q32 >> 32);
        spans->x = (int16_t)x;
        spans->x_end = (int16_t)x_end;
        pixels += x_end - x;
        left_q32 += left_step_q32;
        right_q32 += right_step_q32;
    }
    triangle->left.x_q32 = left_q32;
    triangle->right.x_q32 = right_q32;
    return (uint32_t)pixels;
}

/* Cuts off what is beside the screen. Returns the pixels that are left. */
static uint32_t clamp(el_span *spans, int32_t rows, int32_t width)
{
    uint32_t pixels = 0;
    for (const el_span *const end = spans + rows; spans < end; spans++) {
        const int32_t x = el_max_i32(spans->x, 0);
        const int32_t x_end = el_min_i32(spans->x_end, width);
        spans->x = (int16_t)x;
        spans->x_end = (int16_t)x_end;
        if (x < x_end) {
            pixels += (uint32_t)(x_end - x);
        }
    }
    return pixels;
}

/* The lower part begins: one edge gives way to the other. */
static void bend(el_triangle *triangle)
{
    if (triangle->short_is_left) {
        triangle->left = triangle->lower;
    } else {
        triangle->right = triangle->lower;
    }
    triangle->y_middle = INT16_MAX;
}

uint32_t el_spans_next(el_triangle *triangle, int32_t rows, int32_t width, el_span *spans)
{
    const int32_t upper = triangle->y_middle - triangle->y;
    uint32_t pixels;
    if (rows < upper) {
        pixels = walk(triangle, spans, rows);
    } else {
        pixels = walk(triangle, spans, upper);
        bend(triangle);
        pixels += walk(triangle, spans + upper, rows - upper);
    }
    triangle->y = (int16_t)(triangle->y + rows);
    return triangle->x_at < 0 || triangle->x_end > width ? clamp(spans, rows, width) : pixels;
}
