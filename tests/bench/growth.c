/* How cost grows: frames of which one thing grows from measurement to measurement, all else kept.
 *
 * One line per measurement:
 *
 *     SERIES VARIANT X ARENA BAND_LINES crc CRC passes N vertices N triangles N setups N rows N pixels N bands N
 *
 * X is what grows: triangles, the board's distance, layers, spheres, lines or bytes. bench_tool/growth.py knows which law
 * each series is expected to follow. */
#include "frame.h"
#include "growth_scenes.h"
#include "platform.h"

enum {
    BAND_LINES = 8,
    DEFAULT_UV = 3, /* an eighth of a texel */
    SMALL_ARENA = 32 * 1024,
    LARGE_ARENA = 130 * 1024,
    HUGE_ARENA = 512 * 1024,
    LIST_BYTES = 128 * 1024,                                                 /* beside the bands, where those grow */
    LEAST_ARENA = EL_MIN_MEMORY_BYTES(BENCH_WIDTH, BENCH_HEIGHT, BAND_LINES) /* 16,136 */
};

#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))

static _Alignas(8) uint8_t arena[EL_MIN_MEMORY_BYTES(BENCH_WIDTH, BENCH_HEIGHT, BENCH_HEIGHT) + LIST_BYTES];

static void print_stats(const el_stats *stats)
{
    bench_print_item(" passes ", stats->passes);
    bench_print_item(" vertices ", stats->vertices);
    bench_print_item(" triangles ", stats->triangles);
    bench_print_item(" setups ", stats->setups);
    bench_print_item(" rows ", stats->rows);
    bench_print_item(" pixels ", stats->pixels);
    bench_print_item(" bands ", stats->bands);
}

/* Returns 0, or 1 when the frame could not be drawn. */
static int measure(const char *series, const el_scene *scene, uint32_t frame, uint32_t x, uint32_t arena_bytes,
                   uint32_t band_lines)
{
    const bench_setting setting = {
        .band_lines = (uint16_t)band_lines,
        .uv_error_log2 = DEFAULT_UV,
        .arena = arena,
        .arena_bytes = arena_bytes,
    };
    el_renderer renderer;
    bench_picture picture;
    const el_status status = bench_frame(scene, frame, &setting, &renderer, &picture);
    bench_print(series);
    bench_print(" ");
    bench_print(scene->name);
    bench_print_item(" ", x);
    bench_print_item(" ", arena_bytes);
    bench_print_item(" ", band_lines);
    if (status != EL_OK) {
        bench_print_item(" failed with status -", (uint64_t)-status);
        bench_print("\n");
        return 1;
    }
    bench_print(" crc ");
    bench_print_hex(picture.crc);
    print_stats(el_frame_stats(&renderer));
    bench_print("\n");
    return 0;
}

/* The same for a growth scene, of which there is `amount`. */
static int measure_amount(const char *series, const growth_scene *growth, uint32_t amount, uint32_t arena_bytes)
{
    growth->prepare(amount);
    return measure(series, &growth->scene, amount, amount, arena_bytes, BAND_LINES);
}

static int measure_triangles(void)
{
    static const uint32_t arenas[] = {SMALL_ARENA, LARGE_ARENA, HUGE_ARENA};
    int failed = 0;
    for (size_t a = 0; a < COUNT_OF(arenas); a++) {
        for (size_t i = 0; i < growth_sphere_size_count; i++) {
            failed |= measure_amount("triangles", &growth_sphere, growth_sphere_sizes[i], arenas[a]);
        }
    }
    return failed;
}

static int measure_pixels(void)
{
    static const growth_scene *const boards[] = {&growth_board_flat, &growth_board_gouraud, &growth_board_textured};
    static const uint32_t distances_q4[] = {1720, 993, 544, 314, 172, 122, 92, 73, 60, 32};
    int failed = 0;
    for (size_t b = 0; b < COUNT_OF(boards); b++) {
        for (size_t i = 0; i < COUNT_OF(distances_q4); i++) {
            failed |= measure_amount("pixels", boards[b], distances_q4[i], LARGE_ARENA);
        }
    }
    return failed;
}

static int measure_layers(void)
{
    static const growth_scene *const orders[] = {&growth_layers_back_to_front, &growth_layers_front_to_back,
                                                 &growth_layers_back_to_front_textured,
                                                 &growth_layers_front_to_back_textured};
    static const uint32_t counts[] = {1, 2, 3, 4, 6, 8, 12, GROWTH_LAYERS};
    int failed = 0;
    for (size_t o = 0; o < COUNT_OF(orders); o++) {
        for (size_t i = 0; i < COUNT_OF(counts); i++) {
            failed |= measure_amount("layers", orders[o], counts[i], LARGE_ARENA);
        }
    }
    return failed;
}

static int measure_outside(void)
{
    static const growth_scene *const ways[] = {&growth_outside_meshes, &growth_outside_mesh, &growth_outside_behind};
    /* 0, 50, 75, 90, 95, 97.5, 98.3 and 99 % are outside. */
    static const uint32_t counts[] = {GROWTH_SPHERES_SEEN, 10, 20, 50, 100, 200, 300, GROWTH_SPHERES};
    int failed = 0;
    for (size_t w = 0; w < COUNT_OF(ways); w++) {
        for (size_t i = 0; i < COUNT_OF(counts); i++) {
            failed |= measure_amount("outside", ways[w], counts[i], LARGE_ARENA);
        }
    }
    return failed;
}

static int measure_bands(void)
{
    static const char *const scenes[] = {"S1", "S2", "S3"};
    static const uint16_t lines[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 80, 120, BENCH_HEIGHT};
    int failed = 0;
    for (size_t s = 0; s < COUNT_OF(scenes); s++) {
        for (size_t i = 0; i < COUNT_OF(lines); i++) {
            const uint32_t bytes = EL_MIN_MEMORY_BYTES(BENCH_WIDTH, BENCH_HEIGHT, lines[i]) + LIST_BYTES;
            failed |= measure("bands", el_scene_find(scenes[s]), 0, lines[i], bytes, lines[i]);
        }
    }
    return failed;
}

static int measure_arenas(void)
{
    static const char *const scenes[] = {"S1", "S3"};
    static const uint32_t sizes[] = {LEAST_ARENA, 17 * 1024,  18 * 1024,   20 * 1024,  22 * 1024, 24 * 1024,
                                     28 * 1024,   32 * 1024,  40 * 1024,   48 * 1024,  64 * 1024, 80 * 1024,
                                     96 * 1024,   112 * 1024, LARGE_ARENA, 256 * 1024, HUGE_ARENA};
    int failed = 0;
    for (size_t s = 0; s < COUNT_OF(scenes); s++) {
        for (size_t i = 0; i < COUNT_OF(sizes); i++) {
            failed |= measure("arenas", el_scene_find(scenes[s]), 0, sizes[i], sizes[i], BAND_LINES);
        }
    }
    return failed;
}

int bench_main(void)
{
    bench_empty();
    int failed = measure_triangles();
    failed |= measure_pixels();
    failed |= measure_layers();
    failed |= measure_outside();
    failed |= measure_bands();
    failed |= measure_arenas();
    return failed;
}
