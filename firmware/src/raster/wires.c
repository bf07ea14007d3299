/* Edges are those of edge.h, which are exact on every row: with x and y exchanged on every column, too. Depth is a product,
 * not a sum, so that no pixel depends on where a band begins. */
#include "raster/wires.h"

#include "base/fixed.h"
#include "base/rgb565.h"
#include "raster/field.h"

#if EL_WITH_WIRES

unsigned el_wires_of_piece(unsigned edges, const int32_t *const weights[3])
{
    unsigned kept = 0;
    for (unsigned i = 0; i < 3; i++) {
        const int32_t *const from = weights[i];
        const int32_t *const to = weights[(i + 1U) % 3U];
        for (unsigned edge = 0; edge < 3; edge++) {
            const unsigned opposite = (edge + 2U) % 3U;
            if ((edges >> edge & 1U) != 0 && from[opposite] == 0 && to[opposite] == 0) {
                kept |= 1U << i;
            }
        }
    }
    return kept;
}

unsigned el_wires_of(const el_list *list, const el_record *record)
{
    if (el_list_run(list, record)->kind == EL_RECORD_CLIPPED) {
        return ((const el_record_clipped *)(const void *)record)->edges;
    }
    return el_mesh_edges(el_list_draw(list, record)->mesh, record->index);
}

uint16_t el_wires_colour(const el_list *list, const el_record *record)
{
    const uint8_t *const rgb = el_list_draw(list, record)->material->colour;
    return el_rgb565(rgb[0], rgb[1], rgb[2]);
}

/* What the pixels of a triangle's wires have in common. */
typedef struct pen {
    const el_target *target;
    int32_t top, bottom; /* the target's rows of the screen, ... */
    unsigned gap_log2;   /* ... of which a field has every other one */
    uint16_t colour;
    bool depth;
    int32_t allowance; /* at most 2^16 */
    uint32_t pixels;
} pen;

/* A row or a column of pixels: the one that a point is in. */
static int32_t pixel_of(int32_t at)
{
    return (at - 1) >> EL_SUBPIXEL_BITS;
}

static bool is_between(const pen *p, int32_t y)
{
    return y >= p->top && y < p->bottom;
}

static void draw_pixel(pen *p, int32_t x, int32_t y, int32_t z)
{
    const el_target *const target = p->target;
    const int32_t gaps = (1 << p->gap_log2) - 1;
    if (x < 0 || x >= target->width || !is_between(p, y) || ((y - p->top) & gaps) != 0) {
        return;
    }
    const int32_t at = ((y - p->top) >> p->gap_log2) * target->width + x;
    p->pixels++;
    if (p->depth) {
        uint16_t *const depth = target->depth + at;
        if (z - p->allowance >= *depth) {
            return;
        }
        *depth = (uint16_t)el_min_i32(z, *depth);
    }
    target->colour[at] = p->colour;
}

/* An end of an edge: `along` its longer direction, `across` it. */
typedef struct end {
    int32_t along, across, z;
} end;

static end end_of(const el_corner *corner, bool steep)
{
    return (end){.along = steep ? corner->y : corner->x, .across = steep ? corner->x : corner->y, .z = corner->z};
}

/* Of a flat edge, the columns of which any is in the target's rows, and two more on either side: fewer than [*first, *last)
 * where most of it lies above or below. */
static void find_columns(const pen *p, const end *from, const end *to, int32_t *first, int32_t *last)
{
    const int32_t rise = to->across - from->across;
    if (rise == 0 || (is_between(p, pixel_of(from->across)) && is_between(p, pixel_of(to->across)))) {
        return;
    }
    /* Where it meets the target's upper and lower border, from its begin on: below 2^18 * 2^17 with 4 bits, 2^22 * 2^21
     * with 8; and since it is flat the quotient is in the order of the border's distance. */
    const int64_t length = to->along - from->along;
    const int64_t upper = ((int64_t)p->top * EL_SUBPIXELS - from->across) * length / rise;
    const int64_t lower = ((int64_t)p->bottom * EL_SUBPIXELS - from->across) * length / rise;
    const int64_t least = (from->along + (upper < lower ? upper : lower)) >> EL_SUBPIXEL_BITS;
    const int64_t most = (from->along + (upper < lower ? lower : upper)) >> EL_SUBPIXEL_BITS;
    *first = least - 2 > *first ? (int32_t)(least - 2 < *last ? least - 2 : *last) : *first;
    *last = most + 3 < *last ? (int32_t)(most + 3 > *first ? most + 3 : *first) : *last;
}

/* value / length in Q32, rounded down. */
static int64_t ratio_q32(int32_t value, uint32_t length)
{
#if EL_SUBPIXEL_BITS == 4
    return el_ratio_q32(value, length);
#else
    return el_wide_ratio_q32(value, length);
#endif
}

static void draw_run(pen *p, const end *from, const end *to, bool steep, int32_t first, int32_t last)
{
    if (steep) {
        first = el_max_i32(first, p->top);
        last = el_min_i32(last, p->bottom);
    } else {
        first = el_max_i32(first, 0);
        last = el_min_i32(last, p->target->width);
        find_columns(p, from, to, &first, &last);
    }
    if (first >= last) {
        return;
    }
    /* A pixel further left and up: the first whose centre is not before it is the one that the edge is in. */
    const int32_t half = EL_SUBPIXELS / 2;
    el_edge edge;
    el_edge_make(&edge, from->across - half, from->along, to->across - half, to->along, first);
    /* A step is below 2^48 / length in size, times a distance below `length`; and too low by less than a unit for each
     * sub-pixel of that, 2^-12 in all with 8 bits. */
    const int64_t step_q32 = ratio_q32(to->z - from->z, (uint32_t)(to->along - from->along));
    const int32_t begin = first * EL_SUBPIXELS + half - from->along;
    int64_t z_q32 = ((int64_t)from->z << 32) + (1LL << 31) + step_q32 * begin;
    for (int32_t at = first; at < last; at++) {
        const int32_t across = el_edge_x(&edge);
        draw_pixel(p, steep ? across : at, steep ? at : across, (int32_t)(z_q32 >> 32));
        el_edge_next_row(&edge);
        z_q32 += step_q32 * EL_SUBPIXELS;
    }
}

/* An end whose row or column is not among those of the run, [first, last). */
static void draw_end(pen *p, const end *at, bool steep, int32_t first, int32_t last)
{
    const int32_t along = pixel_of(at->along);
    if (along < first || along >= last) {
        const int32_t across = pixel_of(at->across);
        draw_pixel(p, steep ? across : along, steep ? along : across, at->z);
    }
}

static void draw_edge(pen *p, const el_corner *a, const el_corner *b)
{
    const int32_t dx = a->x - b->x;
    const int32_t dy = a->y - b->y;
    const int32_t top = pixel_of(el_min_i32(a->y, b->y));
    const int32_t bottom = pixel_of(el_max_i32(a->y, b->y));
    if (bottom < p->top || top >= p->bottom) {
        return;
    }
    const bool steep = el_abs_u64(dy) > el_abs_u64(dx);
    const bool turned = (steep ? dy : dx) > 0;
    const end from = end_of(turned ? b : a, steep);
    const end to = end_of(turned ? a : b, steep);
    const int32_t first = el_first_centre(from.along);
    const int32_t last = el_first_centre(to.along);
    draw_end(p, &from, steep, first, last);
    draw_end(p, &to, steep, first, last);
    draw_run(p, &from, &to, steep, first, last);
}

/* By how much nearer than it is a wire is tested. */
static int32_t allowance_of(const el_corner corners[3])
{
    const int32_t nearest = el_min3_i32(corners[0].z, corners[1].z, corners[2].z);
    const int32_t farthest = el_max3_i32(corners[0].z, corners[1].z, corners[2].z);
    const int32_t d1 = corners[1].z - corners[0].z;
    const int32_t d2 = corners[2].z - corners[0].z;
    const int32_t dx1 = corners[1].x - corners[0].x;
    const int32_t dy1 = corners[1].y - corners[0].y;
    const int32_t dx2 = corners[2].x - corners[0].x;
    const int32_t dy2 = corners[2].y - corners[0].y;
    /* Differences are below 2^16 and 2^(13 + EL_SUBPIXEL_BITS): products below 2^37, sums below 2^39, half a pixel of them
     * below 2^46. */
    const uint64_t change =
        el_abs_u64((int64_t)d1 * dy2 - (int64_t)d2 * dy1) + el_abs_u64((int64_t)d2 * dx1 - (int64_t)d1 * dx2);
    const uint64_t area = el_abs_u64((int64_t)dx1 * dy2 - (int64_t)dx2 * dy1);
    const uint64_t half_a_pixel = change * (EL_SUBPIXELS / 2);
    const uint32_t range = (uint32_t)(farthest - nearest);
    /* What is beyond the range need not be divided. NOLINTNEXTLINE(clang-analyzer-core.DivideZero): area > 0 where it is
     * within, for `range` of 0 makes no change. */
    if (half_a_pixel >= range * area) {
        return (int32_t)range + 1;
    }
    return el_min_i32((int32_t)((half_a_pixel + area - 1U) / area) + 2, (int32_t)range + 1);
}

void el_wires_draw(const el_corner corners[3], unsigned edges, const el_surface *surface, const el_target *target,
                   el_stats *stats)
{
    pen p = {.target = target,
             .top = el_screen_row(target->field, target->y),
             .bottom = el_screen_row(target->field, target->y_end - 1) + 1,
             .gap_log2 = target->field != EL_FIELD_NONE,
             .colour = surface->colour,
             .depth = surface->depth};
    if (p.depth) {
        p.allowance = allowance_of(corners);
    }
    for (unsigned i = 0; i < 3; i++) {
        if ((edges >> i & 1U) != 0) {
            draw_edge(&p, &corners[i], &corners[(i + 1U) % 3U]);
        }
    }
    el_count(&stats->pixels, p.pixels);
}

#endif
