#include "raster/tiny_triangle.h"

#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/gather.h"

#if EL_WITH_SMALL_PLANES

/* A corner, by what decides its place from the top to the bottom, and from left to right where corners are level. */
typedef struct corner {
    uint32_t y_x; /* y * 2^16 + x, both below 2^15 */
    int32_t z;
} corner;

static inline corner corner_of(const el_point *point)
{
    return (corner){.y_x = (uint32_t)(uint16_t)point->y << 16 | (uint16_t)point->x, .z = point->z};
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
    return (int32_t)(c->y_x & 0xFFFFU);
}

static inline int32_t y_of(const corner *c)
{
    return (int32_t)(c->y_x >> 16);
}

static inline el_edge_q18 edge_between(const corner *from, const corner *to, int32_t row)
{
    return el_edge_make_q18(x_of(from), y_of(from), x_of(to), y_of(to), row);
}

static inline int32_t magnitude(int32_t a)
{
    return a < 0 ? -a : a;
}

/* Its row y, which may be above the target: then only what is far enough behind it is in memory. */
static inline el_cursor cursor_at(const el_target *target, int32_t y)
{
    const uintptr_t depth = (uintptr_t)target->depth;
    return (el_cursor){
        /* A sum of numbers, as there is no pointer to where nothing is. NOLINTNEXTLINE(performance-no-int-to-ptr) */
        .row = (uint16_t *)(depth + (uintptr_t)(intptr_t)((y - target->y) * target->width) * sizeof(uint16_t)),
        .to_colour = (uintptr_t)target->colour - depth,
    };
}

/* What is counted of a band's rows, in one word: 32 pixels of 17 rows at most. */
enum { ONE_EMPTY_ROW = 1 << 12, ONE_ROW = 1 << 20 };

bool el_tiny_triangle_draw(el_tiny_triangle *t, const el_target *target, el_stats *stats)
{
    const int32_t y = el_max_i32(t->y, target->y);
    const int32_t y_stop = el_min_i32(t->y_end, target->y_end);
    const bool bends = t->y_middle <= y_stop;
    int32_t later_rows = bends ? y_stop - t->y_middle : 0;
    int32_t counts = (y_stop - y - later_rows - 1) * ONE_ROW;
    const el_cursor first = cursor_at(target, t->y);
    const uint32_t base = (uint32_t)t->z.base;
    const uint16_t colour = t->colour;
    const uint32_t dx = t->z.dx;
    const uint32_t dy = t->z.dy;
    uint32_t z_row = t->z.value;
    el_edge_q18 left = t->left;
    el_edge_q18 right = t->right;
    for (;;) {
        do {
            /* Both are rounded up alike: the right one is never left of the left one. */
            const uint32_t i = left.x >> 18;
            const uint32_t i_end = right.x >> 18;
            if (i != i_end) {
                uint16_t *at = first.row + i;
                const uint16_t *const end = first.row + i_end;
                uint32_t z = z_row + dx * i;
                counts += (int32_t)(i_end - i);
                do {
                    const uint32_t depth = base + (z >> EL_TINY_FRACTION_BITS);
                    if (depth < *at) {
                        EL_KEEP_BRANCH();
                        *at = (uint16_t)depth;
                        *el_colour_at(&first, at) = colour;
                    }
                    z += dx;
                } while (++at != end);
            } else {
                counts += ONE_EMPTY_ROW;
            }
            left.x += left.step;
            right.x += right.step;
            z_row += dy;
            counts -= ONE_ROW;
        } while (counts >= 0);
        if (later_rows == 0) {
            break;
        }
        counts += later_rows * ONE_ROW;
        later_rows = 0;
        if (t->short_is_left) {
            left = t->lower;
        } else {
            right = t->lower;
        }
    }
    const uint32_t counted = (uint32_t)(counts + ONE_ROW);
    el_count(&stats->rows, (uint32_t)(y_stop - y));
    el_count(&stats->spans, (uint32_t)(y_stop - y) - counted / ONE_EMPTY_ROW);
    el_count(&stats->pixels, counted % ONE_EMPTY_ROW);
    if (y_stop == t->y_end) {
        return false;
    }
    t->left = left;
    t->right = right;
    t->z.value = z_row;
    if (bends) {
        if (t->y_middle == y_stop) {
            *(t->short_is_left ? &t->left : &t->right) = t->lower;
        }
        t->y_middle = UINT16_MAX;
    }
    return true;
}

bool el_tiny_triangle_make(el_tiny_triangle *t, const el_record *record, const el_run_look *look,
                           const el_target *target)
{
    corner top = corner_of(&record->at.points[0]);
    corner middle = corner_of(&record->at.points[1]);
    corner bottom = corner_of(&record->at.points[2]);
    /* Negative, or beyond the last column: the difference to it borrows in the lower half alone then. */
    const uint32_t last = 0x7FFF0000U + (uint32_t)(target->width * EL_SUBPIXELS);
    if (((top.y_x | middle.y_x | bottom.y_x | (last - top.y_x) | (last - middle.y_x) | (last - bottom.y_x)) &
         0x80008000U) != 0) {
        return false;
    }
    put_in_order(&top, &middle);
    put_in_order(&middle, &bottom);
    put_in_order(&top, &middle);

    el_tiny_shape shape = {
        .dx1 = x_of(&middle) - x_of(&top),
        .dy1 = y_of(&middle) - y_of(&top),
        .dx2 = x_of(&bottom) - x_of(&top),
        .dy2 = y_of(&bottom) - y_of(&top),
    };
    /* Of three numbers the range is half of the differences' sum. */
    const int32_t widths = magnitude(shape.dx1) + magnitude(shape.dx2) + magnitude(shape.dx2 - shape.dx1);
    shape.width_height = widths / 2 + shape.dy2;
    shape.area = shape.dx1 * shape.dy2 - shape.dx2 * shape.dy1;
    const int32_t y_begin = el_max_i32(target->y, el_first_centre(y_of(&top)));
    const int32_t y_end = el_first_centre(y_of(&bottom));
    if (y_begin >= el_min_i32(y_end, target->y_end) || shape.dy2 > EL_TINY_HIGH || shape.width_height > EL_TINY_LONG ||
        shape.area == 0 || magnitude(shape.area) * (shape.width_height + 2 * EL_SUBPIXELS) >= EL_TINY_MOST ||
        !el_tiny_plane_make(&t->z, &shape, x_of(&top), y_of(&top), y_begin, top.z, middle.z - top.z,
                            bottom.z - top.z)) {
        return false;
    }
    const uint32_t width = (uint32_t)target->width;
    const int32_t y_middle = el_first_centre(y_of(&middle));
    t->z.dy -= t->z.dx * width;
    t->short_is_left = shape.area < 0;
    t->y = (uint16_t)y_begin;
    t->y_middle = UINT16_MAX;
    t->y_end = (uint16_t)y_end;
    el_edge_q18 *const bent = t->short_is_left ? &t->left : &t->right;
    el_edge_q18 *const straight = t->short_is_left ? &t->right : &t->left;
    *straight = edge_between(&top, &bottom, y_begin);
    straight->step += width << 18;
    if (y_middle < y_end) {
        t->lower = edge_between(&middle, &bottom, el_max_i32(y_begin, y_middle));
        t->lower.step += width << 18;
    }
    if (y_begin < y_middle) {
        *bent = edge_between(&top, &middle, y_begin);
        bent->step += width << 18;
        if (y_middle < y_end) {
            t->lower.x += ((uint32_t)(y_middle - y_begin) * width) << 18;
            t->y_middle = (uint16_t)y_middle;
        }
    } else {
        *bent = t->lower;
    }
    t->colour = el_flat_colour(look, record);
    return true;
}

#endif
