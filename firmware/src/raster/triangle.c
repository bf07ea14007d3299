#include "raster/triangle.h"

#include <stddef.h>

#include "base/fixed.h"

unsigned el_plane_count(el_shading shading)
{
    switch (shading) {
    case EL_SHADE_GOURAUD:
    case EL_SHADE_TEXTURED:
        return 4;
    case EL_SHADE_TEXTURED_GOURAUD:
        return 7;
    default:
        return 1;
    }
}

uint32_t el_triangle_bytes(el_shading shading)
{
    return (uint32_t)(offsetof(el_triangle, planes) + el_plane_count(shading) * sizeof(el_plane));
}

/* Corners from the top to the bottom, and from left to right where they are level: whichever corner the caller began
 * with, the arithmetic below is the same. */
static void sort_corners(const el_corner corners[3], const el_corner *sorted[3])
{
    for (unsigned i = 0; i < 3; i++) {
        unsigned place = i;
        while (place > 0 && (corners[i].y < sorted[place - 1]->y ||
                             (corners[i].y == sorted[place - 1]->y && corners[i].x < sorted[place - 1]->x))) {
            sorted[place] = sorted[place - 1];
            place--;
        }
        sorted[place] = &corners[i];
    }
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

static void make_planes(el_triangle *triangle, const el_corner *const corners[3], const el_plane_frame *frame)
{
    const el_shading shading = triangle->surface.shading;
    const bool textured = shading == EL_SHADE_TEXTURED || shading == EL_SHADE_TEXTURED_GOURAUD;
    int64_t values[EL_MAX_PLANES][3];
    if (textured) {
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
        for (unsigned i = 0; i < 3; i++) {
            w[i] <<= shift;
            values[EL_PLANE_W][i] = w[i];
        }
        divide_texture_coordinate(u_q16, w, &triangle->u_base_q16, &triangle->u_shift, values[EL_PLANE_U]);
        divide_texture_coordinate(v_q16, w, &triangle->v_base_q16, &triangle->v_shift, values[EL_PLANE_V]);
    }
    const unsigned first_colour = textured ? EL_PLANE_LIGHT_RED : EL_PLANE_RED;
    for (unsigned i = 0; i < 3; i++) {
        values[EL_PLANE_Z][i] = corners[i]->z;
        for (unsigned channel = 0; channel < 3; channel++) {
            values[first_colour + channel][i] = corners[i]->rgb_q8[channel];
        }
    }
    /* Without depth its plane is not made, but it is stepped with the others: a loop with one exception costs more. */
    triangle->planes[EL_PLANE_Z] = (el_plane){0};
    const unsigned count = el_plane_count(shading);
    for (unsigned i = triangle->surface.depth ? 0U : 1U; i < count; i++) {
        const bool has_fraction = textured && (i == EL_PLANE_U || i == EL_PLANE_V);
        el_plane_make(&triangle->planes[i], frame, values[i], has_fraction ? EL_PLANE_FRACTION_BITS : 0U);
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
    triangle->y = (int16_t)y_begin;
    triangle->y_middle = (int16_t)y_middle;
    triangle->y_end = (int16_t)y_end;
    /* With y down, a positive area means that the middle corner is on the right of the long edge. */
    triangle->short_is_left = area < 0;
    el_edge *const short_edge = &triangle->edges[triangle->short_is_left ? 0 : 1];
    el_edge *const long_edge = &triangle->edges[triangle->short_is_left ? 1 : 0];
    el_edge_make(long_edge, x[0], y[0], x[2], y[2], y_begin);
    if (y_begin < y_middle) {
        el_edge_make(short_edge, x[0], y[0], x[1], y[1], y_begin);
        if (y_middle < y_end) {
            el_edge_make(&triangle->edges[2], x[1], y[1], x[2], y[2], y_middle);
        }
    } else {
        el_edge_make(short_edge, x[1], y[1], x[2], y[2], y_begin);
        triangle->y_middle = triangle->y_end;
    }

    el_plane_frame frame;
    el_plane_frame_make(&frame, x, y, y_begin);
    make_planes(triangle, sorted, &frame);
    return true;
}
