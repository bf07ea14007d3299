
#include <stddef.h>

#include "base/fixed.h"
#include "raster/fill.h"

_Static_assert((EL_EDGE_MAX_ROWS + 3LL) * (EL_SUBPIXEL_BITS == 4 ? 16 : 1) * 2 * EL_GUARD_SUB < 1LL << 32,
               "what is cut off on the way is less than a step of the grid");

uint32_t el_triangle_bytes(el_shading shading)
{
    if (el_has_texture(shading)) {
        return sizeof(el_triangle);
    }
    return el_has_colours(shading) ? offsetof(el_triangle, perspective) : offsetof(el_triangle, rgb);
}

static inline void put_in_order(const el_corner **first, const el_corner **second)
{
    const el_corner *const a = *first;
    const el_corner *const b = *second;
    if (a->y > b->y || (a->y == b->y && a->x > b->x)) {
        *first = b;
        *second = a;
    }
}

/* Corners from the top to the bottom, and from left to right where they are level: whichever corner the caller began
 * with, the arithmetic below is the same. */
static inline void sort_corners(const el_corner corners[3], const el_corner *sorted[3])
{
    for (unsigned i = 0; i < 3; i++) {
        sorted[i] = &corners[i];
    }
    put_in_order(&sorted[0], &sorted[1]);
    put_in_order(&sorted[1], &sorted[2]);
    put_in_order(&sorted[0], &sorted[1]);
}

/* u/w and v/w at the corners, relative to the middle of their range, scaled so that |U| < 2^31, with
 * EL_PLANE_FRACTION_BITS bits of fraction. */
static void divide_texture_coordinate(const int32_t coordinates_q16[3], const uint32_t w[3], int32_t *base_q16,
                                      uint8_t *shift, int64_t values[3])
{
    int32_t least = coordinates_q16[0];
    int32_t most = coordinates_q16[0];
    for (unsigned i = 1; i < 3; i++) {
        least = el_min_i32(least, coordinates_q16[i]);
        most = el_max_i32(most, coordinates_q16[i]);
    }
    *base_q16 = (least + most) >> 1; /* |u| < 2^27 */
    const int bits = el_bit_length_u32((uint32_t)(most - *base_q16));
    /* Not so few that the extra fraction would have to be shifted the other way; at most 27. */
    *shift = (uint8_t)el_max_i32(bits, EL_PLANE_FRACTION_BITS);
    for (unsigned i = 0; i < 3; i++) {
        /* |difference| <= 2^shift - 1 and w <= 2^31 - 1: the product is below 2^58, and the quotient stays below 2^31
         * when it is rounded. */
        const int64_t product = (int64_t)(coordinates_q16[i] - *base_q16) * w[i];
        values[i] = el_shift_i64(product, *shift - EL_PLANE_FRACTION_BITS);
    }
}

static void make_perspective(el_perspective *perspective, const el_corner *const corners[3],
                             const el_plane_frame *frame)
{
    int32_t u_q16[3];
    int32_t v_q16[3];
    uint32_t w[3];
    for (unsigned i = 0; i < 3; i++) {
        u_q16[i] = corners[i]->u_q16;
        v_q16[i] = corners[i]->v_q16;
        w[i] = corners[i]->w;
    }
    /* 1/w with its largest corner just below 2^31. */
    const int shift = 31 - el_bit_length_u32(w[0] | w[1] | w[2]);
    int64_t values[3];
    for (unsigned i = 0; i < 3; i++) {
        w[i] <<= shift;
        values[i] = w[i];
    }
    el_plane_make(&perspective->w, frame, values, 0);
    divide_texture_coordinate(u_q16, w, &perspective->u_base_q16, &perspective->u_shift, values);
    el_plane_make(&perspective->u, frame, values, EL_PLANE_FRACTION_BITS);
    divide_texture_coordinate(v_q16, w, &perspective->v_base_q16, &perspective->v_shift, values);
    el_plane_make(&perspective->v, frame, values, EL_PLANE_FRACTION_BITS);
}

static void make_planes(el_triangle *triangle, const el_corner *const corners[3], const el_plane_frame *frame)
{
    const el_shading shading = triangle->surface.shading;
    if (triangle->surface.depth) {
        const uint16_t z[3] = {corners[0]->z, corners[1]->z, corners[2]->z};
        el_plane_make_u16(&triangle->z, frame, z);
    }
    if (el_has_colours(shading)) {
        for (unsigned i = 0; i < 3; i++) {
            const uint16_t values[3] = {corners[0]->rgb_q8[i], corners[1]->rgb_q8[i], corners[2]->rgb_q8[i]};
            el_channel_make(&triangle->rgb[i], frame, values);
        }
    }
    if (el_has_texture(shading)) {
        make_perspective(&triangle->perspective, corners, frame);
    }
}

bool el_triangle_setup(el_triangle *triangle, const el_corner corners[3], const el_surface *surface, int32_t first_row)
{
    const el_corner *sorted[3];
    sort_corners(corners, sorted);
    const int32_t x[3] = {sorted[0]->x, sorted[1]->x, sorted[2]->x};
    const int32_t y[3] = {sorted[0]->y, sorted[1]->y, sorted[2]->y};
    const int32_t y_begin = el_max_i32(first_row, el_first_centre(y[0]));
    const int32_t y_middle = el_first_centre(y[1]);
    const int32_t y_end = el_first_centre(y[2]);
    const int64_t area = el_doubled_area(x, y);
    if (y_begin >= y_end || area == 0) {
        return false;
    }
    triangle->surface = *surface;
    triangle->kind = el_fill_kind(surface);
    triangle->y = (int16_t)y_begin;
    triangle->y_middle = (int16_t)y_middle;
    triangle->y_end = (int16_t)y_end;
    triangle->x_begin = (int16_t)el_first_centre(el_min_i32(x[0], el_min_i32(x[1], x[2])));
    triangle->x_end = (int16_t)el_first_centre(el_max_i32(x[0], el_max_i32(x[1], x[2])));
    /* With y down, a positive area means that the middle corner is on the right of the long edge. */
    triangle->short_is_left = area < 0;
    el_edge *const short_edge = triangle->short_is_left ? &triangle->left : &triangle->right;
    el_edge *const long_edge = triangle->short_is_left ? &triangle->right : &triangle->left;
    el_edge_make(long_edge, x[0], y[0], x[2], y[2], y_begin);
    if (y_begin < y_middle) {
        el_edge_make(short_edge, x[0], y[0], x[1], y[1], y_begin);
        if (y_middle < y_end) {
            el_edge_make(&triangle->lower, x[1], y[1], x[2], y[2], y_middle);
        } else {
            triangle->y_middle = INT16_MAX;
        }
    } else {
        el_edge_make(short_edge, x[1], y[1], x[2], y[2], y_begin);
        triangle->y_middle = INT16_MAX;
    }

    el_plane_frame frame;
    el_plane_frame_make(&frame, x, y);
    frame.x = 0;
    frame.row = y_begin;
    make_planes(triangle, sorted, &frame);
    return true;
}
