#include "base/angle.h"

/* pi * 2^28, rounded: 2 pi angle / 2^32 in Q31 is pi angle, so (angle * PI_Q28) >> 28. */
#define PI_Q28 843314857U

static int64_t multiply_q31(int64_t a, int64_t b)
{
    return (a * b + (1LL << 30)) >> 31; /* both at most 2^31 in magnitude here: the product is at most 2^62 */
}

/* sin and cos of x in [0, pi/4], Q31, by their Taylor series in Horner's form. The first term left out is x^13/13! below
 * 2^-37 for the sine and x^12/12! below 2^-32 for the cosine. */
static int64_t sin_series_q31(int64_t x)
{
    const int64_t one = 1LL << 31;
    const int64_t square = multiply_q31(x, x);
    int64_t sum = one - square / 110;
    sum = one - multiply_q31(square, sum) / 72;
    sum = one - multiply_q31(square, sum) / 42;
    sum = one - multiply_q31(square, sum) / 20;
    sum = one - multiply_q31(square, sum) / 6;
    return multiply_q31(x, sum);
}

static int64_t cos_series_q31(int64_t x)
{
    const int64_t one = 1LL << 31;
    const int64_t square = multiply_q31(x, x);
    int64_t sum = one - square / 90;
    sum = one - multiply_q31(square, sum) / 56;
    sum = one - multiply_q31(square, sum) / 30;
    sum = one - multiply_q31(square, sum) / 12;
    return one - multiply_q31(square, sum) / 2;
}

int32_t el_sin_q30(el_angle angle)
{
    /* Each quadrant is folded to [0, pi/2], and its upper half to the cosine of the rest. */
    const uint32_t quadrant = angle >> 30;
    uint32_t folded = angle & 0x3FFFFFFFU;
    if ((quadrant & 1U) != 0) {
        folded = 0x40000000U - folded;
    }
    int64_t magnitude;
    if (folded <= 0x20000000U) {
        magnitude = sin_series_q31((int64_t)(((uint64_t)folded * PI_Q28) >> 28));
    } else {
        magnitude = cos_series_q31((int64_t)(((uint64_t)(0x40000000U - folded) * PI_Q28) >> 28));
    }
    const int32_t value_q30 = (int32_t)((magnitude + 1) >> 1);
    return quadrant >= 2 ? -value_q30 : value_q30;
}

int32_t el_cos_q30(el_angle angle)
{
    return el_sin_q30(angle + 0x40000000U);
}
