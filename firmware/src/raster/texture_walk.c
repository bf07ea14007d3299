#include "raster/texture_walk.h"

#include "base/divide.h"
#include "base/fixed.h"
#include "raster/texel_row.h"

enum {
    LENGTHS = 14,
    STEEP_LOG2 = 27, /* gradients of 2^27 per pixel and more, of 2^31: a knot at every pixel */
    NEVER_Q8 = 1 << 20,
    LEAST_UPPER = 1 << 11, /* of |J|, in units of 2^32, that is looked at closer */
    /* log2(16/15): a sixteenth of the error is left for rounding. Knots are exact to 3 * 2^-16 texel and steps are cut off
     * at 2^-16, which adds up to 2^-10 in the longest piece; at the smallest error, 1/32, 2^-9 is left. */
    ROUNDING_RESERVE_Q8 = 24
};

/* What every piece needs is merged where registers are many; on Armv6-M a call costs less than what must be moved away. */
#if defined(__ARM_ARCH_6M__) || EL_SMALL_CODE
#define EACH_PIECE __attribute__((noinline))
#else
#define EACH_PIECE EL_SPECIALISED
#endif

/* Of a piece, in pixels; the first is always good enough. */
static const uint8_t lengths[LENGTHS] = {1, 4, 5, 6, 7, 8, 9, 11, 13, 16, 22, 32, 45, EL_MAX_PIECE};

/* 2/3 log2 of each length, rounded up, and log2(1 + i/128), rounded down, in Q8. */
static const uint16_t length_q8[LENGTHS] = {0, 342, 397, 442, 480, 512, 542, 591, 632, 683, 762, 854, 938, 1024};

static const uint16_t log2_q8[129] = {
    0,   2,   5,   8,   11,  14,  16,  19,  22,  25,  27,  30,  33,  35,  38,  40,  43,  46,  48,  51,  53,  56,
    58,  61,  63,  65,  68,  70,  73,  75,  77,  80,  82,  84,  87,  89,  91,  93,  96,  98,  100, 102, 104, 106,
    109, 111, 113, 115, 117, 119, 121, 123, 125, 127, 129, 132, 134, 136, 138, 140, 141, 143, 145, 147, 149, 151,
    153, 155, 157, 159, 161, 162, 164, 166, 168, 170, 172, 173, 175, 177, 179, 181, 182, 184, 186, 188, 189, 191,
    193, 194, 196, 198, 200, 201, 203, 205, 206, 208, 209, 211, 213, 214, 216, 218, 219, 221, 222, 224, 225, 227,
    229, 230, 232, 233, 235, 236, 238, 239, 241, 242, 244, 245, 247, 248, 250, 251, 253, 254, 256};

/* Leading zeros of x >= 1. Without an instruction for it they are counted from where they were the last time: W and J
 * change little from knot to knot and from row to row. near <= 31. */
static inline unsigned leading_zeros(uint32_t x, unsigned near)
{
#if defined(__ARM_FEATURE_CLZ) || EL_SMALL_CODE
    (void)near;
    return (unsigned)__builtin_clz(x);
#else
    while (x << near >> near != x) {
        near--;
    }
    while (x << near < 0x80000000U) {
        near++;
    }
    return near;
#endif
}

/* log2 x rounded down, of an x >= 1 moved up by its leading zeros. */
static inline int32_t log2_of_normalised_q8(uint32_t x, unsigned leading)
{
    return (31 - (int32_t)leading) * 256 + log2_q8[(x >> 24) & 127U];
}

/* The upper word of x << shift, shift <= 31. */
static inline uint32_t upper_word(uint64_t x, unsigned shift)
{
    return (uint32_t)(x >> 32) << shift | (uint32_t)x >> 1 >> (31U - shift);
}

/* log2 rounded up of a number with `power` bits behind its first one, whose leading bits are those of `normalised`. */
static inline int32_t log2_ceil_of_normalised_q8(uint32_t normalised, int32_t power)
{
    return power * 256 + log2_q8[((normalised >> 24) & 127U) + 1U] + 1;
}

/* log2 x rounded up; x >= 1. *near is for leading_zeros. */
static int32_t log2_ceil_q8(uint64_t x, uint32_t *near)
{
    const uint32_t upper = (uint32_t)(x >> 32);
    const uint32_t word = upper != 0 ? upper : (uint32_t)x;
    const unsigned leading = leading_zeros(word, *near);
    *near = leading;
    const uint32_t normalised = upper != 0 ? upper_word(x, leading) : word << leading;
    return log2_ceil_of_normalised_q8(normalised, (upper != 0 ? 63 : 31) - (int32_t)leading);
}

/* base + 2^shift U / W in Q16 texels, off by less than 3 units; down is 30 - shift. |U| <= W < 2^31, so with both moved up
 * by W's leading zeros, at least one, U fits 33 bits; 31 of them and the sign are kept, and their product with 2^63 / W is
 * 2^30 U / W, off by less than 3 for what is cut off and EL_RECIPROCAL_ERROR / 2 for the reciprocal: less than 2 units of the
 * result, whose shift is at most 27, and one is cut off again. */
static inline int32_t knot(uint64_t u_q32, unsigned w_shift, uint32_t reciprocal, unsigned down, int32_t base_q16)
{
    const int32_t upper = (int32_t)upper_word(u_q32, w_shift - 1U);
    const int32_t ratio_q30 = el_multiply_high_i32_u32(upper, reciprocal);
    return (int32_t)((uint32_t)base_q16 + (uint32_t)(ratio_q30 >> down));
}

/* The logarithm and reciprocal of this W, of some pixel. */
static inline void find_of_w(el_texture_walk *walk, uint64_t w)
{
    const unsigned shift = leading_zeros((uint32_t)(w >> 32), walk->w_shift);
    const uint32_t normalised = upper_word(w, shift);
    walk->w_shift = shift;
    walk->w_log2_q8 = log2_of_normalised_q8(normalised, shift);
    walk->reciprocal = el_reciprocal_near(normalised);
}

/* The same so many pixels from the span's first. */
static EACH_PIECE void find_w(el_texture_walk *walk, uint32_t pixels)
{
    find_of_w(walk, walk->w + el_multiply_u16(walk->w_dx, pixels));
}

static inline void find_first_knot(el_texture_axis *axis, unsigned w_shift, uint32_t reciprocal)
{
    axis->next_q16 = knot(axis->value, w_shift, reciprocal, axis->down, axis->base_q16);
}

/* The knot there: u or v, where find_w was; and the step that leads there from the knot before, whose distance has that
 * reciprocal. W's numbers are taken from the walk: as arguments they would be in registers that products need. */
static EACH_PIECE void find_knot(el_texture_axis *axis, const el_texture_walk *walk, uint32_t pixels,
                                 uint32_t step_reciprocal)
{
    const uint64_t value = axis->value + el_multiply_u16(axis->dx, pixels);
    const int32_t from_q16 = axis->next_q16;
    const int32_t to_q16 = knot(value, walk->w_shift, walk->reciprocal, axis->down, axis->base_q16);
    axis->q16 = from_q16;
    axis->next_q16 = to_q16;
    /* The difference over the length, rounded down: exact below 2^26, 1,024 texels, and one unit too much at most beyond. */
    axis->step_q16 = el_multiply_high_i32_u32(to_q16 - from_q16, step_reciprocal);
}

static inline int32_t step_q4_of(const el_texture_axis *axis)
{
    return (int32_t)((int64_t)axis->dx >> 28);
}

/* log2 of |J| times 2^shift, J = U' W - U W' with 4 bits of fraction, rounded up. Gradients are below 2^27, so with
 * 4 bits of fraction below 2^31, and a product below 2^62. Cutting off the rest of the gradients' fraction moves J by less
 * than W + |U| <= 2 W, cutting off that of U and W by less than |U'| + |W'|. */
static EL_SELDOM int32_t curvature_q8(el_texture_axis *axis, int32_t w, int32_t w_step_q4)
{
    const int32_t value = (int32_t)(uint32_t)(axis->value >> 32);
    const int32_t step_q4 = step_q4_of(axis);
    const int64_t j_q4 = el_product_i32(step_q4, w) - el_product_i32(value, w_step_q4);
    const uint64_t cut_off_q4 = el_abs_u64(step_q4) + el_abs_u64(w_step_q4) + 2U * ((uint64_t)(uint32_t)w + 1U);
    const uint64_t bound_q4 = el_abs_u64(j_q4) + cut_off_q4;
    return log2_ceil_q8(bound_q4, &axis->curvature_shift) + (30 - (int32_t)axis->down) * 256;
}

#if EL_SMALL_CODE
static inline int32_t find_curvature_q8(el_texture_axis *axis, int32_t w, int32_t w_step_q4)
{
    return curvature_q8(axis, w, w_step_q4);
}
#else
/* The same, mostly from upper words: they tell |J| to 3 * 2^32, and what is cut off is at most 2 * 2^32. So, in units of
 * 2^32, the number whose logarithm is asked for is at least the magnitude less 3, and less than 8 more. The logarithm looks
 * at eight bits, which mostly are the same from there to there. */
static inline int32_t find_curvature_q8(el_texture_axis *axis, int32_t w, int32_t w_step_q4)
{
    const int32_t value = (int32_t)(uint32_t)(axis->value >> 32);
    const int32_t step_q4 = step_q4_of(axis);
    /* Either is within 2^30 + 2. Where their difference runs over, the magnitude is within 3 of 2^31, and its bits are those
     * that do not tell. */
    const uint32_t upper = (uint32_t)el_product_near_i32(step_q4, w) - (uint32_t)el_product_near_i32(value, w_step_q4);
    const uint32_t magnitude = upper >> 31 != 0 ? 0U - upper : upper;
    if (magnitude < LEAST_UPPER) {
        return curvature_q8(axis, w, w_step_q4);
    }
    const uint32_t least = magnitude - 3U;
    const unsigned leading = leading_zeros(least, axis->curvature_shift); /* 21 at most */
    const uint32_t normalised = least << leading;
    if ((normalised & 0xFFFFFFU) >= (1U << 24) - (7U << leading)) {
        return curvature_q8(axis, w, w_step_q4);
    }
    axis->curvature_shift = leading;
    return log2_ceil_of_normalised_q8(normalised, 63 - (int32_t)leading + 30 - (int32_t)axis->down);
}
#endif

static bool is_steep(const el_plane *plane)
{
    return el_abs_u64((int64_t)plane->dx) >= 1ULL << (32 + STEEP_LOG2);
}

static EL_APART_IF_SMALL void start_axis(el_texture_axis *axis, const el_plane *plane, int32_t base_q16, unsigned shift)
{
    axis->dx = plane->dx;
    axis->base_q16 = base_q16;
    axis->down = 30U - shift;
    axis->curvature_shift = 0;
}

void el_texture_walk_start(el_texture_walk *walk, const el_triangle *triangle)
{
    const el_perspective *const p = &triangle->perspective;
    start_axis(&walk->u, &p->u, p->u_base_q16, p->u_shift);
    start_axis(&walk->v, &p->v, p->v_base_q16, p->v_shift);
    walk->w_dx = p->w.dx;
    walk->w_shift = 0;
    walk->first_length = LENGTHS - 1;
    walk->is_curved = false;
    if (p->w.dx == 0) {
        walk->limit_q8 = -NEVER_Q8;
    } else if (is_steep(&p->w) || is_steep(&p->u) || is_steep(&p->v)) {
        walk->limit_q8 = NEVER_Q8;
    } else {
        walk->is_curved = true;
        const int32_t w_step_q4 = (int32_t)((int64_t)p->w.dx >> 28);
        uint32_t near = 0;
        const int32_t w_step = log2_ceil_q8(el_abs_u64(w_step_q4) + 1U, &near);
        const int32_t error_q8 = -(int32_t)triangle->surface.uv_error_log2 * 256;
        /* 4 bits of fraction twice, 16 bits of u and v. */
        walk->without_j_q8 = w_step - (4 + 4 + 16) * 256 - 2 * 256 - error_q8 + ROUNDING_RESERVE_Q8;
    }
}

static void find_limit(el_texture_walk *walk)
{
    const int32_t w = (int32_t)(uint32_t)(walk->w >> 32);
    const int32_t w_step_q4 = (int32_t)((int64_t)walk->w_dx >> 28);
    const int32_t curvature =
        el_max_i32(find_curvature_q8(&walk->u, w, w_step_q4), find_curvature_q8(&walk->v, w, w_step_q4));
    const int32_t three = curvature + walk->without_j_q8;
    /* A third, rounded up: the constant keeps the dividend positive, 26,138 is the most and -6,374 the least that it can
     * be without, and for less than 2^16 the product is the quotient. */
    walk->limit_q8 = (int32_t)((uint32_t)(three + 3 * 4096 + 2) * 0xAAABU >> 17) - 4096;
}

#if EL_SMALL_CODE
static bool is_enough(const el_texture_walk *walk, uint32_t i)
{
    return walk->w_log2_q8 >= walk->limit_q8 + length_q8[i];
}

static inline void find_first_length(el_texture_walk *walk)
{
    uint32_t i = LENGTHS - 1;
    while (i > 0 && !is_enough(walk, i)) {
        i--;
    }
    walk->length = i;
}
#else
/* Pieces of lengths[i], until W is enough for longer ones, or at a piece's end not enough for these. */
static void set_length(el_texture_walk *walk, uint32_t i)
{
    walk->length = i;
    walk->pixels = lengths[i];
    walk->more_q8 = INT32_MAX;
    walk->enough_q8 = INT32_MIN;
    if ((int64_t)walk->w_dx < 0) {
        /* Where it was not enough for more than a pixel, it never is again. */
        walk->enough_q8 = i > 0 ? walk->limit_q8 + length_q8[i] : INT32_MIN;
    } else if (i + 1U < LENGTHS) {
        walk->more_q8 = walk->limit_q8 + length_q8[i + 1U];
    }
}

/* The longest piece for which W here is enough: the first one where W grows; where it falls, the first is no longer.
 * It is looked for from that of the row above on. */
static inline void find_first_length(el_texture_walk *walk)
{
    uint32_t i = walk->first_length;
    while (i < LENGTHS - 1 && walk->w_log2_q8 >= walk->limit_q8 + length_q8[i + 1]) {
        i++;
    }
    while (i > 0 && walk->w_log2_q8 < walk->limit_q8 + length_q8[i]) {
        i--;
    }
    walk->first_length = i;
    set_length(walk, i);
}
#endif

/* A plane in column x of its row. */
static EACH_PIECE uint64_t plane_at(const el_plane *plane, uint32_t x)
{
    return plane->value + el_multiply_u16(plane->dx, x);
}

void el_texture_walk_begin(el_texture_walk *walk, const el_perspective *planes, uint32_t x, uint32_t pixels)
{
    walk->w = plane_at(&planes->w, x) + EL_W_MARGIN_Q32;
    walk->u.value = plane_at(&planes->u, x);
    walk->v.value = plane_at(&planes->v, x);
    find_w(walk, 0);
    find_first_knot(&walk->u, walk->w_shift, walk->reciprocal);
    find_first_knot(&walk->v, walk->w_shift, walk->reciprocal);
    if (pixels == 1) {
        return;
    }
    if (walk->is_curved) {
        find_limit(walk);
    }
    find_first_length(walk);
}

#if !EL_SMALL_CODE && EL_WITH_SAMPLES
void el_texture_walk_point(el_texture_walk *walk, const el_perspective *planes, uint32_t x, const uint64_t wuv[3])
{
    find_of_w(walk, EL_W_MARGIN_Q32 + plane_at(&planes->w, x) + wuv[0]);
    walk->u.value = plane_at(&planes->u, x) + wuv[1];
    walk->v.value = plane_at(&planes->v, x) + wuv[2];
    find_first_knot(&walk->u, walk->w_shift, walk->reciprocal);
    find_first_knot(&walk->v, walk->w_shift, walk->reciprocal);
}
#endif

/* 2^32 / length, rounded up, modulo 2^32: of a piece of one pixel no step is needed. */
#if EL_SMALL_CODE
static uint32_t reciprocal_of(uint32_t length)
{
    return 0xFFFFFFFFU / length + 1U;
}
#else
static const uint32_t reciprocals[EL_MAX_PIECE + 1] = {
    0,          0,          2147483648U, 1431655766U, 1073741824U, 858993460U, 715827883U, 613566757U, 536870912U,
    477218589U, 429496730U, 390451573U,  357913942U,  330382100U,  306783379U, 286331154U, 268435456U, 252645136U,
    238609295U, 226050911U, 214748365U,  204522253U,  195225787U,  186737709U, 178956971U, 171798692U, 165191050U,
    159072863U, 153391690U, 148102321U,  143165577U,  138547333U,  134217728U, 130150525U, 126322568U, 122713352U,
    119304648U, 116080198U, 113025456U,  110127367U,  107374183U,  104755300U, 102261127U, 99882961U,  97612894U,
    95443718U,  93368855U,  91382283U,   89478486U,   87652394U,   85899346U,  84215046U,  82595525U,  81037119U,
    79536432U,  78090315U,  76695845U,   75350304U,   74051161U,   72796056U,  71582789U,  70409300U,  69273667U,
    68174085U,  67108864U,
};

static inline uint32_t reciprocal_of(uint32_t length)
{
    return reciprocals[length];
}
#endif

#if EL_SMALL_CODE
/* Finds W at the piece's end, whose length it returns. W grows, and so do pieces; or it falls, and is not enough for them at
 * their end. */
static inline uint32_t find_end(el_texture_walk *walk, uint32_t at, uint32_t most)
{
    const bool falls = (int64_t)walk->w_dx < 0;
    uint32_t i = walk->length;
    while (!falls && i < LENGTHS - 1 && is_enough(walk, i + 1U)) {
        i++;
    }
    uint32_t length;
    for (;; i--) {
        length = lengths[i] < most ? lengths[i] : most;
        find_w(walk, at + length);
        if (!falls || i == 0 || is_enough(walk, i)) {
            break;
        }
    }
    walk->length = i;
    return length;
}
#else
/* W has grown, and so do pieces. */
static __attribute__((noinline)) void lengthen(el_texture_walk *walk)
{
    uint32_t i = walk->length;
    do {
        i++;
    } while (i < LENGTHS - 1 && walk->w_log2_q8 >= walk->limit_q8 + length_q8[i + 1]);
    set_length(walk, i);
}

/* W falls, and is not enough at the piece's end: the longest piece for which it is. */
static __attribute__((noinline)) uint32_t shorten(el_texture_walk *walk, uint32_t at, uint32_t most)
{
    uint32_t i = walk->length;
    uint32_t length;
    do {
        i--;
        length = lengths[i] < most ? lengths[i] : most;
        find_w(walk, at + length);
    } while (i > 0 && walk->w_log2_q8 < walk->limit_q8 + length_q8[i]);
    set_length(walk, i);
    return length;
}

static inline uint32_t find_end(el_texture_walk *walk, uint32_t at, uint32_t most)
{
    if (walk->w_log2_q8 >= walk->more_q8) {
        lengthen(walk);
    }
    uint32_t length = walk->pixels < most ? walk->pixels : most;
    find_w(walk, at + length);
    if (walk->w_log2_q8 < walk->enough_q8) {
        length = shorten(walk, at, most);
    }
    return length;
}
#endif

static EL_SPECIALISED uint32_t make_piece(el_texture_walk *walk, uint32_t at, uint32_t most)
{
    const uint32_t length = find_end(walk, at, most);
    const uint32_t step_reciprocal = reciprocal_of(length);
    find_knot(&walk->u, walk, at + length, step_reciprocal);
    find_knot(&walk->v, walk, at + length, step_reciprocal);
    return length;
}

uint32_t el_texture_walk_piece(el_texture_walk *walk, uint32_t at, uint32_t most)
{
    return make_piece(walk, at, most);
}

#if !EL_SMALL_CODE
/* U or V from pixel to pixel. */
typedef struct steps {
    uint64_t value, dx;
    unsigned down;
    int32_t base_q16;
} steps;

static inline steps steps_of(const el_texture_axis *axis, uint32_t at)
{
    return (steps){
        .value = axis->value + el_multiply_u16(axis->dx, at),
        .dx = axis->dx,
        .down = axis->down,
        .base_q16 = axis->base_q16,
    };
}

static inline int32_t next_knot(steps *s, const el_texture_walk *walk)
{
    s->value += s->dx;
    return knot(s->value, walk->w_shift, walk->reciprocal, s->down, s->base_q16);
}

/* Pieces of one pixel, until W is enough for longer ones. */
static __attribute__((noinline)) uint32_t draw_knots(el_texture_walk *walk, const el_texel_source *source,
                                                     uint16_t *colour, uint32_t at, uint32_t most)
{
    el_texture_walk here = *walk;
    const el_texel_source from = *source;
    steps u = steps_of(&walk->u, at);
    steps v = steps_of(&walk->v, at);
    uint64_t w = walk->w + el_multiply_u16(walk->w_dx, at);
    int32_t u_q16 = walk->u.next_q16;
    int32_t v_q16 = walk->v.next_q16;
    uint16_t *const begin = colour;
    const uint16_t *const end = colour + most;
    do {
        *colour++ = (uint16_t)el_texel_at(&from, (uint32_t)u_q16, (uint32_t)v_q16);
        w += here.w_dx;
        find_of_w(&here, w);
        u_q16 = next_knot(&u, &here);
        v_q16 = next_knot(&v, &here);
    } while (colour != end && here.w_log2_q8 < here.more_q8);
    walk->w_log2_q8 = here.w_log2_q8;
    walk->w_shift = here.w_shift;
    walk->reciprocal = here.reciprocal;
    walk->u.next_q16 = u_q16;
    walk->v.next_q16 = v_q16;
    return (uint32_t)(colour - begin);
}

static EL_SPECIALISED el_texel_row row_of(const el_texture_walk *walk, uint16_t *colour, uint32_t count)
{
    return (el_texel_row){
        .u_q16 = (uint32_t)walk->u.q16,
        .v_q16 = (uint32_t)walk->v.q16,
        .u_step_q16 = (uint32_t)walk->u.step_q16,
        .v_step_q16 = (uint32_t)walk->v.step_q16,
        .colour = colour,
        .count = count,
    };
}

/* Makes a piece and draws it. */
static EACH_PIECE uint32_t draw_piece(el_texture_walk *walk, const el_texels *texels, uint16_t *colour, uint32_t at,
                                      uint32_t most)
{
    const uint32_t length = make_piece(walk, at, most);
    const el_texel_row row = row_of(walk, colour, length);
    el_draw_texels(texels, &row);
    return length;
}

void el_texture_walk_draw(el_texture_walk *walk, const el_texels *texels, uint16_t *colour, uint32_t pixels)
{
    uint32_t at = 0;
    while (at < pixels) {
        if (walk->pixels == 1 && walk->w_log2_q8 < walk->more_q8) {
            at += draw_knots(walk, &texels->source, colour + at, at, pixels - at);
        } else {
            at += draw_piece(walk, texels, colour + at, at, pixels - at);
        }
    }
}

void el_texture_walk_draw_part(const el_texture_walk *walk, const el_texels *texels, uint16_t *colour, uint32_t count)
{
    const el_texel_row row = row_of(walk, colour, count);
    el_draw_texels(texels, &row);
}
#endif
