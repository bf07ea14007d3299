/* Integer arithmetic that several layers need: bit lengths, roots, and products that are wider than a register.
 *
 * Right shifts of negative numbers are arithmetic (C11 leaves that to the implementation; gcc, clang and every other
 * compiler for these cores agree), so `>>` is floor division by a power of two throughout. */
#ifndef EL_BASE_FIXED_H
#define EL_BASE_FIXED_H

#include <stdint.h>

#include "base/machine.h"
#include "base/options.h"

/* A core without a 32 x 32 -> 64 bit product (Armv6-M) has products of 32 bits instead, where they need not be short. */
#if defined(__ARM_ARCH_6M__) && !EL_SMALL_CODE
#define EL_PRODUCTS_IN_HALVES
#define EL_ZEROS_BY_TABLE /* nor does it have an instruction that counts leading zeros */
#endif

/* What was read from memory is read again behind this: of eight registers none is kept for it. */
#if defined(EL_PRODUCTS_IN_HALVES) && defined(__thumb__)
#define EL_READ_AGAIN() __asm__ volatile("" ::: "memory")
#else
#define EL_READ_AGAIN() ((void)0)
#endif

/* Bits of x: 0 for 0, 32 for x >= 2^31. */
static inline int el_bit_length_u32(uint32_t x)
{
    return x == 0 ? 0 : 32 - __builtin_clz(x);
}

#if defined(EL_ZEROS_BY_TABLE)
/* Leading zeros of a byte. */
extern const uint8_t el_zeros_of_byte[256];
#endif

/* Leading zeros of x. Pre: x > 0. */
static inline unsigned el_leading_zeros(uint32_t x)
{
#if defined(EL_ZEROS_BY_TABLE)
    /* Without an instruction for it; nearly all numbers that are asked for have a bit in their first byte. */
    unsigned zeros = 0;
    for (; x >> 24 == 0; x <<= 8) {
        zeros += 8;
    }
    return zeros + el_zeros_of_byte[x >> 24];
#else
    return (unsigned)__builtin_clz(x);
#endif
}

/* Moves *x up until its top bit is set. Returns by how much. Pre: *x > 0. */
EL_INLINE unsigned el_normalise(uint32_t *x)
{
#if EL_SMALL_CODE /* what all files share names nothing that each has for itself */
    const unsigned zeros = (unsigned)__builtin_clz(*x);
#else
    const unsigned zeros = el_leading_zeros(*x);
#endif
    *x <<= zeros;
    return zeros;
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

static inline int32_t el_min3_i32(int32_t a, int32_t b, int32_t c)
{
    return el_min_i32(a, el_min_i32(b, c));
}

static inline uint32_t el_max_u32(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static inline uint32_t el_min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline int32_t el_max_i32(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static inline int32_t el_max3_i32(int32_t a, int32_t b, int32_t c)
{
    return el_max_i32(a, el_max_i32(b, c));
}

/* a * b modulo 2^64, b < 2^16. */
EL_INLINE uint64_t el_multiply_u16(uint64_t a, uint32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    const uint32_t low = (uint32_t)a;
    const uint32_t middle = (low >> 16) * b;
    return ((uint64_t)((uint32_t)(a >> 32) * b) << 32 | (low & 0xFFFFU) * b) + ((uint64_t)middle << 16);
#else
    /* Not a * b: compilers multiply by b's upper word, too. */
    const uint64_t low = (uint64_t)(uint32_t)a * b;
    const uint32_t high = (uint32_t)(low >> 32) + (uint32_t)(a >> 32) * b;
    return (uint64_t)high << 32 | (uint32_t)low;
#endif
}

/* sum + a * b modulo 2^64, b < 2^16: what is added costs nothing where the long product has an instruction that adds. */
EL_INLINE uint64_t el_add_product_u16(uint64_t sum, uint64_t a, uint32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    return sum + el_multiply_u16(a, b);
#else
    const uint64_t low = sum + (uint64_t)(uint32_t)a * b;
    const uint32_t high = (uint32_t)(low >> 32) + (uint32_t)(a >> 32) * b;
    return (uint64_t)high << 32 | (uint32_t)low;
#endif
}

/* a * b modulo 2^64, |b| < 2^16. */
EL_INLINE uint64_t el_multiply_u64(uint64_t a, int32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    const uint64_t product = el_multiply_u16(a, (uint32_t)(b < 0 ? -b : b));
    return b < 0 ? 0 - product : product;
#else
    return a * (uint64_t)(int64_t)b;
#endif
}

/* a * b. */
EL_INLINE uint64_t el_product_u64(uint32_t a, uint32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    const uint32_t a_high = a >> 16;
    const uint32_t a_low = a & 0xFFFFU;
    const uint32_t b_high = b >> 16;
    const uint32_t b_low = b & 0xFFFFU;
    const uint32_t low = a_low * b_low;
    const uint32_t first = a_high * b_low + (low >> 16);
    const uint32_t second = a_low * b_high + (first & 0xFFFFU);
    const uint32_t high = a_high * b_high + (first >> 16) + (second >> 16);
    return (uint64_t)high << 32 | second << 16 | (low & 0xFFFFU);
#else
    return (uint64_t)a * b;
#endif
}

/* a * b. */
static inline int64_t el_product_i32(int32_t a, int32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    /* Upper halves have the signs: |upper * lower| <= 2^15 (2^16 - 1), to which less than 2^16 is added. */
    const int32_t a_high = a >> 16;
    const int32_t a_low = (int32_t)((uint32_t)a & 0xFFFFU);
    const int32_t b_high = b >> 16;
    const int32_t b_low = (int32_t)((uint32_t)b & 0xFFFFU);
    const uint32_t low = (uint32_t)a_low * (uint32_t)b_low;
    const int32_t first = a_high * b_low + (int32_t)(low >> 16);
    const int32_t second = a_low * b_high + (int32_t)((uint32_t)first & 0xFFFFU);
    const int32_t high = a_high * b_high + (first >> 16) + (second >> 16);
    return (int64_t)((uint64_t)(uint32_t)high << 32 | ((uint32_t)second << 16 | (low & 0xFFFFU)));
#else
    return (int64_t)a * b;
#endif
}

/* floor(a * b / 2^32). */
static inline uint32_t el_product_high_u32(uint32_t a, uint32_t b)
{
    return (uint32_t)(el_product_u64(a, b) >> 32);
}

/* a * b / 2^32, too low by less than EL_PRODUCT_ERROR: in halves without the lower ones' product and the others' fractions. */
enum { EL_PRODUCT_ERROR = 3 };
static inline uint32_t el_product_near_u32(uint32_t a, uint32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    const uint32_t a_high = a >> 16;
    const uint32_t b_high = b >> 16;
    return a_high * b_high + ((a_high * (b & 0xFFFFU)) >> 16) + (((a & 0xFFFFU) * b_high) >> 16);
#else
    return (uint32_t)(((uint64_t)a * b) >> 32);
#endif
}

/* The same of numbers with signs. */
static inline int32_t el_product_near_i32(int32_t a, int32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    /* |upper * lower| <= 2^15 (2^16 - 1). */
    const int32_t a_high = a >> 16;
    const int32_t b_high = b >> 16;
    const int32_t a_low = (int32_t)((uint32_t)a & 0xFFFFU);
    const int32_t b_low = (int32_t)((uint32_t)b & 0xFFFFU);
    return a_high * b_high + ((a_high * b_low) >> 16) + ((a_low * b_high) >> 16);
#else
    return (int32_t)(((int64_t)a * b) >> 32);
#endif
}

/* floor(a * b / 2^16), b < 2^16. */
static inline uint32_t el_product_high_u16(uint32_t a, uint32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    return (a >> 16) * b + (((a & 0xFFFFU) * b) >> 16);
#else
    return (uint32_t)(((uint64_t)a * (b << 16)) >> 32);
#endif
}

/* a * b, b < 2^16. */
static inline uint64_t el_product_u32_u16(uint32_t a, uint32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    const uint32_t low = (a & 0xFFFFU) * b;
    const uint32_t high = (a >> 16) * b + (low >> 16);
    return (uint64_t)(high >> 16) << 32 | high << 16 | (low & 0xFFFFU);
#else
    return (uint64_t)a * b;
#endif
}

/* floor(a * b / 2^32). */
static inline int32_t el_multiply_high_i32_u32(int32_t a, uint32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    /* a's upper half has the sign: |upper * lower| <= 2^15 (2^16 - 1), to which less than 2^16 is added. */
    const int32_t a_high = a >> 16;
    const uint32_t a_low = (uint32_t)a & 0xFFFFU;
    const int32_t b_high = (int32_t)(b >> 16);
    const uint32_t b_low = b & 0xFFFFU;
    const int32_t first = a_high * (int32_t)b_low + (int32_t)((a_low * b_low) >> 16);
    const uint32_t second = a_low * (uint32_t)b_high + ((uint32_t)first & 0xFFFFU);
    return a_high * b_high + (first >> 16) + (int32_t)(second >> 16);
#else
    return (int32_t)(((int64_t)a * b) >> 32);
#endif
}

/* a * b. */
static inline int64_t el_product_i32_u32(int32_t a, uint32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    return (int64_t)((uint64_t)(uint32_t)el_multiply_high_i32_u32(a, b) << 32 | (uint32_t)a * b);
#else
    return (int64_t)a * b;
#endif
}

/* floor(a * b / 2^11), which fits 32 bits, or 31 where b < 0. |a| < 2^15. */
static inline int32_t el_product_down_11(int32_t a, int32_t b)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    return a * (b >> 16) * (1 << 5) + ((a * (b & 0xFFFF)) >> 11);
#else
    return (int32_t)(((int64_t)a * b) >> 11);
#endif
}

/* floor(sqrt(x)). */
uint32_t el_sqrt_u64(uint64_t x);

/* value * factor / 2^shift, rounded to nearest, ties up. The product may take 95 bits.
 * Pre: 0 <= shift <= 94 and the result fits 63 bits (it is saturated where it does not). */
int64_t el_scale_i64(int64_t value, uint32_t factor, int shift);

/* value * 2^-shift, rounded to nearest, ties up; a negative shift multiplies. Saturates at +-(2^63 - 1). */
int64_t el_shift_i64(int64_t value, int shift);

#endif
