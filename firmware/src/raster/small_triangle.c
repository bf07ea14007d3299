#include "raster/small_triangle.h"

#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/gather.h"
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

/* Rows of a triangle: its sides where the next one crosses them, the lower part's other edge, and its depth. */
typedef struct sides {
    el_edge_q20 left, right, lower;
    bool short_is_left;
    el_plane z; /* its half added */
} sides;

/* Draws the rows [y, y_stop), where at y_bend, unless that is y_stop, the lower edge follows on the side that is bent; and moves
 * the sides on to y_stop. */
static EL_SPECIALISED void draw_rows(sides *s, const el_target *target, int32_t y, int32_t y_bend, int32_t y_stop,
                                     uint16_t colour, el_stats *stats)
{
    const int32_t width = target->width;
    const el_cursor cursor = el_cursor_at(target, y, EL_FILL_DEPTH);
    uint16_t *row = cursor.row;
    const uint16_t *const end_of_rows = row + (y_stop - y) * width;
    const uint16_t *end_of_part = row + (y_bend - y) * width;
    uint32_t pixels = 0;
    uint32_t empty = 0;
    for (;;) {
        if (row == end_of_part) {
            if (row == end_of_rows) {
                break;
            }
            end_of_part = end_of_rows;
            if (s->short_is_left) {
                s->left = s->lower;
            } else {
                s->right = s->lower;
            }
        }
        /* Both are rounded up alike: the right one is never left of the left one. */
        const int32_t x = s->left.x >> 20;
        const int32_t x_end = s->right.x >> 20;
        if (x != x_end) {
            uint16_t *at = row + x;
            const uint16_t *const end = row + x_end;
            pixels += (uint32_t)(x_end - x);
            uint64_t z = s->z.value + el_multiply_u16(s->z.dx, (uint32_t)x);
            do {
                const uint32_t depth = (uint32_t)(z >> 32);
                if (depth < *at) {
                    EL_KEEP_BRANCH();
                    *at = (uint16_t)depth;
                    *el_colour_at(&cursor, at) = colour;
                }
                z += s->z.dx;
            } while (++at != end);
        } else {
            empty++;
        }
        s->left.x += s->left.step;
        s->right.x += s->right.step;
        s->z.value += s->z.dy;
        row += width;
    }
    el_count(&stats->rows, (uint32_t)(y_stop - y));
    el_count(&stats->spans, (uint32_t)(y_stop - y) - empty);
    el_count(&stats->pixels, pixels);
}

/* What is kept of the sides for the rows from y_stop on. */
static inline void keep_sides(el_triangle *rest, const sides *s, int32_t y_stop)
{
    rest->y = (int16_t)y_stop;
    el_edge_widen(&rest->left, s->left);
    el_edge_widen(&rest->right, s->right);
    rest->z.value = s->z.value - EL_HALF_Q32;
}

void el_small_triangle_go_on(el_triangle *triangle, const el_target *target, el_stats *stats)
{
    const int32_t y = triangle->y;
    const int32_t y_stop = el_min_i32(triangle->y_end, target->y_end);
    const int32_t y_middle = triangle->y_middle;
    if (y >= y_stop) {
        return;
    }
    sides s = {
        .left = el_edge_narrowed(&triangle->left),
        .right = el_edge_narrowed(&triangle->right),
        .lower = {0, 0},
        .short_is_left = triangle->short_is_left,
        .z = {.value = triangle->z.value + EL_HALF_Q32, .dx = triangle->z.dx, .dy = triangle->z.dy},
    };
    if (y_middle < y_stop) {
        s.lower = el_edge_narrowed(&triangle->lower);
        triangle->y_middle = INT16_MAX;
    }
    draw_rows(&s, target, y, el_min_i32(y_middle, y_stop), y_stop, triangle->surface.colour, stats);
    if (y_stop < triangle->y_end) {
        keep_sides(triangle, &s, y_stop);
    } else {
        triangle->y = (int16_t)y_stop;
    }
}

bool el_small_triangle_draw(const el_record *record, const el_run_look *look, const el_target *target, el_stats *stats,
                            el_triangle *rest)
{
    corner top = corner_of(&record->at.points[0]);
    corner middle = corner_of(&record->at.points[1]);
    corner bottom = corner_of(&record->at.points[2]);
    put_in_order(&top, &middle);
    put_in_order(&middle, &bottom);
    put_in_order(&top, &middle);

    const int32_t y_begin = el_max_i32(target->y, el_first_centre(y_of(&top)));
    const int32_t y_end = el_first_centre(y_of(&bottom));
    const int32_t y_stop = el_min_i32(y_end, target->y_end);
    const el_small_shape shape = {
        .dx1 = x_of(&middle) - x_of(&top),
        .dy1 = y_of(&middle) - y_of(&top),
        .dx2 = x_of(&bottom) - x_of(&top),
        .dy2 = y_of(&bottom) - y_of(&top),
    };
    const int32_t x_least = el_min_i32(x_of(&top), el_min_i32(x_of(&middle), x_of(&bottom)));
    const int32_t x_most = el_max_i32(x_of(&top), el_max_i32(x_of(&middle), x_of(&bottom)));
    /* el_shape_is_small, by the box that is asked for here besides. */
    if (y_begin >= y_stop || shape.dy2 > EL_EDGE_SHORT || x_most - x_least > EL_EDGE_NARROW || x_least < 0 ||
        x_most > target->width * EL_SUBPIXELS) {
        return false;
    }
    const int32_t area = el_small_area(&shape);
    if (area == 0) {
        return false;
    }

    const uint16_t colour = el_flat_colour(look, record);
    const el_small_frame frame = {
        .shape = shape,
        .x0 = x_of(&top),
        .y0 = y_of(&top),
        .row = y_begin,
        .area = el_small_divisor_make(area),
    };
    const int32_t y_middle = el_first_centre(y_of(&middle));
    const el_edge_q20 straight = edge_between(&top, &bottom, y_begin);
    el_edge_q20 lower = straight;
    if (y_middle < y_end) {
        lower = edge_between(&middle, &bottom, el_max_i32(y_begin, y_middle));
    }
    el_edge_q20 bent = lower;
    int32_t y_bend = y_stop;
    if (y_begin < y_middle) {
        bent = edge_between(&top, &middle, y_begin);
        y_bend = el_min_i32(y_middle, y_stop);
    }
    sides s = {
        .left = area < 0 ? bent : straight,
        .right = area < 0 ? straight : bent,
        .lower = lower,
        .short_is_left = area < 0,
    };
    el_small_plane_make(&s.z, &frame, top.z, middle.z, bottom.z);
    s.z.value += EL_HALF_Q32;
    draw_rows(&s, target, y_begin, y_bend, y_stop, colour, stats);
    if (rest != NULL) {
        rest->surface = (el_surface){.shading = EL_SHADE_FLAT, .depth = true, .colour = colour};
        rest->y_middle = (int16_t)(y_stop <= y_middle && y_middle < y_end ? y_middle : INT16_MAX);
        rest->y_end = (int16_t)y_end;
        rest->x_begin = (int16_t)el_first_centre(x_least);
        rest->x_end = (int16_t)el_first_centre(x_most);
        rest->kind = EL_FILL_DEPTH;
        rest->short_is_left = area < 0;
        rest->edges_are_short = true;
        el_edge_widen(&rest->lower, lower);
        rest->z = s.z;
        keep_sides(rest, &s, y_stop);
    }
    return true;
}

#endif
