/* A polygon's edges one by one, and filling its rows when they are sorted. Internal to canvas/. */
#ifndef EL_CANVAS_POLYGON_ROWS_H
#define EL_CANVAS_POLYGON_ROWS_H

#include "canvas/polygon.h"

/* Closes the open contour; adds an edge, one of a contour whose other edges come so, too, in any order. */
void el_polygon_close(el_polygon *polygon);
void el_polygon_add_edge(el_polygon *polygon, const int32_t from[2], const int32_t to[2]);

/* Pre: `polygon` has edges, sorted by their upper ends; the canvas' clip has no column that the polygon does not touch.
 * EL_ERROR_MEMORY as el_polygon_fill has it. */
el_status el_polygon_fill_rows(el_polygon *polygon, const el_canvas *canvas, el_rule rule, el_smooth smooth,
                               const el_paint *paint);

#endif
