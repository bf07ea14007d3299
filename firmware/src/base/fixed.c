#include "base/fixed.h"

_Static_assert((-3 >> 1) == -2, "Edgeline needs arithmetic right shifts");

/* NOLINTBEGIN(readability-redundant-declaration): where the copy lies that small code shares. */
EL_INLINE_HERE unsigned el_normalise(uint32_t *x);
EL_INLINE_HERE uint64_t el_multiply_u16(uint64_t a, uint32_t b);
EL_INLINE_HERE uint64_t el_multiply_u64(uint64_t a, int32_t b);
EL_INLINE_HERE uint64_t el_product_u64(uint32_t a, uint32_t b);
/* NOLINTEND(readability-redundant-declaration) */

#if EL_SMALL_CODE
uint32_t el_sqrt_u64(uint64_t x)
{
    uint32_t root = 0;
    for (uint32_t bit = 1U << 31; bit != 0; bit >>= 1) {
        const uint32_t more = root | bit;
        root = el_product_u64(more, more) <= x ? more : root;
    }
    return root;
}
#else
/* floor(sqrt(x)), 2^30 <= x, by binary digits (Woo's abacus method); *rest is what remains, at most twice the root. */
static uint32_t upper_root(uint32_t x, uint32_t *rest)
{
    uint32_t root = 0;
    for (uint32_t bit = 1U << 30; bit != 0; bit >>= 2) {
        const uint32_t sum = root + bit;
        root >>= 1;
        if (x >= sum) {
            x -= sum;
            root += bit;
        }
    }
    *rest = x;
    return root;
}

uint32_t el_sqrt_u64(uint64_t x)
{
    if (x == 0) {
        return 0;
    }
    /* Zimmermann, "Karatsuba Square Root", INRIA 1999: of x with one of its first two bits set, the upper root and a
     * division have the root, or 1 more. With rest <= 2 upper, the dividend is below 2^32, and the quotient at most 2^16. */
    const unsigned half_shift = (64U - (unsigned)el_bit_length_u64(x)) / 2U;
    const uint64_t moved = x << (2U * half_shift);
    uint32_t rest;
    const uint32_t upper = upper_root((uint32_t)(moved >> 32), &rest);
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): 2^15 <= upper. */
    const uint32_t quotient = (rest << 15 | (uint32_t)moved >> 17) / upper;
    const uint64_t sum = ((uint64_t)upper << 16) + quotient;
    const uint32_t root = sum >> 32 != 0 ? UINT32_MAX : (uint32_t)sum;
    return (el_product_u64(root, root) > moved ? root - 1U : root) >> half_shift;
}
#endif

int64_t el_scale_i64(int64_t value, uint32_t factor, int shift)
{
    /* The product is high * 2^32 and the lower 32 bits of `low`; high lies within -2^63 and 2^63 - 2^31. */
    const uint64_t low = el_product_u64((uint32_t)value, factor);
    const int64_t high = el_product_i32_u32((int32_t)(value >> 32), factor) + (int64_t)(low >> 32);
    if (shift > 32) {
        return el_shift_i64(high, shift - 32);
    }
    const uint64_t lower = ((low & 0xFFFFFFFFU) + ((1ULL << shift) >> 1)) >> shift;
    const int64_t sum = (int64_t)(((uint64_t)high << (32 - shift)) + lower);
    const int64_t sign = high >> 63;
    if (high >> (shift + 31) == sign && sum != INT64_MIN) {
        return sum;
    }
    return sign < 0 ? -INT64_MAX : INT64_MAX;
}

int64_t el_shift_i64(int64_t value, int shift)
{
    if (shift >= 64) {
        return 0;
    }
    if (shift > 0) {
        const int64_t doubled = value >> (shift - 1);
        return (doubled >> 1) + (doubled & 1);
    }
    const int left = shift > -63 ? -shift : 63; /* 63 saturates all but 0 */
    const int64_t limit = INT64_MAX >> left;
    if (value > limit) {
        return INT64_MAX;
    }
    return value < -limit ? -INT64_MAX : (int64_t)((uint64_t)value << left);
}
