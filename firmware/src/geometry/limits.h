/* The screen's units and limits, from which the widths of all products below follow. */
#ifndef EL_GEOMETRY_LIMITS_H
#define EL_GEOMETRY_LIMITS_H

#include <stdint.h>

/* Fraction bits of a screen coordinate: 4, 6 or 8. Vertices are snapped to 1/16, 1/64 or 1/256 px. Coverage is exact with
 * each; more bits move less when the camera does, and cost memory (32-bit coordinates) and 64-bit arithmetic at set-up.
 * A program and its library are compiled with the same number. */
#ifndef EL_SUBPIXEL_BITS
#define EL_SUBPIXEL_BITS 4
#endif
#define EL_SUBPIXELS (1 << EL_SUBPIXEL_BITS)

#if EL_SUBPIXEL_BITS != 4 && EL_SUBPIXEL_BITS != 6 && EL_SUBPIXEL_BITS != 8
#error "EL_SUBPIXEL_BITS is 4, 6 or 8"
#endif

#if EL_SUBPIXEL_BITS == 4
typedef int16_t el_coordinate; /* on the screen, 1/EL_SUBPIXELS px */
#else
typedef int32_t el_coordinate;
#endif

enum {
    EL_MAX_WIDTH = 2040,  /* pixels */
    EL_MAX_HEIGHT = 2040, /* lines */
    EL_GUARD_PX = 2040,   /* projected vertices lie within +-2040 px of the screen's origin */
    EL_GUARD_SUB = EL_GUARD_PX * EL_SUBPIXELS
};

/* The largest depth of a vertex. 65535 is left for "nothing drawn", so that what lies on the far plane is drawn. */
#define EL_DEPTH_MAX 65534

#endif
