/* One frame, measured: rendered into a sink that only sums its pixels up. The sums stand outside of what is measured, so a
 * figure is what the renderer itself costs, from el_frame_begin to the last band, the call of the sink included. */
#ifndef EL_BENCH_FRAME_H
#define EL_BENCH_FRAME_H

#include <stdbool.h>

#include "scene.h"

/* What a measurement is about, apart from the scene. */
typedef struct bench_setting {
    uint16_t band_lines;
    uint8_t uv_error_log2;
    bool depth_prepass;
    uint8_t samples;      /* per pixel; 0 is 1 */
    bool interlaced;      /* one field of the frame, that of the even lines */
    bool again;           /* the same frame has been drawn before, unmeasured */
    const el_layer *over; /* or NULL */
    void *arena;
    uint32_t arena_bytes;
} bench_setting;

/* What the sink saw. */
typedef struct bench_picture {
    uint32_t crc;              /* CRC-32 of the frame's RGB565 pixels */
    uint32_t list_bytes;       /* the most that the display list took when a band came ... */
    uint32_t collecting_bytes; /* ... and the arena's largest use before that list's bands were drawn */
} bench_picture;

enum { BENCH_WIDTH = 320, BENCH_HEIGHT = 240 };

/* Measures frame `number` of `scene` between bench_start and bench_stop, after one bench_next; the counters are
 * el_frame_stats of `renderer`. Returns the error of el_init or of the scene. */
el_status bench_frame(const el_scene *scene, uint32_t number, const bench_setting *setting, el_renderer *renderer,
                      bench_picture *picture);

/* What a pair of markers costs by itself: the first measurement of a program, and its line. */
void bench_empty(void);

/* "NAMEvalue" */
void bench_print_item(const char *name, uint64_t value);

#endif
