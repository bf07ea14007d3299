/* Directions: a quotient of at most tan(pi/8), where few terms of Gregory's series do, and what it was folded from. */
#include <stdbool.h>

#include "base/angle.h"
#include "base/fixed.h"

/* 2^33 / (2 pi), rounded: radians in Q31 times this, less 32 bits, are units of 2^-32 turn. */
#define UNITS_PER_RADIAN_Q32 1367130551U

#define ONE_Q31 (1U << 31)

/* x - x^3/3 + x^5/5 - ... in Horner's form; x is at most 0.41429, so the first term left out, x^25/25, is below 2^-36. */
enum { LAST_DIVISOR = 23 };

static uint32_t atan_q31(uint32_t x)
{
    const uint32_t square = (uint32_t)(((uint64_t)x * x) >> 31); /* below 0.172 */
    uint32_t sum = ONE_Q31 / LAST_DIVISOR;
    for (uint32_t divisor = LAST_DIVISOR; divisor > 1;) {
        divisor -= 2;
        sum = ONE_Q31 / divisor - (uint32_t)(((uint64_t)square * sum) >> 31);
    }
    return (uint32_t)(((uint64_t)x * sum) >> 31);
}

el_angle el_atan2(int64_t y, int64_t x)
{
    uint64_t across = el_abs_u64(y);
    uint64_t along = el_abs_u64(x);
    if ((across | along) == 0) {
        return 0;
    }
    /* 31 bits: their sum has 32. */
    const int excess = el_max_i32(0, el_bit_length_u64(across | along) - 31);
    across >>= excess;
    along >>= excess;

    /* Each eighth of a turn from its own axis, and its outer half from the diagonal: with tan(a) = p / q,
     * tan(pi/4 - a) = (q - p) / (q + p). 29 / 70 is a little more than tan(pi/8). */
    const bool is_steep = across > along;
    const uint64_t less = is_steep ? along : across;
    const uint64_t more = is_steep ? across : along;
    const bool from_diagonal = 70 * less > 29 * more;
    const uint64_t p = from_diagonal ? more - less : less;
    const uint64_t q = from_diagonal ? more + less : more; /* not 0: excess leaves the largest its bits */
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): the same. */
    const uint32_t ratio_q31 = (uint32_t)((p << 31) / q);
    uint32_t angle = (uint32_t)(((uint64_t)atan_q31(ratio_q31) * UNITS_PER_RADIAN_Q32) >> 32);
    angle = from_diagonal ? EL_DEGREES(45, 1) - angle : angle;
    angle = is_steep ? EL_DEGREES(90, 1) - angle : angle;
    angle = x < 0 ? EL_DEGREES(180, 1) - angle : angle;
    return y < 0 ? 0U - angle : angle;
}
