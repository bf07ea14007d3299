/* samples.h: the patterns, and what becomes of mixed pixels. */
#include "raster/samples.h"

#include "base/fixed.h"
#include "base/rgb565.h"
#include "raster/fill.h"

#if EL_WITH_SAMPLES

const el_sample_point *el_sample_points(unsigned count)
{
    return el_known_sample_points(count);
}

static EL_SPECIALISED void resolve(uint16_t *colour, uint16_t *depth, const uint32_t *samples, uint32_t count)
{
    EL_SETTLE(samples); /* or both words would be found anew */
    static const uint8_t bits_of[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};
    uint32_t nearest = samples[0];
    uint32_t sum = el_rgb565_spread(nearest);
    const uint32_t mask = *colour;
    if (mask != 0) {
        const uint32_t outside = samples[1];
        const uint32_t inside = count == 4 ? bits_of[mask] : (uint32_t)bits_of[mask & 15U] + bits_of[mask >> 4];
        const uint32_t rest = el_rgb565_spread(outside);
        sum = (sum - rest) * inside + rest * count;
        nearest = el_min_u32(nearest, outside);
    } else {
        for (uint32_t k = 1; k < count; k++) {
            sum += el_rgb565_spread(samples[k]);
            nearest = el_min_u32(nearest, samples[k]);
        }
    }
    /* Sums of eight are below 2^8, 2^8 and 2^9 from bits 0, 11 and 21 on. */
    const uint32_t half = count / 2U;
    const uint32_t mean = (sum + (half | half << 11 | half << 21)) / count & EL_RGB565_SPREAD;
    *colour = (uint16_t)((mean | mean >> 16) & 0xFFFFU);
    *depth = (uint16_t)(nearest >> 16);
}

static EL_SPECIALISED void resolve_all(const el_sampled_target *target, uint32_t pixels, uint32_t count)
{
    uint16_t *const colour = target->target.colour;
    uint16_t *const depth = target->target.depth;
    const uint32_t *const samples = target->samples;
    uint32_t *const mixed = target->mixed;
    const uint32_t *const end = mixed + EL_MIXED_WORDS(pixels);
    for (uint32_t *word = mixed; word != end; word++) {
        uint32_t bits = *word;
        if (bits == 0) {
            continue;
        }
        *word = 0;
        uint32_t at = (uint32_t)(word - mixed) * 32U;
        do {
            at += el_normalise(&bits);
            bits <<= 1;
            resolve(colour + at, depth + at, samples + at * count, count);
            at++;
        } while (bits != 0);
    }
}

void el_samples_resolve(const el_sampled_target *target)
{
    const uint32_t pixels = (uint32_t)((target->target.y_end - target->target.y) * target->target.width);
    if (target->count == 4) {
        resolve_all(target, pixels, 4);
    } else {
        resolve_all(target, pixels, 8);
    }
}

#endif
