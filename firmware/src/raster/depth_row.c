#include "raster/depth_row.h"

#include "base/fill.h"
#include "base/options.h"

/* Of several steps along a row compilers make products and sums, for which there are no registers. What they know nothing of
 * stays a step. */
#if defined(__thumb__) || defined(__riscv)
#define KEEP_STEP(x) __asm__("" : "+r"(x))
#else
#define KEEP_STEP(x) ((void)0)
#endif

enum {
    BLOCK = EL_DEPTH_BLOCK,
    COMPARED = 2 * BLOCK /* pixels that are compared before it is asked again */
};

/* Whether each of a block's depths is beyond `far`, as far as that is seen at once: in the bits that all of them have, which
 * are a depth that none is nearer than. What is empty, or far behind, has many of them. */
static EL_SPECIALISED bool is_beyond(const uint16_t *block, uint32_t far)
{
    const el_word *const words = (const el_word *)(const void *)block;
    const uint32_t common = words[0] & words[1] & words[2] & words[3];
    return (common & common >> 16) > far;
}

#if !defined(__ARM_ARCH_6M__)
static EL_SPECIALISED uint64_t stepped(uint64_t z, uint64_t step)
{
    const uint64_t next = z + step;
    uint32_t upper = (uint32_t)(next >> 32);
    KEEP_STEP(upper);
    return (uint64_t)upper << 32 | (uint32_t)next;
}
#endif

/* Writes a block's depths from z on. Returns the next pixel's. */
static EL_SPECIALISED uint64_t write_block(uint16_t *block, uint64_t z, uint64_t step)
{
#if defined(__ARM_ARCH_6M__)
    /* No registers for two words, and none that the two halves of a number could be taken apart in. */
#pragma GCC unroll 8
    for (unsigned i = 0; i < BLOCK; i++) {
        block[i] = (uint16_t)(z >> 32);
        z += step;
        KEEP_STEP(z);
    }
#else
    el_word *const words = (el_word *)(void *)block;
#pragma GCC unroll 4
    for (unsigned i = 0; i < BLOCK / 2; i++) {
        const uint32_t first = (uint32_t)(z >> 32);
        z = stepped(z, step);
        words[i] = first | (uint32_t)(z >> 32) << 16;
        z = stepped(z, step);
    }
#endif
    return z;
}

uint32_t el_depth_row_take(el_depth_row *row)
{
    const uint16_t *const begin = row->next;
    const uint16_t *const end = row->end;
    const uint64_t step = row->step;
    const uint32_t farther = row->farther;
    uint16_t *depth = row->next;
    uint64_t z = row->z;
    while (depth != end) {
        /* To where a word begins, or some further. */
        const uint16_t *compared = depth + 1;
        if (((uintptr_t)depth & 2U) == 0) {
            while (end - depth >= BLOCK && is_beyond(depth, (uint32_t)(z >> 32) + farther)) {
                z = write_block(depth, z, step);
                depth += BLOCK;
            }
            compared = end - depth > COMPARED ? depth + COMPARED : end;
        }
        while (depth != compared && (uint32_t)(z >> 32) < *depth) {
            *depth++ = (uint16_t)(z >> 32);
            z += step;
        }
        if (depth != compared) {
            break;
        }
    }
    row->z = z;
    row->next = depth;
    return (uint32_t)(depth - begin);
}

uint32_t el_depth_row_pass(el_depth_row *row)
{
    const uint64_t step = row->step;
    uint16_t *depth = row->next;
    uint64_t z = row->z;
    while (depth != row->end && (uint32_t)(z >> 32) < *depth) {
        if (((uintptr_t)depth & 2U) == 0 && row->end - depth >= BLOCK &&
            is_beyond(depth, (uint32_t)(z >> 32) + row->farther)) {
            z += step * BLOCK;
            depth += BLOCK;
        } else {
            depth++;
            z += step;
        }
    }
    const uint32_t passed = (uint32_t)(depth - row->next);
    row->z = z;
    row->next = depth;
    return passed;
}

uint32_t el_depth_row_skip(el_depth_row *row)
{
    uint64_t z = row->z;
    const uint64_t step = row->step;
    uint16_t *depth = row->next;
    while (depth != row->end && (uint32_t)(z >> 32) >= *depth) {
        depth++;
        z += step;
    }
    const uint32_t skipped = (uint32_t)(depth - row->next);
    row->z = z;
    row->next = depth;
    return skipped;
}
