/* Numbers out of the fuzzer's bytes. When they run out, the rest is zero: every input is a whole case. */
#ifndef EL_FUZZ_TAKE_H
#define EL_FUZZ_TAKE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct input {
    const uint8_t *at;
    size_t left;
} input;

static inline void take_bytes(input *in, void *to, size_t count)
{
    const size_t there = count < in->left ? count : in->left;
    memset(to, 0, count);
    if (there > 0) {
        memcpy(to, in->at, there);
        in->at += there;
        in->left -= there;
    }
}

static inline uint8_t take_u8(input *in)
{
    uint8_t value;
    take_bytes(in, &value, sizeof value);
    return value;
}

static inline uint16_t take_u16(input *in)
{
    uint16_t value;
    take_bytes(in, &value, sizeof value);
    return value;
}

static inline uint32_t take_u32(input *in)
{
    uint32_t value;
    take_bytes(in, &value, sizeof value);
    return value;
}

static inline int32_t take_i32(input *in)
{
    return (int32_t)take_u32(in);
}

/* Tells what does not hold, and ends the run as a crash: libFuzzer keeps the input. */
#define FUZZ_EXPECT(condition)                                                                                         \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition);                             \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)

#endif
