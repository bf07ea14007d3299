/* Polygons of any shape: concave, with holes, crossing themselves, of several contours.
 *
 *     static uint8_t memory[EL_POLYGON_BYTES(40, 320)];
 *     el_polygon p;
 *     el_polygon_begin(&p, memory, sizeof memory);
 *     el_polygon_move(&p, EL_SUB(10), EL_SUB(10));
 *     el_polygon_line(&p, EL_SUB(50), EL_SUB(20));
 *     el_polygon_line(&p, EL_SUB(20), EL_SUB(60));
 *     el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SMOOTH_4, el_solid(0xFFE0));
 *
 * Points are in 1/EL_SUBPIXELS px, as a triangle's corners are when they are snapped, and the fill rule is the same: a
 * pixel is drawn when its centre is inside; a centre on an edge is inside for a left or top edge alone. A polygon and a
 * triangle, or two polygons, that share an edge leave no pixel out and draw none twice.
 *
 * Once built, a polygon can be filled in as many bands as there are, by one core at a time: a fill writes into its memory. */
#ifndef EL_CANVAS_POLYGON_H
#define EL_CANVAS_POLYGON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "canvas/canvas.h"
#include "geometry/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whole pixels in 1/EL_SUBPIXELS px. */
#define EL_SUB(pixels) ((pixels)*EL_SUBPIXELS)

/* What is inside: where the contours wind around a point at all, or where a ray from it crosses an odd number of edges. */
typedef enum el_rule { EL_NON_ZERO, EL_EVEN_ODD } el_rule;

/* How edges look. EL_SHARP: a pixel is drawn or not, by its centre. The others take 4, 8 or 16 rows of each pixel, and of
 * each row what is inside, to 1/16 px: as much of the pixel is drawn, in 64, 128 or 256 levels. The samples are a regular
 * grid, so EL_SMOOTH_16 is the 256-sample reference itself. */
typedef enum el_smooth { EL_SHARP = 0, EL_SMOOTH_4 = 2, EL_SMOOTH_8 = 3, EL_SMOOTH_16 = 4 } el_smooth;

/* An edge from its upper end to its lower one, and where it crosses the row that is filled. */
typedef struct el_polygon_edge {
    el_coordinate x0, y0, x1, y1;
    int32_t column;     /* the first sample that is not left of it */
    uint32_t rest;      /* what was rounded away, in 1/divisor columns */
    int32_t step;       /* per row, whole columns ... */
    uint32_t step_rest; /* ... and the rest */
    uint16_t active;    /* the list of active edges: entry i has the number of the i-th from the left */
    int8_t winding;     /* 1 downwards, -1 upwards */
} el_polygon_edge;

/* Memory for polygons of so many edges, smooth ones that touch up to so many columns of pixels. Sharp ones need no width: 0. */
#define EL_POLYGON_BYTES(edges, width) ((edges) * sizeof(el_polygon_edge) + 2U * ((width) + 2U) + 7U)

/* Owned by the caller; its members are canvas/'s. */
typedef struct el_polygon {
    el_polygon_edge *edges;
    uint32_t bytes;
    uint16_t count, capacity;
    bool is_open, is_sorted;
    el_status status;
    int32_t first[2], last[2]; /* of the open contour */
    int32_t least[2], most[2]; /* of all points */
} el_polygon;

/* An empty polygon in `memory`, the caller's until it is no longer filled; any alignment. */
void el_polygon_begin(el_polygon *polygon, void *memory, size_t bytes);

/* Closes the open contour, and begins the next one; adds a point to it. Points lie within +-EL_GUARD_PX px of the screen's
 * origin: what is beyond makes el_polygon_fill return EL_ERROR_RANGE. */
void el_polygon_move(el_polygon *polygon, int32_t x, int32_t y);
void el_polygon_line(el_polygon *polygon, int32_t x, int32_t y);

/* Closes the last contour, and draws what of the polygon lies in the canvas. More contours may follow. EL_ERROR_MEMORY:
 * it has more edges than its memory, or, smooth, too many columns for what the edges leave of it; EL_ERROR_RANGE as
 * above; EL_ERROR_ARGUMENT: no such smoothing. Then nothing is drawn. */
el_status el_polygon_fill(el_polygon *polygon, const el_canvas *canvas, el_rule rule, el_smooth smooth, el_paint paint);

#ifdef __cplusplus
}
#endif

#endif
