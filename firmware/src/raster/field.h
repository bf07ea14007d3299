/* Interlaced frames: a field is every other line of the screen, the even or the odd ones. Its lines have numbers of their
 * own, which are what targets, triangles under way and the display list count then.
 *
 * A triangle is set up as ever, in a line of the field, and then walks two rows at a time: what its edges and planes have in a
 * line is what they have there in a whole frame, to the last bit. */
#ifndef EL_RASTER_FIELD_H
#define EL_RASTER_FIELD_H

#include <stdbool.h>
#include <stdint.h>

#include "base/options.h"
#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The first of the field's lines that is not above screen row `row`. */
static inline int32_t el_field_row(unsigned field, int32_t row)
{
    return !EL_WITH_INTERLACED || field == EL_FIELD_NONE ? row : (row + 2 - (int32_t)field) >> 1;
}

/* The screen's row of a line. */
static inline int32_t el_screen_row(unsigned field, int32_t line)
{
    return !EL_WITH_INTERLACED || field == EL_FIELD_NONE ? line : 2 * line + (int32_t)field - 1;
}

/* Rows of the screen from a line to the next. */
static inline uint32_t el_field_step(unsigned field)
{
    return !EL_WITH_INTERLACED || field == EL_FIELD_NONE ? 1U : 2U;
}

#if EL_WITH_INTERLACED
/* As el_triangle_setup, for a field: `first_line` is one of its lines. */
bool el_field_setup(el_triangle *triangle, const el_corner corners[3], const el_surface *surface, int32_t first_line,
                    unsigned field);
#endif

#ifdef __cplusplus
}
#endif

#endif
