/* A triangle's edge, stepped row by row in exact integers.
 *
 * The edge function E(i, j) of an edge with direction (dx, dy), dy > 0, at the centre of pixel (i, j), is negative on
 * one side and moves by a fixed amount per pixel and per row. Its zero on row j lies at a rational column with the
 * denominator dy; `x` is the first pixel whose centre is not left of that zero, and `rest`, 0 <= rest < dy, is what
 * remains of the edge function there. A step adds the exact quotient and remainder of dx / dy, so x never drifts: on
 * any row it is what a direct evaluation gives.
 *
 * A left edge's pixel x is inside (E = 0 counts), a right edge's is not: with rows from the first centre not above the
 * top to the last centre above the bottom, that is the top-left rule, without a case for it. */
#ifndef EL_RASTER_EDGE_H
#define EL_RASTER_EDGE_H

#include <stdint.h>

#include "geometry/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct el_edge {
    int32_t x;          /* first pixel not left of the edge on this row; within +-2041 on the edge's own rows */
    int32_t step;       /* floor(dx / dy) */
    uint32_t rest;      /* 0 <= rest < height */
    uint32_t rest_step; /* 0 <= rest_step < height */
    uint32_t height;    /* dy, at most 2 * EL_GUARD_SUB */
} el_edge;

/* What m below fits: |m| < 2^(20 + EL_SUBPIXEL_BITS) * 2^5 = 2^29 with 4 bits, 2^31.2 with 6, 2^33.2 with 8. */
#if EL_SUBPIXEL_BITS == 4
typedef int32_t el_edge_number;
#else
typedef int64_t el_edge_number;
#endif

/* The first row (or column) whose centre is not before `a`, in 1/EL_SUBPIXELS px. */
static inline int32_t el_first_centre(int32_t a)
{
    return (a + (EL_SUBPIXELS / 2 - 1)) >> EL_SUBPIXEL_BITS;
}

/* Sets up the edge from (x0, y0) down to (x1, y1) for `row`. Pre: coordinates in 1/EL_SUBPIXELS px within
 * +-EL_GUARD_SUB, y0 < y1, el_first_centre(y0) <= row < el_first_centre(y1). */
static inline void el_edge_make(el_edge *edge, int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row)
{
    const int32_t dx = x1 - x0; /* |dx| <= 2 * EL_GUARD_SUB */
    const int32_t dy = y1 - y0; /* 1 to 2 * EL_GUARD_SUB */
    const int32_t half = EL_SUBPIXELS / 2;
    /* With S = EL_SUBPIXELS and G = EL_GUARD_SUB: x = ceil(n / (S dy)), n = (x0 - half) dy + (centre - y0) dx.
     * |n| <= (G + half) 2G + (2G)^2 < 6.01 G^2: 2^32.6 for S = 16, 2^40.6 for S = 256. n moves by S dx per row, so
     * m = floor((n + S dy - 1) / S) moves by dx, and x = floor(m / dy). */
    const int64_t n = (int64_t)(x0 - half) * dy + (int64_t)(row * EL_SUBPIXELS + half - y0) * dx;
    const el_edge_number m = (el_edge_number)((n + (int64_t)EL_SUBPIXELS * dy - 1) >> EL_SUBPIXEL_BITS);
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): y0 < y1. */
    int32_t quotient = (int32_t)(m / dy);
    int32_t rest = (int32_t)(m - (el_edge_number)quotient * dy);
    if (rest < 0) {
        quotient--;
        rest += dy;
    }
    int32_t step = dx / dy;
    int32_t rest_step = dx - step * dy;
    if (rest_step < 0) {
        step--;
        rest_step += dy;
    }
    edge->x = quotient;
    edge->rest = (uint32_t)rest;
    edge->step = step;
    edge->rest_step = (uint32_t)rest_step;
    edge->height = (uint32_t)dy;
}

static inline void el_edge_next_row(el_edge *edge)
{
    edge->x += edge->step;
    edge->rest += edge->rest_step; /* below 4 * EL_GUARD_SUB */
    if (edge->rest >= edge->height) {
        edge->rest -= edge->height;
        edge->x++;
    }
}

#ifdef __cplusplus
}
#endif

#endif
