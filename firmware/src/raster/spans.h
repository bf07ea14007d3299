/* Spans: which pixels of its rows a triangle covers. Edges are walked here and nowhere else, whatever the shading; what
 * fills pixels sees half-open ranges of columns. */
#ifndef EL_RASTER_SPANS_H
#define EL_RASTER_SPANS_H

#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Rows that are walked at a time: as many as a band has, mostly, and little enough for a stack. */
enum { EL_SPAN_ROWS = 16 };

/* Pixels [x, x_end) of each row; none where x >= x_end. Both are 0 to the target's width. */
typedef struct el_spans {
    uint16_t x[EL_SPAN_ROWS];
    uint16_t x_end[EL_SPAN_ROWS];
} el_spans;

/* A number with a bit for each of some rows, 31 at most, to be shifted out by one row after the other until it is 0. Of a loop
 * that counts, a compiler knows beforehand where values arrive that rows add to, and makes a long product of each. */
static inline uint32_t el_row_bits(int32_t rows)
{
    return (1U << rows) >> 1;
}

/* The spans of the triangle's next rows in the target, EL_SPAN_ROWS at most. Returns how many
 * they are. Moves triangle->y to the row after them, and the edges if the triangle goes on there; what is linear on the
 * screen stays. Counts rows and pixels, and each row as a span: who finds one without pixels corrects that.
 * Pre: triangle->y >= target->y. */
int32_t el_spans_next(el_triangle *triangle, const el_target *target, el_stats *stats, el_spans *spans);

#ifdef __cplusplus
}
#endif

#endif
