/* Spans: which pixels of its rows a triangle covers. Edges are walked here and nowhere else, whatever the shading; what
 * fills pixels sees half-open ranges of columns. */
#ifndef EL_RASTER_SPANS_H
#define EL_RASTER_SPANS_H

#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Pixels [x, x_end) of a row; none where x >= x_end. */
typedef struct el_span {
    int16_t x, x_end;
} el_span;

/* Rows that are walked at a time: as many as a band has, mostly, and little enough for a stack. */
enum { EL_SPAN_ROWS = 16 };

/* The spans of the triangle's next `rows` rows, within columns [0, width). Moves its edges and triangle->y to the row after
 * them, but not what is linear on the screen. Returns how many pixels the spans have.
 * Pre: 1 <= rows <= EL_SPAN_ROWS, triangle->y + rows <= triangle->y_end. */
uint32_t el_spans_next(el_triangle *triangle, int32_t rows, int32_t width, el_span *spans);

#ifdef __cplusplus
}
#endif

#endif
