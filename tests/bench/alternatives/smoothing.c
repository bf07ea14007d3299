/* Smooth edges: frames of S1 with one sample per pixel, with several, and with a display's stripes.
 *
 * What is left for the score is a small picture of it: of each pixel its RGB565, and the sums of the channels of the 256 pixels
 * that lie there in a picture of 16 times the width and height, which has one sample in each. Those of stripes lie about where
 * the stripe is; beyond the screen's sides S1 is black. */
#include <string.h>

#include "alternatives.h"
#include "edgeline.h"
#include "platform.h"
#include "scene.h"

enum {
    FINER = 16,
    THIRD = (FINER + 1) / 3, /* of a pixel, rounded */
    SMALL_WIDTH = 120,
    SMALL_HEIGHT = 90,
    BAND_LINES = 8,
    VALUES = 4
};

static void sink_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
}

static void sink_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

/* The copy is not measured. */
static void keep_rows(void *context, el_band *band, unsigned slot)
{
    bench_stop();
    memcpy((uint16_t *)context + band->y * band->width, band->pixels,
           (size_t)band->width * band->lines * sizeof band->pixels[0]);
    el_band_release(band, slot);
    bench_start();
}

static void record_rows(void *context, el_band *band, unsigned slot)
{
    int32_t *values = (int32_t *)context + (size_t)VALUES * band->y * band->width;
    for (int32_t i = 0; i < band->width * band->lines; i++, values += VALUES) {
        values[0] = band->pixels[i];
    }
    el_band_release(band, slot);
}

typedef struct sums {
    int32_t *record;
    const el_config *config; /* of the picture that is scored */
} sums;

static void add_rows(void *context, el_band *band, unsigned slot)
{
    const sums *const to = context;
    const int32_t outer = to->config->stripes == EL_STRIPES_NONE ? 0 : THIRD;
    const int32_t moved[3] = {outer, 0, -outer};
    for (int32_t i = 0; i < band->width * band->lines; i++) {
        const uint32_t pixel = band->pixels[i];
        const int32_t channels[3] = {(int32_t)(pixel >> 11), (int32_t)(pixel >> 5 & 63U), (int32_t)(pixel & 31U)};
        const int32_t row = (band->y + i / band->width) / FINER;
        for (int32_t k = 0; k < 3; k++) {
            const int32_t x = i % band->width + moved[k];
            if (x >= 0 && x < SMALL_WIDTH * FINER) {
                to->record[(row * SMALL_WIDTH + x / FINER) * VALUES + 1 + k] += channels[k];
            }
        }
    }
    el_band_release(band, slot);
}

static void play(el_config config, const el_sink *sink, bool measured)
{
    static el_renderer renderer;
    config.band_lines = BAND_LINES;
    config.memory = bench_depth; /* not drawn into otherwise; all of these frames in one pass */
    config.memory_bytes = sizeof bench_depth;
    config.sinks[0] = sink;
    el_status status = el_init(&renderer, &config);
    if (measured) {
        bench_start();
    }
    if (status == EL_OK) {
        status = el_scene_play(el_scene_find("S1"), 0, &renderer);
    }
    if (measured) {
        bench_stop();
    }
    if (status != EL_OK) {
        bench_print("smoothing: S1 was not drawn\n"); /* which is no line of results */
    }
}

static void draw(el_config config, int32_t *record)
{
    el_sink sink = {.context = bench_colour[0], .begin = sink_begin, .rows = keep_rows, .end = sink_end};
    if (record == NULL) {
        config.width = WIDTH;
        config.height = HEIGHT;
        play(config, &sink, true);
        return;
    }
    config.width = SMALL_WIDTH;
    config.height = SMALL_HEIGHT;
    sink.context = record;
    sink.rows = record_rows;
    play(config, &sink, false);
    sums to = {.record = record, .config = &config};
    const el_config fine = {.width = SMALL_WIDTH * FINER, .height = SMALL_HEIGHT * FINER};
    sink.context = &to;
    sink.rows = add_rows;
    play(fine, &sink, false);
}

static void samples_1(const bench_case *self, int32_t *record)
{
    (void)self;
    draw((el_config){.samples = 1}, record);
}

static void samples_4(const bench_case *self, int32_t *record)
{
    (void)self;
    draw((el_config){.samples = 4}, record);
}

static void samples_8(const bench_case *self, int32_t *record)
{
    (void)self;
    draw((el_config){.samples = 8}, record);
}

static void stripes(const bench_case *self, int32_t *record)
{
    (void)self;
    draw((el_config){.stripes = EL_STRIPES_RGB}, record);
}

static void stripes_4(const bench_case *self, int32_t *record)
{
    (void)self;
    draw((el_config){.stripes = EL_STRIPES_RGB, .samples = 4}, record);
}

#define CASE(name)                                                                                                     \
    {                                                                                                                  \
        "smoothing", #name, name, bench_colour[0], sizeof bench_colour[0],                                             \
            (size_t)SMALL_WIDTH *SMALL_HEIGHT *VALUES * sizeof(int32_t), {0, 0}, 0                                     \
    }
const bench_case smoothing_cases[] = {CASE(samples_1), CASE(samples_4), CASE(samples_8),
                                      CASE(stripes),   CASE(stripes_4), {0}};
