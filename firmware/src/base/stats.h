/* The work counters of one frame.
 *
 * Every member is a uint32_t, in the order in which FRAME_END carries them on the wire (WIRE.md); new ones go to the
 * end. A counter that a frame never touched is 0. They wrap at 2^32, which no frame reaches. */
#ifndef EL_BASE_STATS_H
#define EL_BASE_STATS_H

#include <stdint.h>

#include "base/options.h"

typedef struct el_stats {
    uint32_t passes;             /* rounds of the caller's draw loop */
    uint32_t draws;              /* el_draw calls, all passes together; so are the counters below */
    uint32_t draws_culled;       /* draws whose bounding sphere is outside the view */
    uint32_t vertices;           /* vertices transformed */
    uint32_t triangles;          /* triangles looked at */
    uint32_t triangles_outside;  /* rejected by outcodes, before any division */
    uint32_t triangles_clipped;  /* cut at the near or far plane or the guard band */
    uint32_t triangles_backface; /* facing away, after snapping */
    uint32_t triangles_empty;    /* zero area, or no row or column of pixel centres inside the bounding box */
    uint32_t triangles_other;    /* outside the rows of this pass */
    uint32_t triangles_listed;   /* put on the display list */
    uint32_t setups;             /* triangle set-ups in the band rasterizer */
    uint32_t rows;               /* rows of triangles walked */
    uint32_t spans;              /* of those, rows with at least one pixel */
    uint32_t pixels;             /* pixels of those spans, before the depth test */
    uint32_t bands;              /* bands handed to the sinks */
    uint32_t flushes;            /* lists drawn early into a band because they were full */
    uint32_t memory_peak;        /* largest use of the arena, bytes */
    uint32_t clusters_outside;   /* clusters outside the view, by their spheres */
    uint32_t clusters_turned;    /* clusters that face away, by their cones */
    uint32_t triangles_skipped;  /* triangles of both kinds, which were not looked at */
    uint32_t triangles_hidden;   /* not drawn into a band, being behind all that was there; once for each band */
    uint32_t pixels_prepass;     /* pixels of spans that were drawn for their depth alone */
    uint32_t lines_background; /* lines of bands left out: background, in the frame before too (EL_REUSE_BACKGROUND) */
    uint32_t frames_unchanged; /* 1: this frame is the one before, nothing was drawn (EL_REUSE_FRAME) */
} el_stats;

static inline void el_count(uint32_t *counter, uint32_t events)
{
    if (EL_WITH_STATS) {
        *counter += events;
    }
}

enum { EL_STATS_COUNT = sizeof(el_stats) / sizeof(uint32_t) };

#endif
