/* Small triangles from their record to their pixels in one go: what most of a mesh's triangles are, so nothing of them is in
 * memory on the way. Larger ones, and those that take more than that, are set up and drawn as triangle.h says, to the
 * same pixels. */
#ifndef EL_RASTER_SMALL_TRIANGLE_H
#define EL_RASTER_SMALL_TRIANGLE_H

#include "raster/plain.h"

#ifdef __cplusplus
extern "C" {
#endif

#if EL_WITH_SMALL_PLANES

/* Draws a flat triangle with depth into the target and makes `rest`, unless it is NULL, what there is left to draw below, if
 * there is something. Returns false, and has done nothing, where the triangle is not small, reaches beside the screen, or has
 * no pixel's centre in its rows. */
bool el_small_triangle_draw(const el_record *record, const el_run_look *look, const el_target *target, el_stats *stats,
                            el_triangle *rest);

/* el_triangle_draw for such a triangle: flat, with depth, its edges short, its columns on the screen. */
void el_small_triangle_go_on(el_triangle *triangle, const el_target *target, el_stats *stats);

#endif

#ifdef __cplusplus
}
#endif

#endif
