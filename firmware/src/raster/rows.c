/* A triangle's rows without drawing: walked, and sampled. */
#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/texture_walk.h"

void el_triangle_next_row(el_triangle *triangle)
{
    const unsigned kind = triangle->kind;
    const el_target row = {.y = triangle->y, .y_end = triangle->y + 1};
    el_stats stats = {0};
    el_spans spans;
    (void)el_spans_next(triangle, &row, &stats, &spans);
    el_slopes slopes = el_slopes_of(triangle, kind);
    el_values_add(&slopes.first, &slopes.per_row, kind);
    el_slopes_keep(&slopes, triangle, kind);
    if ((kind & EL_FILL_TEXTURE) != 0) {
        el_perspective_next_row(&triangle->perspective);
    }
}

void el_triangle_sample(const el_triangle *triangle, int32_t x, int32_t width, el_sample *sample)
{
    const unsigned kind = triangle->kind;
    const int32_t begin = el_max_i32(el_edge_x(&triangle->left), 0);
    const int32_t end = el_min_i32(el_edge_x(&triangle->right), width);
    el_slopes slopes = el_slopes_of(triangle, kind);
    el_values values = el_values_at(&slopes, begin, kind);
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
    el_texture_walk_start(&walk, triangle);
    el_texture_walk_begin(&walk, &triangle->perspective, (uint32_t)begin, (uint32_t)(end - begin));
    const uint32_t last = (uint32_t)(end - 1 - begin);
    const uint32_t wanted = (uint32_t)(x - begin);
    uint32_t at = 0;
    uint32_t piece_end = 0;
    while (piece_end <= wanted && piece_end < last) {
        at = piece_end;
        piece_end += el_texture_walk_piece(&walk, at, last - at);
    }
    if (piece_end <= wanted) {
        at = piece_end;
        el_texture_walk_last(&walk);
    }
    const int32_t further = (int32_t)(wanted - at);
    sample->u_q16 = walk.u.q16 + further * walk.u.step_q16;
    sample->v_q16 = walk.v.q16 + further * walk.v.step_q16;
}
