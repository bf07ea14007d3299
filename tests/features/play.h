/* A feature as a picture, in any of the ways that must not show. */
#ifndef EL_TEST_FEATURE_PLAY_H
#define EL_TEST_FEATURE_PLAY_H

#include "feature.h"

typedef struct feature_way {
    uint16_t band_lines;
    uint8_t samples;           /* per pixel; this one shows */
    bool depth_prepass;        /* not with samples, and not with blended depth */
    bool interlaced;           /* two frames, of every other line each; with one sample, one worker and no pre-pass */
    const el_workers *workers; /* NULL: none */
    uint32_t more_bytes;       /* than the least arena */
} feature_way;

/* Enough for all features in one pass, with bands of 8 lines, 8 samples and no workers. */
enum { FEATURE_MORE_BYTES = 200 * 1024 };

/* Whether the library has it so; else it is refused. */
bool feature_takes(const feature *of, const feature_way *way);

/* The arena that it takes. */
size_t feature_bytes(const feature_way *way);

/* Draws it into `pixels` and `depth` [FEATURE_PIXELS]; `memory` has feature_bytes(way). *passes: how many it took. EL_OK or the
 * first error. */
el_status feature_play(const feature *of, const feature_way *way, void *memory, uint16_t *pixels, uint16_t *depth,
                       uint32_t *passes);

/* Of the pixels as little-endian numbers. */
uint32_t feature_crc(const uint16_t *pixels);

#endif
