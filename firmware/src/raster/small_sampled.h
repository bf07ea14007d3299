/* Small triangles in one colour or in their vertices' colours, with depth, where pixels have several samples: what nearly all
 * of a mesh's are. To the same pixels as sampled.c's. */
#ifndef EL_RASTER_SMALL_SAMPLED_H
#define EL_RASTER_SMALL_SAMPLED_H

#include "raster/fill.h"
#include "raster/sampled_pixel.h"
#include "raster/samples.h"
#include "raster/small_plane.h"

#if EL_WITH_SMALL_SAMPLED

/* An edge in the next row, for all samples, Q20 modulo 2^32: of sample k it is x + at[k], whose whole part is the first pixel
 * of which that sample is not left of the edge. */
typedef struct el_sampled_side {
    uint32_t x, step;
    int32_t least, most; /* of at[] */
    int32_t at[EL_MAX_SAMPLES];
} el_sampled_side;

/* A triangle under way, in its next row. What pixels need comes first: Thumb code reaches it at once there. */
typedef struct el_small_sampled {
    el_slopes slopes;
    el_sampled_place at;
    uint16_t flat;
    uint8_t kind;
    bool short_is_left;
    /* From the centre to each sample. */
    uint64_t z_at[EL_MAX_SAMPLES];
    uint32_t rgb_at[EL_MAX_SAMPLES][3];
    el_sampled_side straight, upper, lower;
    const el_sample_point *points;
    int32_t y0, y1, y2; /* corners, 1/EL_SUBPIXELS px */
    int16_t y, y_end;   /* the next row, and that below the last */
    /* Rows in which all samples are between the same two edges. */
    int16_t upper_begin, upper_end;
    int16_t lower_begin, lower_end;
} el_small_sampled;

/* Sets up a triangle whose corners are sorted by their rows, of such a shape and area, not 0, whose samples are on the screen's
 * columns, from row y on, one of those that may have some. */
void el_small_sampled_setup(el_small_sampled *s, const el_corner *const corners[3], const el_small_shape *shape,
                            int32_t area, const el_surface *surface, uint32_t count, int32_t y);

/* Draws down to the target's last row, or the triangle's. Returns whether it goes on below.
 * Pre: its next row is not above the target's first. */
bool el_small_sampled_go_on(el_small_sampled *s, const el_sampled_target *target, el_stats *stats);

#endif

#endif
