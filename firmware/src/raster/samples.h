/* Several samples per pixel: anti-aliasing by multi-sampling.
 *
 * A triangle covers those of a pixel's samples that lie inside it, by the rule of all pixels (edge.h): exactly. Within a
 * pixel it has one depth and one colour: those at the pixel's centre where it covers all samples, else those at the first
 * sample that it covers. Either is inside the triangle - the centre lies in the middle between two samples - so neither
 * leaves the range of the corners' values. The depth test is made for each sample, with what is there.
 *
 * Nearly all pixels have the same in all samples. These lie in the colour and depth bands as ever, and are drawn as ever;
 * a pixel in which samples differ is mixed: its samples are apart, and its place in the depth band has depth 0, which
 * nothing is nearer than: a loop over a row leaves mixed pixels as they are, without knowing of them. A complete band is
 * resolved: a mixed pixel becomes the mean of its samples. */
#ifndef EL_RASTER_SAMPLES_H
#define EL_RASTER_SAMPLES_H

#include "raster/sample_memory.h"
#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where a sample is, from the pixel's centre, in 1/EL_SUBPIXELS px. */
typedef struct el_sample_point {
    int16_t x, y;
} el_sample_point;

/* The standard patterns: one sample in each of so many rows, and in each of so many columns; in sixteenths of a pixel. Four are
 * two and their opposites, from the top down. */
#define EL_FOUR_SAMPLES(AT) AT(-2, -6), AT(6, -2), AT(-6, 2), AT(2, 6)
#define EL_EIGHT_SAMPLES(AT) AT(1, -3), AT(-1, 3), AT(5, 1), AT(-3, -5), AT(-5, 5), AT(-7, -1), AT(3, 7), AT(7, -7)
#define EL_SAMPLE_AT(x, y)                                                                                             \
    {                                                                                                                  \
        (x) * (EL_SUBPIXELS / 16), (y) * (EL_SUBPIXELS / 16)                                                           \
    }

/* For where `count` is known when this is compiled: few products are left of the points then. */
static inline const el_sample_point *el_known_sample_points(unsigned count)
{
    static const el_sample_point four[] = {EL_FOUR_SAMPLES(EL_SAMPLE_AT)};
    static const el_sample_point eight[] = {EL_EIGHT_SAMPLES(EL_SAMPLE_AT)};
    return count == 4 ? four : eight;
}

/* How far samples are from the centre on either axis, in 1/EL_SUBPIXELS px, at most; 0 for one sample. */
static inline uint8_t el_samples_reach(unsigned count)
{
    return (uint8_t)(count <= 1 ? 0 : (count == 4 ? 6 : 7) * (EL_SUBPIXELS / 16));
}

/* A band whose pixels have several samples. */
typedef struct el_sampled_target {
    el_target target;
    uint32_t *mixed; /* EL_MIXED_WORDS(width) per row at most */
    /* Of each pixel `count`, used where it is mixed (sampled_pixel.h): depth in the upper half, colour in the lower. */
    uint32_t *samples;
    unsigned count; /* 4 or 8 */
} el_sampled_target;

#if EL_WITH_SAMPLES

/* The pattern of 4 or 8 samples. */
const el_sample_point *el_sample_points(unsigned count);

/* 1 where most triangles can be carried on from one target to the next. */
#define EL_WITH_SMALL_SAMPLED (EL_WITH_SAMPLES && EL_WITH_SMALL_PLANES)

typedef struct el_small_sampled el_small_sampled; /* small_sampled.h */

typedef enum el_sampled_rest {
    EL_SAMPLED_DONE,
    EL_SAMPLED_GOES_ON, /* it has rows below the target, for which it is to be set up again */
    EL_SAMPLED_CARRIED  /* the same, but what is needed for them is in `place` */
} el_sampled_rest;

/* Draws the rows of a triangle that lie in the target. `place`: memory for one under way; NULL where none is carried on. */
el_sampled_rest el_sampled_draw(const el_corner corners[3], const el_surface *surface, const el_sampled_target *target,
                                el_stats *stats, el_small_sampled *place);

/* Makes one colour of each mixed pixel's, the mean of each of RGB565's channels, rounded to nearest and half a unit up, and
 * one depth, the nearest. No pixel is mixed then. */
void el_samples_resolve(const el_sampled_target *target);

#endif

#ifdef __cplusplus
}
#endif

#endif
