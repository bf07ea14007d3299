/* frame.h: a renderer per measurement, so that none has the passes of the one before to start with. */
#include "frame.h"

#include "base/crc32.h"
#include "platform.h"

typedef struct watched {
    const el_renderer *renderer;
    bench_picture picture;
} watched;

static void sink_begin(void *context, uint16_t width, uint16_t height)
{
    watched *const seen = context;
    (void)width;
    (void)height;
    seen->picture = (bench_picture){0};
}

/* Of a frame that is not measured. */
static void pass_over(void *context, el_band *band, unsigned slot)
{
    (void)context;
    el_band_release(band, slot);
}

static void sink_rows(void *context, el_band *band, unsigned slot)
{
    bench_stop();
    watched *const seen = context;
    bench_picture *const picture = &seen->picture;
    picture->crc = el_crc32(picture->crc, band->pixels, (size_t)band->width * band->lines * sizeof band->pixels[0]);
    if (seen->renderer->list.used >= picture->list_bytes) {
        picture->list_bytes = seen->renderer->list.used;
        picture->collecting_bytes = el_frame_stats(seen->renderer)->memory_peak;
    }
    el_band_release(band, slot);
    bench_start();
}

static void sink_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

el_status bench_frame(const el_scene *scene, uint32_t number, const bench_setting *setting, el_renderer *renderer,
                      bench_picture *picture)
{
    watched seen = {.renderer = renderer};
    el_sink sink = {.context = &seen, .begin = sink_begin, .rows = pass_over, .end = sink_end};
    const el_config config = {
        .width = BENCH_WIDTH,
        .height = BENCH_HEIGHT,
        .band_lines = setting->band_lines,
        .background = scene->background,
        .uv_error_log2 = setting->uv_error_log2,
        .depth_prepass = setting->depth_prepass,
#if EL_WITH_SAMPLES
        .samples = setting->samples,
#endif
#if EL_WITH_INTERLACED
        .interlaced = setting->interlaced,
#endif
        .over = setting->over,
        .memory = setting->arena,
        .memory_bytes = setting->arena_bytes,
        .sinks = {&sink},
    };
#if EL_WITH_INTERLACED
    sink.takes_gaps = setting->interlaced;
#endif
    el_status status = el_init(renderer, &config);
    if (status == EL_OK && setting->again) {
        status = el_scene_play(scene, number, renderer);
    }
    sink.rows = sink_rows;
    bench_next();
    if (status == EL_OK) {
        bench_start();
        status = el_scene_play(scene, number, renderer);
        bench_stop();
    }
    *picture = seen.picture;
    return status;
}

void bench_empty(void)
{
    bench_next();
    bench_start();
    bench_stop();
    bench_print("empty 0 0 0 crc 00000000\n");
}

void bench_print_item(const char *name, uint64_t value)
{
    bench_print(name);
    bench_print_u64(value);
}
