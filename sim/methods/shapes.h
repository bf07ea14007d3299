/* What all methods share: points, the picture that counts, boxes, the side of an edge and where an edge crosses a row.
 *
 * Coordinates are integers of 1/EL_SUBPIXELS pixel, y down; pixel (i, j) has its centre at (i + 1/2, j + 1/2) pixels. All
 * ranges are half-open. "Clockwise" is as seen on the screen: the inside is on the right of each edge. */
#ifndef EL_METHODS_SHAPES_H
#define EL_METHODS_SHAPES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "raster/edge.h"

typedef struct el_spot {
    int32_t x, y; /* within +-EL_GUARD_SUB */
} el_spot;

/* A picture that counts: a triangle's method adds 1 to each pixel that it covers, so that two triangles show what they
 * both drew. The caller owns the counts. */
typedef struct el_hits {
    int32_t width, height;
    uint16_t *counts; /* width * height */
} el_hits;

/* What happens to a pixel whose centre lies exactly on an edge. */
typedef enum el_edge_rule {
    EL_EDGES_ALL,     /* it counts */
    EL_EDGES_NONE,    /* it does not */
    EL_EDGES_LEFT_TOP /* it counts on a left edge and on a level edge above the inside */
} el_edge_rule;

typedef enum el_fill_rule {
    EL_FILL_EVEN_ODD, /* inside: a ray to the outside crosses the outline an odd number of times */
    EL_FILL_NON_ZERO  /* inside: the outline winds around the point, whichever way */
} el_fill_rule;

/* Pixels [x, x_end) x [y, y_end). */
typedef struct el_box {
    int32_t x, y, x_end, y_end;
} el_box;

static inline el_spot el_centre_of(int32_t column, int32_t row)
{
    return (el_spot){column * EL_SUBPIXELS + EL_SUBPIXELS / 2, row * EL_SUBPIXELS + EL_SUBPIXELS / 2};
}

static inline el_box el_box_of_picture(const el_hits *hits)
{
    return (el_box){0, 0, hits->width, hits->height};
}

/* The pixels of the picture whose centres lie within the spots' bounds, the bounds included. */
el_box el_box_of_spots(const el_spot *spots, size_t count, const el_hits *hits);

/* Twice the area of the triangle (a, b, p): positive when p is on the right of a -> b, 0 when it is on the line.
 * Differences are below 2^20 in the finest sub-pixels, the products below 2^40. */
static inline int64_t el_side(el_spot a, el_spot b, el_spot p)
{
    return (int64_t)(b.x - a.x) * (p.y - a.y) - (int64_t)(b.y - a.y) * (p.x - a.x);
}

/* Of an edge that has the inside on its right. */
static inline bool el_is_left_or_top(el_spot a, el_spot b)
{
    return b.y < a.y || (b.y == a.y && b.x > a.x);
}

/* The least el_side that is inside, by the rule: sides are integers, so "greater than 0" is "at least 1". */
static inline int64_t el_least_inside(el_spot a, el_spot b, el_edge_rule rule)
{
    return rule == EL_EDGES_ALL || (rule == EL_EDGES_LEFT_TOP && el_is_left_or_top(a, b)) ? 0 : 1;
}

/* The corners in clockwise order. False when the area is 0: such a triangle is nothing, by every rule. */
bool el_turn_clockwise(const el_spot corners[3], el_spot turned[3]);

/* The rows whose centres the edge a -> b passes: from the first that is not above its upper end to the last that is
 * above its lower end, clipped to [0, rows). A level edge has none. */
typedef struct el_rows {
    int32_t y, y_end;
} el_rows;

el_rows el_rows_of_edge(el_spot a, el_spot b, int32_t rows);

/* The first column whose centre is not left of the point where the edge crosses that row of centres: an exact ceiling
 * of a quotient of integers. Pre: a.y != b.y, and the row is one of the edge's. */
int32_t el_crossing_column(el_spot a, el_spot b, int32_t row);

static inline void el_hit(el_hits *hits, int32_t column, int32_t row)
{
    hits->counts[row * hits->width + column]++;
}

/* Hits the columns [x, x_end) that lie in the picture. Returns how many. */
uint32_t el_hit_span(el_hits *hits, int32_t row, int32_t x, int32_t x_end);

#endif
