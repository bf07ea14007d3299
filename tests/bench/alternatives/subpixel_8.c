/* Corners snapped to 1/256 px. */
#undef EL_SUBPIXEL_BITS
#define EL_SUBPIXEL_BITS 8
#include "subpixel.h"

void run_subpixel_8(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    snap_and_walk();
}
