/* Whole frames: each scene rendered into a sink that only sums its pixels up. The sums stand outside of what is measured,
 * so a figure is what the renderer itself costs, from el_frame_begin to the last band, the call of the sink included.
 *
 * One line per measurement:
 *
 *     SCENE ARENA UV FRAME crc CRC passes N peak BYTES ns NANOSECONDS
 */
#include "base/crc32.h"
#include "platform.h"
#include "scene.h"

enum {
    WIDTH = 320,
    HEIGHT = 240,
    BAND_LINES = 8,
    LARGE_ARENA = 130 * 1024, /* all scenes in one pass */
    SMALL_ARENA = 32 * 1024,  /* what the small boards can spare */
    DEFAULT_UV = 3            /* an eighth of a texel */
};

static _Alignas(8) uint8_t arena[LARGE_ARENA];
static uint32_t picture_crc;

static void sink_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
    picture_crc = 0;
}

static void sink_rows(void *context, el_band *band, unsigned slot)
{
    bench_stop();
    (void)context;
    picture_crc = el_crc32(picture_crc, band->pixels, (size_t)band->width * band->lines * sizeof band->pixels[0]);
    el_band_release(band, slot);
    bench_start();
}

static void sink_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

static const el_sink sink = {.begin = sink_begin, .rows = sink_rows, .end = sink_end};

static void print_item(const char *name, uint64_t value)
{
    bench_print(name);
    bench_print_u64(value);
}

/* Returns 0, or 1 when the frame could not be drawn. */
static int measure(const el_scene *scene, uint32_t arena_bytes, uint8_t uv_error_log2, uint32_t frame)
{
    el_renderer renderer;
    uint64_t best_ns = UINT64_MAX;
    bench_print(scene->name);
    print_item(" ", arena_bytes);
    print_item(" ", uv_error_log2);
    print_item(" ", frame);
    for (unsigned i = 0; i < bench_repeats; i++) {
        const el_config config = {
            .width = WIDTH,
            .height = HEIGHT,
            .band_lines = BAND_LINES,
            .background = scene->background,
            .uv_error_log2 = uv_error_log2,
            .memory = arena,
            .memory_bytes = arena_bytes,
            .sinks = {&sink},
        };
        el_status status = el_init(&renderer, &config);
        if (status == EL_OK) {
            bench_next();
            bench_start();
            status = el_scene_play(scene, frame, &renderer);
            bench_stop();
        }
        if (status != EL_OK) {
            print_item(" failed with status -", (uint64_t)-status);
            bench_print("\n");
            return 1;
        }
        best_ns = bench_elapsed_ns() < best_ns ? bench_elapsed_ns() : best_ns;
    }
    const el_stats *const stats = el_frame_stats(&renderer);
    bench_print(" crc ");
    bench_print_hex(picture_crc);
    print_item(" passes ", stats->passes);
    print_item(" peak ", stats->memory_peak);
    print_item(" ns ", best_ns);
    bench_print("\n");
    return 0;
}

int bench_main(void)
{
    static const char *const still[] = {"S1", "S2", "S2-no-depth", "S3", "S4"};
    static const char *const moving[] = {"teapot", "room", "solid", "field"};
    static const uint32_t frames[] = {0, 5, 10};
    int failed = 0;

    /* What a pair of markers costs by itself. */
    bench_next();
    bench_start();
    bench_stop();
    bench_print("empty 0 0 0 crc 00000000 passes 0 peak 0 ns 0\n");

    for (size_t i = 0; i < sizeof still / sizeof still[0]; i++) {
        failed |= measure(el_scene_find(still[i]), LARGE_ARENA, DEFAULT_UV, 0);
        failed |= measure(el_scene_find(still[i]), SMALL_ARENA, DEFAULT_UV, 0);
    }
    for (uint8_t uv = 1; uv <= 5; uv++) {
        failed |= uv == DEFAULT_UV ? 0 : measure(el_scene_find("S2"), LARGE_ARENA, uv, 0);
        failed |= uv == DEFAULT_UV ? 0 : measure(el_scene_find("S2-no-depth"), LARGE_ARENA, uv, 0);
    }
    for (size_t i = 0; i < sizeof moving / sizeof moving[0]; i++) {
        for (size_t k = 0; k < sizeof frames / sizeof frames[0]; k++) {
            failed |= measure(el_scene_find(moving[i]), LARGE_ARENA, DEFAULT_UV, frames[k]);
        }
    }
    return failed;
}
