/* What one core draws bands with: its buffers, and the triangles that it carries from band to band. Internal to the frame
 * layer; el_renderer holds that of the caller's core. */
#ifndef EL_FRAME_PAINTER_H
#define EL_FRAME_PAINTER_H

#include <stdbool.h>
#include <stdint.h>

#include "base/sink.h"
#include "base/stats.h"
#include "raster/list.h"

/* What sizes of states there are: one for each el_shading, and that of tiny triangles, which small code has not. Where pixels
 * have several samples, there is one size. */
typedef enum el_state_kind {
    EL_STATE_SAMPLED = EL_SHADE_FLAT,
    EL_STATE_TINY = EL_SHADE_OVERDRAW + 1,
    EL_STATE_KINDS = EL_SHADE_OVERDRAW + (EL_SMALL_CODE ? 1 : 2)
} el_state_kind;

/* Triangles that reach beyond the band in which they begin are carried on: their set-up state lives in what the list
 * has left of its memory. Where there is no room for a state, the triangle is set up anew in every band: slower, with the
 * same pixels. What is carried is a chain in the order of submission, of states and of such records, whose name tells
 * which it is: states lie behind the list. Each begins with the name of the next one. */
typedef struct el_carrying {
    uint16_t first;                      /* of the chain; 0: none */
    uint16_t first_state;                /* names from here on are states */
    uint32_t begin;                      /* of the memory that there is, bytes from the list's base, ... */
    uint32_t used;                       /* ... end of what is handed out so far ... */
    uint32_t end;                        /* ... and of all */
    uint16_t given_back[EL_STATE_KINDS]; /* each begins with the next one's name; 0: none */
} el_carrying;

typedef struct el_hidden el_hidden;

typedef struct el_painter {
    uint8_t current;      /* which of `bands` is drawn into next */
    uint8_t band_is_open; /* it is cleared, and part of its triangles are drawn */
    bool goes_on;         /* what reaches beyond the open band is carried on */
    bool first_depth;     /* its depth is drawn before its colours */
    uint8_t first;        /* `current` as this pass begins */
    /* With several workers, how many of its bands of this pass are complete, which its core writes, and how many of those
     * the sinks have got, which the caller's core writes. */
    uint16_t drawn;
    uint16_t handed;
#if EL_WITH_DEBUG_VIEWS
    uint32_t band_work; /* this frame's before the open band, see EL_DEBUG_BANDS */
#endif
    el_stats *stats;
    el_carrying carrying;
    el_band bands[2];
    uint16_t *depth[2]; /* of each band; one and the same where there is one worker */
#if EL_WITH_SAMPLES
    uint32_t *samples; /* mixed bits, and samples behind them (raster/samples.h); NULL: there is no memory for any */
#endif
#if EL_WITH_HIDDEN
    el_hidden *hidden; /* of the band that is drawn into */
#endif
} el_painter;

#endif
