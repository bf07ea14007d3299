/* What poses, cameras and quaternions have in common: lengths, products and rotations of a few numbers. Internal to the
 * geometry layer. */
#ifndef EL_GEOMETRY_VECTOR_H
#define EL_GEOMETRY_VECTOR_H

#include <stdint.h>

#include "base/fixed.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Rounding may carry an element of a product of rotations a few units beyond 1; the pose's range ends there. */
int32_t el_clamp_unit(int64_t value_q30);

static inline int32_t el_saturate_i32(int64_t value)
{
    return value > INT32_MAX ? INT32_MAX : (value < INT32_MIN ? INT32_MIN : (int32_t)value);
}

/* a * b in Q58 where both are in Q30: 2^60 at most, so that four of any words add up. */
static inline int64_t el_product_q58(int32_t a_q30, int32_t b_q30)
{
    return el_product_i32(a_q30, b_q30) >> 2;
}

/* Scales v, of 3 or 4 numbers, to length 1, Q30, within 4 units. Returns the bits of its largest number; 0 when v has no
 * length. Any v but INT64_MIN. */
int el_vector_normalise(const int64_t v[], unsigned count, int32_t unit_q30[]);

/* a . b / 2^32, each product rounded down; |a| |b| < 2^62. */
int32_t el_vector_dot_high(const int32_t a[3], const int32_t b[3]);

/* A product of two vectors of length 1 that has fewer bits, and so is shorter than 2^-20, is rounding, not a direction. */
enum { EL_DIRECTION_BITS = 41 };

/* |elements| <= 2^30. */
void el_vector_cross(const int32_t a_q30[3], const int32_t b_q30[3], int64_t product[3]);

/* Cut to what el_vector_along takes: four times the world's half. */
int64_t el_clamp_place(int64_t value_q16);

/* row * v, rounded to nearest, |v| < 2^32: below 3 * 2^33. */
int64_t el_vector_along(const int32_t row_q30[3], const int64_t v[3]);

#ifdef __cplusplus
}
#endif

#endif
