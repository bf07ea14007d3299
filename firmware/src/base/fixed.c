#include "base/fixed.h"

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
    /* The magnitude's product in three words, high:middle:low, 63 + 32 bits. */
    const uint64_t magnitude = el_abs_u64(value);
    uint64_t low = (magnitude & 0xFFFFFFFFU) * factor;
    uint64_t high = (magnitude >> 32) * factor + (low >> 32);
    low &= 0xFFFFFFFFU;

    /* Round half up for the signed value: half up for positive magnitudes, half down (just below half) for negative. */
    uint64_t round_low = 0;
    uint64_t round_high = 0;
    if (shift > 32) {
        round_high = 1ULL << (shift - 33);
    } else if (shift > 0) {
        round_low = 1ULL << (shift - 1);
    }
    if (value < 0 && shift > 0) {
        if (round_low == 0) {
            round_low = 0xFFFFFFFFU;
            round_high -= 1;
        } else {
            round_low -= 1;
        }
    }
    low += round_low;
    high += round_high + (low >> 32);
    low &= 0xFFFFFFFFU;

    uint64_t result;
    if (shift >= 32) {
        result = high >> (shift - 32);
    } else if (el_bit_length_u64(high) + 32 - shift > 63) {
        result = INT64_MAX;
    } else {
        result = (high << (32 - shift)) | (low >> shift);
    }
    if (result > INT64_MAX) {
        result = INT64_MAX;
    }
    return value < 0 ? -(int64_t)result : (int64_t)result;
}

int64_t el_shift_i64(int64_t value, int shift)
{
    if (shift >= 64) {
        return 0;
    }
    if (shift > 0) {
        return (value >> shift) + ((value >> (shift - 1)) & 1);
    }
    const uint64_t magnitude = el_abs_u64(value);
    if (magnitude == 0) {
        return 0;
    }
    if (el_bit_length_u64(magnitude) - shift > 63) {
        return value < 0 ? -INT64_MAX : INT64_MAX;
    }
    return value < 0 ? -(int64_t)(magnitude << -shift) : (int64_t)(magnitude << -shift);
}
