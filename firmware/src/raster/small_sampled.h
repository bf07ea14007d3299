/* Small triangles in one colour or in their vertices' colours, with depth, where pixels have several samples: what nearly all
 * of a mesh's are. To the same pixels as sampled.c's. */
#ifndef EL_RASTER_SMALL_SAMPLED_H
#define EL_RASTER_SMALL_SAMPLED_H

#include "raster/samples.h"
#include "raster/small_plane.h"

#define EL_WITH_SMALL_SAMPLED (EL_WITH_SAMPLES && EL_WITH_SMALL_PLANES)

#if EL_WITH_SMALL_SAMPLED

/* el_sampled_draw for a triangle whose corners are sorted by their rows, of such a shape and area, not 0, whose samples are on
 * the screen's columns; rows [y, y_end) of the target. */
void el_small_sampled_draw(const el_corner *const corners[3], const el_small_shape *shape, int32_t area,
                           const el_surface *surface, const el_sampled_target *target, int32_t y, int32_t y_end,
                           el_stats *stats);

#endif

#endif
