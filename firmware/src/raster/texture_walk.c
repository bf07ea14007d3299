#include "raster/texture_walk.h"

#include "base/divide.h"
#include "base/fixed.h"

enum {
    LENGTHS = 13,
    STEEP_LOG2 = 27, /* gradients of 2^27 per pixel and more, of 2^31: a knot at every pixel */
    NEVER_Q8 = 1 << 20,
    /* log2(16/15): a sixteenth of the error is left for rounding. Knots are exact to 3 * 2^-16 texel and steps are cut off
     * at 2^-16, which adds up to 2^-10 in the longest piece; at the smallest error, 1/32, 2^-9 is left. */
    ROUNDING_RESERVE_Q8 = 24
};

static const uint8_t lengths[LENGTHS] = {4, 5, 6, 7, 8, 9, 11, 13, 16, 22, 32, 45, EL_MAX_PIECE};

/* 2/3 log2 of each length, rounded up, and log2(1 + i/128), rounded down, in Q8. */
static const uint16_t length_q8[LENGTHS] = {342, 397, 442, 480, 512, 542, 591, 632, 683, 762, 854, 938, 1024};

static const uint16_t log2_q8[129] = {
    0,   2,   5,   8,   11,  14,  16,  19,  22,  25,  27,  30,  33,  35,  38,  40,  43,  46,  48,  51,  53,  56,
    58,  61,  63,  65,  68,  70,  73,  75,  77,  80,  82,  84,  87,  89,  91,  93,  96,  98,  100, 102, 104, 106,
    109, 111, 113, 115, 117, 119, 121, 123, 125, 127, 129, 132, 134, 136, 138, 140, 141, 143, 145, 147, 149, 151,
    153, 155, 157, 159, 161, 162, 164, 166, 168, 170, 172, 173, 175, 177, 179, 181, 182, 184, 186, 188, 189, 191,
    193, 194, 196, 198, 200, 201, 203, 205, 206, 208, 209, 211, 213, 214, 216, 218, 219, 221, 222, 224, 225, 227,
    229, 230, 232, 233, 235, 236, 238, 239, 241, 242, 244, 245, 247, 248, 250, 251, 253, 254, 256};

/* log2 x rounded down, of an x >= 1 moved up by its leading zeros. */
static inline int32_t log2_of_normalised_q8(uint32_t x, unsigned leading)
{
    return (31 - (int32_t)leading) * 256 + log2_q8[(x >> 24) & 127U];
}

static inline int32_t log2_floor_q8(uint32_t x)
{
    const unsigned leading = (unsigned)__builtin_clz(x);
    return log2_of_normalised_q8(x << leading, leading);
}

/* log2 x rounded up; x >= 1. */
static int32_t log2_ceil_q8(uint64_t x)
{
    const int leading = __builtin_clzll(x);
    return (63 - leading) * 256 + log2_q8[(((x << leading) >> 56) & 127U) + 1U] + 1;
}

/* The upper word of x << shift, shift <= 31. */
static inline uint32_t upper_word(uint64_t x, unsigned shift)
{
    return (uint32_t)(x >> 32) << shift | (uint32_t)x >> 1 >> (31U - shift);
}

/* base + 2^shift U / W in Q16 texels, off by less than 3 units. |U| <= W < 2^31, so with both moved up by W's leading
 * zeros, at least one, U fits 33 bits; 31 of them and the sign are kept, and their product with 2^63 / W is 2^30 U / W,
 * off by less than 3 for what is cut off and EL_RECIPROCAL_ERROR / 2 for the reciprocal: less than 2 units of the result,
 * whose shift is at most 27, and one is cut off again. */
static inline int32_t knot(uint64_t u_q32, unsigned w_shift, uint32_t reciprocal, uint8_t shift, int32_t base_q16)
{
    const int32_t upper = (int32_t)upper_word(u_q32, w_shift - 1U);
    const int32_t ratio_q30 = el_multiply_high_i32_u32(upper, reciprocal);
    return (int32_t)((uint32_t)base_q16 + (uint32_t)(ratio_q30 >> (30 - shift)));
}

/* Moves the planes' values to the right. */
static inline void go_on(el_texture_walk *walk, uint32_t pixels)
{
    const el_perspective *const p = walk->planes;
    walk->w += el_multiply_u16(p->w.dx, pixels);
    walk->u += el_multiply_u16(p->u.dx, pixels);
    walk->v += el_multiply_u16(p->v.dx, pixels);
}

/* u and v where the planes' values are. */
static inline void find_knot(el_texture_walk *walk)
{
    const el_perspective *const p = walk->planes;
    const unsigned w_shift = (unsigned)__builtin_clz((uint32_t)(walk->w >> 32));
    const uint32_t normalised = upper_word(walk->w, w_shift);
    const uint32_t reciprocal = el_reciprocal_near(normalised);
    walk->w_log2_q8 = log2_of_normalised_q8(normalised, w_shift);
    walk->next_u_q16 = knot(walk->u, w_shift, reciprocal, p->u_shift, p->u_base_q16);
    walk->next_v_q16 = knot(walk->v, w_shift, reciprocal, p->v_shift, p->v_base_q16);
}

/* log2 of |J| times 2^shift, J = U' W - U W' with 4 bits of fraction, rounded up. Gradients are below 2^27, so with
 * 4 bits of fraction below 2^31, and a product below 2^62. Cutting off the rest of the gradients' fraction moves J by less
 * than W + |U| <= 2 W, cutting off that of U and W by less than |U'| + |W'|. */
static int32_t curvature_q8(uint64_t value_q32, const el_plane *plane, int32_t w, int32_t w_step_q4, uint8_t shift)
{
    const int32_t value = (int32_t)(uint32_t)(value_q32 >> 32);
    const int32_t step_q4 = (int32_t)((int64_t)plane->dx >> 28);
    const int64_t j_q4 = el_product_i32(step_q4, w) - el_product_i32(value, w_step_q4);
    const uint64_t cut_off_q4 = el_abs_u64(step_q4) + el_abs_u64(w_step_q4) + 2U * ((uint64_t)(uint32_t)w + 1U);
    const uint64_t bound_q4 = el_abs_u64(j_q4) + cut_off_q4;
    return log2_ceil_q8(bound_q4) + shift * 256;
}

static bool is_steep(const el_plane *plane)
{
    return el_abs_u64((int64_t)plane->dx) >= 1ULL << (32 + STEEP_LOG2);
}

void el_texture_walk_begin(el_texture_walk *walk, const el_triangle *triangle, int32_t x)
{
    const el_perspective *const p = &triangle->perspective;
    walk->planes = p;
    walk->w = p->w.value + EL_W_MARGIN_Q32;
    walk->u = p->u.value;
    walk->v = p->v.value;
    go_on(walk, (uint32_t)x);
    walk->length = LENGTHS - 1;
    find_knot(walk);
    walk->u_step_q16 = 0;
    walk->v_step_q16 = 0;

    if (p->w.dx == 0) {
        walk->limit_q8 = -NEVER_Q8;
    } else if (is_steep(&p->w) || is_steep(&p->u) || is_steep(&p->v)) {
        walk->limit_q8 = NEVER_Q8;
    } else {
        const int32_t w = (int32_t)(uint32_t)(walk->w >> 32);
        const int32_t w_step_q4 = (int32_t)((int64_t)p->w.dx >> 28);
        const int32_t curvature = el_max_i32(curvature_q8(walk->u, &p->u, w, w_step_q4, p->u_shift),
                                             curvature_q8(walk->v, &p->v, w, w_step_q4, p->v_shift));
        const int32_t w_step = log2_ceil_q8(el_abs_u64(w_step_q4) + 1U);
        /* 4 bits of fraction twice, 16 bits of u and v. */
        const int32_t product_q8 = curvature + w_step - (4 + 4 + 16) * 256;
        const int32_t error_q8 = -(int32_t)triangle->surface.uv_error_log2 * 256;
        /* A third, rounded up: the constant keeps the dividend positive, 26,138 is the most and -6,374 the least that it can
         * be without, and for less than 2^16 the product is the quotient. */
        const int32_t three = product_q8 - 2 * 256 - error_q8 + ROUNDING_RESERVE_Q8;
        walk->limit_q8 = (int32_t)((uint32_t)(three + 3 * 4096 + 2) * 0xAAABU >> 17) - 4096;
    }
}

/* 2^32 / length, rounded up; length >= 2. */
#if EL_SMALL_CODE
static uint32_t reciprocal_of(int32_t length)
{
    return 0xFFFFFFFFU / (uint32_t)length + 1U;
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

static inline uint32_t reciprocal_of(int32_t length)
{
    return reciprocals[length];
}
#endif

/* The longest piece that keeps to the error, `most` pixels at most. */
static inline int32_t piece_length(el_texture_walk *walk, int32_t most)
{
    const uint64_t w_step = walk->planes->w.dx;
    int32_t i = walk->length;
    if ((int64_t)w_step >= 0) {
        /* W grows, and so do pieces. */
        const int32_t room_q8 = walk->w_log2_q8 - walk->limit_q8;
        while (i < LENGTHS - 1 && room_q8 >= length_q8[i + 1]) {
            i++;
        }
        while (i >= 0 && room_q8 < length_q8[i]) {
            i--;
        }
    } else {
        for (; i >= 0; i--) {
            /* Longer than what is left of the span: as good as the shortest that is. */
            if (i > 0 && lengths[i - 1] >= most) {
                continue;
            }
            const uint32_t pixels = (uint32_t)el_min_i32(lengths[i], most);
            const uint32_t least = (uint32_t)((walk->w + el_multiply_u16(w_step, pixels)) >> 32);
            if (log2_floor_q8(least) >= walk->limit_q8 + length_q8[i]) {
                break;
            }
        }
    }
    walk->length = (uint8_t)el_max_i32(i, 0);
    return i < 0 ? 1 : el_min_i32(lengths[i], most);
}

int32_t el_texture_walk_piece(el_texture_walk *walk, int32_t left)
{
    walk->u_q16 = walk->next_u_q16;
    walk->v_q16 = walk->next_v_q16;
    if (left == 1) {
        return 1;
    }
    /* The last knot is on the last pixel: beyond it 1/w may be anything. */
    const int32_t length = piece_length(walk, left - 1);
    go_on(walk, (uint32_t)length);
    find_knot(walk);
    /* Differences over the length, rounded down: exact below 2^26, 1,024 texels, and one unit too much at most beyond. */
    walk->u_step_q16 = walk->next_u_q16 - walk->u_q16;
    walk->v_step_q16 = walk->next_v_q16 - walk->v_q16;
    if (length > 1) {
        const uint32_t reciprocal = reciprocal_of(length);
        walk->u_step_q16 = el_multiply_high_i32_u32(walk->u_step_q16, reciprocal);
        walk->v_step_q16 = el_multiply_high_i32_u32(walk->v_step_q16, reciprocal);
    }
    return length;
}
