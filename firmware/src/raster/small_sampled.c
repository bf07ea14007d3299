/* small_sampled.h. Within a row the samples' crossings with an edge are as far from each other as in any other row, so an edge
 * is walked once, and what leads from there to each sample is a constant.
 *
 * In Q20, as el_edge_q20 (edge.h), whose crossing may be too low by 79 units and too high by less than 48: 49 and 16 are taken.
 * Here a sub-pixel of the step is rounded down, and is taken up to 15 times on the way to the first row and up to 7 times, in
 * either direction, on the way to a sample: too low by 22 units more, too high by 7. */
#include "raster/small_sampled.h"

#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/sampled_pixel.h"

#if EL_WITH_SMALL_SAMPLED

typedef el_sampled_side side;
typedef el_small_sampled small_sampled;

/* --- Set-up ------------------------------------------------------------------------------------------------------- */

static EL_SPECIALISED void make_side(side *s, const el_corner *from, const el_corner *to, int32_t row, uint32_t count)
{
    const el_sample_point *const points = el_sample_points(count);
    if (from->y == to->y) {
        return; /* no sample's */
    }
    const int32_t down = row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - from->y;
    const int32_t step = el_product_down_11(to->x - from->x, el_reciprocal_of_short(to->y - from->y));
    const int32_t part = step >> EL_SUBPIXEL_BITS; /* below 2^26 */
    s->step = (uint32_t)step;
    s->x = ((uint32_t)(from->x + EL_SUBPIXELS / 2) << (20 - EL_SUBPIXEL_BITS)) - 48U +
           (uint32_t)step * (uint32_t)(down >> EL_SUBPIXEL_BITS) + (uint32_t)(part * (down & (EL_SUBPIXELS - 1)));
    int32_t least = INT32_MAX;
    int32_t most = INT32_MIN;
#pragma GCC unroll 4
    for (uint32_t k = 0; k < count; k++) {
        const int32_t at = part * points[k].y - points[k].x * (1 << (20 - EL_SUBPIXEL_BITS));
        s->at[k] = at;
        least = el_min_i32(least, at);
        most = el_max_i32(most, at);
    }
    s->least = least;
    s->most = most;
}

static EL_APART void make_side_4(side *s, const el_corner *from, const el_corner *to, int32_t row)
{
    make_side(s, from, to, row, 4);
}

static EL_APART void make_side_8(side *s, const el_corner *from, const el_corner *to, int32_t row)
{
    make_side(s, from, to, row, 8);
}

static EL_APART void make_depth(small_sampled *s, const el_corner *const c[3], const el_small_frame *frame,
                                uint32_t back, uint32_t count)
{
    el_plane z;
    el_small_plane_make(&z, frame, c[0]->z, c[1]->z, c[2]->z);
    s->slopes.first.z = z.value - el_multiply_u16(z.dy, back) + EL_HALF_Q32;
    s->slopes.per_column.z = z.dx;
    s->slopes.per_row.z = z.dy;
    const uint64_t per_x = (uint64_t)((int64_t)z.dx >> EL_SUBPIXEL_BITS);
    const uint64_t per_y = (uint64_t)((int64_t)z.dy >> EL_SUBPIXEL_BITS);
    for (uint32_t k = 0; k < count; k++) {
        s->z_at[k] = el_multiply_u64(per_x, s->points[k].x) + el_multiply_u64(per_y, s->points[k].y);
    }
}

static EL_APART uint32_t make_channel(small_sampled *s, const el_small_frame *frame, const int32_t values[3],
                                      unsigned i, uint32_t back, uint32_t count, uint32_t step[2])
{
    el_channel channel;
    el_small_quotient per_x;
    el_small_quotient per_y;
    el_small_channel_make_from(&channel, frame, values[0], values[1], values[2], &per_x, &per_y);
    step[0] = channel.dx;
    step[1] = channel.dy;
    /* Each of the latter two of four samples is opposite to one of the first two. */
    for (uint32_t k = 0; k < (count == 4 ? 2U : count); k++) {
        const uint32_t way = el_quotients_times(&per_x, s->points[k].x, &per_y, s->points[k].y);
        s->rgb_at[k][i] = way;
        if (count == 4) {
            s->rgb_at[3U - k][i] = 0U - way;
        }
    }
    return channel.value - channel.dy * back;
}

static void make_colours(small_sampled *s, const el_corner *const c[3], const el_small_frame *frame, uint32_t back,
                         uint32_t count)
{
    uint32_t first[3];
    uint32_t step[3][2];
    for (unsigned i = 0; i < 3; i++) {
        const int32_t values[3] = {c[0]->rgb_q8[i], c[1]->rgb_q8[i], c[2]->rgb_q8[i]};
        first[i] = make_channel(s, frame, values, i, back, count, step[i]);
    }
    el_slopes *const slopes = &s->slopes;
    slopes->first.red = first[0];
    slopes->first.green = first[1];
    slopes->first.blue = first[2];
    slopes->per_column.red = step[0][0];
    slopes->per_column.green = step[1][0];
    slopes->per_column.blue = step[2][0];
    slopes->per_row.red = step[0][1];
    slopes->per_row.green = step[1][1];
    slopes->per_row.blue = step[2][1];
}

/* --- Pixels ------------------------------------------------------------------------------------------------------- */

/* Depth and colour at the centre of pixel x, which `way` is added to. */
static EL_SPECIALISED uint32_t depth_at(const small_sampled *s, uint32_t x, uint64_t way)
{
    return (uint32_t)((s->slopes.first.z + el_multiply_u16(s->slopes.per_column.z, x) + way) >> 32);
}

static EL_SPECIALISED uint32_t colour_at(const small_sampled *s, uint32_t x, const uint32_t way[3], unsigned kind)
{
    if ((kind & EL_FILL_COLOURS) == 0) {
        return s->flat;
    }
    const el_slopes *const slopes = &s->slopes;
    const el_values there = {
        .red = slopes->first.red + slopes->per_column.red * x + way[0],
        .green = slopes->first.green + slopes->per_column.green * x + way[1],
        .blue = slopes->first.blue + slopes->per_column.blue * x + way[2],
    };
    return el_coloured(&there);
}

/* The lowest bit of a mask of four. */
static const uint8_t lowest[16] = {0, 0, 1, 0, 2, 0, 1, 0, 3, 0, 1, 0, 2, 0, 1, 0};

/* Draws the samples of `mask` of a mixed pixel. */
static EL_SPECIALISED void draw_again(const el_sampled_place *at, uint32_t x, uint32_t mask, uint32_t drawn,
                                      uint32_t count)
{
    uint32_t *const samples = at->samples + x * count;
    const uint32_t nearer = drawn | 0xFFFFU;
    const uint32_t taken = at->colour[x];
    if (taken != 0 && (taken ^ mask) == (1U << count) - 1U) {
        /* All of those that another triangle left. */
        if (samples[1] > nearer) {
            samples[1] = drawn;
        }
        return;
    }
    el_spread(at, x, count);
    for (uint32_t k = 0; k < count; k++) {
        if ((mask >> k & 1U) != 0 && samples[k] > nearer) {
            samples[k] = drawn;
        }
    }
}

/* Draws the samples of `mask`, not 0 and not all, of pixel x. */
static EL_SPECIALISED void draw_samples(const small_sampled *s, uint32_t x, uint32_t mask, uint32_t count,
                                        unsigned kind)
{
    const uint32_t first = count == 4 || (mask & 15U) != 0 ? lowest[mask & 15U] : 4U + lowest[mask >> 4];
    const el_sampled_place *const at = &s->at;
    const uint32_t z = depth_at(s, x, s->z_at[first]);
    const uint32_t old_depth = at->depth[x];
    uint32_t *const samples = at->samples + x * count;
    if (z >= old_depth) {
        if (old_depth != 0 || !el_pixel_is_mixed(at, x)) {
            return;
        }
        const uint32_t drawn = z << 16 | colour_at(s, x, s->rgb_at[first], kind);
        draw_again(at, x, mask, drawn, count);
        return;
    }
    const uint32_t drawn = z << 16 | colour_at(s, x, s->rgb_at[first], kind);
    samples[0] = drawn;
    samples[1] = old_depth << 16 | at->colour[x];
    at->depth[x] = 0;
    at->colour[x] = (uint16_t)mask;
    at->mixed[x / 32U] |= 1U << (x % 32U);
}

#define PIXELS(DO)                                                                                                     \
    DO(coloured_4, EL_FILL_COLOURS | EL_FILL_DEPTH, 4)                                                                 \
    DO(flat_4, EL_FILL_DEPTH, 4)                                                                                       \
    DO(coloured_8, EL_FILL_COLOURS | EL_FILL_DEPTH, 8)                                                                 \
    DO(flat_8, EL_FILL_DEPTH, 8)

#define DEFINE(name, kind, count)                                                                                      \
    static EL_APART void draw_##name(const small_sampled *s, uint32_t x, uint32_t mask)                                \
    {                                                                                                                  \
        draw_samples(s, x, mask, count, kind);                                                                         \
    }
PIXELS(DEFINE)

static EL_SPECIALISED void draw_pixel(const small_sampled *s, uint32_t x, uint32_t mask, uint32_t count)
{
    if (s->kind == EL_FILL_DEPTH) {
        (count == 4 ? draw_flat_4 : draw_flat_8)(s, x, mask);
    } else {
        (count == 4 ? draw_coloured_4 : draw_coloured_8)(s, x, mask);
    }
}

/* Pixels [x, x_end), none beyond one of the sides: samples are covered right of it, or, where `flip` has all bits, left. */
static EL_SPECIALISED void draw_beside(const small_sampled *s, uint32_t x, uint32_t x_end, const side *edge,
                                       uint32_t flip, uint32_t count)
{
    while (x < x_end) {
        const uint32_t before = edge->x - ((x + 1U) << 20);
        uint32_t mask = 0;
#pragma GCC unroll 8
        for (uint32_t k = 0; k < count; k++) {
            mask |= (before + (uint32_t)edge->at[k]) >> 31 << k;
        }
        mask ^= flip;
        draw_pixel(s, x, mask, count);
        x++;
    }
}

/* Pixels [x, x_end) between the crossings of each sample with both sides, which are equal where the row has no such sample. */
static EL_SPECIALISED void draw_between(const small_sampled *s, uint32_t x, uint32_t x_end, const uint32_t *left,
                                        const uint32_t *right, uint32_t count)
{
    for (; x < x_end; x++) {
        const uint32_t behind = (x + 1U) << 20;
        uint32_t mask = 0;
#pragma GCC unroll 8
        for (uint32_t k = 0; k < count; k++) {
            mask |= ((left[k] - behind) & ~(right[k] - behind)) >> 31 << k;
        }
        if (mask != 0) {
            draw_pixel(s, x, mask, count);
        }
    }
}

/* Those of pixels [x, x_end) that are mixed, and covered as a whole. */
static EL_APART void draw_mixed(const small_sampled *s, uint32_t x, uint32_t x_end, uint32_t count)
{
    static const uint32_t nowhere[3] = {0, 0, 0};
    for (; x < x_end; x++) {
        if (!el_pixel_is_mixed(&s->at, x)) {
            continue;
        }
        const uint32_t drawn = depth_at(s, x, 0) << 16 | colour_at(s, x, nowhere, s->kind);
        draw_again(&s->at, x, (1U << count) - 1U, drawn, count);
        el_unmix(&s->at, x, count);
    }
}

/* Pixels [x, x_end), one at least, covered as a whole, but for mixed ones. Returns whether there may be some. */
static EL_SPECIALISED bool draw_inner(const small_sampled *s, uint32_t x, uint32_t x_end, unsigned kind)
{
    bool any_at_0 = false;
    uint16_t *depth = s->at.depth + x;
    const uint16_t *const end = s->at.depth + x_end;
    const el_cursor cursor = {.to_colour = (uintptr_t)s->at.colour - (uintptr_t)s->at.depth};
    const el_values step = s->slopes.per_column;
    const uint16_t flat = s->flat;
    el_values v = el_values_at(&s->slopes, (int32_t)x, kind);
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
    return any_at_0;
}

static EL_APART bool draw_inner_coloured(const small_sampled *s, uint32_t x, uint32_t x_end)
{
    return draw_inner(s, x, x_end, EL_FILL_COLOURS | EL_FILL_DEPTH);
}

static EL_APART bool draw_inner_flat(const small_sampled *s, uint32_t x, uint32_t x_end)
{
    return draw_inner(s, x, x_end, EL_FILL_DEPTH);
}

static EL_SPECIALISED void draw_whole(const small_sampled *s, uint32_t x, uint32_t x_end, uint32_t count)
{
    if (s->kind == EL_FILL_DEPTH ? draw_inner_flat(s, x, x_end) : draw_inner_coloured(s, x, x_end)) {
        draw_mixed(s, x, x_end, count);
    }
}

/* --- Rows --------------------------------------------------------------------------------------------------------- */

/* A row in which all samples have the same two sides. Returns how many pixels may have samples in it. */
static EL_SPECIALISED uint32_t draw_row(const small_sampled *s, const side *left, const side *right, uint32_t count)
{
    const uint32_t begin = (left->x + (uint32_t)left->least) >> 20;
    const uint32_t inner = (left->x + (uint32_t)left->most) >> 20;
    const uint32_t inner_end = (right->x + (uint32_t)right->least) >> 20;
    const uint32_t end = (right->x + (uint32_t)right->most) >> 20;
    if (begin >= end) {
        return 0;
    }
    if (inner < inner_end) {
        draw_beside(s, begin, inner, left, 0, count);
        draw_whole(s, inner, inner_end, count);
        draw_beside(s, inner_end, end, right, (1U << count) - 1U, count);
        return end - begin;
    }
    uint32_t lefts[EL_MAX_SAMPLES];
    uint32_t rights[EL_MAX_SAMPLES];
#pragma GCC unroll 4
    for (uint32_t k = 0; k < count; k++) {
        lefts[k] = left->x + (uint32_t)left->at[k];
        rights[k] = right->x + (uint32_t)right->at[k];
    }
    draw_between(s, begin, end, lefts, rights, count);
    return end - begin;
}

/* Any other row y. */
static EL_SPECIALISED uint32_t draw_corner_row(const small_sampled *s, int32_t y, uint32_t count)
{
    const el_sample_point *const points = el_sample_points(count);
    uint32_t lefts[EL_MAX_SAMPLES];
    uint32_t rights[EL_MAX_SAMPLES];
    uint32_t begin = UINT32_MAX;
    uint32_t inner = 0;
    uint32_t inner_end = UINT32_MAX;
    uint32_t end = 0;
#pragma GCC unroll 4
    for (uint32_t k = 0; k < count; k++) {
        const int32_t sample_y = y * EL_SUBPIXELS + EL_SUBPIXELS / 2 + points[k].y;
        lefts[k] = 0;
        rights[k] = 0;
        if (sample_y < s->y0 || sample_y >= s->y2) {
            inner_end = 0;
            continue;
        }
        const side *const bent = sample_y < s->y1 ? &s->upper : &s->lower;
        const uint32_t bent_x = bent->x + (uint32_t)bent->at[k];
        const uint32_t straight_x = s->straight.x + (uint32_t)s->straight.at[k];
        lefts[k] = s->short_is_left ? bent_x : straight_x;
        rights[k] = s->short_is_left ? straight_x : bent_x;
        begin = el_min_u32(begin, lefts[k] >> 20);
        inner = el_max_u32(inner, lefts[k] >> 20);
        inner_end = el_min_u32(inner_end, rights[k] >> 20);
        end = el_max_u32(end, rights[k] >> 20);
    }
    if (begin >= end) {
        return 0;
    }
    uint32_t x = begin;
    if (inner < inner_end) {
        draw_between(s, begin, inner, lefts, rights, count);
        draw_whole(s, inner, inner_end, count);
        x = inner_end;
    }
    draw_between(s, x, end, lefts, rights, count);
    return end - begin;
}

static EL_SPECIALISED void next_row(small_sampled *s, uint32_t width, uint32_t count)
{
    el_values_add(&s->slopes.first, &s->slopes.per_row, EL_FILL_COLOURS | EL_FILL_DEPTH);
    s->at.colour += width;
    s->at.depth += width;
    s->at.mixed += EL_MIXED_WORDS(width);
    s->at.samples += width * count;
}

/* What rows have drawn, for the statistics. */
typedef struct drawn {
    uint32_t pixels, spans;
} drawn;

/* `rows` rows in which all samples have the same two sides, one at least. */
static EL_SPECIALISED void draw_part(small_sampled *s, side *left, side *right, int32_t rows, uint32_t width,
                                     drawn *sum, uint32_t count)
{
    do {
        const uint32_t pixels = draw_row(s, left, right, count);
        sum->pixels += pixels;
        sum->spans += pixels != 0;
        left->x += left->step;
        right->x += right->step;
        next_row(s, width, count);
    } while (--rows > 0);
}

static EL_SPECIALISED int32_t draw_rows(small_sampled *s, int32_t y_end, uint32_t width, drawn *sum, uint32_t count)
{
    int32_t y = s->y;
    while (y < y_end) {
        const bool is_upper = y >= s->upper_begin && y < s->upper_end;
        if (is_upper || (y >= s->lower_begin && y < s->lower_end)) {
            side *const bent = is_upper ? &s->upper : &s->lower;
            side *const other = is_upper ? &s->lower : &s->upper;
            const int32_t rows = el_min_i32(y_end, is_upper ? s->upper_end : s->lower_end) - y;
            draw_part(s, s->short_is_left ? bent : &s->straight, s->short_is_left ? &s->straight : bent, rows, width,
                      sum, count);
            other->x += other->step * (uint32_t)rows;
            y += rows;
            continue;
        }
        const uint32_t pixels = draw_corner_row(s, y, count);
        sum->pixels += pixels;
        sum->spans += pixels != 0;
        s->straight.x += s->straight.step;
        s->upper.x += s->upper.step;
        s->lower.x += s->lower.step;
        next_row(s, width, count);
        y++;
    }
    return y;
}

static EL_APART int32_t draw_rows_4(small_sampled *s, int32_t y_end, uint32_t width, drawn *sum)
{
    return draw_rows(s, y_end, width, sum, 4);
}

static EL_APART int32_t draw_rows_8(small_sampled *s, int32_t y_end, uint32_t width, drawn *sum)
{
    return draw_rows(s, y_end, width, sum, 8);
}

bool el_small_sampled_go_on(el_small_sampled *s, const el_sampled_target *target, el_stats *stats)
{
    const int32_t y_end = el_min_i32(s->y_end, target->target.y_end);
    const uint32_t width = (uint32_t)target->target.width;
    drawn sum = {0, 0};
    s->at = el_sampled_place_at(target, s->y);
    el_count(&stats->rows, (uint32_t)(y_end - s->y));
    s->y = (int16_t)(target->count == 4 ? draw_rows_4(s, y_end, width, &sum) : draw_rows_8(s, y_end, width, &sum));
    el_count(&stats->pixels, sum.pixels);
    el_count(&stats->spans, sum.spans);
    return s->y < s->y_end;
}

void el_small_sampled_setup(el_small_sampled *s, const el_corner *const corners[3], const el_small_shape *shape,
                            int32_t area, const el_surface *surface, uint32_t count, int32_t y)
{
    const int32_t reach = el_samples_reach(count);
    s->points = el_sample_points(count);
    s->y = (int16_t)y;
    s->y0 = corners[0]->y;
    s->y1 = corners[1]->y;
    s->y2 = corners[2]->y;
    s->y_end = (int16_t)el_first_centre(s->y2 + reach);
    s->upper_begin = (int16_t)el_first_centre(s->y0 + reach);
    s->upper_end = (int16_t)el_first_centre(s->y1 - reach);
    s->lower_begin = (int16_t)el_first_centre(s->y1 + reach);
    s->lower_end = (int16_t)el_first_centre(s->y2 - reach);
    s->short_is_left = area < 0;
    s->flat = surface->colour;
    s->kind = el_fill_kind(surface);
    s->upper.x = s->upper.step = s->lower.x = s->lower.step = 0;
    if (count == 4) {
        make_side_4(&s->straight, corners[0], corners[2], y);
        make_side_4(&s->upper, corners[0], corners[1], y);
        make_side_4(&s->lower, corners[1], corners[2], y);
    } else {
        make_side_8(&s->straight, corners[0], corners[2], y);
        make_side_8(&s->upper, corners[0], corners[1], y);
        make_side_8(&s->lower, corners[1], corners[2], y);
    }
    const el_small_frame frame = {
        .shape = *shape,
        .x0 = corners[0]->x,
        .y0 = corners[0]->y,
        .row = el_max_i32(y, el_first_centre(corners[0]->y)),
        .area = el_small_divisor_make(area),
    };
    /* The planes may begin below the first row with a sample. */
    const uint32_t back = (uint32_t)(frame.row - y);
    make_depth(s, corners, &frame, back, count);
    s->slopes.first.red = s->slopes.first.green = s->slopes.first.blue = 0;
    s->slopes.per_row.red = s->slopes.per_row.green = s->slopes.per_row.blue = 0;
    if (s->kind != EL_FILL_DEPTH) {
        make_colours(s, corners, &frame, back, count);
    }
}

#endif
