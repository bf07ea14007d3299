/* Sub-pixel precision: unsnapped corners are snapped to EL_SUBPIXEL_BITS bits, which the including file defines, and
 * walked exactly. */
#ifndef EL_BENCH_SUBPIXEL_H
#define EL_BENCH_SUBPIXEL_H

#include "exact_walk.h"
#include "platform.h"

void run_subpixel_4(const bench_case *self, int32_t *record);
void run_subpixel_6(const bench_case *self, int32_t *record);
void run_subpixel_8(const bench_case *self, int32_t *record);

static inline void snap_and_walk(void)
{
    const int shift = FINE_BITS - EL_SUBPIXEL_BITS;
    bench_start();
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        const bench_triangle *const triangle = &bench_triangles[i];
        int32_t x[3];
        int32_t y[3];
        for (unsigned k = 0; k < 3; k++) {
            x[k] = (triangle->fine_x[k] + (1 << (shift - 1))) >> shift;
            y[k] = (triangle->fine_y[k] + (1 << (shift - 1))) >> shift;
        }
        exact_walk(x, y, bench_colour[triangle->picture]);
    }
    bench_stop();
}

#endif
