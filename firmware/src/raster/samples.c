/* samples.h: the patterns, and what becomes of mixed pixels. */
#include "raster/samples.h"

#include "base/fixed.h"

#if EL_WITH_SAMPLES

#define AT(x, y)                                                                                                       \
    {                                                                                                                  \
        (x) * (EL_SUBPIXELS / 16), (y) * (EL_SUBPIXELS / 16)                                                           \
    }
static const el_sample_point four[4] = {AT(-2, -6), AT(6, -2), AT(-6, 2), AT(2, 6)};
static const el_sample_point eight[8] = {AT(1, -3), AT(-1, 3),  AT(5, 1), AT(-3, -5),
                                         AT(-5, 5), AT(-7, -1), AT(3, 7), AT(7, -7)};

const el_sample_point *el_sample_points(unsigned count)
{
    return count == 4 ? four : eight;
}

/* RGB565 with a gap above each channel that takes the sum of eight. */
enum { SPREAD = 0x07E0F81F };

static const uint8_t bits_of[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

static EL_SPECIALISED uint32_t spread(uint32_t sample)
{
    return (sample << 16 | (sample & 0xFFFFU)) & SPREAD;
}

static EL_SPECIALISED void resolve(uint16_t *colour, uint16_t *depth, const uint32_t *samples, uint32_t count)
{
    uint32_t nearest = samples[0];
    uint32_t sum;
    const uint32_t mask = *colour;
    if (mask != 0) {
        const uint32_t outside = samples[1];
        const uint32_t inside = bits_of[mask & 15U] + (count == 8 ? bits_of[mask >> 4] : 0U);
        sum = spread(nearest) * inside + spread(outside) * (count - inside);
        nearest = el_min_u32(nearest, outside);
    } else {
        sum = spread(nearest);
        for (uint32_t k = 1; k < count; k++) {
            sum += spread(samples[k]);
            nearest = el_min_u32(nearest, samples[k]);
        }
    }
    /* Sums of eight are below 2^8, 2^8 and 2^9 from bits 0, 11 and 21 on. */
    const uint32_t half = count / 2U;
    const uint32_t mean = (sum + (half | half << 11 | half << 21)) / count & SPREAD;
    *colour = (uint16_t)(mean | mean >> 16);
    *depth = (uint16_t)(nearest >> 16);
}

static EL_SPECIALISED void resolve_row(const el_sampled_target *target, uint32_t row, uint32_t count)
{
    const uint32_t width = (uint32_t)target->target.width;
    uint32_t *const mixed = target->mixed + row * EL_MIXED_WORDS(width);
    for (uint32_t word = 0; word < EL_MIXED_WORDS(width); word++) {
        uint32_t bits = mixed[word];
        if (bits == 0) {
            continue;
        }
        mixed[word] = 0;
        for (uint32_t at = row * width + word * 32U; bits != 0; bits >>= 1, at++) {
#if !defined(__ARM_ARCH_6M__)
            const uint32_t skipped = (uint32_t)__builtin_ctz(bits);
            bits >>= skipped;
            at += skipped;
#else
            if ((bits & 1U) == 0) {
                continue;
            }
#endif
            resolve(target->target.colour + at, target->target.depth + at, target->samples + at * count, count);
        }
    }
}

void el_samples_resolve(const el_sampled_target *target)
{
    const uint32_t rows = (uint32_t)(target->target.y_end - target->target.y);
    for (uint32_t row = 0; row < rows; row++) {
        if (target->count == 4) {
            resolve_row(target, row, 4);
        } else {
            resolve_row(target, row, 8);
        }
    }
}

#endif
