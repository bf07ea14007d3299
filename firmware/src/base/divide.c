#include "base/divide.h"

#include <stdbool.h>

#include "base/fixed.h"

/* NOLINTBEGIN(readability-redundant-declaration): where the copy lies that small code shares. */
EL_INLINE_HERE uint32_t el_first_guess(uint32_t d10);
EL_INLINE_HERE uint32_t el_reciprocal_word(uint32_t d);
EL_INLINE_HERE el_divisor el_divisor_make(uint32_t d);
EL_INLINE_HERE uint32_t el_divide_words(uint32_t high, uint32_t low, const el_divisor *divisor, uint32_t *remainder);
EL_INLINE_HERE uint32_t el_divide_u64(uint64_t n, const el_divisor *divisor);
EL_INLINE_HERE int32_t el_divide_floor_i64(int64_t n, const el_divisor *divisor);
/* NOLINTEND(readability-redundant-declaration) */

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
