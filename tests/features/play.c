#include "play.h"

#include <string.h>

#include "base/crc32.h"

typedef struct shown {
    uint16_t *pixels, *depth;
} shown;

static void begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
}

static void rows(void *context, el_band *band, unsigned slot)
{
    const shown *const to = context;
    const size_t bytes = FEATURE_WIDTH * sizeof to->pixels[0];
    for (size_t i = 0; i < band->lines; i++) {
        const size_t at = (band->y + i * (1U + el_band_gap(band))) * FEATURE_WIDTH;
        memcpy(to->pixels + at, band->pixels + i * FEATURE_WIDTH, bytes);
        memcpy(to->depth + at, band->depth + i * FEATURE_WIDTH, bytes);
    }
    el_band_release(band, slot);
}

static void end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

bool feature_takes(const feature *of, const feature_way *way)
{
    return !(of->blends_depth && way->depth_prepass) && !(of->has_wires && way->samples > 1);
}

size_t feature_bytes(const feature_way *way)
{
    const uint32_t lines = way->band_lines;
    const uint32_t workers = way->workers != NULL ? way->workers->count : 1U;
    return EL_MIN_MEMORY_BYTES((uint32_t)FEATURE_WIDTH, (uint32_t)FEATURE_HEIGHT, lines) +
           EL_WORKERS_BYTES((uint32_t)FEATURE_WIDTH, (uint32_t)FEATURE_HEIGHT, lines, workers) +
           workers * EL_SAMPLES_BYTES((uint32_t)FEATURE_WIDTH, lines, way->samples) + way->more_bytes;
}

el_status feature_play(const feature *of, const feature_way *way, void *memory, uint16_t *pixels, uint16_t *depth,
                       uint32_t *passes)
{
    shown to = {pixels, depth};
    const el_sink sink = {
#if EL_WITH_INTERLACED
        .takes_gaps = true,
#endif
        .context = &to,
        .begin = begin,
        .rows = rows,
        .end = end,
    };
    el_renderer renderer;
    el_config config = {.width = FEATURE_WIDTH,
                        .height = FEATURE_HEIGHT,
                        .band_lines = way->band_lines,
                        .background = of->scene.background,
                        .depth_prepass = way->depth_prepass,
                        .memory = memory,
                        .memory_bytes = feature_bytes(way),
                        .sinks = {&sink},
                        .under = of->under.draw != NULL ? &of->under : NULL,
                        .over = of->over.draw != NULL ? &of->over : NULL,
                        .workers = way->workers};
#if EL_WITH_SAMPLES
    config.samples = way->samples;
#endif
#if EL_WITH_INTERLACED
    config.interlaced = way->interlaced;
#endif
    el_status status = el_init(&renderer, &config);
    for (unsigned i = 0; i < (way->interlaced ? 2 : 1) && status == EL_OK; i++) {
        status = el_scene_play(&of->scene, 0, &renderer);
        *passes = el_frame_stats(&renderer)->passes;
    }
    return status;
}

uint32_t feature_crc(const uint16_t *pixels)
{
    uint32_t crc = 0;
    for (size_t i = 0; i < FEATURE_PIXELS; i++) {
        const uint8_t bytes[2] = {(uint8_t)pixels[i], (uint8_t)(pixels[i] >> 8)};
        crc = el_crc32(crc, bytes, sizeof bytes);
    }
    return crc;
}
