/* What is left out because the frame before has it: the second of two frames of a scene that follow each other, with a
 * colour panel behind the renderer whose bus only counts. A figure is all that the processor does for the frame, hashes
 * included, but the transfers themselves.
 *
 * One line per measurement:
 *
 *     SCENE WAY crc CRC bytes ON_THE_BUS
 */
#include "base/crc32.h"
#include "panel/ili9341.h"
#include "platform.h"
#include "scene.h"

enum { WIDTH = 320, HEIGHT = 240, BAND_LINES = 8, ARENA = 130 * 1024, FIRST_FRAME = 4 };

static _Alignas(8) uint8_t arena[ARENA];
static uint32_t shown[EL_TFT_SHOWN_BYTES(WIDTH, HEIGHT) / 4];
static uint32_t bus_bytes;
static uint32_t bus_crc;
static int measuring;

static void bus_reset(void *context, int level)
{
    (void)context;
    (void)level;
}

static void bus_command(void *context, uint8_t command, const uint8_t *parameters, size_t count)
{
    (void)context;
    (void)command;
    (void)parameters;
    bus_bytes += 1U + (uint32_t)count;
}

static void bus_pixels(void *context, const uint16_t *words, size_t count, void (*done)(void *argument), void *argument)
{
    (void)context;
    if (measuring) {
        bench_stop();
        bus_bytes += 2U * (uint32_t)count;
        bus_crc = el_crc32(bus_crc, words, 2 * count);
        bench_start();
    }
    done(argument);
}

static void bus_delay_ms(void *context, uint32_t ms)
{
    (void)context;
    (void)ms;
}

static const el_bus bus = {.reset = bus_reset, .command = bus_command, .pixels = bus_pixels, .delay_ms = bus_delay_ms};

typedef struct way {
    const char *name;
    uint32_t *shown;
    uint8_t reuse;
} way;

static int measure(const char *name, const way *how)
{
    const el_scene *const scene = el_scene_find(name);
    el_tft panel;
    el_renderer renderer;
    el_status status = el_tft_init(&panel, &(el_tft_config){.bus = &bus,
                                                            .model = &el_ili9341,
                                                            .rotation = EL_ROTATION_90,
                                                            .shown = how->shown,
                                                            .shown_bytes = sizeof shown});
    const el_sink sink = el_tft_sink(&panel);
    if (status == EL_OK) {
        status = el_init(&renderer, &(el_config){.width = WIDTH,
                                                 .height = HEIGHT,
                                                 .band_lines = BAND_LINES,
                                                 .background = scene->background,
                                                 .reuse = how->reuse,
                                                 .memory = arena,
                                                 .memory_bytes = sizeof arena,
                                                 .sinks = {&sink}});
    }
    if (status == EL_OK) {
        status = el_scene_play(scene, FIRST_FRAME, &renderer);
    }
    bus_bytes = 0;
    bus_crc = 0;
    measuring = 1;
    bench_next();
    bench_start();
    if (status == EL_OK) {
        status = el_scene_play(scene, FIRST_FRAME + 1, &renderer);
    }
    bench_stop();
    measuring = 0;
    bench_print(name);
    bench_print(" ");
    bench_print(how->name);
    bench_print(" crc ");
    bench_print_hex(bus_crc);
    bench_print(" bytes ");
    bench_print_u64(bus_bytes);
    bench_print("\n");
    return status == EL_OK ? 0 : 1;
}

int bench_main(void)
{
    static const char *const scenes[] = {"teapot", "solid", "field", "room", "S1"};
    static const way ways[] = {
        {"whole", NULL, 0},
        {"changes", shown, 0},
        {"changes,background", shown, EL_REUSE_BACKGROUND},
        {"all", shown, EL_REUSE_BACKGROUND | EL_REUSE_FRAME},
    };
    int failed = 0;

    /* What a pair of markers costs by itself. */
    bench_next();
    bench_start();
    bench_stop();
    bench_print("empty - crc 00000000 bytes 0\n");

    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        for (size_t k = 0; k < sizeof ways / sizeof ways[0]; k++) {
            failed |= measure(scenes[i], &ways[k]);
        }
    }
    return failed;
}
