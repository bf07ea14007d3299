/* Integer arithmetic that several layers need: bit lengths, roots, and products that are wider than a register.
 *
 * Right shifts of negative numbers are arithmetic (C11 leaves that to the implementation; gcc, clang and every other
 * compiler for these cores agree), so `>>` is floor division by a power of two throughout. */
#ifndef EL_BASE_FIXED_H
#define EL_BASE_FIXED_H

#include <stdint.h>

#include "base/machine.h"

_Static_assert((-3 >> 1) == -2, "Edgeline needs arithmetic right shifts");

/* Bits of x: 0 for 0, 32 for x >= 2^31. */
static inline int el_bit_length_u32(uint32_t x)
{
    return x == 0 ? 0 : 32 - __builtin_clz(x);
}

static inline int el_bit_length_u64(uint64_t x)
{
    return x == 0 ? 0 : 64 - __builtin_clzll(x);
}

static inline uint64_t el_abs_u64(int64_t x)
{
    return x < 0 ? 0 - (uint64_t)x : (uint64_t)x;
}

static inline int32_t el_min_i32(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static inline int32_t el_max_i32(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* floor(sqrt(x)), by binary digits (Woo's abacus method): no division, 32 steps at most. */
uint32_t el_sqrt_u64(uint64_t x);

/* value * factor / 2^shift, rounded to nearest, ties up. The product may take 95 bits.
 * Pre: 0 <= shift <= 94 and the result fits 63 bits (it is saturated where it does not). */
int64_t el_scale_i64(int64_t value, uint32_t factor, int shift);

/* value * 2^-shift, rounded to nearest, ties up; a negative shift multiplies. Saturates at +-(2^63 - 1). */
int64_t el_shift_i64(int64_t value, int shift);

#endif
