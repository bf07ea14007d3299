/* Corners snapped to 1/64 px. */
#undef EL_SUBPIXEL_BITS
#define EL_SUBPIXEL_BITS 6
#include "subpixel.h"

void run_subpixel_6(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    snap_and_walk();
}
