/* small_sampled.h: rows and pixels. Within a row the samples' crossings with an edge are as far from each other as in any other
 * row, so an edge is walked once, and what leads from there to each sample is a constant. Values are walked from pixel to pixel,
 * and from where a row ends to where the next one begins. */
#include "raster/small_sampled.h"

#include <stddef.h>

#include "base/fixed.h"

#if EL_WITH_SMALL_SAMPLED

typedef el_sampled_side side;
typedef el_small_sampled small_sampled;

/* --- Pixels ------------------------------------------------------------------------------------------------------- */

/* The depth and colour of a pixel, Q16 and RGB565, at its centre, or where a way from there leads. */
static EL_SPECIALISED uint32_t depth_of(const el_values *v, uint64_t way)
{
    return (uint32_t)((v->z + way) >> 32);
}

static EL_SPECIALISED uint32_t colour_of(const small_sampled *s, const el_values *v, const uint32_t way[3],
                                         unsigned kind)
{
    if ((kind & EL_FILL_COLOURS) == 0) {
        return s->flat;
    }
    const el_values there = {.red = v->red + way[0], .green = v->green + way[1], .blue = v->blue + way[2]};
    return el_coloured(&there);
}

/* To and from registers, member by member: a structure would go through memory. */
static EL_SPECIALISED el_values values_of(const small_sampled *s, unsigned kind)
{
    const el_values *const first = &s->slopes.first;
    el_values v;
    v.z = first->z;
    if ((kind & EL_FILL_COLOURS) != 0) {
        v.red = first->red;
        v.green = first->green;
        v.blue = first->blue;
    }
    return v;
}

static EL_SPECIALISED void put_values(small_sampled *s, const el_values *v, unsigned kind)
{
    el_values *const first = &s->slopes.first;
    first->z = v->z;
    if ((kind & EL_FILL_COLOURS) != 0) {
        first->red = v->red;
        first->green = v->green;
        first->blue = v->blue;
    }
}

static EL_SPECIALISED void step_right(small_sampled *s, unsigned kind)
{
    el_values_add(&s->slopes.first, &s->slopes.per_column, kind);
}

static EL_SPECIALISED void step_left(small_sampled *s, unsigned kind)
{
    el_values *const v = &s->slopes.first;
    const el_values *const per_column = &s->slopes.per_column;
    v->z -= per_column->z;
    if ((kind & EL_FILL_COLOURS) != 0) {
        v->red -= per_column->red;
        v->green -= per_column->green;
        v->blue -= per_column->blue;
    }
}

/* To the first sample of a mask that is not 0. */
static EL_SPECIALISED const el_sampled_way *first_way(const small_sampled *s, uint32_t mask, uint32_t count)
{
    /* Of a mask of four, in bytes from the beginning: sum and product are made beforehand. */
    enum {
        WAY = sizeof(el_sampled_way),
        FIRST = offsetof(small_sampled, ways),
        SECOND = FIRST + WAY,
        THIRD = SECOND + WAY,
        FOURTH = THIRD + WAY
    };
    _Static_assert((int)FOURTH < 1 << 8, "in a byte");
    static const uint8_t offsets[16] = {0,      FIRST, SECOND, FIRST, THIRD, FIRST, SECOND, FIRST,
                                        FOURTH, FIRST, SECOND, FIRST, THIRD, FIRST, SECOND, FIRST};
    uint32_t offset = offsets[mask & 15U];
    if (count == 4) {
        offset = offsets[mask];
    } else if ((mask & 15U) == 0) {
        offset = 4U * WAY + offsets[mask >> 4];
    }
    return (const el_sampled_way *)(const void *)((const unsigned char *)s + offset);
}

/* Draws the samples of `mask` of a mixed pixel. */
static EL_SPECIALISED void draw_again(const el_sampled_place *at, uint32_t x, uint32_t mask, uint32_t drawn,
                                      uint32_t count)
{
    uint32_t *const samples = at->samples + x * count;
    const uint32_t z = drawn >> 16;
    const uint32_t taken = at->colour[x];
    if (taken != 0 && (taken ^ mask) == (1U << count) - 1U) {
        /* All of those that another triangle left. */
        if (z < samples[1] >> 16) {
            samples[1] = drawn;
        }
        return;
    }
    el_spread(at, x, count);
    for (uint32_t k = 0; k < count; k++) {
        if ((mask >> k & 1U) != 0 && z < samples[k] >> 16) {
            samples[k] = drawn;
        }
    }
}

/* Draws the samples of `mask`, not 0 and not all, of the pixel where the values are. */
static EL_SPECIALISED void draw_samples(const small_sampled *s, uint32_t pixel, uint32_t mask, uint32_t count,
                                        unsigned kind)
{
    const el_sampled_way *way = first_way(s, mask, count);
    EL_SETTLE(way);
    const el_sampled_place *const at = &s->at;
    const el_values *const v = &s->slopes.first;
    const uint32_t z = depth_of(v, way->z);
    const uint32_t old_depth = at->depth[pixel];
    if (z >= old_depth) {
        if (old_depth != 0 || !el_bit_is_set(at->mixed, pixel)) {
            return;
        }
        draw_again(at, pixel, mask, z << 16 | colour_of(s, v, way->rgb, kind), count);
        return;
    }
    uint32_t *const samples = at->samples + pixel * count;
    samples[0] = z << 16 | colour_of(s, v, way->rgb, kind);
    samples[1] = old_depth << 16 | at->colour[pixel];
    at->depth[pixel] = 0;
    at->colour[pixel] = (uint16_t)mask;
    el_set_bit(at->mixed, pixel);
}

#define PIXELS(DO)                                                                                                     \
    DO(coloured_4, EL_FILL_COLOURS | EL_FILL_DEPTH, 4)                                                                 \
    DO(flat_4, EL_FILL_DEPTH, 4)                                                                                       \
    DO(coloured_8, EL_FILL_COLOURS | EL_FILL_DEPTH, 8)                                                                 \
    DO(flat_8, EL_FILL_DEPTH, 8)

#define DEFINE(name, kind, count)                                                                                      \
    static EL_APART void draw_##name(const small_sampled *s, uint32_t pixel, uint32_t mask)                            \
    {                                                                                                                  \
        draw_samples(s, pixel, mask, count, kind);                                                                     \
    }
PIXELS(DEFINE)

static EL_SPECIALISED void draw_pixel(const small_sampled *s, uint32_t pixel, uint32_t mask, uint32_t count,
                                      unsigned kind)
{
    if (kind == EL_FILL_DEPTH) {
        (count == 4 ? draw_flat_4 : draw_flat_8)(s, pixel, mask);
    } else {
        (count == 4 ? draw_coloured_4 : draw_coloured_8)(s, pixel, mask);
    }
}

/* Which samples of pixel x are covered, where an edge passes between them: those right of it, or where `is_right`, left. */
static EL_SPECIALISED uint32_t mask_beside(const side *edge, uint32_t x, bool is_right, uint32_t count)
{
    const uint32_t before = edge->x - ((x + 1U) << 20);
    uint32_t mask = 0;
    if (count == 4) {
        const uint32_t near = (uint32_t)edge->near;
        return edge->masks[((before - near) >> 31) + ((before + near) >> 31)];
    }
#pragma GCC unroll 8
    for (uint32_t k = 0; k < count; k++) {
        mask |= (before + (uint32_t)edge->at[k]) >> 31 << k;
    }
    return is_right ? mask ^ ((1U << count) - 1U) : mask;
}

/* Of the pixels [pixel, end), which are covered as a whole, those that are mixed. The values are those of `end`. */
static EL_APART void draw_mixed(const small_sampled *s, uint32_t pixel, uint32_t end, uint32_t count)
{
    static const uint32_t nowhere[3] = {0, 0, 0};
    for (; pixel < end; pixel++) {
        if (!el_bit_is_set(s->at.mixed, pixel)) {
            continue;
        }
        const uint32_t back = end - pixel;
        const el_values *const first = &s->slopes.first;
        const el_values *const per_column = &s->slopes.per_column;
        const el_values v = {
            .z = first->z - el_multiply_u16(per_column->z, back),
            .red = first->red - per_column->red * back,
            .green = first->green - per_column->green * back,
            .blue = first->blue - per_column->blue * back,
        };
        const uint32_t drawn = depth_of(&v, 0) << 16 | colour_of(s, &v, nowhere, s->kind);
        draw_again(&s->at, pixel, (1U << count) - 1U, drawn, count);
        el_unmix(&s->at, pixel, count);
    }
}

/* Pixels [pixel, end), one at least, covered as a whole, but for mixed ones. The values are those of the pixel before, and are
 * moved on to `end`. Returns whether any may be mixed. */
static EL_SPECIALISED bool draw_inner(small_sampled *s, uint32_t pixel, uint32_t end_pixel, unsigned kind)
{
    bool any_at_0 = false;
    uint16_t *depth = s->at.depth + pixel;
    const uint16_t *const end = s->at.depth + end_pixel;
    const el_cursor cursor = {.to_colour = (uintptr_t)s->at.colour - (uintptr_t)s->at.depth};
    const el_values step = s->slopes.per_column;
    const uint16_t flat = s->flat;
    el_values v = values_of(s, kind);
    el_values_add(&v, &step, kind);
    do {
        const uint32_t old = *depth;
        const uint32_t z = (uint32_t)(v.z >> 32);
        if (z < old) {
            EL_KEEP_BRANCH();
            *depth = (uint16_t)z;
            *el_colour_at(&cursor, depth) = (kind & EL_FILL_COLOURS) != 0 ? (uint16_t)el_coloured(&v) : flat;
        } else if (old == 0) {
            EL_KEEP_BRANCH();
            any_at_0 = true;
        }
        el_values_add(&v, &step, kind);
    } while (++depth != end);
    put_values(s, &v, kind);
    return any_at_0;
}

static EL_APART bool draw_inner_coloured(small_sampled *s, uint32_t pixel, uint32_t end)
{
    return draw_inner(s, pixel, end, EL_FILL_COLOURS | EL_FILL_DEPTH);
}

static EL_APART bool draw_inner_flat(small_sampled *s, uint32_t pixel, uint32_t end)
{
    return draw_inner(s, pixel, end, EL_FILL_DEPTH);
}

static EL_SPECIALISED void draw_whole(small_sampled *s, uint32_t pixel, uint32_t end, uint32_t count, unsigned kind)
{
    if (kind == EL_FILL_DEPTH ? draw_inner_flat(s, pixel, end) : draw_inner_coloured(s, pixel, end)) {
        draw_mixed(s, pixel, end, count);
    }
}

/* --- Rows --------------------------------------------------------------------------------------------------------- */

/* Moves the values from the row above to column x. */
static EL_SPECIALISED void move_down_as(small_sampled *s, uint32_t x, unsigned kind)
{
    const uint32_t columns = x - (uint32_t)s->column; /* below 2^16 */
    const el_values *const per_column = &s->slopes.per_column;
    el_values v = values_of(s, kind);
    el_values_add(&v, &s->slopes.per_row, kind);
    v.z = el_add_product_u16(v.z, per_column->z, columns);
    if ((kind & EL_FILL_COLOURS) != 0) {
        v.red += per_column->red * columns;
        v.green += per_column->green * columns;
        v.blue += per_column->blue * columns;
    }
    put_values(s, &v, kind);
}

static EL_APART void move_down_coloured(small_sampled *s, uint32_t x)
{
    move_down_as(s, x, EL_FILL_COLOURS | EL_FILL_DEPTH);
}

static EL_APART void move_down_flat(small_sampled *s, uint32_t x)
{
    move_down_as(s, x, EL_FILL_DEPTH);
}

static EL_SPECIALISED void move_down(small_sampled *s, uint32_t x, unsigned kind)
{
    if (kind == EL_FILL_DEPTH) {
        move_down_flat(s, x);
    } else {
        move_down_coloured(s, x);
    }
}

/* Past a row without pixels. */
static EL_APART void pass_row(small_sampled *s)
{
    el_values_add(&s->slopes.first, &s->slopes.per_row, EL_FILL_COLOURS | EL_FILL_DEPTH);
    s->column -= EL_SAMPLED_BACK;
}

/* Rows that are left and pixels that were drawn are counted in one word: 66 pixels of 34 rows at most. */
enum { ONE_ROW = 1 << 12 };

/* What rows have drawn, for the statistics. */
typedef struct drawn {
    uint32_t pixels, empty;
} drawn;

/* Pixels [x, x_end), one at least, at one end of a row. The values are those of the first, and are left at the last. */
static EL_SPECIALISED void draw_beside(small_sampled *s, uint32_t row, uint32_t x, uint32_t x_end, const side *edge,
                                       bool is_right, uint32_t count, unsigned kind)
{
    for (;;) {
        draw_pixel(s, row + x, mask_beside(edge, x, is_right, count), count, kind);
        x++;
        EL_SETTLE(x);
        if (x == x_end) {
            return;
        }
        step_right(s, kind);
    }
}

/* Of four samples, from what is loaded for the most. */
static EL_SPECIALISED uint32_t least_of(const side *edge, uint32_t count)
{
    return count == 4 ? 0U - (uint32_t)edge->most : (uint32_t)edge->least;
}

/* A row in which all samples have the same two sides. */
static EL_SPECIALISED void draw_row(small_sampled *s, const side *left, const side *right, int32_t *counts, drawn *sum,
                                    uint32_t count, unsigned kind)
{
    const uint32_t begin = (left->x + least_of(left, count)) >> 20;
    const uint32_t inner = (left->x + (uint32_t)left->most) >> 20;
    const uint32_t inner_end = (right->x + least_of(right, count)) >> 20;
    const uint32_t end = (right->x + (uint32_t)right->most) >> 20;
    if (begin >= end) {
        sum->empty++;
        pass_row(s);
        return;
    }
    const uint32_t row = s->row;
    *counts += (int32_t)(end - begin);
    uint32_t x = end - 1U; /* where the values are left */
    if (inner < inner_end) {
        if (begin < inner) {
            move_down(s, begin, kind);
            draw_beside(s, row, begin, inner, left, false, count, kind);
        } else {
            move_down(s, begin - 1U, kind);
        }
        draw_whole(s, row + inner, row + inner_end, count, kind);
        if (inner_end < end) {
            draw_beside(s, row, inner_end, end, right, true, count, kind);
        } else {
            x = end;
        }
    } else {
        move_down(s, begin, kind);
        for (x = begin;;) {
            uint32_t mask = (1U << count) - 1U;
            if (x < inner) {
                mask = mask_beside(left, x, false, count);
            }
            if (x >= inner_end) {
                mask &= mask_beside(right, x, true, count);
            }
            if (mask != 0) {
                draw_pixel(s, row + x, mask, count, kind);
            }
            if (x == end - 1U) {
                break;
            }
            x++;
            step_right(s, kind);
        }
    }
    s->column = (int32_t)x - EL_SAMPLED_BACK;
}

/* Which samples of the row whose centre is at `centre` are above a corner. */
static EL_SPECIALISED uint32_t mask_above(int32_t corner, int32_t centre, uint32_t count)
{
    const el_sample_point *const points = el_known_sample_points(count);
    const int32_t below = corner - centre;
    uint32_t mask = 0;
    if (count == 4) {
        /* They are four sixteenths below each other, the first one six above the centre. */
        return (1U << el_min_i32(el_max_i32((below + 9) >> 2, 0), 4)) - 1U;
    }
#pragma GCC unroll 8
    for (uint32_t k = 0; k < count; k++) {
        mask |= (uint32_t)(points[k].y - below) >> 31 << k;
    }
    return mask;
}

/* Columns of four samples in a word, 7 bits in each byte: the eighth tells which one is behind another. */
enum { FOUR_TIMES = 0x01010101 };
#define EIGHTH_BITS 0x80808080U

/* Bits 0, 8, 16 and 24 as a mask: the product moves them to 24 and the bits above; all its other bits are below. */
static EL_SPECIALISED uint32_t gathered(uint32_t bits)
{
    return bits * ((1U << 24) + (1U << 17) + (1U << 10) + (1U << 3)) >> 24;
}

/* Where samples cross a side: the columns from the triangle's first one on, and their range. */
typedef struct crossings {
    uint32_t columns[EL_MAX_SAMPLES / 4]; /* 0 for samples above and below the triangle */
    uint32_t least, most;
} crossings;

static EL_SPECIALISED void add_crossing(crossings *c, const side *edge, uint32_t k, uint32_t first, uint32_t count)
{
    const uint32_t way = k < el_known_ways(count) ? (uint32_t)edge->at[k] : 0U - (uint32_t)edge->at[3U - k];
    const uint32_t column = ((edge->x + way) >> 20) - first;
    c->columns[k / 4U] |= column << (k % 4U * 8U);
    c->least = el_min_u32(c->least, column);
    c->most = el_max_u32(c->most, column);
}

/* Any other row y. */
static EL_SPECIALISED void draw_corner_row(small_sampled *s, int32_t y, drawn *sum, uint32_t count, unsigned kind)
{
    const int32_t centre = y * EL_SUBPIXELS + EL_SUBPIXELS / 2;
    const uint32_t in_upper = mask_above(s->y1, centre, count);
    const uint32_t in_rows = mask_above(s->y2, centre, count) & ~mask_above(s->y0, centre, count);
    const uint32_t first = s->first_column;
    crossings bent = {.columns = {0, 0}, .least = UINT32_MAX, .most = 0};
    crossings straight = bent;
#pragma GCC unroll 4
    for (uint32_t k = 0; k < count; k++) {
        if ((in_rows >> k & 1U) != 0) {
            add_crossing(&bent, (in_upper >> k & 1U) != 0 ? &s->upper : &s->lower, k, first, count);
            add_crossing(&straight, &s->straight, k, first, count);
        }
    }
    const crossings left = s->short_is_left ? bent : straight;
    const crossings right = s->short_is_left ? straight : bent;
    if (left.least >= right.most) {
        sum->empty++;
        pass_row(s);
        return;
    }
    const uint32_t inner = left.most;
    const uint32_t inner_end = in_rows == (1U << count) - 1U ? right.least : 0U;
    const uint32_t end = right.most;
    const uint32_t pixel = s->row + first;
    uint32_t i = left.least;
    sum->pixels += end - i;
    move_down(s, first + i, kind);
    for (;;) {
        if (i == inner && inner < inner_end) {
            step_left(s, kind);
            draw_whole(s, pixel + inner, pixel + inner_end, count, kind);
            i = inner_end;
        }
        if (i == end) {
            break;
        }
        const uint32_t here = i * FOUR_TIMES + EIGHTH_BITS;
        uint32_t mask = 0;
        for (uint32_t n = 0; n < count / 4U; n++) {
            mask |= gathered(((here - left.columns[n]) & ~(here - right.columns[n]) & EIGHTH_BITS) >> 7) << 4U * n;
        }
        if (mask != 0) {
            draw_pixel(s, pixel + i, mask, count, kind);
        }
        if (i + 1U == end) {
            break;
        }
        step_right(s, kind);
        i++;
    }
    s->column = (int32_t)(first + i) - EL_SAMPLED_BACK;
}

/* `rows` rows in which all samples have the same two sides, one at least. */
static EL_SPECIALISED void draw_part(small_sampled *s, side *left, side *right, int32_t rows, uint32_t width,
                                     drawn *sum, uint32_t count, unsigned kind)
{
    int32_t counts = rows * ONE_ROW;
    do {
        counts -= ONE_ROW;
        draw_row(s, left, right, &counts, sum, count, kind);
        left->x += left->step;
        right->x += right->step;
        s->row += width;
    } while (counts >= ONE_ROW);
    sum->pixels += (uint32_t)counts;
}

#define DEFINE_ROWS(name, kind, count)                                                                                 \
    static EL_APART void draw_part_##name(small_sampled *s, side *left, side *right, int32_t rows, uint32_t width,     \
                                          drawn *sum)                                                                  \
    {                                                                                                                  \
        draw_part(s, left, right, rows, width, sum, count, kind);                                                      \
    }                                                                                                                  \
    static EL_APART void draw_corner_row_##name(small_sampled *s, int32_t y, drawn *sum)                               \
    {                                                                                                                  \
        draw_corner_row(s, y, sum, count, kind);                                                                       \
    }
DEFINE_ROWS(coloured_4, EL_FILL_COLOURS | EL_FILL_DEPTH, 4)
DEFINE_ROWS(flat_4, EL_FILL_DEPTH, 4)
DEFINE_ROWS(8, s->kind, 8)

#define BY_LOOK(s, count, name, ...)                                                                                   \
    do {                                                                                                               \
        if ((count) != 4) {                                                                                            \
            name##_8(__VA_ARGS__);                                                                                     \
        } else if ((s)->kind == EL_FILL_DEPTH) {                                                                       \
            name##_flat_4(__VA_ARGS__);                                                                                \
        } else {                                                                                                       \
            name##_coloured_4(__VA_ARGS__);                                                                            \
        }                                                                                                              \
    } while (0)

static void draw_rows(small_sampled *s, int32_t y_end, uint32_t width, el_stats *stats, uint32_t count)
{
    drawn sum = {0, 0};
    int32_t y = s->y;
    el_count(&stats->rows, (uint32_t)(y_end - y));
    el_count(&stats->spans, (uint32_t)(y_end - y));
    while (y < y_end) {
        const bool is_upper = y >= s->upper_begin && y < s->upper_end;
        if (is_upper || (y >= s->lower_begin && y < s->lower_end)) {
            side *const bent = is_upper ? &s->upper : &s->lower;
            side *const other = is_upper ? &s->lower : &s->upper;
            side *const left = s->short_is_left ? bent : &s->straight;
            side *const right = s->short_is_left ? &s->straight : bent;
            const int32_t rows = el_min_i32(y_end, is_upper ? s->upper_end : s->lower_end) - y;
            BY_LOOK(s, count, draw_part, s, left, right, rows, width, &sum);
            other->x += other->step * (uint32_t)rows;
            y += rows;
            continue;
        }
        BY_LOOK(s, count, draw_corner_row, s, y, &sum);
        s->straight.x += s->straight.step;
        s->upper.x += s->upper.step;
        s->lower.x += s->lower.step;
        s->row += width;
        y++;
    }
    s->y = (int16_t)y;
    el_count(&stats->pixels, sum.pixels);
    el_count(&stats->spans, 0U - sum.empty);
}

bool el_small_sampled_go_on(el_small_sampled *s, const el_sampled_target *target, el_stats *stats)
{
    const int32_t y_end = el_min_i32(s->y_end, target->target.y_end);
    const uint32_t width = (uint32_t)target->target.width;
    s->at = el_sampled_place_at(target, target->target.y);
    s->row = (uint32_t)(s->y - target->target.y) * width;
    draw_rows(s, y_end, width, stats, target->count);
    return s->y < s->y_end;
}

#endif
