/* Angles as fractions of a turn, and their sines. */
#ifndef EL_BASE_ANGLE_H
#define EL_BASE_ANGLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* 2^32 is a whole turn, so angles wrap by themselves. */
typedef uint32_t el_angle;

/* `numerator`/`denominator` degrees as an angle, at compile time: EL_DEGREES(45, 1), EL_DEGREES(7374, 100).
 * Ranges: 0 <= numerator < 2^20, 1 <= denominator <= 2^20. */
#define EL_DEGREES(numerator, denominator)                                                                             \
    ((el_angle)((((uint64_t)(numerator) << 32) / (uint64_t)(denominator) + 180U) / 360U))

/* Q2.30, within 2 units of the exact value. */
int32_t el_sin_q30(el_angle angle);
int32_t el_cos_q30(el_angle angle);

/* The direction of (x, y), counter-clockwise from x, within 8 units of 2^-32 turn; 0 for (0, 0). Any numbers. */
el_angle el_atan2(int64_t y, int64_t x);

#ifdef __cplusplus
}
#endif

#endif
