/* The screen's units and limits, from which the widths of all products below follow. */
#ifndef EL_GEOMETRY_LIMITS_H
#define EL_GEOMETRY_LIMITS_H

/* Fraction bits of a screen coordinate: vertices are snapped to 1/16 px. */
#define EL_SUBPIXEL_BITS 4
#define EL_SUBPIXELS (1 << EL_SUBPIXEL_BITS)

enum {
    EL_MAX_WIDTH = 2040,  /* pixels */
    EL_MAX_HEIGHT = 2040, /* lines */
    EL_GUARD_PX = 2040,   /* projected vertices lie within +-2040 px of the screen's origin */
    EL_GUARD_SUB = EL_GUARD_PX * EL_SUBPIXELS
};

_Static_assert(EL_GUARD_SUB < 32767, "screen coordinates are int16_t, and rounding may add a unit");

/* The largest depth of a vertex. 65535 is left for "nothing drawn", so that what lies on the far plane is drawn. */
#define EL_DEPTH_MAX 65534

#endif
