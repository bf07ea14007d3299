/* A sink that checks the renderer's promises while it records a frame: begin, then every line once from the top to the
 * bottom, then end; and that a band it holds stays as it was handed over.
 *
 * It gives bands back at once, or keeps them until it is waited for, as a DMA does. Asked whether it can do without lines
 * that are unchanged, it says no, or whatever `answers` has: then what it recorded of them before stands. */
#ifndef EL_TEST_RECORDING_SINK_H
#define EL_TEST_RECORDING_SINK_H

#include <string.h>

#include "base/crc32.h"
#include "edgeline.h"
#include "seeded.h"
#include "unity.h"

enum { RECORD_MAX_PIXELS = 320 * 240, RECORD_MAX_BAND = 64 * 64, RECORD_MAX_HELD = 2 * EL_MAX_WORKERS };

typedef struct recording {
    bool defers; /* keeps each band until the renderer waits for it, or until finish_recording */
    uint16_t width, height;
    uint16_t next_line;
    bool in_frame;
    uint32_t frames;
    uint32_t bands;
    uint32_t waits;
    seeded *answers;   /* NULL: no */
    uint32_t left_out; /* lines, of all frames */
    el_stats stats;
    uint16_t pixels[RECORD_MAX_PIXELS];
    uint16_t depth[RECORD_MAX_PIXELS];
    struct {
        el_band *band;
        unsigned slot;
        uint16_t y, lines;
        uint32_t crc;
    } held[RECORD_MAX_HELD]; /* oldest first */
    unsigned held_count;
} recording;

static inline uint32_t band_crc(const el_band *band)
{
    return el_crc32(0, band->pixels, sizeof(uint16_t) * band->width * band->lines);
}

static inline void record_begin(void *context, uint16_t width, uint16_t height)
{
    recording *const r = context;
    TEST_ASSERT_FALSE_MESSAGE(r->in_frame, "a frame began inside a frame");
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(RECORD_MAX_PIXELS, (uint32_t)width * height);
    r->width = width;
    r->height = height;
    r->next_line = 0;
    r->bands = 0;
    r->in_frame = true;
}

static inline void release_oldest(recording *r)
{
    const el_band *const band = r->held[0].band;
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(r->held[0].y, band->y, "a held band was moved");
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(r->held[0].lines, band->lines, "a held band was cut");
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(r->held[0].crc, band_crc(band), "the pixels of a held band changed");
    el_band_release(r->held[0].band, r->held[0].slot);
    r->held_count--;
    memmove(r->held, r->held + 1, r->held_count * sizeof r->held[0]);
}

static inline void record_rows(void *context, el_band *band, unsigned slot)
{
    recording *const r = context;
    TEST_ASSERT_TRUE_MESSAGE(r->in_frame, "rows outside a frame");
    TEST_ASSERT_EQUAL_UINT16(r->width, band->width);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(r->next_line, band->y, "a gap between bands, or a line twice");
    TEST_ASSERT_GREATER_THAN_UINT16(0, band->lines);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(r->height, (uint32_t)band->y + band->lines);
    TEST_ASSERT_TRUE_MESSAGE(band->held[slot] != 0, "a band was handed over that is not ours");
    const uint32_t at = (uint32_t)band->y * band->width;
    const uint32_t count = (uint32_t)band->lines * band->width;
    memcpy(r->pixels + at, band->pixels, count * sizeof r->pixels[0]);
    memcpy(r->depth + at, band->depth, count * sizeof r->depth[0]);
    r->next_line = (uint16_t)(band->y + band->lines);
    r->bands++;
    if (!r->defers) {
        el_band_release(band, slot);
        return;
    }
    TEST_ASSERT_LESS_THAN_UINT(RECORD_MAX_HELD, r->held_count);
    r->held[r->held_count].band = band;
    r->held[r->held_count].slot = slot;
    r->held[r->held_count].y = band->y;
    r->held[r->held_count].lines = band->lines;
    r->held[r->held_count].crc = band_crc(band);
    r->held_count++;
}

static inline bool record_unchanged(void *context, uint16_t y, uint16_t lines)
{
    recording *const r = context;
    TEST_ASSERT_TRUE_MESSAGE(r->in_frame, "asked outside a frame");
    TEST_ASSERT_GREATER_THAN_UINT32_MESSAGE(0, r->frames, "asked before it had a frame");
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(r->next_line, y, "asked for other lines than the next ones");
    TEST_ASSERT_GREATER_THAN_UINT16(0, lines);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(r->height, (uint32_t)y + lines);
    if (r->answers == NULL || any_below(r->answers, 4) == 0) {
        return false;
    }
    r->next_line = (uint16_t)(y + lines);
    r->left_out += lines;
    return true;
}

static inline void record_end(void *context, const el_stats *stats)
{
    recording *const r = context;
    TEST_ASSERT_TRUE_MESSAGE(r->in_frame, "end outside a frame");
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(r->height, r->next_line, "the frame ended early");
    if (r->answers == NULL) {
        TEST_ASSERT_EQUAL_UINT32(r->bands, stats->bands);
    }
    r->stats = *stats;
    r->in_frame = false;
    r->frames++;
}

static inline void record_wait(void *context)
{
    recording *const r = context;
    r->waits++;
    if (r->held_count > 0) {
        release_oldest(r);
    }
}

static inline el_sink recording_sink(recording *r)
{
    return (el_sink){.context = r,
                     .begin = record_begin,
                     .rows = record_rows,
                     .unchanged = record_unchanged,
                     .end = record_end,
                     .wait = record_wait};
}

/* What is still held is looked at once more and given back. */
static inline void finish_recording(recording *r)
{
    while (r->held_count > 0) {
        release_oldest(r);
    }
}

static inline uint32_t recorded_crc(const recording *r)
{
    return el_crc32(0, r->pixels, sizeof(uint16_t) * r->width * r->height);
}

#endif
