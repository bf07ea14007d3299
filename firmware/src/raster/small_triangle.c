#include "raster/small_triangle.h"

#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/small_plane.h"

#if EL_WITH_SMALL_PLANES

/* A corner, by what decides its place from the top to the bottom, and from left to right where corners are level. */
typedef struct corner {
    int32_t y_x; /* y * 2^16 + x, both of 16 bits: in the order of y, then of x */
    int32_t z;
} corner;

static inline corner corner_of(const el_point *point)
{
    return (corner){.y_x = point->y * (1 << 16) + point->x, .z = point->z};
}

static inline void put_in_order(corner *first, corner *second)
{
    if (first->y_x > second->y_x) {
        const corner other = *first;
        *first = *second;
        *second = other;
    }
}

static inline int32_t x_of(const corner *c)
{
    return (int16_t)c->y_x;
}

static inline int32_t y_of(const corner *c)
{
    return (c->y_x - x_of(c)) >> 16;
}

static inline el_edge_q20 edge_between(const corner *from, const corner *to, int32_t row)
{
    return el_edge_make_q20(x_of(from), y_of(from), x_of(to), y_of(to), row);
}

bool el_small_triangle_draw(const el_point points[3], uint16_t colour, const el_target *target, el_stats *stats,
                            el_triangle *rest)
{
    enum { KIND = EL_FILL_DEPTH };
    corner top = corner_of(&points[0]);
    corner middle = corner_of(&points[1]);
    corner bottom = corner_of(&points[2]);
    put_in_order(&top, &middle);
    put_in_order(&middle, &bottom);
    put_in_order(&top, &middle);

    const int32_t y_begin = el_max_i32(target->y, el_first_centre(y_of(&top)));
    const int32_t y_end = el_first_centre(y_of(&bottom));
    const el_small_shape shape = {
        .dx1 = x_of(&middle) - x_of(&top),
        .dy1 = y_of(&middle) - y_of(&top),
        .dx2 = x_of(&bottom) - x_of(&top),
        .dy2 = y_of(&bottom) - y_of(&top),
    };
    const uint32_t most = (uint32_t)target->width * EL_SUBPIXELS;
    if (y_begin >= y_end || !el_shape_is_small(&shape) || (uint32_t)x_of(&top) > most ||
        (uint32_t)x_of(&middle) > most || (uint32_t)x_of(&bottom) > most) {
        return false;
    }
    const int32_t area = el_small_area(&shape);
    if (area == 0) {
        return false;
    }

    const el_small_frame frame = {
        .shape = shape,
        .x0 = x_of(&top),
        .y0 = y_of(&top),
        .row = y_begin,
        .area = el_small_divisor_make(area),
    };
    el_plane z;
    el_small_plane_make(&z, &frame, top.z, middle.z, bottom.z);
    z.value += EL_HALF_Q32;

    const int32_t width = target->width;
    const el_cursor cursor = el_cursor_at(target, y_begin, KIND);
    uint16_t *row = cursor.row;
    const int32_t y_stop = el_min_i32(y_end, target->y_end);
    const int32_t y_middle = el_first_centre(y_of(&middle));
    const bool short_is_left = area < 0;
    const el_edge_q20 straight = edge_between(&top, &bottom, y_begin);
    el_edge_q20 bent;
    int32_t y_part = y_stop; /* where the part ends that is drawn */
    bool is_lower = true;
    if (y_begin < y_middle) {
        bent = edge_between(&top, &middle, y_begin);
        is_lower = y_middle >= y_end;
        y_part = el_min_i32(y_middle, y_stop);
    } else {
        bent = edge_between(&middle, &bottom, y_begin);
    }
    el_edge_q20 left = short_is_left ? bent : straight;
    el_edge_q20 right = short_is_left ? straight : bent;
    int32_t y = y_begin;
    uint32_t pixels = 0;
    uint32_t empty = 0;
    for (;;) {
        const uint16_t *const part_end = row + (y_part - y) * width;
        while (row != part_end) {
            const int32_t x = left.x >> 20;
            const int32_t count = (right.x >> 20) - x;
            if (count > 0) {
                pixels += (uint32_t)count;
                uint16_t *at = row + x;
                const uint16_t *const end = at + count;
                uint64_t value = z.value + el_multiply_u16(z.dx, (uint32_t)x);
                do {
                    const uint32_t depth = (uint32_t)(value >> 32);
                    if (depth < *at) {
                        EL_KEEP_BRANCH();
                        *at = (uint16_t)depth;
                        *el_colour_at(&cursor, at) = colour;
                    }
                    value += z.dx;
                } while (++at != end);
            } else {
                empty++;
            }
            left.x += left.step;
            right.x += right.step;
            z.value += z.dy;
            row += width;
        }
        y = y_part;
        if (y == y_stop) {
            break;
        }
        y_part = y_stop;
        is_lower = true;
        bent = edge_between(&middle, &bottom, y_middle);
        left = short_is_left ? bent : left;
        right = short_is_left ? right : bent;
    }
    if (rest != NULL) {
        const int32_t last = el_max_i32(x_of(&top), el_max_i32(x_of(&middle), x_of(&bottom)));
        const int32_t first = el_min_i32(x_of(&top), el_min_i32(x_of(&middle), x_of(&bottom)));
        rest->surface = (el_surface){.shading = EL_SHADE_FLAT, .depth = true, .colour = colour};
        rest->y = (int16_t)y_stop;
        rest->y_middle = is_lower ? INT16_MAX : (int16_t)y_middle;
        rest->y_end = (int16_t)y_end;
        rest->x_begin = (int16_t)el_first_centre(first);
        rest->x_end = (int16_t)el_first_centre(last);
        rest->kind = KIND;
        rest->short_is_left = short_is_left;
        el_edge_widen(&rest->left, left);
        el_edge_widen(&rest->right, right);
        if (!is_lower) {
            el_edge_widen(&rest->lower, edge_between(&middle, &bottom, y_middle));
        }
        rest->z = (el_plane){.value = z.value - EL_HALF_Q32, .dx = z.dx, .dy = z.dy};
    }
    el_count(&stats->rows, (uint32_t)(y_stop - y_begin));
    el_count(&stats->spans, (uint32_t)(y_stop - y_begin) - empty);
    el_count(&stats->pixels, pixels);
    return true;
}

#endif
