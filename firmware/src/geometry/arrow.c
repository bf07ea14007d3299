#include "geometry/arrow.h"

#include "base/fixed.h"
#include "base/root.h"

bool el_arrow_make(el_arrow *arrow, const int32_t vector[3])
{
    uint32_t bits = 0;
    for (unsigned i = 0; i < 3; i++) {
        bits |= (uint32_t)(vector[i] < 0 ? -vector[i] : vector[i]);
    }
    if (bits == 0) {
        return false;
    }
    const unsigned up = el_leading_zeros(bits) - 1U;
    for (unsigned i = 0; i < 3; i++) {
        arrow->v[i] = (int32_t)((uint32_t)vector[i] << up);
    }
    arrow->shift = (int)up;
    return true;
}

/* Where 31 bits are too few: with the upper 30 of the greatest. */
static bool make_of_far(el_arrow *arrow, const int64_t from[3], const int32_t to[3])
{
    uint64_t bits = 0;
    for (unsigned i = 0; i < 3; i++) {
        bits |= el_abs_u64(to[i] - from[i]);
    }
    const int down = el_bit_length_u64(bits) - 30;
    int32_t vector[3];
    for (unsigned i = 0; i < 3; i++) {
        vector[i] = (int32_t)((to[i] - from[i]) >> down);
    }
    const bool made = el_arrow_make(arrow, vector);
    arrow->shift -= down;
    return made;
}

bool el_arrow_between(el_arrow *arrow, const int64_t from[3], const int32_t to[3])
{
    int32_t vector[3];
    int32_t beyond = 0; /* bits from the 31st on that are not the sign's */
    for (unsigned i = 0; i < 3; i++) {
        const int64_t way = to[i] - from[i];
        const int32_t upper = (int32_t)(way >> 30); /* 0 or -1 */
        vector[i] = (int32_t)way;
        beyond |= upper ^ (upper >> 31);
    }
    return beyond == 0 ? el_arrow_make(arrow, vector) : make_of_far(arrow, from, to);
}

void el_arrow_measure(el_arrow *arrow)
{
    uint32_t square = 0;
    for (unsigned i = 0; i < 3; i++) {
        square += (uint32_t)(el_product_i32(arrow->v[i], arrow->v[i]) >> 32); /* less than 2^30 each */
    }
    arrow->square = square;
    /* 2^46 / sqrt(square) */
    arrow->to_unit = square >> 30 != 0 ? el_reciprocal_root(square) >> 1 : el_reciprocal_root(square << 2);
}

void el_arrow_direction(const el_arrow *arrow, int32_t unit_q30[3])
{
    for (unsigned i = 0; i < 3; i++) {
        unit_q30[i] = el_multiply_high_i32_u32(arrow->v[i], arrow->to_unit);
    }
}
