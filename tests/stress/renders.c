#include "renders.h"

#include <stdlib.h>
#include <string.h>

typedef struct collector {
    picture *into;
    uint32_t next_line;
    bool broken;
} collector;

static void begin(void *context, uint16_t width, uint16_t height)
{
    collector *const c = context;
    c->broken = c->broken || width != c->into->width || height != c->into->height;
}

static void rows(void *context, el_band *band, unsigned slot)
{
    collector *const c = context;
    picture *const p = c->into;
    if (band->y != c->next_line || band->y + band->lines > p->height || band->width != p->width) {
        c->broken = true;
    } else {
        const size_t at = (size_t)band->y * p->width;
        const size_t bytes = (size_t)band->lines * p->width * sizeof p->colour[0];
        memcpy(p->colour + at, band->pixels, bytes);
        memcpy(p->depth + at, band->depth, bytes);
        c->next_line += band->lines;
    }
    el_band_release(band, slot);
}

static void end(void *context, const el_stats *stats)
{
    collector *const c = context;
    c->into->stats = *stats;
    c->broken = c->broken || c->next_line != c->into->height;
}

bool render(stress *s, const el_camera *camera, const drawing drawings[], unsigned count, picture *into)
{
    dice *const r = &s->random;
    const uint16_t lines = (uint16_t)any_between(r, 1, once_in(r, 2) ? into->height : 1 + into->height / 8);
    const size_t bytes =
        EL_MIN_MEMORY_BYTES((size_t)into->width, (size_t)into->height, (size_t)lines) + (size_t)any_of_bits(r, 17);
    collector c = {.into = into};
    const el_sink sink = {.context = &c, .begin = begin, .rows = rows, .end = end};
    const el_config config = {
        .width = into->width,
        .height = into->height,
        .band_lines = lines,
        .uv_error_log2 = (uint8_t)any_below(r, MAX_UV_ERROR_LOG2 + 1),
        .memory = malloc(bytes), /* an arena of its own, so that AddressSanitizer sees its end */
        .memory_bytes = bytes,
        .sinks = {&sink},
    };
    el_renderer renderer;
    int status = el_init(&renderer, &config);
    if (status == EL_OK) {
        status = el_frame_begin(&renderer, camera);
    }
    for (int more = status == EL_OK; more > 0;) {
        for (unsigned i = 0; i < count && status == EL_OK; i++) {
            status = el_draw(&renderer, drawings[i].mesh, drawings[i].pose, drawings[i].material);
        }
        more = status == EL_OK ? el_frame_next(&renderer) : 0;
        status = more < 0 ? more : status;
    }
    free(config.memory);
    if (status != EL_OK || c.broken) {
        stress_fail(s, "%d x %d in bands of %d lines, %zu bytes: status %d%s", into->width, into->height, lines, bytes,
                    status, c.broken ? ", and the bands are not the picture's" : "");
    }
    return status == EL_OK && !c.broken;
}
