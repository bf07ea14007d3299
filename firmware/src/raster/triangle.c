/* Set-up: from three corners to edges and planes. Small triangles, which are most of a mesh, take a way of their own
 * (small_plane.h, short edges of edge.h) that leads to the same pixels with the arithmetic of one register. */
#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/small_plane.h"

_Static_assert((EL_EDGE_MAX_ROWS + 3LL) * (EL_SUBPIXEL_BITS == 4 ? 16 : 1) * 2 * EL_GUARD_SUB < 1LL << 32,
               "what is cut off on the way is less than a step of the grid");

uint32_t el_triangle_bytes(el_shading shading)
{
    if (el_has_texture(shading)) {
        return sizeof(el_triangle);
    }
    return el_has_colours(shading) ? offsetof(el_triangle, perspective) : offsetof(el_triangle, rgb);
}

/* A triangle's corners from the top to the bottom, and from left to right where they are level: whichever corner the
 * caller began with, the arithmetic below is the same. */
typedef struct outline {
    const el_corner *top, *middle, *bottom;
} outline;

static inline void put_in_order(const el_corner **first, const el_corner **second)
{
    const el_corner *const a = *first;
    const el_corner *const b = *second;
    if (a->y > b->y || (a->y == b->y && a->x > b->x)) {
        *first = b;
        *second = a;
    }
}

static inline outline sort_corners(const el_corner corners[3])
{
    outline o = {.top = &corners[0], .middle = &corners[1], .bottom = &corners[2]};
    put_in_order(&o.top, &o.middle);
    put_in_order(&o.middle, &o.bottom);
    put_in_order(&o.top, &o.middle);
    return o;
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

/* What is linear on the screen, of any triangle: the textured part, and the others unless they are there already. */
static EL_APART void make_planes(el_triangle *triangle, const outline *sorted, bool texture_alone)
{
    const el_corner *const corners[3] = {sorted->top, sorted->middle, sorted->bottom};
    const int32_t x[3] = {corners[0]->x, corners[1]->x, corners[2]->x};
    const int32_t y[3] = {corners[0]->y, corners[1]->y, corners[2]->y};
    el_plane_frame frame;
    el_plane_frame_make(&frame, x, y);
    frame.x = 0;
    frame.row = triangle->y;
    if (triangle->surface.depth && !texture_alone) {
        const uint16_t z[3] = {corners[0]->z, corners[1]->z, corners[2]->z};
        el_plane_make_u16(&triangle->z, &frame, z);
    }
    if (el_has_colours(triangle->surface.shading) && !texture_alone) {
        for (unsigned i = 0; i < 3; i++) {
            const uint16_t values[3] = {corners[0]->rgb_q8[i], corners[1]->rgb_q8[i], corners[2]->rgb_q8[i]};
            el_channel_make(&triangle->rgb[i], &frame, values);
        }
    }
    if (el_has_texture(triangle->surface.shading)) {
        make_perspective(&triangle->perspective, corners, &frame);
    }
}

static EL_SPECIALISED void make_edge(el_edge *edge, const el_corner *from, const el_corner *to, int32_t row,
                                     bool edges_are_short)
{
#if EL_WITH_SMALL_PLANES
    if (edges_are_short) {
        el_edge_make_short(edge, from->x, from->y, to->x, to->y, row);
        return;
    }
#endif
    (void)edges_are_short;
    el_edge_make(edge, from->x, from->y, to->x, to->y, row);
}

/* All but the planes, from row y_begin on. */
static EL_SPECIALISED void begin(el_triangle *triangle, const outline *o, const el_surface *surface, int32_t y_begin,
                                 bool short_is_left, bool edges_are_short)
{
    const int32_t y_middle = el_first_centre(o->middle->y);
    const int32_t y_end = el_first_centre(o->bottom->y);
    triangle->surface = *surface;
    triangle->kind = el_fill_kind(surface);
    triangle->y = (int16_t)y_begin;
    triangle->y_end = (int16_t)y_end;
    triangle->short_is_left = short_is_left;
    triangle->edges_are_short = edges_are_short;
    /* The middle corner can only be beyond the others on its own side. */
    int32_t least = el_min_i32(o->top->x, o->bottom->x);
    int32_t most = el_max_i32(o->top->x, o->bottom->x);
    el_edge *bent = &triangle->right;
    el_edge *straight = &triangle->left;
    if (short_is_left) {
        bent = &triangle->left;
        straight = &triangle->right;
        least = el_min_i32(least, o->middle->x);
    } else {
        most = el_max_i32(most, o->middle->x);
    }
    if (EL_TRIANGLE_HAS_COLUMNS) {
        triangle->x_begin = (int16_t)el_first_centre(least);
        triangle->x_end = (int16_t)el_first_centre(most);
    }
    make_edge(straight, o->top, o->bottom, y_begin, edges_are_short);
    int32_t y_bend = INT16_MAX;
    int32_t y_lower = y_begin;
    if (y_begin < y_middle) {
        make_edge(bent, o->top, o->middle, y_begin, edges_are_short);
        bent = &triangle->lower;
        y_lower = y_middle;
        y_bend = y_middle < y_end ? y_middle : y_bend;
    }
    triangle->y_middle = (int16_t)y_bend;
    if (y_middle < y_end) {
        make_edge(bent, o->middle, o->bottom, y_lower, edges_are_short);
    }
}

/* The way of larger triangles, apart, so that it takes no registers from that of most. */
static EL_APART bool set_up_large(el_triangle *triangle, const outline *o, const el_surface *surface, int32_t y_begin)
{
    const int32_t x[3] = {o->top->x, o->middle->x, o->bottom->x};
    const int32_t y[3] = {o->top->y, o->middle->y, o->bottom->y};
    const int64_t area = el_doubled_area(x, y);
    if (area == 0) {
        return false;
    }
    begin(triangle, o, surface, y_begin, area < 0, false);
    make_planes(triangle, o, false);
    return true;
}

#if EL_WITH_SMALL_PLANES
static inline void make_small_planes(el_triangle *triangle, const outline *o, const el_small_shape *shape, int32_t area)
{
    const el_small_frame frame = {
        .shape = *shape,
        .x0 = o->top->x,
        .y0 = o->top->y,
        .row = triangle->y,
        .area = el_small_divisor_make(area),
    };
    if (triangle->surface.depth) {
        el_small_plane_make(&triangle->z, &frame, o->top->z, o->middle->z, o->bottom->z);
    }
    if (el_has_colours(triangle->surface.shading)) {
        for (unsigned i = 0; i < 3; i++) {
            el_small_channel_make(&triangle->rgb[i], &frame, o->top->rgb_q8[i], o->middle->rgb_q8[i],
                                  o->bottom->rgb_q8[i]);
        }
    }
    if (el_has_texture(triangle->surface.shading)) {
        const outline again = *o;
        make_planes(triangle, &again, true);
    }
}
#endif

bool el_triangle_setup(el_triangle *triangle, const el_corner corners[3], const el_surface *surface, int32_t first_row)
{
    const outline o = sort_corners(corners);
    const int32_t y_begin = el_max_i32(first_row, el_first_centre(o.top->y));
    if (y_begin >= el_first_centre(o.bottom->y)) {
        return false;
    }
#if EL_WITH_SMALL_PLANES
    const el_small_shape shape = {
        .dx1 = o.middle->x - o.top->x,
        .dy1 = o.middle->y - o.top->y,
        .dx2 = o.bottom->x - o.top->x,
        .dy2 = o.bottom->y - o.top->y,
    };
    if (el_shape_is_small(&shape)) {
        const int32_t area = el_small_area(&shape);
        if (area == 0) {
            return false;
        }
        begin(triangle, &o, surface, y_begin, area < 0, true);
        make_small_planes(triangle, &o, &shape, area);
        return true;
    }
#endif
    const outline again = o;
    return set_up_large(triangle, &again, surface, y_begin);
}

#if EL_WITH_SAMPLES
void el_triangle_sort(const el_corner corners[3], const el_corner *sorted[3])
{
    const outline o = sort_corners(corners);
    sorted[0] = o.top;
    sorted[1] = o.middle;
    sorted[2] = o.bottom;
}

void el_triangle_setup_planes(el_triangle *triangle, const el_corner *const sorted[3], const el_surface *surface,
                              int32_t row)
{
    const outline o = {.top = sorted[0], .middle = sorted[1], .bottom = sorted[2]};
    triangle->surface = *surface;
    triangle->kind = el_fill_kind(surface);
    triangle->y = (int16_t)row;
    make_planes(triangle, &o, false);
}
#endif

void el_triangle_take_depth(el_triangle *depth, const el_triangle *triangle)
{
    memcpy(depth, triangle, offsetof(el_triangle, rgb));
    depth->surface.shading = EL_SHADE_FLAT;
    depth->surface.depth = depth->surface.depth && !el_is_mixed(&depth->surface);
    depth->surface.finish = 0;
    depth->kind = el_fill_kind(&depth->surface);
}
