/* small_sampled.h: the set-up.
 *
 * In Q20, as el_edge_q20 (edge.h), whose crossing may be too low by 79 units and too high by less than 48: 49 and 16 are taken.
 * Here a sub-pixel of the step is rounded down, and is taken up to 15 times on the way to the first row and up to 7 times, in
 * either direction, on the way to a sample: too low by 22 units more, too high by 7. */
#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/small_sampled.h"

#if EL_WITH_SMALL_SAMPLED

typedef el_sampled_side side;
typedef el_small_sampled small_sampled;

/* What four samples' ways to an edge come to: `a` and `b` are those of the first two. `all` where the triangle is on its left,
 * else 0. */
static EL_SPECIALISED void make_masks(side *s, int32_t a, int32_t b, uint32_t all)
{
    const int32_t far_a = a < 0 ? -a : a;
    const int32_t far_b = b < 0 ? -b : b;
    const uint32_t first_a = a < 0 ? 1U : 8U;
    const uint32_t first_b = b < 0 ? 2U : 4U;
    uint32_t first;
    uint32_t last;
    if (far_a >= far_b) {
        s->most = far_a;
        s->near = far_b;
        first = first_a;
        last = first_a ^ 9U;
    } else {
        s->most = far_b;
        s->near = far_a;
        first = first_b;
        last = first_b ^ 6U;
    }
    s->masks[0] = (uint8_t)(first ^ all);
    s->masks[1] = (uint8_t)((first_a | first_b) ^ all);
    s->masks[2] = (uint8_t)(15U ^ last ^ all);
}

static EL_SPECIALISED void make_side(side *s, const el_corner *from, const el_corner *to, int32_t row, uint32_t all,
                                     uint32_t count)
{
    const el_sample_point *const points = el_known_sample_points(count);
    if (from->y == to->y) {
        s->x = s->step = 0;
        return; /* no sample's */
    }
    const int32_t down = row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - from->y;
    const int32_t step = el_product_down_11(to->x - from->x, el_reciprocal_of_short(to->y - from->y));
    const int32_t part = step >> EL_SUBPIXEL_BITS; /* below 2^26 */
    s->step = (uint32_t)step;
    s->x = ((uint32_t)(from->x + EL_SUBPIXELS / 2) << (20 - EL_SUBPIXEL_BITS)) - 48U +
           (uint32_t)step * (uint32_t)(down >> EL_SUBPIXEL_BITS) + (uint32_t)(part * (down & (EL_SUBPIXELS - 1)));
    const uint32_t made = el_known_ways(count);
    int32_t least = INT32_MAX;
    int32_t most = INT32_MIN;
#pragma GCC unroll 8
    for (uint32_t k = 0; k < made; k++) {
        const int32_t at = part * points[k].y - points[k].x * (1 << (20 - EL_SUBPIXEL_BITS));
        s->at[k] = at;
        least = el_min_i32(least, at);
        most = el_max_i32(most, at);
    }
    if (count == 4) {
        make_masks(s, s->at[0], s->at[1], all);
    } else {
        s->least = least;
        s->most = most;
    }
}

static EL_APART void make_side_4(side *s, const el_corner *from, const el_corner *to, int32_t row, uint32_t all)
{
    make_side(s, from, to, row, all, 4);
}

static EL_APART void make_side_8(side *s, const el_corner *from, const el_corner *to, int32_t row, uint32_t all)
{
    make_side(s, from, to, row, all, 8);
}

static EL_SPECIALISED void make_depth(small_sampled *s, const el_corner *const c[3], const el_small_frame *frame,
                                      uint32_t back, uint32_t count)
{
    const el_sample_point *const points = el_known_sample_points(count);
    el_plane z;
    el_small_plane_make(&z, frame, c[0]->z, c[1]->z, c[2]->z);
    const uint64_t to_the_left = z.dx << EL_SAMPLED_BACK_LOG2;
    s->slopes.first.z = z.value - el_multiply_u16(z.dy, back + 1U) + EL_HALF_Q32;
    s->slopes.per_column.z = z.dx;
    s->slopes.per_row.z = z.dy - to_the_left;
    const uint64_t per_x = (uint64_t)((int64_t)z.dx >> EL_SUBPIXEL_BITS);
    const uint64_t per_y = (uint64_t)((int64_t)z.dy >> EL_SUBPIXEL_BITS);
    const uint32_t made =
        count == 4 ? 2U : count; /* each of the latter two of four is opposite to one of the first two */
#pragma GCC unroll 8
    for (uint32_t k = 0; k < made; k++) {
        const uint64_t way = el_multiply_u64(per_x, points[k].x) + el_multiply_u64(per_y, points[k].y);
        s->ways[k].z = way;
        if (count == 4) {
            s->ways[3U - k].z = 0U - way;
        }
    }
}

static EL_APART void make_depth_4(small_sampled *s, const el_corner *const c[3], const el_small_frame *frame,
                                  uint32_t back)
{
    make_depth(s, c, frame, back, 4);
}

static EL_APART void make_depth_8(small_sampled *s, const el_corner *const c[3], const el_small_frame *frame,
                                  uint32_t back)
{
    make_depth(s, c, frame, back, 8);
}

/* To samples: the same channel of each way. */
static EL_SPECIALISED void make_channel_ways(small_sampled *s, const el_small_quotient *per_x,
                                             const el_small_quotient *per_y, unsigned i, uint32_t count)
{
    const el_sample_point *const points = el_known_sample_points(count);
    const uint32_t made = el_known_ways(count);
#pragma GCC unroll 2
    for (uint32_t k = 0; k < made; k++) {
        const uint32_t way = el_quotients_times(per_x, points[k].x, per_y, points[k].y);
        s->ways[k].rgb[i] = way;
        if (count == 4) {
            s->ways[3U - k].rgb[i] = 0U - way;
        }
    }
}

static EL_APART uint32_t make_channel(small_sampled *s, const el_corner *const c[3], const el_small_frame *frame,
                                      unsigned i, uint32_t back, uint32_t count, uint32_t step[2])
{
    el_channel channel;
    el_small_quotient per_x;
    el_small_quotient per_y;
    el_small_channel_make_from(&channel, frame, c[0]->rgb_q8[i], c[1]->rgb_q8[i], c[2]->rgb_q8[i], &per_x, &per_y);
    if (count == 4) {
        make_channel_ways(s, &per_x, &per_y, i, 4);
    } else {
        make_channel_ways(s, &per_x, &per_y, i, 8);
    }
    step[0] = channel.dx;
    step[1] = channel.dy;
    return channel.value - channel.dy * (back + 1U);
}

#define BY_COUNT(count, name, ...) ((count) == 4 ? name##_4(__VA_ARGS__) : name##_8(__VA_ARGS__))

static void make_colours(small_sampled *s, const el_corner *const c[3], const el_small_frame *frame, uint32_t back,
                         uint32_t count)
{
    uint32_t first[3];
    uint32_t step[3][2];
    for (unsigned i = 0; i < 3; i++) {
        first[i] = make_channel(s, c, frame, i, back, count, step[i]);
    }
    el_slopes *const slopes = &s->slopes;
    slopes->per_column.red = step[0][0];
    slopes->per_column.green = step[1][0];
    slopes->per_column.blue = step[2][0];
    slopes->first.red = first[0];
    slopes->first.green = first[1];
    slopes->first.blue = first[2];
    slopes->per_row.red = step[0][1] - (step[0][0] << EL_SAMPLED_BACK_LOG2);
    slopes->per_row.green = step[1][1] - (step[1][0] << EL_SAMPLED_BACK_LOG2);
    slopes->per_row.blue = step[2][1] - (step[2][0] << EL_SAMPLED_BACK_LOG2);
}

void el_small_sampled_setup(el_small_sampled *s, const el_corner *const corners[3], const el_small_shape *shape,
                            int32_t area, uint8_t kind, uint16_t flat, uint32_t count, int32_t y)
{
    const int32_t reach = el_samples_reach(count);
    const int32_t left = el_min3_i32(corners[0]->x, corners[1]->x, corners[2]->x);
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
    s->first_column = (uint16_t)el_first_centre(left - reach);
    s->column = -EL_SAMPLED_BACK;
    s->flat = flat;
    s->kind = kind;
    BY_COUNT(count, make_side, &s->straight, corners[0], corners[2], y, s->short_is_left ? 15U : 0U);
    BY_COUNT(count, make_side, &s->upper, corners[0], corners[1], y, s->short_is_left ? 0U : 15U);
    BY_COUNT(count, make_side, &s->lower, corners[1], corners[2], y, s->short_is_left ? 0U : 15U);
    const el_small_frame frame = {
        .shape = *shape,
        .x0 = corners[0]->x,
        .y0 = corners[0]->y,
        .row = el_max_i32(y, el_first_centre(corners[0]->y)),
        .area = el_small_divisor_make(area),
    };
    /* The planes may begin below the first row with a sample. */
    const uint32_t back = (uint32_t)(frame.row - y);
    BY_COUNT(count, make_depth, s, corners, &frame, back);
    s->slopes.first.red = s->slopes.first.green = s->slopes.first.blue = 0;
    s->slopes.per_row.red = s->slopes.per_row.green = s->slopes.per_row.blue = 0;
    if (s->kind != EL_FILL_DEPTH) {
        make_colours(s, corners, &frame, back, count);
    }
}

#endif
