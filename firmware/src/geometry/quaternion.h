/* Rotations as four numbers: smaller than a matrix, and what can be mixed.
 *
 * A quaternion of length 1 is a rotation; its negative is the same one. All that these functions make have length 1
 * within 2^-29, after any number of products: rounding does not add up. Others, of any numbers, do no harm, but mean
 * nothing. Formulas: Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985. */
#ifndef EL_GEOMETRY_QUATERNION_H
#define EL_GEOMETRY_QUATERNION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/angle.h"
#include "geometry/pose.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct el_quaternion {
    int32_t q30[4]; /* w, x, y, z: the half angle's cosine, and its sine along the axis */
} el_quaternion;

/* No rotation. */
el_quaternion el_quaternion_identity(void);

/* By `angle` about `axis`, of any length and unit, counter-clockwise seen from its tip; the identity for no axis. Within
 * 2^-28 radians. */
el_quaternion el_quaternion_about(const int32_t axis[3], el_angle angle);

/* Of any length in any unit, the rotation that it stands for; the identity for four zeros. */
el_quaternion el_quaternion_normalise(const el_quaternion *q);

/* First `b`, then `a`. Each product turns by 2^-29 radians more or less than it should at most. */
el_quaternion el_quaternion_multiply(const el_quaternion *a, const el_quaternion *b);

/* The rotation back. */
el_quaternion el_quaternion_conjugate(const el_quaternion *q);

/* `v` turned, in its own unit, to nearest but for 2^-27 of its length; saturated where it does not fit. */
void el_quaternion_rotate(const el_quaternion *q, const int32_t v[3], int32_t rotated[3]);

/* As a pose has it, each element within 2^-28. */
void el_quaternion_to_rotation(const el_quaternion *q, int32_t rotation_q30[3][3]);

/* Of a rotation. A reflection has none: what it gets has length 1 and no meaning. */
el_quaternion el_quaternion_from_rotation(const int32_t rotation_q30[3][3]);

/* The rotation that lies `part_q30` of the shorter way from `from` to `to`, at constant speed: exactly `from` at 0 and
 * exactly `to` from EL_UNIT_Q30 on; between them within 10^-6 degrees. From a rotation to the one opposite, either way. */
el_quaternion el_quaternion_slerp(const el_quaternion *from, const el_quaternion *to, uint32_t part_q30);

/* Whether they lie on opposite sides, so that -b is nearer to a than b is. */
bool el_quaternion_is_far(const el_quaternion *a, const el_quaternion *b);

#ifdef __cplusplus
}
#endif

#endif
