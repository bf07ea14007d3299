#include "geometry/vector.h"

#include "base/fixed.h"
#include "geometry/pose.h"

int32_t el_clamp_unit(int64_t value_q30)
{
    if (value_q30 > EL_UNIT_Q30) {
        return EL_UNIT_Q30;
    }
    return value_q30 < -EL_UNIT_Q30 ? -EL_UNIT_Q30 : (int32_t)value_q30;
}

int el_vector_normalise(const int64_t v[], unsigned count, int32_t unit_q30[])
{
    uint64_t bits = 0;
    for (unsigned i = 0; i < count; i++) {
        bits |= el_abs_u64(v[i]);
    }
    if (bits == 0) {
        return 0;
    }
    /* 30 bits each, or 2^30: the sum of four squares is 2^62 at most. */
    const int size_bits = el_bit_length_u64(bits);
    const int shift = size_bits - 30;
    uint64_t sum = 0;
    for (unsigned i = 0; i < count; i++) {
        const int64_t scaled = el_shift_i64(v[i], shift);
        sum += (uint64_t)(scaled * scaled);
    }
    const int64_t length = el_sqrt_u64(sum);
    for (unsigned i = 0; i < count; i++) {
        unit_q30[i] = el_clamp_unit((el_shift_i64(v[i], shift) * EL_UNIT_Q30) / length);
    }
    return size_bits;
}

int32_t el_vector_dot_high(const int32_t a[3], const int32_t b[3])
{
    return (int32_t)(el_product_i32(a[0], b[0]) >> 32) + (int32_t)(el_product_i32(a[1], b[1]) >> 32) +
           (int32_t)(el_product_i32(a[2], b[2]) >> 32);
}

void el_vector_cross(const int32_t a_q30[3], const int32_t b_q30[3], int64_t product[3])
{
    for (unsigned i = 0; i < 3; i++) {
        const unsigned j = (i + 1U) % 3U;
        const unsigned k = (i + 2U) % 3U;
        product[i] = (int64_t)a_q30[j] * b_q30[k] - (int64_t)a_q30[k] * b_q30[j];
    }
}

int64_t el_clamp_place(int64_t value_q16)
{
    const int64_t most = (1LL << 32) - 1;
    return value_q16 > most ? most : (value_q16 < -most ? -most : value_q16);
}

int64_t el_vector_along(const int32_t row_q30[3], const int64_t v[3])
{
    int64_t sum_q28 = 0;
    for (unsigned i = 0; i < 3; i++) {
        sum_q28 += v[i] * row_q30[i] >> 2; /* the product below 2^63 */
    }
    return el_shift_i64(sum_q28, 28);
}
