/* Filling the rows of a polygon whose edges are sorted. Internal to canvas/. */
#ifndef EL_CANVAS_POLYGON_ROWS_H
#define EL_CANVAS_POLYGON_ROWS_H

#include "canvas/polygon.h"

/* Pre: `polygon` has edges, sorted by their upper ends; the canvas' clip has no column that the polygon does not touch.
 * EL_ERROR_MEMORY as el_polygon_fill has it. */
el_status el_polygon_fill_rows(el_polygon *polygon, const el_canvas *canvas, el_rule rule, el_smooth smooth,
                               const el_paint *paint);

#endif
