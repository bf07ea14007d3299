/* Dithering of vertex colours to RGB565, as the renderer does it, off and on. */
#include "spans.h"

static void off_case(const bench_case *self, int32_t *record)
{
    const el_surface surface = {.shading = EL_SHADE_GOURAUD};
    (void)record;
    draw_all(&surface, self->triangles, 0, NULL, NULL);
}

static void on_case(const bench_case *self, int32_t *record)
{
    const el_surface surface = {.shading = EL_SHADE_GOURAUD, .finish = EL_FINISH_DITHER};
    (void)record;
    draw_all(&surface, self->triangles, 0, NULL, NULL);
}

/* Blocks of 4 x 4 pixels fit the larger triangles only. */
#define LARGE_TRIANGLES                                                                                                \
    {                                                                                                                  \
        SMALL_TRIANGLES, TRIANGLES                                                                                     \
    }

const bench_case dither_cases[] = {
    {"dither", "off", off_case, bench_colour, sizeof bench_colour, 0, LARGE_TRIANGLES, 0},
    {"dither", "on", on_case, bench_colour, sizeof bench_colour, 0, LARGE_TRIANGLES, 0},
    {0},
};
