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
    const uint32_t product = el_product_high_u16(d, first);
    const uint32_t left = 0x7FFFFFFFU - product; /* below 1.0001 * 2^17 */
    return (first << 16) + ((first * (left >> 2)) >> 13);
}

/* 2^61 / d for 2^30 <= d < 2^31, too low by less than EL_RECIPROCAL_LOW and too high by less than EL_RECIPROCAL_HIGH: all
 * 2^30 of them were tried. A first quotient that times d is so near to a power of two that the lower word has all of what
 * is left, and that times the quotient. For what is compared with these bounds: cores have it in ways of their own. */
enum { EL_RECIPROCAL_LOW = 4, EL_RECIPROCAL_HIGH = 3 };
static inline uint32_t el_reciprocal_beside(uint32_t d)
{
#if defined(EL_DIVIDE_BY_TABLE)
    /* The guess has 10 bits, 2^45 / d. */
    const int32_t guess = el_first_guesses[(d >> 21) - 512U];
    const int32_t off = (int32_t)((d >> 5) * (uint32_t)guess); /* d guess / 2^5 - 2^40, within 2^30 */
    const uint32_t first = (uint32_t)(2 * guess - ((guess * (off >> 15)) >> 24)); /* 2^15 to 2^16 */
    const int32_t left = (int32_t)(d * first);                                    /* d first - 2^46, within 2^31 */
    return (first << 15) - (uint32_t)(((int32_t)first * (left >> 16)) >> 15);
#else
    const uint32_t first = 0xFFFFFFFFU / (d >> 13); /* below 2^15 */
    const int32_t left = (int32_t)(d * first);      /* d first - 2^45, within 2^31 */
    return (first << 16) - (uint32_t)(((int64_t)left * (int32_t)(first << 3)) >> 32);
#endif
}

/* The first step of Algorithm 2 of the paper, a division of 24 bits by 10: a hardware divider's business where there is one,
 * the paper's table elsewhere. */
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

/* floor((2^64 - 1) / d) - 2^32, 2^31 <= d: Algorithm 2. */
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

/* Division by a small triangle's doubled area, 1 <= |d| < 2^EL_SMALL_DIVISOR_BITS, which needs no more than a register:
 * after the whole part, digits for which there is room behind the remainder. Cores without a divider have them by a
 * reciprocal of 16 bits: two of 16 bits, or three of 11 where d has more than 16 bits. */
enum { EL_SMALL_DIVISOR_BITS = 19 };

#if defined(EL_DIVIDE_BY_TABLE)
typedef struct el_small_divisor {
    int32_t d;
    uint32_t limit;      /* what |n| >> 16 must be below for digits of 16 bits: |d|, or 0 when it has more than 16 */
    uint32_t normalised; /* |d| << shift, 2^15 to 2^16 - 1 */
    uint32_t reciprocal; /* floor(2^31 / normalised), or 1 less */
    uint8_t shift;
} el_small_divisor;

static inline el_small_divisor el_small_divisor_make(int32_t d)
{
    const uint32_t magnitude = (uint32_t)(d < 0 ? -d : d);
    uint32_t normalised = magnitude;
    unsigned shift = 0;
    if (magnitude >> 16 != 0) {
        return (el_small_divisor){.d = d};
    }
    if (normalised >> 8 == 0) {
        normalised <<= 8;
        shift = 8;
    }
    if (normalised >> 12 == 0) {
        normalised <<= 4;
        shift += 4;
    }
    if (normalised >> 14 == 0) {
        normalised <<= 2;
        shift += 2;
    }
    if (normalised >> 15 == 0) {
        normalised <<= 1;
        shift += 1;
    }
    /* A step of Newton's from the table, as in el_reciprocal_u16. */
    const uint32_t guess = el_first_guesses[(normalised >> 6) & 511U];
    const int32_t left = (1 << 30) - (int32_t)(guess * normalised);
    return (el_small_divisor){
        .d = d,
        .limit = magnitude,
        .normalised = normalised,
        .reciprocal = 2U * guess + (uint32_t)(((int32_t)guess * (left >> 5)) >> 24),
        .shift = (uint8_t)shift,
    };
}

/* floor((high * 2^bits + low) / normalised) and what remains, for digits of 16 bits; or of 11, with a divisor of 19 bits and
 * the reciprocal of its upper 16, rounded up. Pre: high < normalised, low < 2^bits. */
static inline uint32_t el_divide_digit(uint32_t high, uint32_t low, unsigned bits, const el_small_divisor *divisor,
                                       uint32_t *remainder)
{
    /* The product of 16 bits each stays below 2^32. The quotient is too low by 5 at most. */
    uint32_t quotient = ((bits == 16 ? high : high >> 3) * divisor->reciprocal) >> (31 - bits);
    uint32_t rest = (high << bits | low) - quotient * divisor->normalised;
    while (rest >= divisor->normalised) {
        rest -= divisor->normalised;
        quotient++;
    }
    *remainder = rest;
    return quotient;
}

/* el_divide_small_q32 where the divisor has more than 16 bits, or the whole part. */
uint64_t el_divide_small_apart_q32(int32_t n, int32_t d);
#else
typedef struct el_small_divisor {
    int32_t d;
} el_small_divisor;

static inline el_small_divisor el_small_divisor_make(int32_t d)
{
    return (el_small_divisor){.d = d};
}
#endif

/* n / d as Q32, truncated towards zero, in 64 bits. |n| < 2^27. */
static inline uint64_t el_divide_small_q32(int32_t n, const el_small_divisor *divisor)
{
#if defined(EL_DIVIDE_BY_TABLE)
    const uint32_t magnitude = n < 0 ? 0U - (uint32_t)n : (uint32_t)n;
    if (magnitude >> 16 >= divisor->limit) {
        return el_divide_small_apart_q32(n, divisor->d);
    }
    uint32_t rest = magnitude << divisor->shift; /* below |d| << 16 << shift */
    uint32_t whole = 0;
    if (rest >= divisor->normalised) {
        whole = el_divide_digit(rest >> 16, rest & 0xFFFFU, 16, divisor, &rest);
    }
    const uint32_t high = el_divide_digit(rest, 0, 16, divisor, &rest);
    const uint64_t quotient = (uint64_t)whole << 32 | high << 16 | el_divide_digit(rest, 0, 16, divisor, &rest);
    return (n < 0) != (divisor->d < 0) ? 0 - quotient : quotient;
#else
    /* Signed: each digit has the quotient's sign, and so has the remainder n's, below 2^19 as d is: 2^12 of it fits. */
    /* NOLINTBEGIN(clang-analyzer-core.DivideZero): d is not 0. */
    const int32_t d = divisor->d;
    const int32_t whole = n / d;
    int32_t rest = (n - whole * d) * (1 << 12);
    const int32_t high = rest / d;
    rest = (rest - high * d) * (1 << 10);
    const int32_t middle = rest / d;
    rest = (rest - middle * d) * (1 << 10);
    const int32_t low = rest / d;
    /* NOLINTEND(clang-analyzer-core.DivideZero) */
    const int32_t upper = high * (1 << 10) + middle; /* below 2^22 */
    const uint64_t sum = (uint64_t)(uint32_t)(whole + (upper >> 22)) << 32 | (uint32_t)upper << 10;
    return sum + (uint64_t)(int64_t)low;
#endif
}

/* The same in three digits, whose sum whole * 2^EL_WHOLE_BIT + high * 2^EL_HIGH_BIT + low is the Q32; |high|, |low| are at
 * most 2^EL_HIGH_BIT. What follows from them modulo 2^32 needs no wider sums. */
#if defined(EL_DIVIDE_BY_TABLE)
enum { EL_WHOLE_BIT = 32, EL_HIGH_BIT = 16 };
#else
enum { EL_WHOLE_BIT = 28, EL_HIGH_BIT = 14 };
#endif

typedef struct el_small_quotient {
    int32_t whole, high, low;
} el_small_quotient;

static inline el_small_quotient el_divide_small(int32_t n, const el_small_divisor *divisor)
{
#if defined(EL_DIVIDE_BY_TABLE)
    const uint32_t magnitude = n < 0 ? 0U - (uint32_t)n : (uint32_t)n;
    if (magnitude >> 16 < divisor->limit) {
        uint32_t rest = magnitude << divisor->shift; /* below |d| << 16 << shift */
        uint32_t whole = 0;
        if (rest >= divisor->normalised) {
            whole = el_divide_digit(rest >> 16, rest & 0xFFFFU, 16, divisor, &rest);
        }
        const uint32_t high = el_divide_digit(rest, 0, 16, divisor, &rest);
        const uint32_t low = el_divide_digit(rest, 0, 16, divisor, &rest);
        const int32_t sign = (n < 0) == (divisor->d < 0) ? 1 : -1;
        return (el_small_quotient){
            .whole = (int32_t)whole * sign, .high = (int32_t)high * sign, .low = (int32_t)low * sign};
    }
#else
    /* With 17 bits, 2^14 of a remainder fit; n has room for 2^4. */
    const int32_t d = divisor->d;
    if ((uint32_t)d + (1U << 17) < 1U << 18) {
        /* NOLINTBEGIN(clang-analyzer-core.DivideZero): d is not 0. */
        const int32_t whole = n * (1 << 4) / d;
        int32_t rest = (n * (1 << 4) - whole * d) * (1 << 14);
        const int32_t high = rest / d;
        rest = (rest - high * d) * (1 << 14);
        return (el_small_quotient){.whole = whole, .high = high, .low = rest / d};
        /* NOLINTEND(clang-analyzer-core.DivideZero) */
    }
#endif
    const uint64_t quotient = el_divide_small_q32(n, divisor);
    const uint32_t digit = (1U << EL_HIGH_BIT) - 1U;
    return (el_small_quotient){
        .whole = (int32_t)(uint32_t)(quotient >> EL_WHOLE_BIT),
        .high = (int32_t)((uint32_t)(quotient >> EL_HIGH_BIT) & digit),
        .low = (int32_t)((uint32_t)quotient & digit),
    };
}

/* floor((2^31 - 1) / d), 1 <= d <= EL_SHORT_DIVISOR. */
enum { EL_SHORT_DIVISOR = 511 };
#if defined(EL_DIVIDE_BY_TABLE)
extern const int32_t el_reciprocals[EL_SHORT_DIVISOR + 1];
static inline int32_t el_reciprocal_of_short(int32_t d)
{
    return el_reciprocals[d];
}
#else
static inline int32_t el_reciprocal_of_short(int32_t d)
{
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): d >= 1, since an edge with a row of its own has a height. */
    return INT32_MAX / d;
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
