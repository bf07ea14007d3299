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

bool el_arrow_between(el_arrow *arrow, const int64_t from[3], const int32_t to[3])
{
    int64_t way[3];
    int32_t vector[3];
    uint32_t beyond = 0;
    for (unsigned i = 0; i < 3; i++) {
        way[i] = to[i] - from[i];
        vector[i] = (int32_t)way[i];
        beyond |= (uint32_t)((uint64_t)(way[i] + (1LL << 30)) >> 31); /* 0 from -2^30 to below 2^30 */
    }
    if (beyond == 0) {
        return el_arrow_make(arrow, vector);
    }
    uint64_t bits = 0;
    for (unsigned i = 0; i < 3; i++) {
        bits |= el_abs_u64(way[i]);
    }
    const int down = el_bit_length_u64(bits) - 30; /* at least 1 */
    for (unsigned i = 0; i < 3; i++) {
        vector[i] = (int32_t)(way[i] >> down);
    }
    (void)el_arrow_make(arrow, vector);
    arrow->shift -= down;
    return true;
}

void el_arrow_measure(el_arrow *arrow)
{
    uint32_t square = 0;
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t part = (uint32_t)(arrow->v[i] < 0 ? -arrow->v[i] : arrow->v[i]);
        square += el_product_high_u32(part, part); /* less than 2^30 each */
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
