/* Depth of a tiny triangle: a plane in one register, with the bits of all others.
 *
 * Depth at a pixel's centre is a multiple of 1 / area (the doubled one, A, in squared sub-pixels), so depth and a half is one
 * of 1 / 2A: a number that is beyond the true one by less than 1 / 2A has the same whole part. The planes of plane.h are,
 * by between 2^-20.4 and 2^-18.7 where quotients per sub-pixel are truncated, as long as A < 2^17: what they draw is the
 * rounded depth. So is whatever else stays within that bound, and here is what does with 20 bits of fraction:
 *
 *     a gradient per pixel is cut off by less than a unit of 2^-20, so W / 16 columns and H / 16 rows from the corner a value
 *     is off by less than (W + H) / 16 units, and a unit more is cut off where the plane begins;
 *     K = (W + H) / 16 + 2 units are added to it first: it is beyond by more than nothing and less than 2 K;
 *     2 K < 2^20 / 2A where (W + H + 32) A < 2^22, which is what EL_TINY_MOST says. A is below 2^14 then, being W H at most.
 *
 * That leaves 12 bits for depths from the first corner's on, 2048 on either side, modulo 2^32: at a covered pixel the true
 * value lies between the corners'. */
#ifndef EL_RASTER_TINY_H
#define EL_RASTER_TINY_H

#include "raster/edge.h"
#include "raster/plane.h"

#if EL_WITH_SMALL_PLANES

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_TINY_HIGH = 255, EL_TINY_LONG = 511 }; /* its height, and its width and height in sum, at most */

enum { EL_TINY_FRACTION_BITS = 20, EL_TINY_SIDE = 1 << (31 - EL_TINY_FRACTION_BITS), EL_TINY_MOST = 1 << 22 };

/* Q18 modulo 2^32. */
typedef struct el_edge_q18 {
    uint32_t x, step;
} el_edge_q18;

/* Q20 modulo 2^32: depth - base and a half. */
typedef struct el_tiny_plane {
    uint32_t value; /* in the screen's first column of the triangle's next row */
    uint32_t dx, dy;
    int32_t base;
} el_tiny_plane;

/* From a triangle's top corner to its middle one, and to the bottom one. */
typedef struct el_tiny_shape {
    int32_t dx1, dy1;
    int32_t dx2, dy2;
    int32_t area;         /* not 0 */
    int32_t width_height; /* of its box, in sum */
} el_tiny_shape;

/* What a plane's gradient is, in 2^-24 per sub-pixel, which are 2^-20 per pixel: upper * 2^16 + lower, truncated towards
 * zero, both of one sign. */
typedef struct el_tiny_gradient {
    int32_t upper, lower;
} el_tiny_gradient;

/* Of dividend / area, |dividend| < 2^22. */
static inline el_tiny_gradient el_tiny_gradient_make(int32_t dividend, const el_small_divisor *area)
{
    el_tiny_gradient g;
#if defined(EL_DIVIDE_BY_TABLE)
    uint32_t rest = (uint32_t)(dividend < 0 ? -dividend : dividend) << (8 + area->shift); /* el_tiny_is_steep */
    g.upper = (int32_t)el_divide_digit(rest >> 16, rest & 0xFFFFU, 16, area, &rest);
    g.lower = (int32_t)el_divide_digit(rest, 0, 16, area, &rest);
    if ((dividend < 0) != (area->d < 0)) {
        g.upper = -g.upper;
        g.lower = -g.lower;
    }
#else
    /* NOLINTBEGIN(clang-analyzer-core.DivideZero): d is not 0. */
    const int32_t n = dividend * (1 << 8); /* below 2^30 */
    g.upper = n / area->d;
    g.lower = (n - g.upper * area->d) * (1 << 16) / area->d; /* |remainder| < |d| < 2^14 */
    /* NOLINTEND(clang-analyzer-core.DivideZero) */
#endif
    return g;
}

/* Whether a quotient does not fit digits, where it is made of them: slivers. */
static inline bool el_tiny_is_steep(int32_t dividend, int32_t area)
{
#if defined(EL_DIVIDE_BY_TABLE)
    return (dividend < 0 ? -dividend : dividend) >> 8 >= (area < 0 ? -area : area);
#else
    (void)dividend;
    (void)area;
    return false;
#endif
}

static inline uint32_t el_tiny_per_pixel(el_tiny_gradient g)
{
    return ((uint32_t)g.upper << 16) + (uint32_t)g.lower;
}

/* The plane from `row` on, through the top corner at (x0, y0) with depth z0, and the others, d1 and d2 beyond it. Returns
 * false where they do not fit. */
static inline bool el_tiny_plane_make(el_tiny_plane *plane, const el_tiny_shape *shape, int32_t x0, int32_t y0,
                                      int32_t row, int32_t z0, int32_t d1, int32_t d2)
{
    if ((((uint32_t)d1 + EL_TINY_SIDE) | ((uint32_t)d2 + EL_TINY_SIDE)) >= 2U * EL_TINY_SIDE) {
        return false;
    }
    /* 2 * 2^11 * 511 < 2^21, 2 * 2^11 * 1023 < 2^22 */
    const int32_t a = d1 * shape->dy2 - d2 * shape->dy1;
    const int32_t b = d2 * shape->dx1 - d1 * shape->dx2;
    if (el_tiny_is_steep(a, shape->area) || el_tiny_is_steep(b, shape->area)) {
        return false;
    }
    const el_small_divisor divisor = el_small_divisor_make(shape->area);
    const el_tiny_gradient gx = el_tiny_gradient_make(a, &divisor);
    const el_tiny_gradient gy = el_tiny_gradient_make(b, &divisor);
    plane->dx = el_tiny_per_pixel(gx);
    plane->dy = el_tiny_per_pixel(gy);
    plane->base = z0 - EL_TINY_SIDE;
    /* From the corner to the centre of the first column's pixel in that row. Upper parts count modulo 2^20 here; lower ones
     * are below 2^16, and 2^16 * (2^14 + 2^8) < 2^31. */
    const int32_t right = EL_SUBPIXELS / 2 - x0;
    const int32_t down = row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - y0;
    const uint32_t upper = (uint32_t)gx.upper * (uint32_t)right + (uint32_t)gy.upper * (uint32_t)down;
    const int32_t lower = gx.lower * right + gy.lower * down;
    const uint32_t bias = (uint32_t)(shape->width_height >> EL_SUBPIXEL_BITS) + 2U;
    plane->value = ((2U * EL_TINY_SIDE + 1U) << (EL_TINY_FRACTION_BITS - 1)) + bias +
                   (upper << (16 - EL_SUBPIXEL_BITS)) + (uint32_t)(lower >> EL_SUBPIXEL_BITS);
    return true;
}

/* An edge of it, as el_edge_make_q20 has them, in Q18, which leaves 14 bits for pixels.
 *
 * A step of the grid is at least 2^18 / (16 * 255), 64 units. A step per row is off by less than 1.1 units to either side,
 * 255 / 16 of them by less than 18, and a unit more is cut off where the edge begins: 24 units less than 1 are added first, and
 * 18 < 24, 24 + 18 + 1 < 64. */
static inline el_edge_q18 el_edge_make_q18(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row)
{
    const int32_t half = EL_SUBPIXELS / 2;
    const int32_t dx = x1 - x0;
    const int32_t dy = y1 - y0;
    const int32_t down = row * EL_SUBPIXELS + half - y0; /* below dy */
#if defined(EL_DIVIDE_BY_TABLE)
    const int32_t reciprocal = el_reciprocal_of_short(dy);
    const int32_t step = el_product_down_11(dx, reciprocal) >> 2; /* |step| < 2^27 */
#else
    const int32_t step = dx * (1 << 18) / dy;
#endif
    const int32_t aside = (step * down) >> EL_SUBPIXEL_BITS; /* |step * down| < 2^18 |dx| + 2 * 255 < 2^28 */
    return (el_edge_q18){.x = (uint32_t)((x0 + half) * (1 << (18 - EL_SUBPIXEL_BITS)) + aside - 24),
                         .step = (uint32_t)step};
}

#ifdef __cplusplus
}
#endif

#endif
#endif
