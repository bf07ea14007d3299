/* The depth test of a row, before anything else is known of its pixels: which stretches of a span are seen. What is hidden
 * costs no texel, a span that is hidden no 1/w; and a loop that has only depth to keep has registers enough. */
#ifndef EL_RASTER_DEPTH_ROW_H
#define EL_RASTER_DEPTH_ROW_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Depth where nothing was drawn yet. */
enum { EL_DEPTH_EMPTY = 0xFFFF };

/* Pixels of which it is asked at once whether all are nearer. */
enum { EL_DEPTH_BLOCK = 8 };

/* What is left of a span. Its pixels' depths z are 0 to 65535. */
typedef struct el_depth_row {
    uint64_t z, step;    /* Q32, z with its half added, at the next pixel */
    uint16_t *next;      /* the next pixel's depth so far */
    const uint16_t *end; /* after the last pixel's */
    uint32_t farther;    /* no pixel of a block is by more beyond its first */
} el_depth_row;

/* A span of `count` pixels from `depth` on, count >= 1. */
static inline void el_depth_row_begin(el_depth_row *row, uint16_t *depth, uint32_t count, uint64_t z, uint64_t step)
{
    row->z = z;
    row->step = step;
    row->next = depth;
    row->end = depth + count;
    /* From a block's first pixel to its farthest, rounded up. In a span that has a block, depths grow by less than 2^16
     * along it; elsewhere it is not asked for. */
    const int32_t whole = (int32_t)(uint32_t)(step >> 32);
    row->farther = whole < 0 ? 0U : (EL_DEPTH_BLOCK - 1U) * ((uint32_t)whole + 1U);
}

/* Goes on as far as pixels are nearer than what is there, which they become. Returns how many. */
uint32_t el_depth_row_take(el_depth_row *row);

/* The same, and leaves what is there. */
uint32_t el_depth_row_pass(el_depth_row *row);

/* Goes on as far as pixels are not nearer. Returns how many. */
uint32_t el_depth_row_skip(el_depth_row *row);

#ifdef __cplusplus
}
#endif

#endif
