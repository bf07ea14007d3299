/* The choices that the renderer makes, each beside what else was possible: small functions over the same inputs, counted
 * on the cores, timed here, and scored against exact values by bench_tool/score.py.
 *
 * Inputs. TRIANGLES seeded triangles, each within a tile of its own, so that one picture holds many and each pixel tells
 * which triangle covered it. The tiles are of 8, 32, 120 and 240 px. The same xorshift makes them everywhere; nothing is
 * read from a file. */
#ifndef EL_BENCH_ALTERNATIVES_H
#define EL_BENCH_ALTERNATIVES_H

#include <stddef.h>
#include <stdint.h>

#include "raster/triangle.h"

/* Loops are specialised for what they are given, a function too, as the renderer's are. */
#define BENCH_INLINE __attribute__((always_inline)) static inline

enum {
    WIDTH = 320,
    HEIGHT = 240,
    PICTURES = 10,
    PIXELS = WIDTH * HEIGHT,
    SMALL_TRIANGLES = 2 * 1200,                       /* of 8 px: a fine mesh */
    WALL_TRIANGLES = 70 + 2 * 4 + 1,                  /* of 32, 120 and 240 px; 1/w varies by a factor of up to 8 */
    TRIANGLES = SMALL_TRIANGLES + 2 * WALL_TRIANGLES, /* the last ones again with steep walls: a factor of up to 128 */
    FINE_BITS = 12                                    /* fraction bits of a corner before it is snapped */
};

typedef struct bench_triangle {
    int32_t fine_x[3], fine_y[3]; /* 1/4096 px */
    el_corner corners[3];         /* the same, snapped to 1/EL_SUBPIXELS px, with attributes */
    uint32_t picture;
} bench_triangle;

extern bench_triangle bench_triangles[TRIANGLES];
void bench_triangles_make(void);

extern uint16_t bench_colour[PICTURES][PIXELS];
extern uint16_t bench_depth[PICTURES][PIXELS];

/* Triangles [begin, end). */
typedef struct bench_range {
    uint32_t begin, end;
} bench_range;

typedef struct bench_case bench_case;
struct bench_case {
    const char *group;
    const char *name;
    /* Does the work, with bench_start and bench_stop around it. With `record` it leaves there, unmeasured, what the score
     * needs: the values at each pixel before their last rounding. */
    void (*run)(const bench_case *self, int32_t *record);
    const void *output; /* what `run` leaves, equal on all machines */
    size_t output_bytes;
    size_t record_bytes;   /* 0: the output tells all */
    bench_range triangles; /* for the groups that draw a part of them */
    uint8_t uv_error_log2; /* for textures */
};

/* Each file's cases end with a group of NULL. */
extern const bench_case edge_cases[];
extern const bench_case subpixel_cases[];
extern const bench_case depth_cases[];
extern const bench_case gouraud_cases[];
extern const bench_case dither_cases[];
extern const bench_case texture_cases[];
extern const bench_case reciprocal_cases[];
extern const bench_case smoothing_cases[];

/* Corners from the top to the bottom; where they are level, from left to right. */
static inline void bench_sort(int32_t x[3], int32_t y[3])
{
    for (unsigned i = 1; i < 3; i++) {
        for (unsigned k = i; k > 0 && (y[k] < y[k - 1] || (y[k] == y[k - 1] && x[k] < x[k - 1])); k--) {
            const int32_t swap_x = x[k], swap_y = y[k];
            x[k] = x[k - 1];
            y[k] = y[k - 1];
            x[k - 1] = swap_x;
            y[k - 1] = swap_y;
        }
    }
}

#endif
