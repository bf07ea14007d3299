/* Texels of any texture: its format, size, what lies beyond its borders, the nearest or four of them. One way for all, which
 * asks at each texel; the loops of fill_texture.c and texel_line.c do without it. Private to the renderer. */
#ifndef EL_RASTER_SAMPLER_H
#define EL_RASTER_SAMPLER_H

#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* u or v. What repeats is found by a remainder, without a division: n % period for n < 2^13, with n / period exactly
 * n * reciprocal >> shift, where reciprocal = 2^shift / period, rounded up, and 2^shift >= 2^13 * period. */
typedef struct el_sampler_axis {
    uint32_t size;
    uint32_t period; /* 2 * size where every other one is turned around; 0: clamped */
    uint32_t bias;   /* whole periods, more than any coordinate is below 0 */
    uint32_t reciprocal;
    unsigned shift;
} el_sampler_axis;

typedef struct el_sampler {
    el_image image;
    el_sampler_axis u, v;
    bool smooth;
    bool is_open; /* not all of it shows */
} el_sampler;

void el_sampler_make(el_sampler *sampler, const el_texture *texture);

/* Which of the period's texels, below axis->period, is whole texel `at`. Pre: it has one. */
uint32_t el_sampler_in_period(const el_sampler_axis *axis, int32_t at);

/* The texture's column or row for whole texel `at`, of which -2056 to 2056 are those that there are; any other leads to some
 * texel. */
uint32_t el_sampler_place(const el_sampler_axis *axis, int32_t at);

/* What is there, and how much of it shows, 0..256; of 0 there is no colour. */
uint32_t el_sampler_at(const el_sampler *sampler, uint32_t u_q16, uint32_t v_q16, uint16_t *colour);

#ifdef __cplusplus
}
#endif

#endif
