/* Depth and colours of a small triangle: the planes of plane.h, made with 32-bit products and short divisions.
 *
 * Quotients are per sub-pixel, exact and truncated at 2^-32, and a pixel is EL_SUBPIXELS of them: what is made for a
 * small triangle by plane.c has the same bits. Here is what nearly all of a mesh's triangles take, so it is short, and
 * inline: the shape stays in registers while its planes are made. */
#ifndef EL_RASTER_SMALL_PLANE_H
#define EL_RASTER_SMALL_PLANE_H

#include "raster/edge.h"
#include "raster/plane.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of a triangle whose sides are short edges: 511 sub-pixels high, 1023 wide at most. */
typedef struct el_small_frame {
    int32_t dx1, dy1; /* from the first to the second corner, 1/EL_SUBPIXELS px */
    int32_t dx2, dy2; /* from the first to the third */
    int32_t x0, y0;   /* the first corner */
    int32_t x, row;   /* the pixel that the planes start at, less than 2^11 sub-pixels away on each axis */
    el_small_divisor area;
} el_small_frame;

_Static_assert(EL_SUBPIXEL_BITS != 4 || EL_EDGE_NARROW * EL_EDGE_SHORT < 1 << EL_SMALL_DIVISOR_BITS,
               "the doubled area is at most the box, and a small divisor");
_Static_assert(EL_SUBPIXEL_BITS != 4 || (int)EL_EDGE_NARROW <= (int)EL_SMALL_SUB,
               "what is drawn by small planes is what plane.c makes by parts");

/* Per sub-pixel, Q32. */
typedef struct el_small_gradient {
    uint64_t per_x, per_y;
} el_small_gradient;

/* Of the plane through the differences d1 and d2, below 2^16, from the first corner's value. */
static inline el_small_gradient el_small_gradient_make(const el_small_frame *frame, int32_t d1, int32_t d2)
{
    /* |a|, |b| <= 2 * 65535 * 1023 < 2^27. */
    const int32_t a = d1 * frame->dy2 - d2 * frame->dy1;
    const int32_t b = d2 * frame->dx1 - d1 * frame->dx2;
    return (el_small_gradient){
        .per_x = el_divide_small_q32(a, &frame->area),
        .per_y = el_divide_small_q32(b, &frame->area),
    };
}

/* Depth, 0 to 65535. */
static inline void el_small_plane_make(el_plane *plane, const el_small_frame *frame, int32_t z0, int32_t z1, int32_t z2)
{
    const el_small_gradient g = el_small_gradient_make(frame, z1 - z0, z2 - z0);
    plane->dx = g.per_x << EL_SUBPIXEL_BITS;
    plane->dy = g.per_y << EL_SUBPIXEL_BITS;
    plane->value = ((uint64_t)z0 << 32) +
                   el_multiply_u64(g.per_x, frame->x * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->x0) +
                   el_multiply_u64(g.per_y, frame->row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->y0);
}

/* A colour channel, 0 to 255 in 8.8. Rounded are the offset to the centre of the first corner's pixel and what a pixel is,
 * which are added up from there. */
static inline void el_small_channel_make(el_channel *channel, const el_small_frame *frame, int32_t v0, int32_t v1,
                                         int32_t v2)
{
    const el_small_gradient g = el_small_gradient_make(frame, v1 - v0, v2 - v0);
    const int32_t column = frame->x0 >> EL_SUBPIXEL_BITS;
    const int32_t row = frame->y0 >> EL_SUBPIXEL_BITS;
    const uint64_t offset = el_multiply_u64(g.per_x, column * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->x0) +
                            el_multiply_u64(g.per_y, row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->y0);
    const uint32_t dx = el_q32_to_q24(g.per_x << EL_SUBPIXEL_BITS);
    const uint32_t dy = el_q32_to_q24(g.per_y << EL_SUBPIXEL_BITS);
    channel->dx = dx;
    channel->dy = dy;
    channel->value = ((uint32_t)v0 << 16) + EL_CHANNEL_HALF + el_q32_to_q24(offset) +
                     dx * (uint32_t)(frame->x - column) + dy * (uint32_t)(frame->row - row);
}

#ifdef __cplusplus
}
#endif

#endif
