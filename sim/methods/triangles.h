/* The methods that find a triangle's pixels, and the table of them.
 *
 * Each draws one triangle, of either winding, and adds 1 to every pixel of the picture that it finds covered; zero area
 * covers nothing. Each returns the work: how many pixels it asked about, for methods that walk rows how many it wrote.
 *
 * Points tested one by one (triangle_points.c): */
#ifndef EL_METHODS_TRIANGLES_H
#define EL_METHODS_TRIANGLES_H

#include "methods/shapes.h"

/* On the right of all three edges, asked of every pixel of the picture, then of the bounding box only. */
uint32_t el_triangle_cross_everywhere(const el_spot corners[3], el_hits *hits);
uint32_t el_triangle_cross_in_box(const el_spot corners[3], el_hits *hits);

/* The three triangles that the point makes with the edges are together as large as the triangle. */
uint32_t el_triangle_area_sum(const el_spot corners[3], el_hits *hits);

/* The three angles under which the point sees the edges add up to a turn. The cosines come from dot products and the
 * angles from acos, in double; "a turn" means within 1e-6. */
uint32_t el_triangle_angle_sum(const el_spot corners[3], el_hits *hits);

/* For each edge the point lies on the same side as the third corner. */
uint32_t el_triangle_same_side(const el_spot corners[3], el_hits *hits);

/* Weights that are areas over the area, in float: none is negative. Dividing an exact integer cannot change its sign. */
uint32_t el_triangle_barycentric_areas(const el_spot corners[3], el_hits *hits);

/* Weights v, w that solve p - a = v (b - a) + w (c - a) by Cramer's rule on dot products, in float: v >= 0, w >= 0,
 * v + w <= 1. The dot products and their differences are rounded, so weights near 0 get the wrong sign. */
uint32_t el_triangle_barycentric_solve(const el_spot corners[3], el_hits *hits);

/* Edge equations: three linear expressions A x + B y + C, evaluated at each pixel of the box; the rule for edges is part
 * of C. */
uint32_t el_triangle_edges_all(const el_spot corners[3], el_hits *hits);
uint32_t el_triangle_edges_none(const el_spot corners[3], el_hits *hits);
uint32_t el_triangle_edges_left_top(const el_spot corners[3], el_hits *hits);

/* Rows (triangle_rows.c); all of them are half-open, which is the rule of left and top edges: */

/* The same three expressions, one addition each per pixel and per row. */
uint32_t el_triangle_edges_stepped(const el_spot corners[3], el_hits *hits);

/* Split at the middle corner into one with a level lower and one with a level upper edge; both sides are stepped by
 * their slopes, in float. */
uint32_t el_triangle_split(const el_spot corners[3], el_hits *hits);

/* For each row where the edges cross it: the leftmost and the rightmost, as exact quotients. */
uint32_t el_triangle_row_crossing(const el_spot corners[3], el_hits *hits);

/* The yardstick: el_triangle_setup and el_triangle_draw, counting pixels instead of colouring them. */
uint32_t el_triangle_edgeline(const el_spot corners[3], el_hits *hits);

typedef struct el_triangle_method {
    const char *id;      /* for files: letters and dashes */
    const char *title;   /* at most 23 letters, the width of a cell in the picture */
    const char *numbers; /* what it calculates with */
    el_edge_rule rule;
    bool exact; /* no pixel differs from its rule, for any corners */
    uint32_t (*draw)(const el_spot corners[3], el_hits *hits);
} el_triangle_method;

enum { EL_TRIANGLE_METHODS = 14 };

extern const el_triangle_method el_triangle_methods[EL_TRIANGLE_METHODS];

#endif
