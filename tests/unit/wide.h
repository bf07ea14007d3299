/* 128-bit integers for references, on compilers that have none (32-bit targets). Plain rather than fast, and the same
 * code everywhere; test_wide.c compares it with the compiler's own where there is one. */
#ifndef EL_TEST_WIDE_H
#define EL_TEST_WIDE_H

#include <stdbool.h>
#include <stdint.h>

/* Two's complement. What leaves 128 bits is lost, as with unsigned integers. */
typedef struct wide {
    uint64_t high, low;
} wide;

static inline wide wide_of(int64_t value)
{
    return (wide){.high = value < 0 ? UINT64_MAX : 0, .low = (uint64_t)value};
}

static inline bool wide_is_negative(wide a)
{
    return a.high >> 63 != 0;
}

static inline wide wide_sum(wide a, wide b)
{
    const uint64_t low = a.low + b.low;
    return (wide){.high = a.high + b.high + (low < a.low), .low = low};
}

static inline wide wide_negated(wide a)
{
    return wide_sum((wide){.high = ~a.high, .low = ~a.low}, wide_of(1));
}

static inline bool wide_less(wide a, wide b)
{
    const uint64_t sign = 1ULL << 63;
    return a.high == b.high ? a.low < b.low : (a.high ^ sign) < (b.high ^ sign);
}

/* a * 2^bits; bits 0..127. */
static inline wide wide_left(wide a, unsigned bits)
{
    if (bits == 0) {
        return a;
    }
    return bits < 64 ? (wide){.high = a.high << bits | a.low >> (64 - bits), .low = a.low << bits}
                     : (wide){.high = a.low << (bits - 64), .low = 0};
}

/* a / 2^bits, rounded down; bits 0..127. */
static inline wide wide_right(wide a, unsigned bits)
{
    const uint64_t fill = wide_is_negative(a) ? UINT64_MAX : 0;
    if (bits >= 64) {
        a = (wide){.high = fill, .low = a.high};
        bits -= 64;
    }
    if (bits == 0) {
        return a;
    }
    return (wide){.high = fill << (64 - bits) | a.high >> bits, .low = a.high << (64 - bits) | a.low >> bits};
}

static inline uint64_t wide_magnitude_64(int64_t value)
{
    return value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
}

/* By halves: (ah * 2^32 + al) * (bh * 2^32 + bl). */
static inline wide wide_product(int64_t a, int64_t b)
{
    const uint64_t x = wide_magnitude_64(a), y = wide_magnitude_64(b);
    const uint64_t low = (x & UINT32_MAX) * (y & UINT32_MAX);
    const uint64_t first = (x >> 32) * (y & UINT32_MAX), second = (x & UINT32_MAX) * (y >> 32);
    wide product = {.high = (x >> 32) * (y >> 32), .low = low};
    product = wide_sum(product, wide_left((wide){.low = first}, 32));
    product = wide_sum(product, wide_left((wide){.low = second}, 32));
    return (a < 0) != (b < 0) ? wide_negated(product) : product;
}

/* n / d, rounded towards zero; d is not 0. Long division, by 32-bit digits where the divisor is one, else bit by bit. */
static inline wide wide_quotient(wide n, int64_t d)
{
    const wide magnitude = wide_is_negative(n) ? wide_negated(n) : n;
    const uint64_t divisor = wide_magnitude_64(d);
    const unsigned step = divisor <= UINT32_MAX ? 32 : 1;
    wide quotient = {0};
    uint64_t rest = 0; /* below the divisor, so below 2^63 in the second case: a bit more fits */
    for (unsigned left = 128; left > 0; left -= step) {
        const uint64_t word = left > 64 ? magnitude.high : magnitude.low;
        const uint64_t digit = word >> ((left - step) & 63U) & (step == 32 ? UINT32_MAX : 1U);
        rest = rest << step | digit;
        quotient = wide_left(quotient, step);
        quotient.low |= step == 32 ? rest / divisor : rest >= divisor;
        rest = step == 32 ? rest % divisor : rest - (rest >= divisor ? divisor : 0);
    }
    return wide_is_negative(n) != (d < 0) ? wide_negated(quotient) : quotient;
}

#endif
