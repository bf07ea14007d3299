/* A triangle's edge, stepped row by row with one addition, and exact on every row.
 *
 * The edge function E(i, j) of an edge with direction (dx, dy), dy > 0, at the centre of pixel (i, j), is negative on one
 * side and moves by a fixed amount per pixel and per row. Its zero on row j lies on a grid: with S = EL_SUBPIXELS it is a
 * multiple of 1 / (S dy), or, rounded up to what the next row keeps, m / dy with an integer m. The first pixel that is not
 * left of it is the zero rounded up. So a number in Q32 that is below the true one by less than a step of the grid still
 * has the right whole part, when a step less one unit is added first:
 *
 *     the sum of all that is cut off, 1 unit of 2^-32 per row and 2 at the start, is below 4083 units;
 *     a step of the grid is at least 2^32 / (16 * 2 EL_GUARD_SUB) = 4112 units with 4 bits, for m / dy with 6 and 8 bits
 *     2^32 / (2 EL_GUARD_SUB) = 16448 and 4112.
 *
 * A left edge's pixel x is inside (E = 0 counts), a right edge's is not: with rows from the first centre not above the
 * top to the last centre above the bottom, that is the top-left rule, without a case for it. */
#ifndef EL_RASTER_EDGE_H
#define EL_RASTER_EDGE_H

#include <stdint.h>

#include "base/divide.h"
#include "geometry/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct el_edge {
    int64_t x_q32;    /* its whole part is the first pixel not left of the edge; within +-2041 on the edge's own rows */
    int64_t step_q32; /* floor(2^32 dx / dy), per row */
} el_edge;

enum { EL_EDGE_MAX_ROWS = 2 * EL_GUARD_PX };

/* The first row (or column) whose centre is not before `a`, in 1/EL_SUBPIXELS px. */
static inline int32_t el_first_centre(int32_t a)
{
    return (a + (EL_SUBPIXELS / 2 - 1)) >> EL_SUBPIXEL_BITS;
}

static inline int32_t el_edge_x(const el_edge *edge)
{
    return (int32_t)(edge->x_q32 >> 32);
}

/* Edges up to 511 units high and 1023 wide: in Q20, with a reciprocal's product instead of three divisions. */
enum { EL_EDGE_SHORT = 511, EL_EDGE_NARROW = 1023 };

/* Sets up the edge from (x0, y0) down to (x1, y1) for `row`. Pre: coordinates in 1/EL_SUBPIXELS px within
 * +-EL_GUARD_SUB, or both ends of such an edge moved by up to half a pixel on either axis, as samples and wires do;
 * y0 < y1, el_first_centre(y0) <= row < el_first_centre(y1). */
static inline void el_edge_make(el_edge *edge, int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row)
{
    const int32_t dx = x1 - x0;              /* |dx| <= 2 * EL_GUARD_SUB */
    const uint32_t dy = (uint32_t)(y1 - y0); /* 1 to 2 * EL_GUARD_SUB */
    const int32_t half = EL_SUBPIXELS / 2;
    const int32_t down =
        row * EL_SUBPIXELS + half - y0; /* 0 to 2 * EL_GUARD_SUB, from the corner to the row's centre */
#if EL_SUBPIXEL_BITS == 4
    edge->step_q32 = el_ratio_q32(dx, dy);
    /* (x0 - half + down dx / dy) / 16, rounded up; down < dy, so `down` steps are below 2^32 |dx| + 2^17 < 2^49. */
    const int64_t aside = (int64_t)el_multiply_u16((uint64_t)edge->step_q32, (uint32_t)down) >> EL_SUBPIXEL_BITS;
    edge->x_q32 = (int64_t)((x0 - half) * (int64_t)(1 << (32 - EL_SUBPIXEL_BITS))) + aside + 0xFFFFFFFFLL;
#else
    edge->step_q32 = el_wide_ratio_q32(dx, dy);
    /* x = ceil(n / (S dy)) with n = (x0 - half) dy + down dx, |n| < 6.01 G^2 for G = EL_GUARD_SUB: 2^40.6 for S = 256.
     * n moves by S dx per row, so m = ceil(n / S) moves by dx, and x = ceil(m / dy); |m| < 2^33. */
    const int64_t n = (int64_t)(x0 - half) * dy + (int64_t)down * dx;
    const int64_t m = (n + EL_SUBPIXELS - 1) >> EL_SUBPIXEL_BITS;
    edge->x_q32 = el_wide_ratio_q32(m, dy) + 0xFFFFFFFFLL;
#endif
}

#if EL_SUBPIXEL_BITS == 4 && !EL_SMALL_CODE
/* By halves, which is two shifts. */
static inline int64_t el_q20_to_q32(int32_t a_q20)
{
    return (int64_t)((uint64_t)(uint32_t)(a_q20 >> 20) << 32 | (uint32_t)a_q20 << 12);
}

/* An el_edge in fewer bits. */
typedef struct el_edge_q20 {
    int32_t x, step;
} el_edge_q20;

/* The same for |x1 - x0| <= EL_EDGE_NARROW, y1 - y0 <= EL_EDGE_SHORT.
 *
 * A step of the grid is at least 2^20 / (16 * 511), 128 units of 2^-20. A reciprocal that is short by up to a unit of
 * 2^-31, and cutting off what is below 2^-20, leave a step too low by less than 3/2 unit, or too high by less than 1/2
 * where dx < 0. That is times t / 16 on a row t below the corner, t < 511, and a unit more is cut off where the edge
 * begins: too low by less than 49 units, too high by less than 16. So what is added first is 48 units less than 1: the
 * whole part is right as long as 16 < 48 and 48 + 49 <= 128. */
static inline el_edge_q20 el_edge_make_q20(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row)
{
    const int32_t half = EL_SUBPIXELS / 2;
    const int32_t down = row * EL_SUBPIXELS + half - y0;                                   /* 0 to 510 */
    const int32_t step_q20 = el_product_down_11(x1 - x0, el_reciprocal_of_short(y1 - y0)); /* |step| < 1023 * 2^20 */
    const int32_t aside = (step_q20 * down) >> EL_SUBPIXEL_BITS;                           /* below 2^20 * 64 */
    /* (x0 - half + down dx / dy) / 16, and 1 to be rounded up: within +-2041 pixels. */
    const int32_t x_q20 = (x0 + half) * (1 << (20 - EL_SUBPIXEL_BITS)) + aside - 48;
    return (el_edge_q20){.x = x_q20, .step = step_q20};
}

static inline void el_edge_widen(el_edge *edge, el_edge_q20 narrow)
{
    edge->x_q32 = el_q20_to_q32(narrow.x);
    edge->step_q32 = el_q20_to_q32(narrow.step);
}

/* Of an edge that was widened. */
static inline el_edge_q20 el_edge_narrowed(const el_edge *edge)
{
    return (el_edge_q20){.x = (int32_t)(edge->x_q32 >> 12), .step = (int32_t)(edge->step_q32 >> 12)};
}

static inline void el_edge_make_short(el_edge *edge, int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row)
{
    el_edge_widen(edge, el_edge_make_q20(x0, y0, x1, y1, row));
}
#endif

static inline void el_edge_next_row(el_edge *edge)
{
    edge->x_q32 += edge->step_q32;
}

#ifdef __cplusplus
}
#endif

#endif
