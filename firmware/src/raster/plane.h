/* A value that is linear on the screen, given at a triangle's three corners: depth, a colour channel, 1/w, u/w, v/w.
 *
 * Q32 modulo 2^64: the whole part keeps its 32 low bits. A sliver's gradient per pixel can be far larger than any value
 * inside the triangle; modulo 2^64 the sums over covered pixels still come out right, because the true values there lie
 * between the corners'. Gradients are exact quotients truncated at 2^-32, so the error at any pixel is below
 * 2^-32 * (distance in pixels from the first corner) < 2^-20. */
#ifndef EL_RASTER_PLANE_H
#define EL_RASTER_PLANE_H

#include <stdint.h>

#include "base/divide.h"

typedef struct el_plane {
    uint64_t row; /* value at the centre of pixel 0 of the current row */
    uint64_t dx;  /* per pixel to the right */
    uint64_t dy;  /* per row down */
} el_plane;

/* A triangle's shape, from which all its planes are made. */
typedef struct el_plane_frame {
    int32_t x0, y0;   /* the first corner, 1/16 px */
    int32_t dx1, dy1; /* from the first to the second corner */
    int32_t dx2, dy2; /* from the first to the third */
    int32_t row;      /* the row that the planes start at */
    int32_t sign;     /* of the doubled area */
    el_divisor area;  /* |doubled area| in (1/16 px)^2: at most the bounding box, 65280^2 < 2^32 */
} el_plane_frame;

/* Corners in 1/16 px, not in a line. */
void el_plane_frame_make(el_plane_frame *frame, const int32_t x[3], const int32_t y[3], int32_t row);

/* The plane through the corners' values, |value| < 2^31. */
void el_plane_make(el_plane *plane, const el_plane_frame *frame, const int32_t values[3]);

/* Doubled area; positive when the corners run clockwise as seen on the screen (y down). Exact. */
static inline int64_t el_doubled_area(const int32_t x[3], const int32_t y[3])
{
    return (int64_t)(x[1] - x[0]) * (y[2] - y[0]) - (int64_t)(x[2] - x[0]) * (y[1] - y[0]);
}

#endif
