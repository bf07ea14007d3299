#include "base/fixed.h"

_Static_assert((-3 >> 1) == -2, "Edgeline needs arithmetic right shifts");

/* NOLINTBEGIN(readability-redundant-declaration): where the copy lies that small code shares. */
EL_INLINE_HERE unsigned el_normalise(uint32_t *x);
EL_INLINE_HERE uint64_t el_multiply_u16(uint64_t a, uint32_t b);
EL_INLINE_HERE uint64_t el_multiply_u64(uint64_t a, int32_t b);
EL_INLINE_HERE uint64_t el_product_u64(uint32_t a, uint32_t b);
/* NOLINTEND(readability-redundant-declaration) */

uint32_t el_sqrt_u64(uint64_t x)
{
    uint64_t root = 0;
    uint64_t bit = 1ULL << 62;
    while (bit > x) {
        bit >>= 2;
    }
    while (bit != 0) {
        if (x >= root + bit) {
            x -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
        bit >>= 2;
    }
    return (uint32_t)root;
}

int64_t el_scale_i64(int64_t value, uint32_t factor, int shift)
{
    /* The product is high * 2^32 and the lower 32 bits of `low`; high lies within -2^63 and 2^63 - 2^31. */
    const uint64_t low = (uint64_t)(uint32_t)value * factor;
    const int64_t high = (value >> 32) * (int64_t)factor + (int64_t)(low >> 32);
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
