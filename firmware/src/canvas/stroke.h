/* Lines of any width along points, as contours of a polygon: fill it with EL_NON_ZERO, under which the parts of a line, and
 * lines that cross, are one shape.
 *
 * A segment is a rectangle, rounded to the screen's unit as its corners are; so are caps and joins. Thin lines of single
 * pixels are el_canvas_line. */
#ifndef EL_CANVAS_STROKE_H
#define EL_CANVAS_STROKE_H

#include <stdbool.h>
#include <stdint.h>

#include "canvas/polygon.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A line's ends: cut off at its points, half a circle around them, or half its width beyond them. */
typedef enum el_cap { EL_CAP_BUTT, EL_CAP_ROUND, EL_CAP_SQUARE } el_cap;

/* Its corners: as far as the outer sides go, or cut off where that is too far; a circle; cut off. */
typedef enum el_join { EL_JOIN_MITER, EL_JOIN_ROUND, EL_JOIN_BEVEL } el_join;

typedef struct el_stroke {
    uint16_t width; /* 1/EL_SUBPIXELS px, at least 1 */
    uint8_t cap;    /* el_cap */
    uint8_t join;   /* el_join */
    uint8_t miter;  /* a miter is at most so many widths long, or becomes a bevel; 0 is 4 */
} el_stroke;

/* Edges that a line through so many points takes at most, without round caps and joins; a round one takes EL_ROUND_EDGES of
 * half the width more, at each point. */
#define EL_STROKE_EDGES(points) ((points)*8U)

/* Adds the line through `count` points (x, y); `closed`: back to the first one, without caps. A line whose points are all
 * the same is its two caps. */
void el_polygon_stroke(el_polygon *polygon, const int32_t (*points)[2], uint32_t count, bool closed,
                       const el_stroke *stroke);

#ifdef __cplusplus
}
#endif

#endif
