/* A value that is linear on the screen, given at a triangle's three corners: depth, a colour channel, 1/w, u/w, v/w.
 *
 * Q32 modulo 2^64: the whole part keeps its 32 low bits. A sliver's gradient per pixel can be far larger than any value
 * inside the triangle; modulo 2^64 the sums over covered pixels still come out right, because the true values there lie
 * between the corners'. Gradients are exact quotients truncated at 2^-32, so the error at any pixel is below
 * 2^-32 * (columns + rows from the first corner) <= 2^-32 * 8160 < 2^-19. */
#ifndef EL_RASTER_PLANE_H
#define EL_RASTER_PLANE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/divide.h"
#include "geometry/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

/* It is followed down the screen's first column: every pixel is in it or to the right. */
typedef struct el_plane {
    uint64_t value; /* at the centre of that column's pixel in the triangle's next row */
    uint64_t dx;    /* per pixel to the right */
    uint64_t dy;    /* per row down */
} el_plane;

/* A colour channel in the same way: 0..255 in 8.24, modulo 2^32, with 1/2 added. Gradients are rounded to 2^-24, so the
 * error at any pixel is below 2^-25 * 8160 < 2^-12. */
typedef struct el_channel {
    uint32_t value, dx, dy;
} el_channel;

#define EL_CHANNEL_HALF (1U << 23)

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
    int32_t x, row;   /* the pixel that the planes start at */
    int32_t sign;     /* of the doubled area */
    bool small;       /* all differences within +-EL_SMALL_SUB: 32 bits are enough for values of 16 */
    el_area area;
} el_plane_frame;

/* With values below 2^16, (2^16 - 1) * 2 * 1023 < 2^31, and quotients per sub-pixel are off by less than 2 * 1023 units of
 * 2^-32 in sum. */
enum { EL_SMALL_SUB = EL_SUBPIXEL_BITS == 4 ? 1023 : -1 };

/* small_plane.h has a shorter way to the same bits for these. */
#define EL_WITH_SMALL_PLANES (EL_SUBPIXEL_BITS == 4 && !EL_SMALL_CODE)

/* Corners in 1/EL_SUBPIXELS px, not in a line. x and row are the caller's to set. */
void el_plane_frame_make(el_plane_frame *frame, const int32_t x[3], const int32_t y[3]);

/* The plane through values[i] * 2^-fraction_bits, |values[i]| < 2^(31 + fraction_bits); fraction_bits is 0 or
 * EL_PLANE_FRACTION_BITS. */
void el_plane_make(el_plane *plane, const el_plane_frame *frame, const int64_t values[3], unsigned fraction_bits);

#if EL_WITH_SAMPLES
/* What a sub-pixel to the right and one down add to a plane, modulo 2^64, truncated at 2^-32: a few of them lead from a pixel's
 * centre to its samples. */
typedef struct el_plane_parts {
    uint64_t dx, dy;
} el_plane_parts;

/* Of the plane that el_plane_make makes of the same. */
void el_plane_parts_make(el_plane_parts *parts, const el_plane_frame *frame, const int64_t values[3],
                         unsigned fraction_bits);
#endif

/* The same for depth: 0 <= values[i] < 2^16. */
void el_plane_make_u16(el_plane *plane, const el_plane_frame *frame, const uint16_t values[3]);

/* The channel through values[i], 0 to 255 in 8.8. */
void el_channel_make(el_channel *channel, const el_plane_frame *frame, const uint16_t values[3]);

/* From 8.8 in Q32 to 8.24, rounded; negative numbers modulo 2^32. */
static inline uint32_t el_q32_to_q24(uint64_t value)
{
    return (uint32_t)((value + 0x8000U) >> 16);
}

/* A plane's gradient times a number of pixels or rows, modulo 2^64; |count| < 2^22. */
EL_INLINE uint64_t el_plane_times(uint64_t gradient, int32_t count)
{
    return !EL_SMALL_CODE && (uint32_t)(count + 0xFFFF) <= 2U * 0xFFFFU ? el_multiply_u64(gradient, count)
                                                                        : gradient * (uint64_t)(int64_t)count;
}

/* Doubled area; positive when the corners run clockwise as seen on the screen (y down). Exact. */
EL_INLINE int64_t el_doubled_area(const int32_t x[3], const int32_t y[3])
{
    const int32_t dx1 = x[1] - x[0];
    const int32_t dy1 = y[1] - y[0];
    const int32_t dx2 = x[2] - x[0];
    const int32_t dy2 = y[2] - y[0];
#if defined(__ARM_ARCH_6M__) && !EL_SMALL_CODE
    /* Most differences are within +-2^14, and both products below 2^29 then. */
    const uint32_t bias = 1U << 14;
    if ((((uint32_t)dx1 + bias) | ((uint32_t)dy1 + bias) | ((uint32_t)dx2 + bias) | ((uint32_t)dy2 + bias)) >> 15 ==
        0) {
        return dx1 * dy2 - dx2 * dy1;
    }
#endif
    return (int64_t)dx1 * dy2 - (int64_t)dx2 * dy1;
}

#ifdef __cplusplus
}
#endif

#endif
