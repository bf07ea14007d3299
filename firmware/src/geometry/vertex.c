/* What is done once per vertex: rows times positions, outcodes, projection and snapping.
 *
 * el_transform_position, el_outcode and el_project say what a vertex is, with all bits. Most vertices are in the view, and
 * theirs come from a reciprocal and products without the last bits, with as much room about each rounding: where they
 * might differ, the exact way is taken, so that every core has the same bits. */
#include "geometry/transform.h"

#include <string.h>

#include "base/divide.h"

_Static_assert(EL_SUBPIXEL_BITS > 4 || EL_GUARD_SUB < 32767, "rounding may add a unit");

/* A mesh position, each coordinate read once. */
typedef struct el_place {
    int32_t x, y, z;
} el_place;

static inline el_place place_of(const int16_t position[3])
{
    return (el_place){.x = position[0], .y = position[1], .z = position[2]};
}

#if defined(EL_PRODUCTS_IN_HALVES)
static uint32_t low_bits(uint32_t value, unsigned bits)
{
    return value & ((1U << bits) - 1U);
}

void el_transform_set_rows(el_transform *transform, const int32_t elements[3][3], const int64_t offsets[3],
                           unsigned shift)
{
    /* With 15 bits below, both sums fit 32 bits; with no more than will be shifted out, the upper one needs no shift. The
     * lower one has 15 all the same: by what is known it is shifted faster. */
    const unsigned split = shift < EL_ROW_SHIFT ? shift : (unsigned)EL_ROW_SHIFT;
    const unsigned raise = (unsigned)EL_ROW_SHIFT - split;
    transform->split = (uint8_t)split;
    transform->over = (uint8_t)(shift - split);
    for (unsigned i = 0; i < 3; i++) {
        el_row *const row = &transform->rows[i];
        row->whole = (uint32_t)((uint64_t)offsets[i] >> shift);
        row->rest_high = (uint16_t)(low_bits((uint32_t)offsets[i], shift) >> split);
        row->rest_low = (uint16_t)(low_bits((uint32_t)offsets[i], split) << raise);
        for (unsigned j = 0; j < 3; j++) {
            row->high[j] = (elements[i][j] + (1 << (split - 1U))) >> split;
            row->low[j] = (elements[i][j] - row->high[j] * (1 << split)) * (1 << raise);
        }
    }
}

static inline int32_t form_value(const el_transform *transform, unsigned i, el_place p, bool plain)
{
    /* The lower sum is below 3 * 2^14 * 2^15 + 2^15. The upper one with what is carried is the whole one over 2^split:
     * where that is 2^15 it is below EL_ROW_MOST + 2^17, and else it is not shifted and as good modulo 2^32, and there
     * is no upper rest. */
    const el_row *const row = &transform->rows[i];
    int32_t low = row->rest_low;
    uint32_t high = plain ? row->whole : row->rest_high;
    low += row->low[0] * p.x;
    low += row->low[1] * p.y;
    low += row->low[2] * p.z;
    high += (uint32_t)(low >> EL_ROW_SHIFT);
    high += (uint32_t)row->high[0] * (uint32_t)p.x;
    high += (uint32_t)row->high[1] * (uint32_t)p.y;
    high += (uint32_t)row->high[2] * (uint32_t)p.z;
    const int32_t value = (int32_t)(plain ? high : row->whole + (uint32_t)((int32_t)high >> transform->over));
    EL_READ_AGAIN();
    return value;
}

/* No bit is shifted out of upper sums, and depth has its short way, as it has in perspective alone: nearly all draws. */
static inline bool is_plain(const el_transform *transform)
{
    return transform->over == 0 && transform->depth_excess != 0;
}
#elif EL_SMALL_CODE
void el_transform_set_rows(el_transform *transform, const int32_t elements[3][3], const int64_t offsets[3],
                           unsigned shift)
{
    transform->shift = (uint8_t)shift;
    for (unsigned i = 0; i < 3; i++) {
        transform->rows[i].offset = offsets[i];
        memcpy(transform->rows[i].elements, elements[i], sizeof transform->rows[i].elements);
    }
}

/* `plain`: as above, for which this has no use. */
static inline int32_t form_value(const el_transform *transform, unsigned i, el_place p, bool plain)
{
    (void)plain;
    /* Three products below 2^46 and an offset below 2^62. */
    const el_row *const row = &transform->rows[i];
    const uint64_t sum = (uint64_t)(row->offset + (int64_t)row->elements[0] * p.x + (int64_t)row->elements[1] * p.y +
                                    (int64_t)row->elements[2] * p.z);
    /* The lower word of sum >> shift, 1 <= shift <= 31. */
    return (int32_t)((uint32_t)(sum >> 32) << (32 - transform->shift) | (uint32_t)sum >> transform->shift);
}

static inline bool is_plain(const el_transform *transform)
{
    (void)transform;
    return false;
}
#else
/* How far elements with `shift` can be moved up on the way to EL_ROW_SHIFT, all or nothing. */
static unsigned raise_of(const int32_t elements[3][3], unsigned shift)
{
    uint32_t all = 0;
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            const int32_t element = elements[i][j];
            all |= (uint32_t)(element < 0 ? ~element : element);
        }
    }
    const unsigned missing = shift < EL_ROW_SHIFT ? EL_ROW_SHIFT - shift : 0U;
    return all >> (31U - missing) == 0 ? missing : 0U;
}

void el_transform_set_rows(el_transform *transform, const int32_t elements[3][3], const int64_t offsets[3],
                           unsigned shift)
{
    const unsigned raise = raise_of(elements, shift);
    transform->shift = (uint8_t)(shift + raise);
    transform->raise = (uint8_t)raise;
    for (unsigned i = 0; i < 3; i++) {
        transform->rows[i].offset = (int64_t)((uint64_t)offsets[i] << raise);
        for (unsigned j = 0; j < 3; j++) {
            transform->rows[i].elements[j] = elements[i][j] * (1 << raise);
        }
    }
}

/* Products are added where they are made, to a sum that begins with the offset: a compiler that may add in any order
 * makes products first and adds them afterwards. */
static inline uint64_t in_this_order(uint64_t sum)
{
#if defined(__thumb__)
    uint32_t low = (uint32_t)sum;
    uint32_t high = (uint32_t)(sum >> 32);
    __asm__("" : "+r"(low), "+r"(high));
    return (uint64_t)high << 32 | low;
#else
    return sum;
#endif
}

/* `plain`: the shift is EL_ROW_SHIFT. */
static inline int32_t form_value(const el_transform *transform, unsigned i, el_place p, bool plain)
{
    /* Modulo 2^64, of which the sum has the lower bits: three products below 2^48 and an offset below 2^62, raised. */
    const el_row *const row = &transform->rows[i];
    uint64_t sum = in_this_order((uint64_t)row->offset + (uint64_t)((int64_t)row->elements[0] * p.x));
    sum = in_this_order(sum + (uint64_t)((int64_t)row->elements[1] * p.y));
    sum += (uint64_t)((int64_t)row->elements[2] * p.z);
    /* The lower word of sum >> shift, 1 <= shift <= 31. */
    const unsigned shift = plain ? (unsigned)EL_ROW_SHIFT : transform->shift;
    return (int32_t)((uint32_t)(sum >> 32) << (32U - shift) | (uint32_t)sum >> shift);
}

/* Shifts are known, and depth has its short way, as it has in perspective alone: nearly all draws. */
static inline bool is_plain(const el_transform *transform)
{
    return transform->shift == EL_ROW_SHIFT && transform->depth_excess != 0;
}
#endif

void el_transform_set_depth(el_transform *transform, uint64_t near_q32, uint32_t scale_q12)
{
    transform->near_q32 = near_q32;
    transform->near = (int32_t)((near_q32 + 0xFFFFFFFFU) >> 32);
    transform->depth_scale = scale_q12;
    transform->depth_shift = 12;
    transform->depth_excess = 0;
#if !EL_SMALL_CODE
    /* The upper 32 bits of near, times the scale. near < 2^30: the excess is 2 at least. */
    const int shift = el_bit_length_u64(near_q32) - 32;
    if (shift >= 0 && scale_q12 < 1U << 29) {
        transform->depth_near = el_product_high_u32(scale_q12 << 3, (uint32_t)(near_q32 >> shift));
        transform->depth_excess = (uint8_t)(31 - shift);
    }
#endif
}

el_clip_vertex el_transform_position(const el_transform *transform, const int16_t position[3])
{
    const bool plain = is_plain(transform);
    const el_place place = place_of(position);
    int32_t coordinates[3];
    for (unsigned i = 0; i < 3; i++) {
        coordinates[i] = form_value(transform, i, place, plain);
    }
    const int32_t d = coordinates[2];
    return (el_clip_vertex){.x = coordinates[0],
                            .y = coordinates[1],
                            .d = d,
                            .w = el_transform_is_orthographic(transform) ? transform->constant_w : d};
}

/* The sides of the view that a vertex is beyond, whatever it and w are: ~w is -w - 1. */
static inline unsigned outside_code(const el_transform *transform, const el_clip_vertex *vertex)
{
    const int32_t w = vertex->w;
    unsigned code = vertex->x <= ~w ? EL_CODE_LEFT : 0U;
    code |= vertex->x > w ? EL_CODE_RIGHT : 0U;
    code |= vertex->y <= ~w ? EL_CODE_BELOW : 0U;
    code |= vertex->y > w ? EL_CODE_ABOVE : 0U;
    code |= vertex->d < transform->near ? EL_CODE_NEAR : 0U;
    code |= vertex->d > transform->far ? EL_CODE_FAR : 0U;
    return code;
}

/* Of one coordinate: v / 2^shift rounded down compares with a whole number as v does with that number times 2^shift. */
static bool is_beyond_guard(int32_t v, int32_t w, unsigned shift)
{
    return (v <= ~w && v >> shift <= ~w) || (v > w && (v - 1) >> shift >= w);
}

uint8_t el_outcode(const el_transform *transform, const el_clip_vertex *vertex)
{
    const unsigned code = outside_code(transform, vertex);
    const bool guard = is_beyond_guard(vertex->x, vertex->w, transform->guard_shift[0]) ||
                       is_beyond_guard(vertex->y, vertex->w, transform->guard_shift[1]);
    return (uint8_t)(code | (guard ? EL_CODE_GUARD : 0U));
}

/* middle + half * c / w in 1/EL_SUBPIXELS px, to the nearest, ties up.
 * |c| <= w << guard_shift keeps the quotient within EL_GUARD_SUB; |c| * half < 2^30 * 2^18. */
static el_coordinate snap(int64_t c, uint16_t size, uint32_t w, const el_divisor *divisor)
{
    const int32_t half = size * (EL_SUBPIXELS / 2);
    const int32_t offset = el_divide_floor_i64(c * half + (w >> 1), divisor);
    return (el_coordinate)(half + offset);
}

static uint16_t depth_of(const el_transform *transform, const el_clip_vertex *vertex, uint32_t w,
                         const el_divisor *divisor)
{
    uint32_t z;
    if (el_transform_is_orthographic(transform)) {
        const uint64_t distance = (uint64_t)(vertex->d - transform->near);
        const uint64_t product = distance * transform->depth_scale;
        z = (uint32_t)((product + ((1ULL << transform->depth_shift) >> 1)) >> transform->depth_shift);
    } else {
        /* depth = scale * (1 - near / w) */
        const uint32_t ratio_q32 =
            transform->near_q32 < (uint64_t)w << 32 ? el_divide_u64(transform->near_q32, divisor) : 0xFFFFFFFFU;
        const uint64_t product = (uint64_t)transform->depth_scale * ~ratio_q32;
        z = (uint32_t)((product + (1ULL << 43)) >> 44);
    }
    return (uint16_t)(z > EL_DEPTH_MAX ? EL_DEPTH_MAX : z);
}

/* 1/w = (2^32 + reciprocal) * 2^(shift - 64): the upper 16 bits of the sum, rounded, its first bit included. */
static void keep_reciprocal(el_screen_vertex *screen, const el_divisor *divisor)
{
    const uint32_t rest = ((divisor->reciprocal >> 16) + 1U) >> 1;
    screen->w = (uint16_t)(0x8000U + (rest > 0x7FFFU ? 0x7FFFU : rest));
    screen->w_shift = (uint8_t)(31 - divisor->shift);
}

void el_project(const el_transform *transform, const el_clip_vertex *vertex, el_screen_vertex *screen)
{
    const uint32_t w = (uint32_t)vertex->w;
    const el_divisor divisor = el_divisor_make(w);
    screen->x = snap(vertex->x, transform->size[0], w, &divisor);
    screen->y = snap(-(int64_t)vertex->y, transform->size[1], w, &divisor);
    screen->z = depth_of(transform, vertex, w, &divisor);
    keep_reciprocal(screen, &divisor);
}

#if !EL_SMALL_CODE
/* What a draw's vertices are snapped with. */
typedef struct el_scales {
    uint32_t width; /* times 2^5 */
    uint32_t height;
    uint32_t depth; /* of what is infinitely far, with DEPTH_FRACTION bits, and the half for rounding */
} el_scales;

/* Results are beside the exact ones by less than 2^TIE_BITS units of their fractions, and are not taken when they are so
 * near to a step. */
enum { TIE_BITS = 4, SNAP_FRACTION = 19 - EL_SUBPIXEL_BITS, DEPTH_FRACTION = 13, W_FRACTION = 15 };
static inline bool is_near_step(uint32_t value, unsigned fraction)
{
    return (value & ((1U << fraction) - (1U << TIE_BITS))) == 0;
}

/* snap without the last bits, for what is in the view, with SNAP_FRACTION bits. c + w is in [0, 2w], so with w moved up
 * to 31 bits, and c + w alike, no bit is lost, and their ratio with 29 bits of fraction is a product with the reciprocal:
 * too low by less than EL_RECIPROCAL_LOW + EL_PRODUCT_ERROR, 7, or too high by less than EL_RECIPROCAL_HIGH. Times
 * size * 2^-11 that is the result, too low by less than 8 with what is cut off of it: with so much more, it is too high
 * by less than 11. */
enum { SNAP_OFF = 8 };
static inline uint32_t snap_fast(uint32_t from_the_side, uint32_t size, uint32_t reciprocal)
{
    const uint32_t ratio = el_product_near_u32(from_the_side, reciprocal);
    return el_product_high_u16(ratio, size) + ((1U << SNAP_FRACTION) / 2U + (uint32_t)SNAP_OFF);
}

/* depth_of without the last bits, with DEPTH_FRACTION bits: scale * near / w is a product with the reciprocal, too low by
 * less than EL_RECIPROCAL_LOW + EL_PRODUCT_ERROR, one for what depth_near lacks, and what is cut off of one, 9, or too high
 * by less than EL_RECIPROCAL_HIGH; depth_of's own is less than a quarter of one above it. With DEPTH_OFF more, in
 * scales.depth, the depth is too high by less than 14. near <= w, so depth_excess is not below w_shift. */
enum { DEPTH_OFF = 4 };
static inline uint32_t depth_fast(const el_transform *transform, const el_scales *scales, unsigned w_shift,
                                  uint32_t reciprocal)
{
    const uint32_t product = el_product_near_u32(transform->depth_near, reciprocal);
    return scales->depth - (product >> (transform->depth_excess - w_shift));
}

/* keep_reciprocal from the reciprocal's upper bits. False where what it lacks might matter, and where it would be
 * rounded to more than 16 bits. */
static inline bool keep_reciprocal_fast(el_screen_vertex *screen, unsigned w_shift, uint32_t reciprocal)
{
    const uint32_t rounded = reciprocal + ((1U << W_FRACTION) / 2U + (uint32_t)EL_RECIPROCAL_LOW);
    if (is_near_step(rounded, W_FRACTION) || (int32_t)rounded < 0) {
        return false;
    }
    screen->w = (uint16_t)(rounded >> W_FRACTION);
    screen->w_shift = (uint8_t)(30U - w_shift);
    return true;
}

/* With all bits, where the last ones might matter: one vertex in some hundreds. */
static EL_SELDOM void project_again(const el_transform *transform, const int16_t position[3], el_screen_vertex *screen)
{
    const el_clip_vertex vertex = el_transform_position(transform, position);
    el_project(transform, &vertex, screen);
}

/* One comparison for each coordinate, and what is outside by one is not asked for the others. False where it is to be
 * projected again. */
static EL_SPECIALISED bool transform_in_view(const el_transform *transform, const el_scales *scales,
                                             const int16_t position[3], el_screen_vertex *screen, bool keeps_w,
                                             bool plain)
{
    const el_place place = place_of(position);
    const int32_t d = form_value(transform, 2, place, plain);
    const int32_t near = transform->near;
    if ((uint32_t)d - (uint32_t)near > (uint32_t)transform->far - (uint32_t)near) {
        screen->code = (uint8_t)(EL_CODE_LATER | (d < near ? EL_CODE_NEAR : EL_CODE_FAR));
        return true;
    }
    const bool orthographic = !plain && el_transform_is_orthographic(transform);
    const uint32_t w = (uint32_t)(orthographic ? transform->constant_w : d); /* 1 at least, below 2^31 */
    const int32_t x = form_value(transform, 0, place, plain);
    const uint32_t from_left = w + (uint32_t)x;
    if (from_left > 2U * w) {
        screen->code = (uint8_t)(EL_CODE_LATER | (x < 0 ? EL_CODE_LEFT : EL_CODE_RIGHT));
        return true;
    }
    const int32_t y = form_value(transform, 1, place, plain);
    const uint32_t from_above = w - (uint32_t)y;
    if (from_above > 2U * w) {
        screen->code = (uint8_t)(EL_CODE_LATER | (y < 0 ? EL_CODE_BELOW : EL_CODE_ABOVE));
        return true;
    }

    screen->code = 0;
    if (!plain && transform->depth_excess == 0) {
        return false;
    }
    const unsigned shift = el_leading_zeros(2U * w);
    const uint32_t reciprocal = el_reciprocal_beside(w << shift);
    const uint32_t right = snap_fast(from_left << shift, scales->width, reciprocal);
    const uint32_t down = snap_fast(from_above << shift, scales->height, reciprocal);
    const uint32_t depth = depth_fast(transform, scales, shift, reciprocal);
    if (is_near_step(right, SNAP_FRACTION) || is_near_step(down, SNAP_FRACTION) ||
        is_near_step(depth, DEPTH_FRACTION) || depth >> DEPTH_FRACTION > EL_DEPTH_MAX) {
        return false;
    }
    screen->x = (el_coordinate)(right >> SNAP_FRACTION);
    screen->y = (el_coordinate)(down >> SNAP_FRACTION);
    screen->z = (uint16_t)(depth >> DEPTH_FRACTION);
    return !keeps_w || keep_reciprocal_fast(screen, shift, reciprocal);
}

static EL_SPECIALISED void transform_vertices(const el_transform *transform, const int16_t (*positions)[3],
                                              uint32_t count, el_screen_vertex *screen, bool keeps_w, bool plain)
{
    const el_scales scales = {
        .width = (uint32_t)transform->size[0] << 5,
        .height = (uint32_t)transform->size[1] << 5,
        .depth = (transform->depth_scale << 1) + ((1U << DEPTH_FRACTION) / 2U + (uint32_t)DEPTH_OFF),
    };
    const el_screen_vertex *const end = screen + count;
    for (; screen != end; screen++) {
        if (!transform_in_view(transform, &scales, *positions, screen, keeps_w, plain)) {
            project_again(transform, *positions, screen);
        }
        positions++;
    }
}

/* A loop of its own for draws without 1/w. Where rows are long, so are loops, and the test is the smaller part. */
#if defined(EL_PRODUCTS_IN_HALVES)
enum { LOOPS_WITHOUT_W = 0 };
#else
enum { LOOPS_WITHOUT_W = 1 };
#endif

void el_transform_vertices(const el_transform *transform, const int16_t (*positions)[3], uint32_t count,
                           el_screen_vertex *screen, bool keeps_w)
{
    if (!is_plain(transform)) {
        transform_vertices(transform, positions, count, screen, keeps_w, false);
    } else if (LOOPS_WITHOUT_W && !keeps_w) {
        transform_vertices(transform, positions, count, screen, false, true);
    } else {
        transform_vertices(transform, positions, count, screen, keeps_w, true);
    }
}

void el_transform_vertex_in_view(const el_transform *transform, const int16_t position[3], el_screen_vertex *screen)
{
    el_transform_vertices(transform, (const int16_t(*)[3])position, 1, screen, true); /* not a copy of so much */
}
#endif

void el_transform_vertex(const el_transform *transform, const int16_t position[3], el_screen_vertex *screen)
{
#if !EL_SMALL_CODE
    el_transform_vertex_in_view(transform, position, screen);
    if (screen->code == 0) {
        return;
    }
#endif
    const el_clip_vertex vertex = el_transform_position(transform, position);
    screen->code = el_outcode(transform, &vertex);
    if ((screen->code & EL_CODE_CLIP) == 0) {
        el_project(transform, &vertex, screen);
    }
}
