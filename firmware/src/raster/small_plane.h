/* Depth and colours of a small triangle: the planes of plane.h, made with 32-bit products and short divisions.
 *
 * Quotients are per sub-pixel, exact and truncated at 2^-32, and a pixel is EL_SUBPIXELS of them: what is made for a
 * small triangle by plane.c has the same bits. Here is what nearly all of a mesh's triangles take, so it is short, and
 * inline: the shape stays in registers while its planes are made. */
#ifndef EL_RASTER_SMALL_PLANE_H
#define EL_RASTER_SMALL_PLANE_H

#include "raster/edge.h"
#include "raster/plane.h"

#if EL_WITH_SMALL_PLANES

#ifdef __cplusplus
extern "C" {
#endif

/* From a triangle's top corner to its middle one, and to the bottom one, in 1/EL_SUBPIXELS px. */
typedef struct el_small_shape {
    int32_t dx1, dy1;
    int32_t dx2, dy2;
} el_small_shape;

/* The doubled area; positive when the corners run clockwise as seen on the screen. */
static inline int32_t el_small_area(const el_small_shape *shape)
{
    return shape->dx1 * shape->dy2 - shape->dx2 * shape->dy1; /* |area| <= 2 * 1023 * 1023 */
}

/* Whether its edges are short. The doubled area is a small divisor then, being the box at most. */
static inline bool el_shape_is_small(const el_small_shape *shape)
{
    const uint32_t most = EL_EDGE_NARROW;
    return shape->dy2 <= EL_EDGE_SHORT && (uint32_t)shape->dx1 + most <= 2U * most &&
           (uint32_t)shape->dx2 + most <= 2U * most && (uint32_t)shape->dx2 - (uint32_t)shape->dx1 + most <= 2U * most;
}

_Static_assert((int)EL_EDGE_NARROW *(int)EL_EDGE_SHORT < 1 << EL_SMALL_DIVISOR_BITS, "a box of short edges");
_Static_assert((int)EL_EDGE_NARROW <= (int)EL_SMALL_SUB, "plane.c makes the same by parts");

typedef struct el_small_frame {
    el_small_shape shape;
    int32_t x0, y0; /* the top corner */
    int32_t row;    /* that the planes start at, less than 2^16 sub-pixels below it, in column 0 */
    el_small_divisor area;
} el_small_frame;

/* Per sub-pixel, times the doubled area. */
typedef struct el_small_gradient {
    int32_t along_x, along_y;
} el_small_gradient;

/* Of the plane through the differences d1 and d2, below 2^16, from the first corner's value. */
static inline el_small_gradient el_small_gradient_make(const el_small_frame *frame, int32_t d1, int32_t d2)
{
    /* |a|, |b| <= 2 * 65535 * 1023 < 2^27. */
    return (el_small_gradient){
        .along_x = d1 * frame->shape.dy2 - d2 * frame->shape.dy1,
        .along_y = d2 * frame->shape.dx1 - d1 * frame->shape.dx2,
    };
}

/* Depth, 0 to 65535. */
static inline void el_small_plane_make(el_plane *plane, const el_small_frame *frame, int32_t z0, int32_t z1, int32_t z2)
{
    const el_small_gradient g = el_small_gradient_make(frame, z1 - z0, z2 - z0);
    const uint64_t per_x = el_divide_small_q32(g.along_x, &frame->area);
    const uint64_t per_y = el_divide_small_q32(g.along_y, &frame->area);
    plane->dx = per_x << EL_SUBPIXEL_BITS;
    plane->dy = per_y << EL_SUBPIXEL_BITS;
    /* Column 0 is to the left of what is on the screen. */
    const uint32_t below = (uint32_t)(frame->row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->y0); /* at most 511 */
    plane->value =
        ((uint64_t)z0 << 32) + el_multiply_u16(per_y, below) - el_multiply_u64(per_x, frame->x0 - EL_SUBPIXELS / 2);
}

/* 8.24 per pixel of a quotient per sub-pixel, in Q32 of 8.8: EL_SUBPIXELS of them, rounded. */
static inline uint32_t el_quotient_per_pixel(const el_small_quotient *q)
{
    const int drop = 16 - EL_SUBPIXEL_BITS;
    return ((uint32_t)q->whole << (EL_WHOLE_BIT - drop)) + ((uint32_t)q->high << (EL_HIGH_BIT - drop)) +
           (uint32_t)((q->low + (1 << (drop - 1))) >> drop);
}

/* 8.24 of x times one and y times the other, rounded; |x|, |y| <= EL_SUBPIXELS / 2. */
static inline uint32_t el_quotients_times(const el_small_quotient *per_x, int32_t x, const el_small_quotient *per_y,
                                          int32_t y)
{
    /* Digits' sums are at most 2^20. Of the second one's, a product with 2^EL_HIGH_BIT, what is below 2^16 goes to the third
     * one's. */
    const int drop = 16 - EL_HIGH_BIT;
    const uint32_t whole = (uint32_t)per_x->whole * (uint32_t)x + (uint32_t)per_y->whole * (uint32_t)y;
    const int32_t high = per_x->high * x + per_y->high * y;
    const int32_t low = per_x->low * x + per_y->low * y + (high & ((1 << drop) - 1)) * (1 << EL_HIGH_BIT);
    return (whole << (EL_WHOLE_BIT - 16)) + (uint32_t)(high >> drop) + (uint32_t)((low + 0x8000) >> 16);
}

/* A colour channel, 0 to 255 in 8.8. Rounded are the offset to the centre of the first corner's pixel and what a pixel is,
 * which are added up from there. Leaves its gradient to the caller. */
static inline void el_small_channel_make_from(el_channel *channel, const el_small_frame *frame, int32_t v0, int32_t v1,
                                              int32_t v2, el_small_quotient *x_gradient, el_small_quotient *y_gradient)
{
    const el_small_gradient g = el_small_gradient_make(frame, v1 - v0, v2 - v0);
    const el_small_quotient per_x = el_divide_small(g.along_x, &frame->area);
    const el_small_quotient per_y = el_divide_small(g.along_y, &frame->area);
    *x_gradient = per_x;
    *y_gradient = per_y;
    const int32_t column = frame->x0 >> EL_SUBPIXEL_BITS;
    const int32_t row = frame->y0 >> EL_SUBPIXEL_BITS;
    const int32_t to_centre_x = column * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->x0;
    const int32_t to_centre_y = row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->y0;
    const uint32_t offset = el_quotients_times(&per_x, to_centre_x, &per_y, to_centre_y);
    const uint32_t dx = el_quotient_per_pixel(&per_x);
    const uint32_t dy = el_quotient_per_pixel(&per_y);
    channel->dx = dx;
    channel->dy = dy;
    channel->value =
        ((uint32_t)v0 << 16) + EL_CHANNEL_HALF + offset + dx * (uint32_t)-column + dy * (uint32_t)(frame->row - row);
}

static inline void el_small_channel_make(el_channel *channel, const el_small_frame *frame, int32_t v0, int32_t v1,
                                         int32_t v2)
{
    el_small_quotient per_x;
    el_small_quotient per_y;
    el_small_channel_make_from(channel, frame, v0, v1, v2, &per_x, &per_y);
}

#ifdef __cplusplus
}
#endif

#endif
#endif
