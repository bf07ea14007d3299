#include "base/divide.h"

#include <stdbool.h>

#include "base/fixed.h"

/* Algorithm 2 of the paper. Its first step is a division of 24 bits by 10: a hardware divider's business where there is
 * one, the paper's table elsewhere. */
#if defined(__ARM_ARCH_6M__) && !defined(__OPTIMIZE_SIZE__)
static inline uint32_t first_guess(uint32_t d10)
{
    return el_first_guesses[d10 - 512U];
}
#else
static inline uint32_t first_guess(uint32_t d10)
{
    return ((1U << 24) - (1U << 14) + (1U << 9)) / d10;
}
#endif

static uint32_t reciprocal_word(uint32_t d)
{
    const uint32_t d10 = d >> 22;        /* 512..1023 */
    const uint32_t d21 = (d >> 11) + 1U; /* 2^20 < d21 <= 2^21 */
    const uint32_t d31 = (d >> 1) + (d & 1U);
    const uint32_t v0 = first_guess(d10);                                                /* below 2^15 */
    const uint32_t v1 = (v0 << 4) - (uint32_t)(el_product_u64(v0 * v0, d21) >> 32) - 1U; /* v0^2 < 2^30 */
    const uint32_t e = ((d & 1U) != 0 ? v1 >> 1 : 0U) - v1 * d31;
    const uint32_t v2 = (v1 << 15) + (uint32_t)(el_product_u64(v1, e) >> 33);
    /* (v2 + 2^32 + 1) * d / 2^32, modulo 2^32 */
    const uint32_t high = (uint32_t)((el_product_u64(v2, d) + d) >> 32);
    return v2 - (high + d);
}

el_divisor el_divisor_make(uint32_t d)
{
    el_divisor divisor;
    divisor.shift = (uint8_t)(32 - el_bit_length_u32(d));
    /* NOLINTNEXTLINE(clang-analyzer-core.*): d >= 1, so the shift is 31 at most. */
    divisor.normalised = d << divisor.shift;
    divisor.reciprocal = reciprocal_word(divisor.normalised);
    return divisor;
}

/* Sign and magnitude of n + fraction * 2^-32. */
typedef struct magnitude {
    uint64_t whole;
    uint32_t fraction;
    bool negative;
} magnitude;

static magnitude magnitude_of(int64_t n, uint32_t fraction)
{
    if (n >= 0) {
        return (magnitude){.whole = (uint64_t)n, .fraction = fraction, .negative = false};
    }
    /* -(n + f) = ~n + (1 - f) where there is a fraction. */
    return (magnitude){
        .whole = fraction == 0 ? el_abs_u64(n) : ~(uint64_t)n, .fraction = 0U - fraction, .negative = true};
}

int64_t el_divide_q32(int64_t n, uint32_t fraction, const el_divisor *divisor)
{
    const magnitude m = magnitude_of(n, fraction);
    const unsigned shift = divisor->shift;
    /* The number << shift in four words; the top one is below 2^31 because shift <= 31, and so below the divisor. */
    uint32_t rest = shift == 0 ? 0U : (uint32_t)(m.whole >> (64 - shift));
    const uint64_t middle = (m.whole << shift) | (shift == 0 ? 0U : m.fraction >> (32 - shift));
    (void)el_divide_words(rest, (uint32_t)(middle >> 32), divisor, &rest);
    const uint32_t whole = el_divide_words(rest, (uint32_t)middle, divisor, &rest);
    const uint32_t low = el_divide_words(rest, m.fraction << shift, divisor, &rest);
    const uint64_t quotient = ((uint64_t)whole << 32) | low;
    return (int64_t)(m.negative ? 0 - quotient : quotient);
}

int64_t el_divide_wide_q32(int64_t n, uint32_t fraction, uint64_t d)
{
    const magnitude m = magnitude_of(n, fraction);
    uint64_t quotient = m.whole / d;
    uint64_t rest = m.whole % d;
    /* 16 bits of the fraction at a time: rest < 2^47, so rest << 16 stays below 2^63. */
    for (int shift = 16; shift >= 0; shift -= 16) {
        const uint64_t next = (rest << 16) | ((m.fraction >> shift) & 0xFFFFU);
        quotient = (quotient << 16) | (next / d);
        rest = next % d;
    }
    return (int64_t)(m.negative ? 0 - quotient : quotient);
}
