/* What a triangle covers and what its planes are worth, exactly: direct evaluation of edge functions at pixel centres,
 * sums of barycentric weights as integers, quotients only by comparison of products. Written from the conventions of
 * edgeline.h alone; no arithmetic is shared with the rasterizer.
 *
 * Widths, for 8 bits of sub-pixels at most: coordinates are below 2^19, edge functions and doubled areas below 2^41, sums
 * of weights times 16-bit values below 2^58. Texture coordinates take 128 bits. */
#ifndef EL_STRESS_EXACT_H
#define EL_STRESS_EXACT_H

#include <stdbool.h>
#include <stdint.h>

#include "geometry/limits.h"

_Static_assert(EL_SUBPIXEL_BITS <= 8, "the widths above");

typedef __int128 wide;

typedef struct point {
    int64_t x, y; /* sub-pixels, y down */
} point;

static inline point centre_of(int64_t column, int64_t row)
{
    return (point){column * EL_SUBPIXELS + EL_SUBPIXELS / 2, row * EL_SUBPIXELS + EL_SUBPIXELS / 2};
}

/* Twice the area of a, b, p: positive when they run clockwise on the screen. As a function of p, the edge function of
 * the edge from a to b, positive inside a clockwise triangle. */
static inline int64_t exact_edge(point a, point b, point p)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/* A triangle that runs clockwise, whichever way it was given. */
typedef struct exact_triangle {
    point corners[3];
    unsigned given[3]; /* the place of each corner in what was given */
    int64_t area;      /* doubled, >= 0 */
} exact_triangle;

exact_triangle exact_triangle_of(const point corners[3]);

/* Whether the pixel is covered, by the top-left rule. */
bool exact_covers(const exact_triangle *triangle, int64_t column, int64_t row);

/* The covered columns [*begin, *end) of a row of a screen that is `width` pixels wide; *begin == *end where there are
 * none. */
void exact_span(const exact_triangle *triangle, int64_t row, int64_t width, int64_t *begin, int64_t *end);

/* The value of a plane at a pixel is sum / area: a numerator that grows by `step` per pixel along a row. */
typedef struct exact_row {
    int64_t sum;
    int64_t step;
} exact_row;

/* `values` in the order in which the corners were given, 0..65535. */
exact_row exact_plane(const exact_triangle *triangle, const int32_t values[3], int64_t column, int64_t row);

/* sum / area rounded to nearest, ties up. */
static inline int64_t exact_rounded(int64_t sum, int64_t area)
{
    return (2 * sum + area) / (2 * area);
}

/* A quotient with a positive denominator. */
typedef struct exact_ratio {
    wide numerator;
    wide denominator;
} exact_ratio;

/* sum(weight w u) / sum(weight w): a perspective-correct coordinate, in the unit of `u`. `w` and `u` in the order in
 * which the corners were given, 1 <= w < 2^31, |u| < 2^28. */
exact_ratio exact_coordinate(const exact_triangle *triangle, const uint32_t w[3], const int32_t u[3], int64_t column,
                             int64_t row);

/* |got - exact|, rounded to double at the end; and whether it is at most 2^-bits of a unit of 2^16, exactly. */
double exact_error(exact_ratio exact, int64_t got);
bool exact_is_within(exact_ratio exact, int64_t got, unsigned bits);

#endif
