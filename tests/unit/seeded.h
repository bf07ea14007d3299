/* Seeded numbers for the loops of the tests (Marsaglia, "Xorshift RNGs", 2003), and failures that name their seed.
 *
 * A loop keeps one `seeded` and counts its rounds in it; when a check fails, the message has the seed and the round, so
 * that the case can be found again.
 *
 * Long loops run PART_OF their rounds: all of them on a computer, and on emulated cores, which are thirty times slower, the
 * first of every EL_TEST_PART. Every test runs everywhere. */
#ifndef EL_TEST_SEEDED_H
#define EL_TEST_SEEDED_H

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>

#include "unity.h"

#ifndef EL_TEST_PART
#define EL_TEST_PART 1
#endif

/* Of `all` rounds, or of things that so many rounds must find: at least one. */
#define PART_OF(all) (((all) + EL_TEST_PART - 1) / EL_TEST_PART)

typedef struct seeded {
    uint64_t seed;
    uint64_t state;
    uint32_t round;
} seeded;

static inline seeded seeded_from(uint64_t seed)
{
    return (seeded){.seed = seed, .state = seed * 0x9E3779B97F4A7C15U + 1U};
}

static inline uint64_t any_u64(seeded *s)
{
    s->state ^= s->state << 13;
    s->state ^= s->state >> 7;
    s->state ^= s->state << 17;
    return s->state;
}

/* least..most, both included. */
static inline int64_t any_between(seeded *s, int64_t least, int64_t most)
{
    return least + (int64_t)((any_u64(s) >> 1) % (uint64_t)(most - least + 1));
}

static inline uint32_t any_below(seeded *s, uint32_t limit)
{
    return (uint32_t)((any_u64(s) >> 8) % limit);
}

/* Of any length up to `bits`, so that small numbers are as frequent as large ones. */
static inline uint64_t any_of_bits(seeded *s, unsigned bits)
{
    const unsigned length = (unsigned)any_between(s, 0, bits);
    return length == 0 ? 0 : any_u64(s) >> (64 - length);
}

static inline int64_t any_signed_of_bits(seeded *s, unsigned bits)
{
    const int64_t magnitude = (int64_t)any_of_bits(s, bits);
    return (any_u64(s) & 256U) != 0 ? -magnitude : magnitude;
}

__attribute__((format(printf, 2, 3))) static inline void fail_at(const seeded *s, const char *format, ...)
{
    char what[400];
    char message[500];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    snprintf(message, sizeof message, "seed %llu, round %u: %s", (unsigned long long)s->seed, (unsigned)s->round, what);
    TEST_FAIL_MESSAGE(message);
}

/* Fails with the condition's own text. */
#define EXPECT(seed, condition)                                                                                        \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fail_at(seed, "line %d: %s", __LINE__, #condition);                                                        \
        }                                                                                                              \
    } while (0)

#endif
