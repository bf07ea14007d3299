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

/* What is left of a span. Its pixels' depths z are 0 to 65535. */
typedef struct el_depth_row {
    uint64_t z, step;    /* Q32, z with its half added, at the next pixel */
    uint16_t *next;      /* the next pixel's depth so far */
    const uint16_t *end; /* after the last pixel's */
    uint32_t farther;    /* no pixel of the next eight is by more beyond the first of them */
} el_depth_row;

/* A span of `count` pixels from `depth` on, count >= 1. */
void el_depth_row_begin(el_depth_row *row, uint16_t *depth, uint32_t count, uint64_t z, uint64_t step);

/* Goes on as far as pixels are nearer than what is there, which they become. Returns how many. */
uint32_t el_depth_row_take(el_depth_row *row);

/* Goes on as far as pixels are not nearer. Returns how many. */
uint32_t el_depth_row_skip(el_depth_row *row);

#ifdef __cplusplus
}
#endif

#endif
