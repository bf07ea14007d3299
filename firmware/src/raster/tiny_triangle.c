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

/* Moved a row down by a step, on a screen of that width. */
static inline el_edge_q18 edge_between(const corner *from, const corner *to, int32_t row, uint32_t width)
{
    el_edge_q18 edge = el_edge_make_q18(x_of(from), y_of(from), x_of(to), y_of(to), row);
    edge.step += width << 18;
    return edge;
}

static inline int32_t magnitude(int32_t a)
{
    return a < 0 ? -a : a;
}

/* The row so many above one of the target's: it may be above all of them, and then only what is far enough behind it is in
 * memory. */
static inline el_cursor cursor_at(const el_target *target, int32_t row, int32_t rows_above)
{
    const int32_t pixels = (row - target->y - rows_above) * target->width; /* |rows| < 2^11 */
    const uintptr_t depth = (uintptr_t)target->depth;
    return (el_cursor){
        /* A sum of numbers, as there is no pointer to where nothing is. NOLINTNEXTLINE(performance-no-int-to-ptr) */
        .row = (uint16_t *)(depth + (uintptr_t)pixels * sizeof(uint16_t)),
        .to_colour = (uintptr_t)target->colour - depth,
    };
}

/* What is counted of a band's rows, in one word: 32 pixels of 17 rows at most. */
enum { ONE_EMPTY_ROW = 1 << 12, ONE_ROW = 1 << 20 };

/* Draws so many of the rows that are left, the lower part's edge following after upper_rows of them. `first` is the row where the
 * triangle was set up. Returns whether there are more, and has moved on to them then. */
static EL_SPECIALISED bool draw_rows(el_tiny_triangle *t, el_cursor first, int32_t rows, int32_t upper_rows,
                                     int32_t rows_left, el_stats *stats)
{
    const uint32_t base = (uint32_t)t->z.base;
    const uint16_t colour = t->colour;
    const uint32_t dx = t->z.dx;
    const uint32_t dy = t->z.dy;
    uint32_t z_row = t->z.value;
    el_edge_q18 left = t->left;
    el_edge_q18 right = t->right;
    bool bends = upper_rows <= rows;
    int32_t counts = ((bends ? upper_rows : rows) - 1) * ONE_ROW;
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
                EL_KEEP_BRANCH();
                counts += ONE_EMPTY_ROW;
            }
            left.x += left.step;
            right.x += right.step;
            z_row += dy;
            counts -= ONE_ROW;
        } while (counts >= 0);
        if (!bends) {
            break;
        }
        bends = false;
        if (t->short_is_left) {
            left = t->lower;
        } else {
            right = t->lower;
        }
        if (upper_rows == rows) {
            break;
        }
        counts += (rows - upper_rows) * ONE_ROW;
    }
    const uint32_t counted = (uint32_t)(counts + ONE_ROW);
    el_count(&stats->rows, (uint32_t)rows);
    el_count(&stats->spans, (uint32_t)rows - counted / ONE_EMPTY_ROW);
    el_count(&stats->pixels, counted % ONE_EMPTY_ROW);
    if (rows == rows_left) {
        return false;
    }
    t->left = left;
    t->right = right;
    t->z.value = z_row;
    t->rows = (uint8_t)(rows_left - rows);
    t->upper_rows = (uint8_t)(upper_rows > rows ? upper_rows - rows : EL_TINY_NO_BEND);
    return true;
}

el_tiny_result el_tiny_triangle_draw(const el_record *record, const el_run_look *look, const el_target *target,
                                     el_stats *stats, el_tiny_triangle *rest)
{
    corner top = corner_of(&record->at.points[0]);
    corner middle = corner_of(&record->at.points[1]);
    corner bottom = corner_of(&record->at.points[2]);
    /* Negative, or beyond the last column: the difference to it borrows in the lower half alone then. */
    const uint32_t last = look->last_corner;
    if (((top.y_x | middle.y_x | bottom.y_x | (last - top.y_x) | (last - middle.y_x) | (last - bottom.y_x)) &
         0x80008000U) != 0) {
        return EL_TINY_REFUSED;
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
    const int32_t y = el_max_i32(target->y, el_first_centre(y_of(&top)));
    const int32_t y_end = el_first_centre(y_of(&bottom));
    const int32_t rows = el_min_i32(y_end, target->y_end) - y;
    el_tiny_triangle t;
    if (rows <= 0 || shape.dy2 > EL_TINY_HIGH || shape.width_height > EL_TINY_LONG || shape.area == 0 ||
        magnitude(shape.area) * (shape.width_height + 2 * EL_SUBPIXELS) >= EL_TINY_MOST ||
        !el_tiny_plane_make(&t.z, &shape, x_of(&top), y_of(&top), y, top.z, middle.z - top.z, bottom.z - top.z)) {
        return EL_TINY_REFUSED;
    }
    const uint32_t width = (uint32_t)target->width;
    const int32_t y_middle = el_first_centre(y_of(&middle));
    int32_t upper_rows = EL_TINY_NO_BEND;
    t.z.dy -= t.z.dx * width;
    t.short_is_left = shape.area < 0;
    const el_edge_q18 straight = edge_between(&top, &bottom, y, width);
    t.lower = straight;
    if (y_middle < y_end) {
        t.lower = edge_between(&middle, &bottom, el_max_i32(y, y_middle), width);
    }
    el_edge_q18 bent = t.lower;
    if (y < y_middle) {
        bent = edge_between(&top, &middle, y, width);
        if (y_middle < y_end) {
            upper_rows = y_middle - y;
            t.lower.x += ((uint32_t)upper_rows * width) << 18;
        }
    }
    t.left = t.short_is_left ? bent : straight;
    t.right = t.short_is_left ? straight : bent;
    t.colour = el_flat_colour(look, record);
    el_count(&stats->setups, 1);
    if (!draw_rows(&t, cursor_at(target, y, 0), rows, upper_rows, y_end - y, stats)) {
        return EL_TINY_DRAWN;
    }
    t.rows_above = (uint8_t)rows;
    *rest = t;
    return EL_TINY_REACHES_ON;
}

bool el_tiny_triangle_go_on(el_tiny_triangle *rest, const el_target *target, el_stats *stats)
{
    const int32_t rows_left = rest->rows;
    const int32_t rows = el_min_i32(rows_left, target->y_end - target->y);
    const el_cursor first = cursor_at(target, target->y, rest->rows_above);
    rest->rows_above = (uint8_t)(rest->rows_above + rows);
    return draw_rows(rest, first, rows, rest->upper_rows, rows_left, stats);
}

#endif
