/* Seeded corners, and the exact edge-function test that decides which pixel centres a triangle covers: an independent
 * reference for the rasterizer, in 64-bit products and straight from the top-left rule. */
#ifndef EL_TEST_ANY_TRIANGLE_H
#define EL_TEST_ANY_TRIANGLE_H

#include <stdbool.h>

#include "raster/triangle.h"
#include "seeded.h"

/* 1/16 px; the sub-pixels of a configuration are that or finer. */
enum { SIXTEENTH = EL_SUBPIXELS / 16 };

/* Twice the area of (a, b, p), positive when p is on the right of a -> b with y down. */
static inline int64_t reference_side(const el_corner *a, const el_corner *b, int64_t x, int64_t y)
{
    return (int64_t)(b->x - a->x) * (y - a->y) - (int64_t)(b->y - a->y) * (x - a->x);
}

/* A point inside is covered; one on an edge only where the triangle lies below a level edge (top) or on the right of
 * another (left). */
static inline bool reference_covers_point(const el_corner corners[3], int64_t x, int64_t y)
{
    const int64_t area = reference_side(&corners[0], &corners[1], corners[2].x, corners[2].y);
    for (unsigned i = 0; i < 3 && area != 0; i++) {
        const el_corner *const a = &corners[area > 0 ? i : (i + 1) % 3]; /* clockwise, the inside on the right */
        const el_corner *const b = &corners[area > 0 ? (i + 1) % 3 : i];
        const int64_t side = reference_side(a, b, x, y);
        const bool top_or_left = b->y < a->y || (b->y == a->y && b->x > a->x);
        if (side < 0 || (side == 0 && !top_or_left)) {
            return false;
        }
    }
    return area != 0;
}

/* The same for the pixel's centre. */
static inline bool reference_covers(const el_corner corners[3], int32_t column, int32_t row)
{
    return reference_covers_point(corners, (int64_t)column * EL_SUBPIXELS + EL_SUBPIXELS / 2,
                                  (int64_t)row * EL_SUBPIXELS + EL_SUBPIXELS / 2);
}

/* A corner within +-reach sub-pixels of `middle`, with every attribute. */
static inline el_corner any_corner(seeded *s, int32_t middle, int32_t reach)
{
    return (el_corner){
        .x = middle + (int32_t)any_between(s, -reach, reach),
        .y = middle + (int32_t)any_between(s, -reach, reach),
        .z = (uint16_t)any_between(s, 0, EL_DEPTH_MAX),
        .w = (uint32_t)any_between(s, 1 << 26, INT32_MAX),
        .u_q16 = (int32_t)any_between(s, -200 * 65536, 200 * 65536),
        .v_q16 = (int32_t)any_between(s, -200 * 65536, 200 * 65536),
        .rgb_q8 = {(uint16_t)any_between(s, 0, 0xFF00), (uint16_t)any_between(s, 0, 0xFF00),
                   (uint16_t)any_between(s, 0, 0xFF00)},
    };
}

#endif
