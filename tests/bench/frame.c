/* frame.h: a renderer per measurement, so that none has the passes of the one before to start with. */
#include "frame.h"

#include "base/crc32.h"
#include "platform.h"

static void sink_begin(void *context, uint16_t width, uint16_t height)
{
    uint32_t *const crc = context;
    (void)width;
    (void)height;
    *crc = 0;
}

static void sink_rows(void *context, el_band *band, unsigned slot)
{
    bench_stop();
    uint32_t *const crc = context;
    *crc = el_crc32(*crc, band->pixels, (size_t)band->width * band->lines * sizeof band->pixels[0]);
    el_band_release(band, slot);
    bench_start();
}

static void sink_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

el_status bench_frame(const el_scene *scene, uint32_t number, const bench_setting *setting, el_renderer *renderer,
                      uint32_t *crc)
{
    const el_sink sink = {.context = crc, .begin = sink_begin, .rows = sink_rows, .end = sink_end};
    const el_config config = {
        .width = BENCH_WIDTH,
        .height = BENCH_HEIGHT,
        .band_lines = setting->band_lines,
        .background = scene->background,
        .uv_error_log2 = setting->uv_error_log2,
        .memory = setting->arena,
        .memory_bytes = setting->arena_bytes,
        .sinks = {&sink},
    };
    el_status status = el_init(renderer, &config);
    bench_next();
    if (status == EL_OK) {
        bench_start();
        status = el_scene_play(scene, number, renderer);
        bench_stop();
    }
    return status;
}

void bench_empty(void)
{
    bench_next();
    bench_start();
    bench_stop();
    bench_print("empty 0 0 0 crc 00000000 passes 0 peak 0 ns 0\n");
}

void bench_print_item(const char *name, uint64_t value)
{
    bench_print(name);
    bench_print_u64(value);
}
