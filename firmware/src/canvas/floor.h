/* Division that rounds down, of numbers that rarely need 64 bits. Internal to canvas/. */
#ifndef EL_CANVAS_FLOOR_H
#define EL_CANVAS_FLOOR_H

#include <stdint.h>

/* floor(n / d) and what remains, 0 to d - 1. Pre: d > 0, |n| < 2^62. */
static inline int64_t el_floor_divide(int64_t n, int64_t d, int64_t *rest)
{
    int64_t quotient;
    int64_t left;
    if (n == (int32_t)n && d == (int32_t)d) {
        /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): d > 0. */
        quotient = (int32_t)n / (int32_t)d;
        left = (int32_t)n % (int32_t)d;
    } else {
        /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): the same. */
        quotient = n / d;
        left = n - quotient * d;
    }
    if (left < 0) {
        left += d;
        quotient--;
    }
    *rest = left;
    return quotient;
}

#endif
