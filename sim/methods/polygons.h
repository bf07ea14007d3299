/* The methods that find a polygon's pixels, and the table of them.
 *
 * A polygon is a set of closed outlines, given as their directed edges: holes and crossings need nothing else. Each
 * method draws into a picture whose counts are 0 and leaves 1 at the pixels that it finds covered (several use the
 * picture itself as their memory, as the textbooks do with the frame store). Each returns the work: pixels asked about,
 * or pixels touched. What lies on the outline is decided as for triangles: left and top edges count.
 *
 * Points tested one by one (polygon_points.c): */
#ifndef EL_METHODS_POLYGONS_H
#define EL_METHODS_POLYGONS_H

#include "methods/shapes.h"

enum { EL_POLYGON_EDGES = 64 };

typedef struct el_polygon {
    size_t edge_count;
    struct el_polygon_edge {
        el_spot a, b;
    } edges[EL_POLYGON_EDGES];
} el_polygon;

/* Adds the closed outline through `count` spots. Pre: there is room for `count` more edges. */
void el_polygon_add(el_polygon *polygon, const el_spot *spots, size_t count);

el_box el_box_of_polygon(const el_polygon *polygon, const el_hits *hits);

/* Crossings of the ray to the left, where every edge that reaches the ray counts, its ends included: a corner on the ray
 * counts twice. Even-odd. */
uint32_t el_polygon_ray_naive(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

/* The same with the cases of a corner on the ray: it counts for each edge that goes down from it, so once where the
 * outline passes, twice or not at all where it turns back; level edges do not count. Even-odd. */
uint32_t el_polygon_ray_cases(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

/* The angles under which the point sees the edges, with their signs, add up to turns, by atan2 in double. For a point on
 * an edge that edge is half a turn to the right, whichever way it runs: outlines that run clockwise count, others do
 * not. A point on a corner sees less than a turn. Both rules. */
uint32_t el_polygon_winding_angle(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

/* Turns without angles: +1 for an edge that crosses the ray downwards, -1 for one upwards. Both rules. */
uint32_t el_polygon_winding_number(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

/* Rows (polygon_rows.c): */

/* Each row is crossed with all edges; the sorted crossings bound the spans. Both rules. */
uint32_t el_polygon_scanline(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

/* The same with the edges sorted by their first row, those that the row crosses kept in a list, and their crossings
 * stepped with an exact remainder. Both rules. */
uint32_t el_polygon_active_edges(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

/* Marks in the picture (polygon_marks.c), all of them even-odd: */

/* For each edge, on each of its rows, every pixel on its right is complemented. */
uint32_t el_polygon_complement(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

/* The same between the edge and a fence, a vertical line through a corner in the middle. */
uint32_t el_polygon_fence(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

/* The first pixel on the right of each crossing is complemented, then each row is filled from flag to flag. */
uint32_t el_polygon_edge_flag(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);

typedef struct el_polygon_method {
    const char *id;
    const char *title; /* at most 23 letters */
    const char *numbers;
    el_fill_rule rule;
    bool exact; /* no pixel differs from its rule, for any outline */
    uint32_t (*draw)(const el_polygon *polygon, el_fill_rule rule, el_hits *hits);
} el_polygon_method;

enum { EL_POLYGON_METHODS = 13 };

extern const el_polygon_method el_polygon_methods[EL_POLYGON_METHODS];

#endif
