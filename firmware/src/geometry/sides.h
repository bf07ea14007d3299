/* The sides of the view as linear forms on mesh positions, in 32 bits: they say of some positions that they are beyond a
 * side, for a third of what clip coordinates take. Of those near to it they say nothing. */
#ifndef EL_GEOMETRY_SIDES_H
#define EL_GEOMETRY_SIDES_H

#include <stdbool.h>
#include <stdint.h>

#include "geometry/transform.h"

enum { EL_SIDES = 6 };

/* Where offset + the sum of element times position is negative, el_outcode has the side's bit.
 * |offset| < 2^28 + 2^18, |elements| <= 2^13: the sum is below 2^30. */
typedef struct el_side {
    int32_t offset;
    int32_t elements[3];
} el_side;

/* In the order of el_outcode's bits, for positions in the mesh's sphere. */
void el_sides_make(el_side sides[EL_SIDES], const el_transform *transform, const el_mesh *mesh);

static inline bool el_side_is_passed(const el_side *side, const int16_t position[3])
{
    return side->offset + side->elements[0] * position[0] + side->elements[1] * position[1] +
               side->elements[2] * position[2] <
           0;
}

/* Whether three positions are beyond one side, the one that the first is found to be beyond first. */
static inline bool el_sides_are_passed(const el_side sides[EL_SIDES], const int16_t (*corners)[3])
{
    const el_side *side = sides;
    do {
        if (el_side_is_passed(side, corners[0])) {
            return el_side_is_passed(side, corners[1]) && el_side_is_passed(side, corners[2]);
        }
    } while (++side != sides + EL_SIDES);
    return false;
}

#endif
