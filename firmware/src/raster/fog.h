/* Fog: what is far fades into a colour, pixel by pixel, by its distance along the camera's axis.
 *
 * That distance is what depth tells: scale - depth goes with 1 / distance, so one look-up leads from depth to how much of the
 * fog is before it, by a table over its logarithm whose steps are linear in between. The table is made for a law and for a
 * camera's near and far; it is the caller's, and may be used for any number of materials and frames. */
#ifndef EL_RASTER_FOG_H
#define EL_RASTER_FOG_H

#include <stdbool.h>
#include <stdint.h>

#include "base/fixed.h"
#include "base/options.h"
#include "base/status.h"
#include "geometry/limits.h"
#include "geometry/pose.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_FOG_STEPS = 256 };

typedef struct el_fog {
    uint16_t colour;                     /* RGB565; may be changed between frames */
    uint8_t step_log2;                   /* of the table, in units of 2^-16 of an octave (el_fog_place) */
    uint32_t scale_q12;                  /* depth = scale * (1 - near / distance) */
    uint32_t end;                        /* place of the table's first entry, the farthest */
    uint16_t alpha_q7[EL_FOG_STEPS + 2]; /* 0..256 in 9.7 */
} el_fog;

/* None before begin_q16, all from end_q16 on, linear in between. With el_fog_exponential within 1.5/255 of the law at the
 * distance of a depth. Distances in world units, Q16. EL_ERROR_CAMERA: not a perspective camera with near and far as pose.h
 * has them. EL_ERROR_RANGE: begin_q16 is not before end_q16, or end_q16 not behind near. */
el_status el_fog_linear(el_fog *fog, const el_camera *camera, uint16_t colour, uint32_t begin_q16, uint32_t end_q16);

/* 1 - e^(-density distance), density per world unit. EL_ERROR_CAMERA; EL_ERROR_RANGE: density is 0. */
el_status el_fog_exponential(el_fog *fog, const el_camera *camera, uint16_t colour, uint32_t density_q16);

/* --- For the fills ------------------------------------------------------------------------------------------------------ */

/* log2 of `nearness`, above 0, its fraction taken to be linear between powers of two, Q16: a step of the table is a step of
 * nearness, from one power to the next. `leading` are its leading zeros. */
static inline uint32_t el_fog_place_of(uint32_t nearness, uint32_t leading)
{
    return ((31U - leading) << 16) + (nearness << leading >> 15);
}

static inline uint32_t el_fog_place(uint32_t nearness)
{
    return el_fog_place_of(nearness, el_leading_zeros(nearness));
}

/* Whether one of the functions above made it: nearness is above 0 at all depths. */
static inline bool el_fog_is_made(const el_fog *fog)
{
    return fog->scale_q12 > (uint32_t)EL_DEPTH_MAX << 12 && fog->step_log2 <= 16;
}

/* How much of the fog lies before that place: 0..256. */
static inline uint32_t el_fog_at_place(const el_fog *fog, uint32_t place)
{
    if (place <= fog->end) {
        return (fog->alpha_q7[0] + 64U) >> 7;
    }
    const uint32_t along = place - fog->end;
    const uint32_t step_log2 = fog->step_log2;
    const uint32_t step = along >> step_log2;
    if (step > EL_FOG_STEPS) {
        return 0;
    }
    /* Alpha falls towards the camera: differences are 2^15 at most, along in a step below 2^16. */
    const uint32_t farther = fog->alpha_q7[step];
    const uint32_t fall = farther - fog->alpha_q7[step + 1U];
    const uint32_t in_step = along - (step << step_log2);
    return (farther - (fall * in_step >> step_log2) + 64U) >> 7;
}

/* The same at a depth, 0 to EL_DEPTH_MAX. */
static inline uint32_t el_fog_at(const el_fog *fog, uint32_t depth)
{
    return el_fog_at_place(fog, el_fog_place(fog->scale_q12 - (depth << 12)));
}

#ifdef __cplusplus
}
#endif

#endif
