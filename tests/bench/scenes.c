/* Whole frames: each scene rendered into a sink that only sums its pixels up. The sums stand outside of what is measured,
 * so a figure is what the renderer itself costs, from el_frame_begin to the last band, the call of the sink included.
 *
 * One line per measurement:
 *
 *     SCENE ARENA UV FRAME crc CRC passes N peak BYTES collecting BYTES colour BYTES depth BYTES bins BYTES list BYTES
 *         ns NANOSECONDS
 *
 * in one line. SCENE-again is the second of two equal frames. `peak` is the arena's largest use, `collecting` its largest
 * one before the bands of the longest list are drawn; two bands of colour, one of depth, the bins and the display list
 * have the bytes that are named, at either time. Beside them lie vertices while triangles are collected, and states of
 * triangles while they are drawn.
 */
#include "base/crc32.h"
#include "own_scenes.h"
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
static el_renderer renderer;
static uint32_t picture_crc;
static uint32_t list_bytes;
static uint32_t collecting_bytes;

static void sink_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
    picture_crc = 0;
    list_bytes = 0;
    collecting_bytes = 0;
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
    (void)context;
    picture_crc = el_crc32(picture_crc, band->pixels, (size_t)band->width * band->lines * sizeof band->pixels[0]);
    if (renderer.list.used >= list_bytes) {
        list_bytes = renderer.list.used;
        collecting_bytes = el_frame_stats(&renderer)->memory_peak;
    }
    el_band_release(band, slot);
    bench_start();
}

static void sink_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

static el_sink sink = {.begin = sink_begin, .end = sink_end};

static void print_item(const char *name, uint64_t value)
{
    bench_print(name);
    bench_print_u64(value);
}

typedef enum repetition { ONCE, AGAIN } repetition;

/* Returns 0, or 1 when the frame could not be drawn. AGAIN: the same frame has been drawn before. */
static int measure(const el_scene *scene, uint32_t arena_bytes, uint8_t uv_error_log2, uint32_t frame, repetition times)
{
    uint64_t best_ns = UINT64_MAX;
    bench_print(scene->name);
    bench_print(times == AGAIN ? "-again" : "");
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
        if (status == EL_OK && times == AGAIN) {
            sink.rows = pass_over;
            status = el_scene_play(scene, frame, &renderer);
        }
        if (status == EL_OK) {
            sink.rows = sink_rows;
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
    print_item(" collecting ", collecting_bytes);
    print_item(" colour ", 2 * EL_COLOUR_BAND_BYTES(WIDTH, BAND_LINES));
    print_item(" depth ", EL_DEPTH_BAND_BYTES(WIDTH, BAND_LINES));
    print_item(" bins ", EL_BIN_BYTES(HEIGHT, BAND_LINES));
    print_item(" list ", list_bytes);
    print_item(" ns ", best_ns);
    bench_print("\n");
    return 0;
}

/* Scenes of the benchmark alone, their first frames. */
static int measure_own(const el_scene *scenes, size_t count)
{
    int failed = 0;
    for (size_t i = 0; i < count; i++) {
        failed |= measure(&scenes[i], LARGE_ARENA, DEFAULT_UV, 0, ONCE);
    }
    return failed;
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
    bench_print("empty 0 0 0 crc 00000000\n");

    for (size_t i = 0; i < sizeof still / sizeof still[0]; i++) {
        failed |= measure(el_scene_find(still[i]), LARGE_ARENA, DEFAULT_UV, 0, ONCE);
        failed |= measure(el_scene_find(still[i]), SMALL_ARENA, DEFAULT_UV, 0, ONCE);
    }
    for (uint8_t uv = 1; uv <= 5; uv++) {
        failed |= uv == DEFAULT_UV ? 0 : measure(el_scene_find("S2"), LARGE_ARENA, uv, 0, ONCE);
        failed |= uv == DEFAULT_UV ? 0 : measure(el_scene_find("S2-no-depth"), LARGE_ARENA, uv, 0, ONCE);
    }
    for (size_t i = 0; i < sizeof moving / sizeof moving[0]; i++) {
        for (size_t k = 0; k < sizeof frames / sizeof frames[0]; k++) {
            failed |= measure(el_scene_find(moving[i]), LARGE_ARENA, DEFAULT_UV, frames[k], ONCE);
        }
    }
    failed |= measure(el_scene_find("teapot"), LARGE_ARENA, DEFAULT_UV, 0, AGAIN);
    failed |= measure_own(overdraw_scenes, overdraw_scene_count);
    failed |= measure_own(model_scenes, model_scene_count);
    return failed;
}
