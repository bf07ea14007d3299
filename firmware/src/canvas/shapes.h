/* Round shapes as contours of polygons: filled by el_polygon_fill, sharp or smooth, and outlined, as two contours, one
 * within the other, with EL_EVEN_ODD.
 *
 * Curves become chords whose ends lie on the curve, rounded to the screen's unit, and whose middles lie within 1/16 px of
 * it: a circle of radius r px takes the multiple of 4 next to 9 sqrt(r). Places and sizes are in 1/EL_SUBPIXELS px. */
#ifndef EL_CANVAS_SHAPES_H
#define EL_CANVAS_SHAPES_H

#include <stdint.h>

#include "base/angle.h"
#include "canvas/polygon.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Edges of a circle or an ellipse whose larger radius is `radius` px, at most: for EL_POLYGON_BYTES. The square root is
 * bounded by its tangents. */
#define EL_ROUND_EDGES(radius) ((radius) < 16 ? 40U : (radius) < 64 ? 76U : (radius) < 256 ? 148U : 408U)

/* Points around an ellipse with radii rx and ry: a multiple of 4, at least 8; at most 408. */
uint32_t el_round_points(int32_t rx, int32_t ry);

/* A contour of its own, clockwise on the screen. Radii below 0 count as 0. */
void el_polygon_ellipse(el_polygon *polygon, int32_t x, int32_t y, int32_t rx, int32_t ry);

/* A piece of pie, or of a ring if `inner` is above 0: from `from` on over `sweep`, clockwise on the screen; angle 0 points
 * to the right. A whole ring is two circles instead, with EL_EVEN_ODD. Of `inner` not below `outer` nothing is filled. */
void el_polygon_sector(el_polygon *polygon, int32_t x, int32_t y, int32_t outer, int32_t inner, el_angle from,
                       el_angle sweep);

/* A rectangle [x, x_end) x [y, y_end), none where an end is not beyond its beginning; its corners are rounded by at most
 * half of its shorter side. */
void el_polygon_rectangle(el_polygon *polygon, int32_t x, int32_t y, int32_t x_end, int32_t y_end, int32_t radius);

#ifdef __cplusplus
}
#endif

#endif
