/* A value that is linear on the screen, given at a triangle's three corners: depth, a colour channel, 1/w, u/w, v/w.
 *
 * Q32 modulo 2^64: the whole part keeps its 32 low bits. A sliver's gradient per pixel can be far larger than any value
 * inside the triangle; modulo 2^64 the sums over covered pixels still come out right, because the true values there lie
 * between the corners'. Gradients are exact quotients truncated at 2^-32, so the error at any pixel is below
 * 2^-32 * (columns + rows from the first corner) <= 2^-32 * 8160 < 2^-19. */
#ifndef EL_RASTER_PLANE_H
#define EL_RASTER_PLANE_H

#include <stdint.h>

#include "base/divide.h"
#include "geometry/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct el_plane {
    uint64_t row; /* value at the centre of pixel 0 of the current row */
    uint64_t dx;  /* per pixel to the right */
    uint64_t dy;  /* per row down */
} el_plane;

/* |doubled area| of a triangle: at most its bounding box, (2 * EL_GUARD_SUB)^2, 2^31.99 with 4 sub-pixel bits, 2^39.99
 * with 8. */
#if EL_SUBPIXEL_BITS == 4
typedef el_divisor el_area;
#else
typedef uint64_t el_area;
#endif

/* Extra bits of fraction that corner values may have: what el_plane_make has room for in 63 bits. */
enum { EL_PLANE_FRACTION_BITS = EL_SUBPIXEL_BITS == 4 ? 8 : 0 };

/* A triangle's shape, from which all its planes are made. */
typedef struct el_plane_frame {
    int32_t x0, y0;   /* the first corner, 1/EL_SUBPIXELS px */
    int32_t dx1, dy1; /* from the first to the second corner */
    int32_t dx2, dy2; /* from the first to the third */
    int32_t row;      /* the row that the planes start at */
    int32_t sign;     /* of the doubled area */
    el_area area;
} el_plane_frame;

/* Corners in 1/EL_SUBPIXELS px, not in a line. */
void el_plane_frame_make(el_plane_frame *frame, const int32_t x[3], const int32_t y[3], int32_t row);

/* The plane through values[i] * 2^-fraction_bits, |values[i]| < 2^(31 + fraction_bits); fraction_bits is 0 or
 * EL_PLANE_FRACTION_BITS. */
void el_plane_make(el_plane *plane, const el_plane_frame *frame, const int64_t values[3], unsigned fraction_bits);

/* Doubled area; positive when the corners run clockwise as seen on the screen (y down). Exact. */
static inline int64_t el_doubled_area(const int32_t x[3], const int32_t y[3])
{
    return (int64_t)(x[1] - x[0]) * (y[2] - y[0]) - (int64_t)(x[2] - x[0]) * (y[1] - y[0]);
}

#ifdef __cplusplus
}
#endif

#endif
