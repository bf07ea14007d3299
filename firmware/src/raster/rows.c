/* A triangle's rows, drawn by the fill of its shading (fill.h), walked without drawing, or sampled. */
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
    if (triangle->y >= el_min_i32(triangle->y_end, target->y_end)) {
        return;
    }
    const unsigned kind = kind_of(&triangle->surface);
    if (EL_WITH_TEXTURE && (kind & EL_FILL_TEXTURE) != 0) {
        el_fill_textured(triangle, target, stats, kind);
    } else {
        el_fill(triangle, target, stats, kind);
    }
}

void el_triangle_next_row(el_triangle *triangle)
{
    const unsigned kind = kind_of(&triangle->surface);
    const el_target row = {.y = triangle->y, .y_end = triangle->y + 1};
    el_stats stats = {0};
    el_span spans[EL_SPAN_ROWS];
    (void)el_spans_next(triangle, &row, &stats, spans);
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
