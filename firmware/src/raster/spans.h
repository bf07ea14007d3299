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

/* The spans of the triangle's next rows in the target, EL_SPAN_ROWS at most, within the target's width. Returns how many
 * they are. Moves triangle->y to the row after them, and the edges if the triangle goes on there; what is linear on the
 * screen stays. Counts rows and pixels, and each row as a span: who finds one without pixels corrects that.
 * Pre: the triangle has rows in the target. */
int32_t el_spans_next(el_triangle *triangle, const el_target *target, el_stats *stats, el_span spans[EL_SPAN_ROWS]);

#ifdef __cplusplus
}
#endif

#endif
