/* A sink that keeps the picture and its depth, and expects whole bands from the top to the bottom. */
#ifndef EL_FUZZ_PICTURE_H
#define EL_FUZZ_PICTURE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "edgeline.h"
#include "take.h"

enum { PICTURE_SIDE = 96 };

typedef struct picture {
    uint16_t width, height;
    uint16_t next_line;
    uint16_t colour[PICTURE_SIDE * PICTURE_SIDE];
    uint16_t depth[PICTURE_SIDE * PICTURE_SIDE];
} picture;

static void picture_begin(void *context, uint16_t width, uint16_t height)
{
    picture *const p = context;
    FUZZ_EXPECT(width == p->width && height == p->height);
    p->next_line = 0;
}

static void picture_rows(void *context, el_band *band, unsigned slot)
{
    picture *const p = context;
    FUZZ_EXPECT(band->y == p->next_line && band->lines > 0 && band->y + band->lines <= p->height);
    FUZZ_EXPECT(band->width == p->width);
    const size_t at = (size_t)band->y * p->width;
    const size_t bytes = (size_t)band->lines * p->width * sizeof p->colour[0];
    memcpy(p->colour + at, band->pixels, bytes);
    memcpy(p->depth + at, band->depth, bytes);
    p->next_line = (uint16_t)(p->next_line + band->lines);
    el_band_release(band, slot);
}

static void picture_end(void *context, const el_stats *stats)
{
    const picture *const p = context;
    (void)stats;
    FUZZ_EXPECT(p->next_line == p->height);
}

static inline el_sink picture_sink(picture *p)
{
    return (el_sink){.context = p, .begin = picture_begin, .rows = picture_rows, .end = picture_end};
}

/* How a picture is made: must not show in it. */
typedef struct way {
    uint16_t band_lines;
    size_t memory_bytes;
} way;

/* The least memory for bands of that many lines, and some. */
static inline way way_of(uint16_t width, uint16_t height, uint16_t lines, uint16_t more)
{
    const uint16_t band_lines = (uint16_t)(1 + lines % height);
    return (way){.band_lines = band_lines,
                 .memory_bytes = EL_MIN_MEMORY_BYTES((size_t)width, (size_t)height, (size_t)band_lines) + more};
}

static inline void expect_same_pictures(const picture *a, const picture *b)
{
    const size_t bytes = (size_t)a->width * a->height * sizeof a->colour[0];
    FUZZ_EXPECT(memcmp(a->colour, b->colour, bytes) == 0);
    FUZZ_EXPECT(memcmp(a->depth, b->depth, bytes) == 0);
}

#endif
