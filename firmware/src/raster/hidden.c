#include "raster/hidden.h"

#include <string.h>

#include "base/fixed.h"

/* A block that was searched in vain so often is not searched again: what a band costs at most. */
enum { LOOKS = 4 };

static void begin(el_hidden *hidden)
{
    memset(hidden->depth, 0xFF, sizeof hidden->depth);
    memset(hidden->looks, LOOKS, sizeof hidden->looks);
    hidden->begun = true;
}

/* The columns [x, x_end) of the target. */
typedef struct columns {
    const uint16_t *at; /* their first depth */
    int32_t count, rows, width;
} columns;

/* Four pixels of a block, a corner's and one of each row's third: whether one of them is beyond. */
static bool has_a_pixel_beyond(const columns *c, uint16_t depth)
{
    const int32_t last_row = (c->rows - 1) * c->width;
    return c->at[0] > depth || c->at[c->count - 1] > depth || c->at[last_row + c->count / 2] > depth ||
           c->at[last_row / 2] > depth;
}

/* The farthest depth of a block; more than `depth` as soon as one is. */
static uint32_t search(const columns *c, uint16_t depth)
{
    uint32_t most = 0;
    const uint16_t *row = c->at;
    for (int32_t y = 0; y < c->rows && most <= depth; y++, row += c->width) {
        const uint16_t *const end = row + c->count;
        for (const uint16_t *at = row; at != end; at++) {
            most = *at > most ? *at : most;
        }
    }
    return most;
}

bool el_hidden_is(el_hidden *hidden, const el_target *target, int32_t x_begin, int32_t x_end, uint16_t depth)
{
    if (!hidden->begun) {
        begin(hidden);
    }
    const int32_t end = el_min_i32(x_end, target->width);
    for (int32_t x = el_max_i32(x_begin, 0); x < end;) {
        const uint32_t block = (uint32_t)x >> EL_BLOCK_LOG2;
        const int32_t block_begin = (int32_t)(block << EL_BLOCK_LOG2);
        x = block_begin + (1 << EL_BLOCK_LOG2);
        if (hidden->depth[block] <= depth) {
            continue;
        }
        const columns c = {
            .at = target->depth + block_begin,
            .count = el_min_i32(x, target->width) - block_begin,
            .rows = target->y_end - target->y,
            .width = target->width,
        };
        if (hidden->looks[block] == 0 || has_a_pixel_beyond(&c, depth)) {
            return false;
        }
        const uint32_t most = search(&c, depth);
        if (most > depth) {
            hidden->looks[block]--;
            return false;
        }
        hidden->depth[block] = (uint16_t)most;
    }
    return true;
}
