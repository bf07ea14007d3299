/* A triangle's rows between its edges as raster/edge.h steps them: the renderer's own way, without attributes. Included
 * once per number of sub-pixel bits. */
#ifndef EL_BENCH_EXACT_WALK_H
#define EL_BENCH_EXACT_WALK_H

#include "alternatives.h"
#include "raster/edge.h"

/* Corners in 1/EL_SUBPIXELS px, on the picture; they get sorted. */
BENCH_INLINE void exact_walk(int32_t x[3], int32_t y[3], uint16_t *picture)
{
    bench_sort(x, y);
    const int64_t area = (int64_t)(x[1] - x[0]) * (y[2] - y[0]) - (int64_t)(x[2] - x[0]) * (y[1] - y[0]);
    int32_t row = el_first_centre(y[0]);
    const int32_t end = el_first_centre(y[2]);
    if (area == 0 || row >= end) {
        return;
    }
    el_edge edges[2]; /* left and right */
    el_edge *const bent = &edges[area < 0 ? 0 : 1];
    el_edge_make(&edges[area < 0 ? 1 : 0], x[0], y[0], x[2], y[2], row);
    for (unsigned part = 0; part < 2; part++) {
        const int32_t part_end = el_first_centre(y[part + 1]);
        if (row >= part_end) {
            continue;
        }
        el_edge_make(bent, x[part], y[part], x[part + 1], y[part + 1], row);
        for (; row < part_end; row++) {
            uint16_t *const pixels = picture + row * WIDTH;
            for (int32_t column = el_edge_x(&edges[0]); column < el_edge_x(&edges[1]); column++) {
                pixels[column] = 1;
            }
            el_edge_next_row(&edges[0]);
            el_edge_next_row(&edges[1]);
        }
    }
}

#endif
