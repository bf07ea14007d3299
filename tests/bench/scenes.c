/* Whole frames (frame.h) of the standard scenes, the demo's, the simulator's of all materials, and the benchmark's own.
 *
 * One line per measurement:
 *
 *     SCENE ARENA UV FRAME crc CRC passes N peak BYTES collecting BYTES colour BYTES depth BYTES bins BYTES list BYTES
 *         ns NANOSECONDS
 *
 * in one line. SCENE-again is the second of two equal frames, SCENE-prepass is drawn depth first, SCENE-4x and SCENE-8x
 * with so many samples per pixel, SCENE-hud with a HUD over it. `peak` is the arena's largest use, `collecting` its largest
 * one before the bands of the longest list are drawn; two bands of colour, one of depth, the bins and the display list
 * have the bytes that are named, at either time. Beside them lie vertices while triangles are collected, and states of
 * triangles while they are drawn. */
#include "frame.h"
#include "materials_scene.h"
#include "own_scenes.h"
#include "platform.h"

enum {
    BAND_LINES = 8,
    LARGE_ARENA = 130 * 1024, /* all scenes in one pass */
    SMALL_ARENA = 32 * 1024,  /* what the small boards can spare */
    DEFAULT_UV = 3            /* an eighth of a texel */
};

static _Alignas(8) uint8_t arena[LARGE_ARENA];

typedef enum way { ONCE, AGAIN, PREPASS, SAMPLES_4, SAMPLES_8, UNDER_HUD } way;

/* Returns 0, or 1 when the frame could not be drawn. */
static int measure(const el_scene *scene, uint32_t arena_bytes, uint8_t uv_error_log2, uint32_t frame, way how)
{
    static const char *const suffixes[] = {[ONCE] = "",         [AGAIN] = "-again",  [PREPASS] = "-prepass",
                                           [SAMPLES_4] = "-4x", [SAMPLES_8] = "-8x", [UNDER_HUD] = "-hud"};
    static el_renderer renderer;
    const bench_setting setting = {
        .band_lines = BAND_LINES,
        .uv_error_log2 = uv_error_log2,
        .depth_prepass = how == PREPASS,
        .again = how == AGAIN,
        .samples = how == SAMPLES_4   ? 4
                   : how == SAMPLES_8 ? 8
                                      : 1,
        .over = how == UNDER_HUD ? &bench_hud : NULL,
        .arena = arena,
        .arena_bytes = arena_bytes,
    };
    uint64_t best_ns = UINT64_MAX;
    bench_picture picture;
    bench_print(scene->name);
    bench_print(suffixes[how]);
    bench_print_item(" ", arena_bytes);
    bench_print_item(" ", uv_error_log2);
    bench_print_item(" ", frame);
    for (unsigned i = 0; i < bench_repeats; i++) {
        const el_status status = bench_frame(scene, frame, &setting, &renderer, &picture);
        if (status != EL_OK) {
            bench_print_item(" failed with status -", (uint64_t)-status);
            bench_print("\n");
            return 1;
        }
        best_ns = bench_elapsed_ns() < best_ns ? bench_elapsed_ns() : best_ns;
    }
    const el_stats *const stats = el_frame_stats(&renderer);
    bench_print(" crc ");
    bench_print_hex(picture.crc);
    bench_print_item(" passes ", stats->passes);
    bench_print_item(" peak ", stats->memory_peak);
    bench_print_item(" collecting ", picture.collecting_bytes);
    bench_print_item(" colour ", 2 * EL_COLOUR_BAND_BYTES(BENCH_WIDTH, BAND_LINES));
    bench_print_item(" depth ", EL_DEPTH_BAND_BYTES(BENCH_WIDTH, BAND_LINES));
    bench_print_item(" bins ", EL_BIN_BYTES(BENCH_HEIGHT, BAND_LINES));
    bench_print_item(" list ", picture.list_bytes);
    bench_print_item(" ns ", best_ns);
    bench_print("\n");
    return 0;
}

/* Scenes of the benchmark alone, their first frames. */
static int measure_own(const el_scene *scenes, size_t count, way how)
{
    int failed = 0;
    for (size_t i = 0; i < count; i++) {
        failed |= measure(&scenes[i], LARGE_ARENA, DEFAULT_UV, 0, how);
    }
    return failed;
}

int bench_main(void)
{
    static const char *const still[] = {"S1", "S2", "S2-no-depth", "S3", "S4"};
    static const char *const moving[] = {"teapot", "room", "solid", "field"};
    static const char *const sampled[] = {"S1", "S3", "teapot", "room"};
    static const uint32_t frames[] = {0, 5, 10};
    int failed = 0;

    bench_empty();

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
    for (size_t i = 0; i < sizeof sampled / sizeof sampled[0]; i++) {
        failed |= measure(el_scene_find(sampled[i]), LARGE_ARENA, DEFAULT_UV, 0, SAMPLES_4);
    }
    failed |= measure(el_scene_find("S1"), LARGE_ARENA, DEFAULT_UV, 0, SAMPLES_8);
    failed |= measure(el_scene_find("S1"), LARGE_ARENA, DEFAULT_UV, 0, UNDER_HUD);
    failed |= measure(&el_materials_scene, LARGE_ARENA, DEFAULT_UV, 0, AGAIN);
    failed |= measure_own(overdraw_scenes, overdraw_scene_count, ONCE);
    failed |= measure_own(overdraw_scenes, overdraw_scene_count, PREPASS);
    failed |= measure_own(mixed_scenes, mixed_scene_count, ONCE);
    failed |= measure_own(model_scenes, model_scene_count, ONCE);
    return failed;
}
