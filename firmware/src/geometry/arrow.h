/* Directions of length 1, for what needs many of them: a vector in 32 bits with an exponent, its square and the reciprocal
 * of its length, so that what asks only for an angle's cosine, or its sign, makes no direction. Internal to the geometry
 * layer; what is made once per draw call has el_vector_normalise, to all bits. */
#ifndef EL_GEOMETRY_ARROW_H
#define EL_GEOMETRY_ARROW_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct el_arrow {
    int32_t v[3];    /* the vector times 2^shift: 2^30 <= the greatest of |v| < 2^31 */
    int shift;       /* -32 to 30 */
    uint32_t square; /* v.v / 2^32, too low by less than 3: 2^28 to 3 * 2^30 */
    uint32_t
        to_unit; /* 2^62 / |v|, off by less than 2^-26 of it: times a part of v and 2^-32 that of length 1 in Q30 */
} el_arrow;

/* v and shift of any vector without INT32_MIN. False: it has no length, and nothing was made. */
bool el_arrow_make(el_arrow *arrow, const int32_t vector[3]);

/* The same of to - from, |from| < 2^60: exact where that fits 31 bits. */
bool el_arrow_between(el_arrow *arrow, const int64_t from[3], const int32_t to[3]);

/* square and to_unit, from v. */
void el_arrow_measure(el_arrow *arrow);

/* The direction of an arrow that was measured: length 1 within 2^-26. */
void el_arrow_direction(const el_arrow *arrow, int32_t unit_q30[3]);

#ifdef __cplusplus
}
#endif

#endif
