/* Every scene drawn without a display: one line per scene, its name and a CRC-32 per frame, as tests/golden/scenes.crc has
 * them. Plain C, for any compiler and core. EL_FRAME_STEP frames apart; slow cores draw fewer. */
#include <stdio.h>

#include "base/crc32.h"
#include "scene.h"

enum {
    WIDTH = 320,
    HEIGHT = 240,
    BAND_LINES = 8,
    FRAMES = 120,
    ARENA_BYTES = 130 * 1024 /* all scenes in one pass */
};

static _Alignas(8) uint8_t arena[ARENA_BYTES];

static void begin(void *context, uint16_t width, uint16_t height)
{
    (void)width;
    (void)height;
    *(uint32_t *)context = 0;
}

/* In the order of bytes that the golden file has: the lower one first. */
static void rows(void *context, el_band *band, unsigned slot)
{
    uint32_t *const crc = context;
    for (size_t i = 0; i < (size_t)band->width * band->lines; i++) {
        const uint8_t bytes[2] = {(uint8_t)band->pixels[i], (uint8_t)(band->pixels[i] >> 8)};
        *crc = el_crc32(*crc, bytes, sizeof bytes);
    }
    el_band_release(band, slot);
}

static void end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

static el_status play(const el_scene *scene)
{
    uint32_t crc = 0;
    const el_sink sink = {.context = &crc, .begin = begin, .rows = rows, .end = end};
    el_renderer renderer;
    el_status status = el_init(&renderer, &(el_config){.width = WIDTH,
                                                       .height = HEIGHT,
                                                       .band_lines = BAND_LINES,
                                                       .background = scene->background,
                                                       .memory = arena,
                                                       .memory_bytes = sizeof arena,
                                                       .sinks = {&sink}});
    (void)fputs(scene->name, stdout);
    for (uint32_t frame = 0; frame < FRAMES && status == EL_OK; frame += EL_FRAME_STEP) {
        status = el_scene_play(scene, frame, &renderer);
        (void)printf(" %08lx", (unsigned long)crc);
    }
    (void)puts("");
    return status;
}

int main(void)
{
    for (size_t i = 0; i < el_scene_count(); i++) {
        if (play(el_scene_at(i)) != EL_OK) {
            return 1;
        }
    }
    return 0;
}
