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

/* An edge in the next row, for all samples, Q20 modulo 2^32: of sample k it is x + at[k], whose whole part is the first pixel
 * of which that sample is not left of the edge. */
typedef struct side {
    uint32_t x, step;
    int32_t least, most; /* of at[] */
    int32_t at[EL_MAX_SAMPLES];
} side;

/* A triangle under way. */
typedef struct small_sampled {
    const el_sample_point *points;
    int32_t y0, y1, y2; /* corners, 1/EL_SUBPIXELS px */
    bool short_is_left;
    uint16_t flat;
    side straight, upper, lower;
    el_slopes slopes;
    /* From the centre to each sample. */
    uint64_t z_at[EL_MAX_SAMPLES];
    uint32_t rgb_at[EL_MAX_SAMPLES][3];
} small_sampled;

/* --- Set-up ------------------------------------------------------------------------------------------------------- */

static EL_SPECIALISED void make_side(side *s, const el_corner *from, const el_corner *to, int32_t row,
                                     const el_sample_point *points, uint32_t count)
{
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

/* From the centre to sample k. */
static EL_SPECIALISED void put_way(small_sampled *s, uint32_t k, uint64_t z, const uint32_t rgb[3], unsigned kind)
{
    s->z_at[k] = z;
    if ((kind & EL_FILL_COLOURS) != 0) {
        s->rgb_at[k][0] = rgb[0];
        s->rgb_at[k][1] = rgb[1];
        s->rgb_at[k][2] = rgb[2];
    }
}

static EL_SPECIALISED void make_values(small_sampled *s, const el_corner *const c[3], const el_small_frame *frame,
                                       int32_t y, uint32_t count, unsigned kind)
{
    el_plane z;
    el_small_plane_make(&z, frame, c[0]->z, c[1]->z, c[2]->z);
    /* The planes may begin below the first row with a sample. */
    const uint32_t back = (uint32_t)(frame->row - y);
    s->slopes.first.z = z.value - el_multiply_u16(z.dy, back) + EL_HALF_Q32;
    s->slopes.per_column.z = z.dx;
    s->slopes.per_row.z = z.dy;
    const uint64_t z_x = (uint64_t)((int64_t)z.dx >> EL_SUBPIXEL_BITS);
    const uint64_t z_y = (uint64_t)((int64_t)z.dy >> EL_SUBPIXEL_BITS);
    el_small_quotient per_x[3];
    el_small_quotient per_y[3];
    if ((kind & EL_FILL_COLOURS) != 0) {
        el_channel rgb[3];
        for (unsigned i = 0; i < 3; i++) {
            el_small_channel_make_from(&rgb[i], frame, c[0]->rgb_q8[i], c[1]->rgb_q8[i], c[2]->rgb_q8[i], &per_x[i],
                                       &per_y[i]);
        }
        s->slopes.first.red = rgb[0].value - rgb[0].dy * back;
        s->slopes.first.green = rgb[1].value - rgb[1].dy * back;
        s->slopes.first.blue = rgb[2].value - rgb[2].dy * back;
        s->slopes.per_column.red = rgb[0].dx;
        s->slopes.per_column.green = rgb[1].dx;
        s->slopes.per_column.blue = rgb[2].dx;
        s->slopes.per_row.red = rgb[0].dy;
        s->slopes.per_row.green = rgb[1].dy;
        s->slopes.per_row.blue = rgb[2].dy;
    }
    /* Each of the latter two of four samples is opposite to one of the first two. */
    for (uint32_t k = 0; k < (count == 4 ? 2U : count); k++) {
        const int32_t x = s->points[k].x;
        const int32_t down = s->points[k].y;
        const uint64_t z_way = el_multiply_u64(z_x, x) + el_multiply_u64(z_y, down);
        uint32_t way[3] = {0, 0, 0};
        uint32_t back_way[3];
        for (unsigned i = 0; i < 3 && (kind & EL_FILL_COLOURS) != 0; i++) {
            way[i] = el_quotients_times(&per_x[i], x, &per_y[i], down);
        }
        put_way(s, k, z_way, way, kind);
        if (count == 4) {
            back_way[0] = 0U - way[0];
            back_way[1] = 0U - way[1];
            back_way[2] = 0U - way[2];
            put_way(s, 3U - k, 0U - z_way, back_way, kind);
        }
    }
}

/* --- Pixels ------------------------------------------------------------------------------------------------------- */

/* Draws the samples of a pixel whose word of `masks` is all ones; others are 0. v: at its centre. */
static EL_SPECIALISED void draw_samples(const small_sampled *s, const el_sampled_place *at, const el_values *v,
                                        uint32_t x, const int32_t masks[EL_MAX_SAMPLES], uint32_t count, unsigned kind)
{
    uint32_t first = 0;
    while (masks[first] == 0) {
        if (++first == count) {
            return;
        }
    }
    const uint32_t z = (uint32_t)((v->z + s->z_at[first]) >> 32);
    const uint32_t old_depth = at->depth[x];
    const bool mixed = z >= old_depth;
    if (mixed && (old_depth != 0 || !el_is_mixed(at, x))) {
        return;
    }
    uint32_t colour = s->flat;
    if ((kind & EL_FILL_COLOURS) != 0) {
        const uint32_t *const way = s->rgb_at[first];
        const el_values there = {.red = v->red + way[0], .green = v->green + way[1], .blue = v->blue + way[2]};
        colour = el_coloured(&there);
    }
    const uint32_t drawn = z << 16 | colour;
    uint32_t *const samples = at->samples + x * count;
    if (mixed) {
        const uint32_t nearer = drawn | 0xFFFFU;
#pragma GCC unroll 8
        for (uint32_t k = 0; k < count; k++) {
            if (masks[k] != 0 && samples[k] > nearer) {
                samples[k] = drawn;
            }
        }
        return;
    }
    const uint32_t old = old_depth << 16 | at->colour[x];
    const uint32_t change = old ^ drawn;
    at->depth[x] = 0;
    at->mixed[x / 32U] |= 1U << (x % 32U);
#pragma GCC unroll 8
    for (uint32_t k = 0; k < count; k++) {
        samples[k] = old ^ (change & (uint32_t)masks[k]);
    }
}

/* Pixels [x, x_end), none beyond one of the sides: samples are covered right of it, or, with `flip` -1, left of it. Values are at
 * the first, and then behind the last. */
static EL_SPECIALISED void draw_beside(const small_sampled *s, const el_sampled_place *at, el_values *v, uint32_t x,
                                       uint32_t x_end, const side *edge, int32_t flip, uint32_t count, unsigned kind)
{
    for (; x < x_end; x++) {
        const uint32_t before = edge->x - ((x + 1U) << 20);
        int32_t masks[EL_MAX_SAMPLES];
#pragma GCC unroll 8
        for (uint32_t k = 0; k < count; k++) {
            masks[k] = ((int32_t)(before + (uint32_t)edge->at[k]) >> 31) ^ flip;
        }
        draw_samples(s, at, v, x, masks, count, kind);
        el_values_add(v, &s->slopes.per_column, kind);
    }
}

/* Pixels [x, x_end) between the crossings of each sample with both sides, which are equal where the row has no such sample. */
static EL_SPECIALISED void draw_between(const small_sampled *s, const el_sampled_place *at, el_values *v, uint32_t x,
                                        uint32_t x_end, const uint32_t *left, const uint32_t *right, uint32_t count,
                                        unsigned kind)
{
    for (; x < x_end; x++) {
        const uint32_t behind = (x + 1U) << 20;
        int32_t masks[EL_MAX_SAMPLES];
#pragma GCC unroll 8
        for (uint32_t k = 0; k < count; k++) {
            masks[k] = ((int32_t)(left[k] - behind) & ~(int32_t)(right[k] - behind)) >> 31;
        }
        draw_samples(s, at, v, x, masks, count, kind);
        el_values_add(v, &s->slopes.per_column, kind);
    }
}

/* Those of pixels [x, x_end) that are mixed, and covered as a whole. */
static EL_SPECIALISED void draw_mixed(const small_sampled *s, const el_sampled_place *at, uint32_t x, uint32_t x_end,
                                      uint32_t count, unsigned kind)
{
    for (; x < x_end; x++) {
        if (!el_is_mixed(at, x)) {
            continue;
        }
        const el_values v = el_values_at(&s->slopes, (int32_t)x, kind);
        const uint32_t z = (uint32_t)(v.z >> 32);
        const uint32_t drawn = z << 16 | ((kind & EL_FILL_COLOURS) != 0 ? el_coloured(&v) : s->flat);
        uint32_t *const samples = at->samples + x * count;
        for (uint32_t k = 0; k < count; k++) {
            if (samples[k] > (drawn | 0xFFFFU)) {
                samples[k] = drawn;
            }
        }
        el_unmix(at, x, count);
    }
}

static EL_SPECIALISED void draw_inner(const small_sampled *s, const el_sampled_place *at, el_values *v, uint32_t x,
                                      uint32_t x_end, uint32_t count, unsigned kind)
{
    uint16_t *depth = at->depth + x;
    const uint16_t *const end = at->depth + x_end;
    const el_cursor cursor = {.to_colour = (uintptr_t)at->colour - (uintptr_t)at->depth};
    do {
        if (el_passes(v, depth, kind)) {
            *el_colour_at(&cursor, depth) = (kind & EL_FILL_COLOURS) != 0 ? (uint16_t)el_coloured(v) : s->flat;
        }
        el_values_add(v, &s->slopes.per_column, kind);
    } while (++depth != end);
    if (el_any_is_mixed(at, x, x_end)) {
        draw_mixed(s, at, x, x_end, count, kind);
    }
}

/* --- Rows --------------------------------------------------------------------------------------------------------- */

/* A row in which all samples have the same two sides. Returns how many pixels have samples in it. */
static EL_SPECIALISED uint32_t draw_row(const small_sampled *s, const el_sampled_place *at, const side *left,
                                        const side *right, uint32_t count, unsigned kind)
{
    const uint32_t begin = (left->x + (uint32_t)left->least) >> 20;
    const uint32_t inner = (left->x + (uint32_t)left->most) >> 20;
    const uint32_t inner_end = (right->x + (uint32_t)right->least) >> 20;
    const uint32_t end = (right->x + (uint32_t)right->most) >> 20;
    if (begin >= end) {
        return 0;
    }
    el_values v = el_values_at(&s->slopes, (int32_t)begin, kind);
    if (inner < inner_end) {
        draw_beside(s, at, &v, begin, inner, left, 0, count, kind);
        draw_inner(s, at, &v, inner, inner_end, count, kind);
        draw_beside(s, at, &v, inner_end, end, right, -1, count, kind);
    } else {
        uint32_t lefts[EL_MAX_SAMPLES];
        uint32_t rights[EL_MAX_SAMPLES];
        for (uint32_t k = 0; k < count; k++) {
            lefts[k] = left->x + (uint32_t)left->at[k];
            rights[k] = right->x + (uint32_t)right->at[k];
        }
        draw_between(s, at, &v, begin, end, lefts, rights, count, kind);
    }
    return end - begin;
}

/* Any other row y. */
static EL_SPECIALISED uint32_t draw_corner_row(const small_sampled *s, const el_sampled_place *at, int32_t y,
                                               uint32_t count, unsigned kind)
{
    uint32_t lefts[EL_MAX_SAMPLES];
    uint32_t rights[EL_MAX_SAMPLES];
    uint32_t begin = UINT32_MAX;
    uint32_t inner = 0;
    uint32_t inner_end = UINT32_MAX;
    uint32_t end = 0;
    for (uint32_t k = 0; k < count; k++) {
        const int32_t sample_y = y * EL_SUBPIXELS + EL_SUBPIXELS / 2 + s->points[k].y;
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
    el_values v = el_values_at(&s->slopes, (int32_t)begin, kind);
    uint32_t x = begin;
    if (inner < inner_end) {
        draw_between(s, at, &v, begin, inner, lefts, rights, count, kind);
        draw_inner(s, at, &v, inner, inner_end, count, kind);
        x = inner_end;
    }
    draw_between(s, at, &v, x, end, lefts, rights, count, kind);
    return end - begin;
}

static EL_SPECIALISED void draw(small_sampled *s, const el_sampled_target *target, int32_t y, int32_t y_end,
                                el_stats *stats, uint32_t count, unsigned kind)
{
    const int32_t reach = el_samples_reach(count);
    const int32_t upper = el_first_centre(s->y0 + reach);
    const int32_t upper_end = el_first_centre(s->y1 - reach);
    const int32_t lower = el_first_centre(s->y1 + reach);
    const int32_t lower_end = el_first_centre(s->y2 - reach);
    uint32_t pixels = 0;
    uint32_t spans = 0;
    el_sampled_place at = el_sampled_place_at(target, y);
    el_count(&stats->rows, (uint32_t)(y_end - y));
    for (; y < y_end; y++) {
        uint32_t drawn;
        const bool is_upper = y >= upper && y < upper_end;
        if (is_upper || (y >= lower && y < lower_end)) {
            const side *const bent = is_upper ? &s->upper : &s->lower;
            drawn = draw_row(s, &at, s->short_is_left ? bent : &s->straight, s->short_is_left ? &s->straight : bent,
                             count, kind);
        } else {
            drawn = draw_corner_row(s, &at, y, count, kind);
        }
        pixels += drawn;
        spans += drawn != 0;
        s->straight.x += s->straight.step;
        s->upper.x += s->upper.step;
        s->lower.x += s->lower.step;
        el_values_add(&s->slopes.first, &s->slopes.per_row, kind);
        at.colour += target->target.width;
        at.depth += target->target.width;
        at.mixed += EL_MIXED_WORDS((uint32_t)target->target.width);
        at.samples += (uint32_t)target->target.width * count;
    }
    el_count(&stats->pixels, pixels);
    el_count(&stats->spans, spans);
}

static EL_SPECIALISED void draw_triangle(const el_corner *const corners[3], const el_small_shape *shape, int32_t area,
                                         const el_surface *surface, const el_sampled_target *target, int32_t y,
                                         int32_t y_end, el_stats *stats, uint32_t count, unsigned kind)
{
    small_sampled s;
    s.points = el_sample_points(count);
    s.y0 = corners[0]->y;
    s.y1 = corners[1]->y;
    s.y2 = corners[2]->y;
    s.short_is_left = area < 0;
    s.flat = surface->colour;
    s.upper.x = s.upper.step = s.lower.x = s.lower.step = 0;
    make_side(&s.straight, corners[0], corners[2], y, s.points, count);
    make_side(&s.upper, corners[0], corners[1], y, s.points, count);
    make_side(&s.lower, corners[1], corners[2], y, s.points, count);
    const el_small_frame frame = {
        .shape = *shape,
        .x0 = corners[0]->x,
        .y0 = corners[0]->y,
        .row = el_max_i32(y, el_first_centre(corners[0]->y)),
        .area = el_small_divisor_make(area),
    };
    make_values(&s, corners, &frame, y, count, kind);
    draw(&s, target, y, y_end, stats, count, kind);
}

#define KINDS(DO)                                                                                                      \
    DO(coloured_4, EL_FILL_COLOURS | EL_FILL_DEPTH, 4)                                                                 \
    DO(coloured_8, EL_FILL_COLOURS | EL_FILL_DEPTH, 8)                                                                 \
    DO(flat_4, EL_FILL_DEPTH, 4)                                                                                       \
    DO(flat_8, EL_FILL_DEPTH, 8)

#define DEFINE(name, kind, samples)                                                                                      \
    static __attribute__((noinline)) void draw_##name(                                                                 \
        const el_corner *const corners[3], const el_small_shape *shape, int32_t area, const el_surface *surface,       \
        const el_sampled_target *target, int32_t y, int32_t y_end, el_stats *stats)                                    \
    {                                                                                                                  \
        draw_triangle(corners, shape, area, surface, target, y, y_end, stats, samples, kind);                          \
    }
KINDS(DEFINE)

void el_small_sampled_draw(const el_corner *const corners[3], const el_small_shape *shape, int32_t area,
                           const el_surface *surface, const el_sampled_target *target, int32_t y, int32_t y_end,
                           el_stats *stats)
{
    const unsigned asked = el_fill_kind(surface);
    const unsigned count = target->count;
#define CALL(name, kind, samples)                                                                                       \
    if (asked == (kind) && count == (samples)) {                                                                 \
        draw_##name(corners, shape, area, surface, target, y, y_end, stats);                                           \
        return;                                                                                                        \
    }
    KINDS(CALL)
}

#endif
