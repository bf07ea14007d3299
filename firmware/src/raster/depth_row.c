#include "raster/depth_row.h"

#include "base/fill.h"
#include "base/fixed.h"

enum {
    BLOCK = 8,    /* pixels of which it is asked at once whether all are empty */
    COMPARED = 16 /* pixels that are compared before it is asked again */
};

void el_depth_row_begin(el_depth_row *row, uint16_t *depth, uint32_t count, uint64_t z, uint64_t step)
{
    row->z = z;
    row->step = step;
    row->next = depth;
    row->end = depth + count;
    /* Linear, so no pixel is farther than both ends; count - 1 < 2^16. */
    const uint64_t last = z + el_multiply_u16(step, count - 1U);
    row->never_far = (uint32_t)(z >> 32) < EL_DEPTH_EMPTY && (uint32_t)(last >> 32) < EL_DEPTH_EMPTY;
}

/* How many of the next pixels are empty, in whole blocks. Where they begin between two words, the first is left to be
 * compared. */
static uint32_t empty_ahead(const el_depth_row *row)
{
    const uint16_t *at = row->next;
    if (((uintptr_t)at & 2U) != 0 || !row->never_far) {
        return 0;
    }
    while (row->end - at >= BLOCK) {
        const el_word *const words = (const el_word *)(const void *)at;
        if ((words[0] & words[1] & words[2] & words[3]) != 0xFFFFFFFFU) {
            break;
        }
        at += BLOCK;
    }
    return (uint32_t)(at - row->next);
}

/* The next pixels up to `end`, one at least. */
static void write_all(el_depth_row *row, const uint16_t *end)
{
    uint64_t z = row->z;
    const uint64_t step = row->step;
    uint16_t *depth = row->next;
#pragma GCC unroll 4
    do {
        *depth++ = (uint16_t)(z >> 32);
        z += step;
    } while (depth != end);
    row->z = z;
    row->next = depth;
}

/* The next pixels up to `end`, as far as they are nearer. Returns whether all are. */
static bool write_nearer(el_depth_row *row, const uint16_t *end)
{
    uint64_t z = row->z;
    const uint64_t step = row->step;
    uint16_t *depth = row->next;
    while (depth != end && (uint32_t)(z >> 32) < *depth) {
        *depth++ = (uint16_t)(z >> 32);
        z += step;
    }
    row->z = z;
    row->next = depth;
    return depth == end;
}

uint32_t el_depth_row_take(el_depth_row *row)
{
    const uint16_t *const begin = row->next;
    /* To a word's beginning; then what is empty has nothing to be compared with, and what is not is compared. */
    const uint16_t *end = begin != row->end && ((uintptr_t)begin & 2U) != 0 ? begin + 1 : begin;
    while (write_nearer(row, end) && end != row->end) {
        const uint32_t empty = empty_ahead(row);
        if (empty != 0) {
            write_all(row, row->next + empty);
        }
        end = row->end - row->next > COMPARED ? row->next + COMPARED : row->end;
    }
    return (uint32_t)(row->next - begin);
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
