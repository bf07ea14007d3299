#include "base/angle.h"

#include <stdbool.h>

/* pi * 2^28, rounded: 2 pi angle / 2^32 in Q31 is pi angle, so (angle * PI_Q28) >> 28. */
#define PI_Q28 843314857U

#define ONE_Q31 (1U << 31)

/* Both at most 1. */
static uint32_t multiply_q31(uint32_t a, uint32_t b)
{
    return (uint32_t)(((uint64_t)a * b + (1U << 30)) >> 31);
}

/* Taylor's series in Horner's form, 1 - x^2/d4 (1 - x^2/d3 (1 - ...)), has these divisors from the inside out. With x in
 * [0, pi/4], the first term left out is x^13/13! below 2^-37 for the sine and x^12/12! below 2^-32 for the cosine. */
enum { TERMS = 5 };
static const uint8_t sine_divisors[TERMS] = {110, 72, 42, 20, 6};
static const uint8_t cosine_divisors[TERMS] = {90, 56, 30, 12, 2};

static uint32_t series_q31(uint32_t x, const uint8_t divisors[TERMS])
{
    const uint32_t square = multiply_q31(x, x);
    uint32_t sum = ONE_Q31;
    for (unsigned i = 0; i < TERMS; i++) {
        sum = ONE_Q31 - multiply_q31(square, sum) / divisors[i];
    }
    return sum;
}

int32_t el_sin_q30(el_angle angle)
{
    /* Each quadrant is folded to [0, pi/2], and its upper half to the cosine of the rest. */
    const uint32_t quadrant = angle >> 30;
    uint32_t folded = angle & 0x3FFFFFFFU;
    if ((quadrant & 1U) != 0) {
        folded = 0x40000000U - folded;
    }
    const bool is_cosine = folded > 0x20000000U;
    if (is_cosine) {
        folded = 0x40000000U - folded;
    }
    const uint32_t x = (uint32_t)(((uint64_t)folded * PI_Q28) >> 28);
    const uint32_t magnitude =
        is_cosine ? series_q31(x, cosine_divisors) : multiply_q31(x, series_q31(x, sine_divisors));
    const int32_t value_q30 = (int32_t)((magnitude + 1U) >> 1);
    return quadrant >= 2 ? -value_q30 : value_q30;
}

int32_t el_cos_q30(el_angle angle)
{
    return el_sin_q30(angle + 0x40000000U);
}
