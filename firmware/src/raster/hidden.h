/* What lies behind everything that a band has already: triangles that need not be set up or drawn into it.
 *
 * A band is cut into blocks of 32 columns. Of each a bound is known that no depth in it is beyond; since depths only come
 * nearer while a band is drawn, a bound once found stays true. It is looked for when a triangle asks, and only where a few
 * of the block's pixels say that the answer may be yes, so that a band that is drawn from back to front is never searched.
 * Drawn from front to back, a triangle that is behind costs its bounding box. */
#ifndef EL_RASTER_HIDDEN_H
#define EL_RASTER_HIDDEN_H

#include <stdbool.h>
#include <stdint.h>

#include "geometry/limits.h"
#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_BLOCK_LOG2 = 5, EL_BLOCKS = (EL_MAX_WIDTH >> EL_BLOCK_LOG2) + 1 };

typedef struct el_hidden {
    uint32_t likely_from;      /* of the stats' pixels */
    bool begun;                /* the rest is valid */
    uint8_t looks[EL_BLOCKS];  /* how often a block may still be searched */
    uint16_t depth[EL_BLOCKS]; /* no pixel of the block is beyond */
} el_hidden;

/* A band of so many pixels begins. */
static inline void el_hidden_begin(el_hidden *hidden, const el_stats *stats, uint32_t pixels)
{
    hidden->begun = false;
    hidden->likely_from = stats->pixels + pixels;
}

/* Whether it is worth to ask: as many pixels as the band has were drawn into it. */
static inline bool el_hidden_is_likely(const el_hidden *hidden, const el_stats *stats)
{
    return (int32_t)(stats->pixels - hidden->likely_from) >= 0;
}

/* Whether no pixel of a triangle could pass the depth test: it lies within columns [x_begin, x_end) and no part of it is
 * nearer than `depth`. False where that is not known. */
bool el_hidden_is(el_hidden *hidden, const el_target *target, int32_t x_begin, int32_t x_end, uint16_t depth);

#ifdef __cplusplus
}
#endif

#endif
