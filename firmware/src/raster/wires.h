/* Wires: the edges of triangles as lines of one pixel, hidden where something is before them.
 *
 * Of an edge's longer direction each column, or each row where it is steep, has one pixel: the one that the edge is in at
 * that column's, or row's, centre. Where that leaves an end's own pixel out it is drawn, too. A point between two pixels is
 * in the left and in the upper one. So an edge has the same pixels from whichever triangle and in whichever bands it is
 * drawn, and edges that meet leave no gap.
 *
 * A wire's depth is that of its edge, linear on the screen and rounded to nearest. The surface that it runs along has the
 * depth of its pixels' centres: half a pixel away in either direction at most, which is half the sum of what its depth
 * changes by per pixel to the right and down, and never more than its corners differ by. Both are rounded. So a wire is
 * tested as if it were nearer by
 *
 *     the smaller of (|dz/dx| + |dz/dy|) / 2, rounded up, + 2, and the greatest difference of its corners' depths, + 1,
 *
 * of its triangle: then each of its pixels whose centre lies in the triangle passes the test against that triangle. It also
 * passes against what is before the triangle by less. It leaves the nearer depth of the two, without that allowance. */
#ifndef EL_RASTER_WIRES_H
#define EL_RASTER_WIRES_H

#include "raster/list.h"
#include "raster/triangle.h"

#if EL_WITH_WIRES

/* How far a wire's pixel reaches beyond its triangle, from the pixel's centre: 1/EL_SUBPIXELS px. */
enum { EL_WIRE_REACH = EL_SUBPIXELS / 2 };

/* A clipped corner's weights, one for each corner of the triangle: 0 on the edge that is opposite of it. */
enum { EL_WIRE_WEIGHTS = 3, EL_WIRE_WEIGHT = 1 << 29 };

/* Which edges of a cut triangle's piece lie on edges of the triangle: bit i, from corner i to the next, of the weights of
 * its corners. `edges` has the same of the triangle. */
unsigned el_wires_of_piece(unsigned edges, const int32_t *const weights[3]);

/* Which edges of its triangle a record draws, and in which colour. */
unsigned el_wires_of(const el_list *list, const el_record *record);
uint16_t el_wires_colour(const el_list *list, const el_record *record);

/* Draws what of those edges lies in the target, in the surface's colour. Counts pixels before the depth test. */
void el_wires_draw(const el_corner corners[3], unsigned edges, const el_surface *surface, const el_target *target,
                   el_stats *stats);

#endif

#endif
