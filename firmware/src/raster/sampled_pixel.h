/* A pixel's samples as words, and its place in the band. Private to sampled.c, small_sampled.c and samples.c.
 *
 * In most mixed pixels two triangles meet, or one and what is behind it: two words are enough for these, and a mask that
 * says which samples have the first one. It lies in the pixel's place in the colour band; 0 there says that each sample
 * has a word of its own. */
#ifndef EL_RASTER_SAMPLED_PIXEL_H
#define EL_RASTER_SAMPLED_PIXEL_H

#include "raster/samples.h"

/* A row of the band, or all of it as one row. */
typedef struct el_sampled_place {
    uint16_t *colour, *depth;
    uint32_t *samples;
    uint32_t *mixed; /* the band's */
    uint32_t first;  /* the number of the row's first pixel in the band, by which its bit is found */
} el_sampled_place;

static inline el_sampled_place el_sampled_place_at(const el_sampled_target *target, int32_t y)
{
    const uint32_t first = (uint32_t)((y - target->target.y) * target->target.width);
    return (el_sampled_place){
        .colour = target->target.colour + first,
        .depth = target->target.depth + first,
        .samples = target->samples + first * target->count,
        .mixed = target->mixed,
        .first = first,
    };
}

/* Bits are numbered from the top: the first that is set is found by counting zeros before it. */
#define EL_TOP_BIT 0x80000000U

static inline bool el_bit_is_set(const uint32_t *bits, uint32_t i)
{
    return (bits[i / 32U] << (i % 32U) & EL_TOP_BIT) != 0;
}

static inline void el_set_bit(uint32_t *bits, uint32_t i)
{
    bits[i / 32U] |= EL_TOP_BIT >> (i % 32U);
}

static inline bool el_pixel_is_mixed(const el_sampled_place *at, uint32_t x)
{
    return el_bit_is_set(at->mixed, at->first + x);
}

/* Gives each sample of a mixed pixel a word of its own. */
static inline void el_spread(const el_sampled_place *at, uint32_t x, uint32_t count)
{
    uint32_t *const samples = at->samples + x * count;
    const uint32_t mask = at->colour[x];
    const uint32_t inside = samples[0];
    const uint32_t outside = samples[1];
    if (mask == 0) {
        return;
    }
    at->colour[x] = 0;
    for (uint32_t k = 0; k < count; k++) {
        samples[k] = (mask >> k & 1U) != 0 ? inside : outside;
    }
}

/* Whether any of pixels [x, x_end) is, one at least. */
static inline bool el_any_is_mixed(const el_sampled_place *at, uint32_t x, uint32_t x_end)
{
    const uint32_t i = at->first + x;
    const uint32_t last_i = at->first + x_end - 1U;
    const uint32_t last = last_i / 32U;
    uint32_t word = i / 32U;
    uint32_t any = at->mixed[word] & 0xFFFFFFFFU >> (i % 32U);
    for (; word < last && any == 0; any = at->mixed[word]) {
        word++;
    }
    return word < last || (any & 0xFFFFFFFFU << (31U - last_i % 32U)) != 0;
}

/* A pixel whose samples have words of their own is mixed no longer, where all are the same. */
static inline void el_unmix(const el_sampled_place *at, uint32_t x, uint32_t count)
{
    const uint32_t *const samples = at->samples + x * count;
    for (uint32_t i = 1; i < count; i++) {
        if (samples[i] != samples[0]) {
            return;
        }
    }
    at->mixed[(at->first + x) / 32U] &= ~(EL_TOP_BIT >> ((at->first + x) % 32U));
    at->depth[x] = (uint16_t)(samples[0] >> 16);
    at->colour[x] = (uint16_t)samples[0];
}

#endif
