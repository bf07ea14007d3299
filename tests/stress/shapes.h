/* Triangles of the kinds that rasterizers get wrong, in sub-pixels, within the guard band; windings are mixed. */
#ifndef EL_STRESS_SHAPES_H
#define EL_STRESS_SHAPES_H

#include "exact.h"
#include "random.h"

typedef enum shape_kind {
    SHAPE_ON_SCREEN,    /* corners on the screen or a little beside it */
    SHAPE_SMALL,        /* up to 12 px: the many of a mesh */
    SHAPE_TINY,         /* below two pixels */
    SHAPE_SLIVER,       /* a doubled area of a few units about a pixel's centre, and longer ones */
    SHAPE_GUARD,        /* corners in the guard band's corners: edge values beyond 2^31 */
    SHAPE_NEAR_MISS,    /* an edge passes a pixel's centre with an edge value of -1, 0 or 1 */
    SHAPE_CENTRED,      /* corners on pixel centres */
    SHAPE_AXIS_ALIGNED, /* a horizontal and a vertical edge, on rows and columns of centres every other time */
    SHAPE_LONG_PRESTEP, /* begins far above and far left of the screen */
    SHAPE_TOUCHING,     /* beside the screen, touching its border within a pixel */
    SHAPE_ANY,          /* one of the above */
} shape_kind;

void shape_make(shape_kind kind, dice *random, int64_t width, int64_t height, point corners[3]);

#endif
