/* Rows of small triangles in their vertices' colours, with depth: what most of a smooth mesh's triangles are. To the same pixels
 * as fill.c's. */
#ifndef EL_RASTER_SMALL_GOURAUD_H
#define EL_RASTER_SMALL_GOURAUD_H

#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

#define EL_WITH_SMALL_GOURAUD (EL_WITH_SMALL_PLANES && EL_WITH_GOURAUD)

#if EL_WITH_SMALL_GOURAUD

/* el_triangle_draw for a triangle of kind EL_FILL_COLOURS | EL_FILL_DEPTH, its edges short, its columns on the screen. */
void el_small_gouraud_draw(el_triangle *triangle, const el_target *target, el_stats *stats);

#endif

#ifdef __cplusplus
}
#endif

#endif
