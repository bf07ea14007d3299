/* What the methods are measured against: exact integers, pixel by pixel, straight from the rules' definitions. */
#ifndef EL_METHODS_REFERENCE_H
#define EL_METHODS_REFERENCE_H

#include "methods/polygons.h"
#include "methods/shapes.h"

/* Whether the triangle, of either winding, covers the pixel by that rule. Zero area covers nothing. */
bool el_reference_in_triangle(const el_spot corners[3], el_spot centre, el_edge_rule rule);

/* How often the outline winds clockwise around the point. A point on the outline is taken for its neighbour an
 * infinitesimal step to the right and a far smaller one down, which is what the rule of left and top edges sees. */
int32_t el_reference_turns(const el_polygon *polygon, el_spot centre);

/* Writes 1 for each covered pixel, else 0. */
void el_reference_triangle(const el_spot corners[3], el_edge_rule rule, el_hits *hits);
void el_reference_polygon(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

/* A value that is linear on the screen and known at the corners: at `centre`, rounded to nearest, halves up.
 * Pre: the area is not 0, and the values are 0 to 65535. The products of a side (2^41) and a value stay below 2^59. */
int32_t el_reference_value(const el_spot corners[3], const int32_t values[3], el_spot centre);

#endif
