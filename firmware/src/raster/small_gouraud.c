#include "raster/small_gouraud.h"

#include "base/fixed.h"
#include "raster/fill.h"

#if EL_WITH_SMALL_GOURAUD

/* Armv6-M computes with eight registers, and can add from the others: where what is only added belongs. */
#if defined(__ARM_ARCH_6M__) && !EL_SMALL_CODE
#define LAY_ASIDE(value) __asm__("" : "+h"(value))
#else
#define LAY_ASIDE(value) ((void)(value))
#endif

enum { KIND = EL_FILL_COLOURS | EL_FILL_DEPTH };

/* A row's first pixel is at most 2^BACK_LOG2 columns to the left of where the row above ended: no small triangle is wider. */
enum { BACK_LOG2 = 6, BACK = 1 << BACK_LOG2 };
_Static_assert((int)EL_EDGE_NARROW < BACK * EL_SUBPIXELS, "so many columns at most");

enum { MAX_ROWS = (EL_EDGE_SHORT + EL_SUBPIXELS) / EL_SUBPIXELS };

/* How a row follows from the one above: so many columns to the right of BACK before its end, so many pixels. */
typedef struct span {
    uint32_t columns, pixels;
} span;

/* Both sides, modulo 2^32: a step beyond the last row may be a long one. And the column where the row above ended less BACK. */
typedef struct walker {
    uint32_t left, right;
    int32_t column;
    uint32_t pixels;
} walker;

/* At least one row. */
static EL_SPECIALISED span *walk_part(walker *w, int32_t left_step, int32_t right_step, span *at, const span *end)
{
    do {
        /* Both are rounded up alike: the right one is never left of the left one. */
        const int32_t x = (int32_t)w->left >> 20;
        const int32_t x_end = (int32_t)w->right >> 20;
        const uint32_t pixels = (uint32_t)(x_end - x);
        at->columns = (uint32_t)(x - w->column);
        at->pixels = pixels;
        w->pixels += pixels;
        w->column = x_end - BACK;
        w->left += (uint32_t)left_step;
        w->right += (uint32_t)right_step;
        at++;
        EL_SETTLE(at);
    } while (at != end);
    return at;
}

/* Walks both sides down to y_stop. Returns the column in which values arrive that follow the spans and go down. */
static EL_SPECIALISED int32_t walk_sides(el_triangle *triangle, int32_t y_stop, bool goes_on, span *spans,
                                         el_stats *stats)
{
    const int32_t y = triangle->y;
    el_edge_q20 left = el_edge_narrowed(&triangle->left);
    el_edge_q20 right = el_edge_narrowed(&triangle->right);
    walker w = {.left = (uint32_t)left.x, .right = (uint32_t)right.x, .column = 0, .pixels = 0};
    span *at = spans;
    if (triangle->y_middle < y_stop) {
        if (triangle->y_middle > y) {
            at = walk_part(&w, left.step, right.step, at, spans + (triangle->y_middle - y));
        }
        const el_edge_q20 lower = el_edge_narrowed(&triangle->lower);
        if (triangle->short_is_left) {
            w.left = (uint32_t)lower.x;
            left.step = lower.step;
        } else {
            w.right = (uint32_t)lower.x;
            right.step = lower.step;
        }
        triangle->y_middle = INT16_MAX;
    }
    (void)walk_part(&w, left.step, right.step, at, spans + (y_stop - y));
    el_count(&stats->pixels, w.pixels);
    if (goes_on) {
        el_edge_widen(&triangle->left, (el_edge_q20){.x = (int32_t)w.left, .step = left.step});
        el_edge_widen(&triangle->right, (el_edge_q20){.x = (int32_t)w.right, .step = right.step});
    }
    return w.column;
}

/* `columns` to the right, 0 to the widest screen's. `z_low`: the lower half of a column's z, settled, so that its
 * product is added in the instruction that makes it where there is one. */
static EL_SPECIALISED void move_right(el_values *v, const el_values *per_column, uint32_t z_low, uint32_t columns)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    (void)z_low;
    v->z += el_multiply_u16(per_column->z, columns);
#else
    v->z += (uint64_t)z_low * columns;
    const uint32_t high = (uint32_t)(v->z >> 32) + (uint32_t)(per_column->z >> 32) * columns;
    v->z = (uint64_t)high << 32 | (uint32_t)v->z;
#endif
    v->red += per_column->red * columns;
    v->green += per_column->green * columns;
    v->blue += per_column->blue * columns;
}

/* What moves values down a row and BACK columns to the left. */
static EL_SPECIALISED el_values down_and_back(const el_slopes *s)
{
    return (el_values){
        .z = s->per_row.z - (s->per_column.z << BACK_LOG2),
        .red = s->per_row.red - (s->per_column.red << BACK_LOG2),
        .green = s->per_row.green - (s->per_column.green << BACK_LOG2),
        .blue = s->per_row.blue - (s->per_column.blue << BACK_LOG2),
    };
}

/* Values are walked from pixel to pixel, and from a row's end to where the next one begins: no row's beginning is kept. */
void el_small_gouraud_draw(el_triangle *triangle, const el_target *target, el_stats *stats)
{
    const int32_t y = triangle->y;
    const int32_t y_stop = el_min_i32(triangle->y_end, target->y_end);
    const bool goes_on = y_stop < triangle->y_end;
    if (y >= y_stop) {
        return;
    }
    span spans[MAX_ROWS];
    const int32_t column = walk_sides(triangle, y_stop, goes_on, spans, stats);
    triangle->y = (int16_t)y_stop;
    const el_cursor cursor = el_cursor_at(target, y, KIND);
    uint16_t *at = cursor.row;
    const int32_t row_step = target->width - BACK;
    const span *next = spans;
    const span *const end_of_rows = spans + (y_stop - y);
    el_slopes s = el_slopes_of(triangle, KIND);
    const el_values per_row = down_and_back(&s);
    el_values v = s.first;
    uint32_t z_low = (uint32_t)s.per_column.z;
    EL_SETTLE(z_low);
    s.per_column.z = s.per_column.z >> 32 << 32 | z_low;
    uint32_t empty = 0;
    for (;;) {
        const span row = *next++;
        /* NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage): walk_sides made a span of each row. */
        move_right(&v, &s.per_column, z_low, row.columns);
        at += row.columns;
        uint16_t *pixel = at;
        at += row.pixels;
        if (pixel != at) {
            do {
                const uint32_t depth = (uint32_t)(v.z >> 32);
                if (depth < *pixel) {
                    EL_KEEP_BRANCH();
                    *pixel = (uint16_t)depth;
                    *el_colour_at(&cursor, pixel) = (uint16_t)el_coloured(&v);
                }
                LAY_ASIDE(s.per_column.red);
                LAY_ASIDE(s.per_column.green);
                LAY_ASIDE(s.per_column.blue);
                el_values_add(&v, &s.per_column, KIND);
                EL_ADD_UP(v.red);
                EL_ADD_UP(v.green);
                EL_ADD_UP(v.blue);
                EL_ADD_UP(v.z);
            } while (++pixel != at);
        } else {
            empty++;
        }
        if (next == end_of_rows) {
            break;
        }
        el_values_add(&v, &per_row, KIND);
        at += row_step;
    }
    el_count(&stats->rows, (uint32_t)(y_stop - y));
    el_count(&stats->spans, (uint32_t)(y_stop - y) - empty);
    if (goes_on) {
        el_values_add(&v, &per_row, KIND);
        triangle->z.value = v.z - EL_HALF_Q32 - el_multiply_u64(s.per_column.z, column);
        triangle->rgb[0].value = v.red - s.per_column.red * (uint32_t)column;
        triangle->rgb[1].value = v.green - s.per_column.green * (uint32_t)column;
        triangle->rgb[2].value = v.blue - s.per_column.blue * (uint32_t)column;
    }
}

#endif
