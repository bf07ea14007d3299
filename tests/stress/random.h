/* The numbers of one case. They follow from the category's name, the seed and the case's index alone, so any case can be
 * run again by itself, and cases do not depend on how many ran before. The generator is SplitMix64 (Steele, Lea and
 * Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014). */
#ifndef EL_STRESS_RANDOM_H
#define EL_STRESS_RANDOM_H

#include <stdbool.h>
#include <stdint.h>

typedef struct dice {
    uint64_t state;
} dice;

static inline uint64_t any_u64(dice *r)
{
    r->state += 0x9E3779B97F4A7C15U;
    uint64_t x = r->state;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
    return x ^ (x >> 31);
}

static inline dice random_of(const char *category, uint64_t seed, uint64_t index)
{
    dice r = {.state = seed};
    for (const char *c = category; *c != '\0'; c++) {
        r.state = any_u64(&r) ^ (uint64_t)*c;
    }
    r.state = any_u64(&r) ^ index;
    return (dice){.state = any_u64(&r)};
}

/* least..most, both included. */
static inline int64_t any_between(dice *r, int64_t least, int64_t most)
{
    return least + (int64_t)((any_u64(r) >> 1) % (uint64_t)(most - least + 1));
}

/* 0..limit - 1. */
static inline uint32_t any_below(dice *r, uint32_t limit)
{
    return (uint32_t)((any_u64(r) >> 8) % limit);
}

/* True once in `n`. */
static inline bool once_in(dice *r, uint32_t n)
{
    return any_below(r, n) == 0;
}

/* Of any length up to `bits`, so that small numbers are as frequent as large ones. */
static inline int64_t any_of_bits(dice *r, unsigned bits)
{
    const unsigned length = any_below(r, bits + 1);
    return length == 0 ? 0 : (int64_t)(any_u64(r) >> (64 - length));
}

static inline int64_t any_signed_of_bits(dice *r, unsigned bits)
{
    const int64_t magnitude = any_of_bits(r, bits);
    return once_in(r, 2) ? -magnitude : magnitude;
}

/* 0 <= value < 1. */
static inline double any_fraction(dice *r)
{
    return (double)(any_u64(r) >> 11) / 9007199254740992.0;
}

#endif
