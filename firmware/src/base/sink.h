/* Where finished bands go: a panel, a stream, a test.
 *
 * A band is a few whole lines of RGB565. Ownership is explicit: the renderer lends a band to each sink by `rows`, and
 * may not touch its pixels until every sink has given it back by el_band_release. A sink may release inside `rows`
 * (it copied or sent the pixels) or later, from an interrupt too (its DMA has ended). The renderer has two bands, so
 * one can be on its way while the next is drawn. */
#ifndef EL_BASE_SINK_H
#define EL_BASE_SINK_H

#include <stdbool.h>
#include <stdint.h>

#include "base/stats.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_MAX_SINKS = 3 };

typedef struct el_band {
    uint16_t *pixels;      /* lines * width pixels, row by row, native-endian RGB565 */
    const uint16_t *depth; /* the same shape, 0 near, 65535 empty; valid during `rows` only */
    uint16_t width;        /* pixels per line */
    uint16_t y;            /* first line on the screen */
    uint16_t lines;        /* lines in this band; the last band of a frame may have fewer than the others */
    uint8_t gap;           /* lines of the screen between two of its lines: 0; 1 in an interlaced frame */
    volatile uint8_t held[EL_MAX_SINKS]; /* not 0 while that sink has the band; each byte has one writer at a time,
                                            so an interrupt may clear it without a lock */
} el_band;

/* Gives `band` back. `slot` is the number that `rows` was called with. Safe in interrupts, and on any core: who finds the
 * band free may write it. */
static inline void el_band_release(el_band *band, unsigned slot)
{
    __atomic_store_n(&band->held[slot], 0, __ATOMIC_RELEASE);
}

static inline bool el_band_is_free(const el_band *band)
{
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        if (__atomic_load_n(&band->held[i], __ATOMIC_ACQUIRE) != 0) {
            return false;
        }
    }
    return true;
}

/* All functions get `context`. For each frame: begin, then rows or unchanged for bands from the top to the bottom without
 * a gap, then end. Of an interlaced frame (el_config.interlaced) the lines between those of the bands are as they were. */
typedef struct el_sink {
    void *context;
    /* A frame of width x height pixels starts. */
    void (*begin)(void *context, uint16_t width, uint16_t height);
    /* Takes `band`; the sink owns it until el_band_release(band, slot). */
    void (*rows)(void *context, el_band *band, unsigned slot);
    /* Lines [y, y + lines) have the pixels that they had in the frame before, whichever way this sink got those, or did
     * not. True: it does without them, `rows` is not called for them; false, and always when it had no frame before: it
     * gets them by `rows` as ever. Asked for the whole frame first, if that is unchanged, and perhaps for some of its bands
     * after the answer false; or for single bands. NULL: as false. */
    bool (*unchanged)(void *context, uint16_t y, uint16_t lines);
    /* The frame's last band has been handed over (it may still be on its way). */
    void (*end)(void *context, const el_stats *stats);
    /* Called again and again while the renderer waits for a band: drive the transfer, or sleep until an interrupt.
     * May be NULL. */
    void (*wait)(void *context);
    /* Bands may have gaps: their line i is line y + i * (1 + gap) of the screen. Without, there are no interlaced frames. */
    bool takes_gaps;
} el_sink;

#ifdef __cplusplus
}
#endif

#endif
