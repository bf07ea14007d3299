/* Exact division by a number that is used several times: one reciprocal, then a product or two per quotient.
 *
 * Möller and Granlund, "Improved division by invariant integers", IEEE Transactions on Computers 60(2), 2011:
 * algorithm 2 makes the reciprocal of a 32-bit word, algorithm 4 divides two words by one. The quotients are exact, so a
 * core with a fast divider may divide instead and get the same pixels. */
#ifndef EL_BASE_DIVIDE_H
#define EL_BASE_DIVIDE_H

#include <stdint.h>

#include "base/fixed.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A core without a divider has tables instead, but where size counts. A test asks for them too. */
#if defined(__ARM_ARCH_6M__) && !EL_SMALL_CODE
#define EL_DIVIDE_BY_TABLE
#endif

typedef struct el_divisor {
    uint32_t normalised; /* d << shift, with its top bit set */
    uint32_t reciprocal; /* floor((2^64 - 1) / normalised) - 2^32 */
    uint8_t shift;       /* 0..31 */
} el_divisor;

/* Half the first word of a reciprocal, 2^63 / d for a normalised d, too low by less than EL_RECIPROCAL_ERROR: all 2^31 of
 * them were tried. 16 bits of it, too low by less than 2^-14 of it, and what they leave, times them. */
enum { EL_RECIPROCAL_ERROR = 18 };

#if defined(EL_DIVIDE_BY_TABLE)
/* floor((2^24 - 2^14 + 2^9) / (512 + i)). */
extern const uint16_t el_first_guesses[512];

/* floor(2^31 / upper), 2^15 < upper <= 2^16. */
static inline uint32_t el_reciprocal_u16(uint32_t upper)
{
    /* A step of Newton's from the table, which is off by 2^-10: what is left is 2^20 of 2^30. It is a unit too low at
     * most; textures are drawn with these bits, so every core must have the same. */
    const uint32_t guess = el_first_guesses[((upper - 1U) >> 6) - 512U];
    const int32_t left = (1 << 30) - (int32_t)(guess * upper);
    const uint32_t quotient = 2U * guess + (uint32_t)(((int32_t)guess * (left >> 5)) >> 24);
    return quotient + (0x80000000U - quotient * upper >= upper ? 1U : 0U);
}
#else
static inline uint32_t el_reciprocal_u16(uint32_t upper)
{
    return 0x80000000U / upper;
}
#endif

static inline uint32_t el_reciprocal_near(uint32_t d)
{
    const uint32_t first = el_reciprocal_u16((d >> 16) + 1U); /* below 2^16 */
    const uint32_t product = first * (d >> 16) + ((first * (d & 0xFFFFU)) >> 16);
    const uint32_t left = 0x7FFFFFFFU - product; /* below 1.0001 * 2^17 */
    return (first << 16) + ((first * (left >> 2)) >> 13);
}

/* Algorithm 2 of the paper. Its first step is a division of 24 bits by 10: a hardware divider's business where there is
 * one, the paper's table elsewhere. */
#if defined(EL_DIVIDE_BY_TABLE)
EL_INLINE uint32_t el_first_guess(uint32_t d10)
{
    return el_first_guesses[d10 - 512U];
}
#else
EL_INLINE uint32_t el_first_guess(uint32_t d10)
{
    return ((1U << 24) - (1U << 14) + (1U << 9)) / d10;
}
#endif

EL_INLINE uint32_t el_reciprocal_word(uint32_t d)
{
    const uint32_t d10 = d >> 22;        /* 512..1023 */
    const uint32_t d21 = (d >> 11) + 1U; /* 2^20 < d21 <= 2^21 */
    const uint32_t d31 = (d >> 1) + (d & 1U);
    const uint32_t v0 = el_first_guess(d10);                                             /* below 2^15 */
    const uint32_t v1 = (v0 << 4) - (uint32_t)(el_product_u64(v0 * v0, d21) >> 32) - 1U; /* v0^2 < 2^30 */
    const uint32_t e = ((d & 1U) != 0 ? v1 >> 1 : 0U) - v1 * d31;
    const uint32_t v2 = (v1 << 15) + (uint32_t)(el_product_u64(v1, e) >> 33);
    /* (v2 + 2^32 + 1) * d / 2^32, modulo 2^32 */
    const uint32_t high = (uint32_t)((el_product_u64(v2, d) + d) >> 32);
    return v2 - (high + d);
}

/* Pre: d >= 1. */
EL_INLINE el_divisor el_divisor_make(uint32_t d)
{
    el_divisor divisor;
    divisor.normalised = d;
    divisor.shift = (uint8_t)el_normalise(&divisor.normalised);
    divisor.reciprocal = el_reciprocal_word(divisor.normalised);
    return divisor;
}

/* floor((high * 2^32 + low) / normalised); *remainder gets the rest. Pre: high < normalised. */
EL_INLINE uint32_t el_divide_words(uint32_t high, uint32_t low, const el_divisor *divisor, uint32_t *remainder)
{
    const uint32_t d = divisor->normalised;
    const uint64_t product = el_product_u64(divisor->reciprocal, high) + (((uint64_t)high << 32) | low);
    uint32_t quotient = (uint32_t)(product >> 32) + 1U;
    uint32_t rest = low - quotient * d;
    if (rest > (uint32_t)product) {
        quotient--;
        rest += d;
    }
    if (rest >= d) {
        quotient++;
        rest -= d;
    }
    *remainder = rest;
    return quotient;
}

/* floor(n / d). Pre: the quotient fits 32 bits. */
EL_INLINE uint32_t el_divide_u64(uint64_t n, const el_divisor *divisor)
{
    const uint64_t shifted = n << divisor->shift; /* n < d * 2^32 and d << shift < 2^32: below 2^64 */
    uint32_t remainder;
    return el_divide_words((uint32_t)(shifted >> 32), (uint32_t)shifted, divisor, &remainder);
}

/* floor(n / d) for signed n. Pre: -2^31 <= n / d < 2^31. */
EL_INLINE int32_t el_divide_floor_i64(int64_t n, const el_divisor *divisor)
{
    /* For n < 0, floor(n / d) = -1 - floor((-n - 1) / d), and -n - 1 = ~n. */
    const uint32_t sign = n < 0 ? 0xFFFFFFFFU : 0U;
    const uint64_t magnitude = n < 0 ? ~(uint64_t)n : (uint64_t)n;
    return (int32_t)(el_divide_u64(magnitude, divisor) ^ sign);
}

/* n / d as Q32, truncated towards zero, in 64 bits. |n| < 2^31. */
static inline uint64_t el_divide_i32_q32(int32_t n, const el_divisor *divisor)
{
    const uint32_t magnitude = n < 0 ? 0U - (uint32_t)n : (uint32_t)n;
    const unsigned shift = divisor->shift;
    uint32_t rest;
    const uint32_t whole =
        el_divide_words(shift == 0 ? 0U : magnitude >> (32U - shift), magnitude << shift, divisor, &rest);
    const uint32_t fraction = el_divide_words(rest, 0, divisor, &rest);
    const uint64_t quotient = (uint64_t)whole << 32 | fraction;
    return n < 0 ? 0 - quotient : quotient;
}

/* floor((2^32 - 1) / d), 1 <= d <= EL_SHORT_DIVISOR. */
enum { EL_SHORT_DIVISOR = 511 };
#if defined(EL_DIVIDE_BY_TABLE)
extern const uint32_t el_reciprocals[EL_SHORT_DIVISOR + 1];
static inline uint32_t el_reciprocal_of_short(uint32_t d)
{
    return el_reciprocals[d];
}
#else
static inline uint32_t el_reciprocal_of_short(uint32_t d)
{
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): d >= 1, since an edge with a row of its own has a height. */
    return 0xFFFFFFFFU / d;
}
#endif

/* floor(2^32 n / d) for 1 <= d < 2^16, |n| < 2^31, |n / d| < 2^31: the whole part, then twice 16 bits of the fraction. */
static inline int64_t el_ratio_q32(int32_t n, uint32_t d)
{
    const uint32_t magnitude = n < 0 ? ~(uint32_t)n : (uint32_t)n; /* floor(n / d) = ~floor(~n / d) for n < 0 */
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): the same. */
    const uint32_t quotient = magnitude / d;
    uint32_t rest = magnitude - quotient * d;
    const int32_t whole = (int32_t)(n < 0 ? ~quotient : quotient);
    rest = n < 0 ? d - 1U - rest : rest;
    const uint32_t high = (rest << 16) / d;
    rest = (rest << 16) - high * d;
    return (int64_t)(((uint64_t)(uint32_t)whole << 32) | (high << 16) | (rest << 16) / d);
}

/* (n + fraction * 2^-32) / d as Q32, truncated towards zero, modulo 2^64: the 32 low bits of the whole part and 32 bits of
 * fraction. Any n but INT64_MIN. */
int64_t el_divide_q32(int64_t n, uint32_t fraction, const el_divisor *divisor);

/* The same for a divisor of more than 32 bits, by the processor's or the compiler's own division. 1 <= d < 2^47. */
int64_t el_divide_wide_q32(int64_t n, uint32_t fraction, uint64_t d);

/* floor(2^32 n / d), |n / d| < 2^31, 1 <= d < 2^31. */
static inline int64_t el_wide_ratio_q32(int64_t n, uint32_t d)
{
    const int64_t quotient = n / (int64_t)d;
    const int64_t rest = n - quotient * (int64_t)d;
    const int64_t whole = rest < 0 ? quotient - 1 : quotient;
    const uint64_t positive = (uint64_t)(rest < 0 ? rest + (int64_t)d : rest);
    return (int64_t)(((uint64_t)whole << 32) | (positive << 32) / d);
}

#ifdef __cplusplus
}
#endif

#endif
