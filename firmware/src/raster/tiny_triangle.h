/* Tiny flat triangles with depth: what most of a mesh's triangles are, some pixels each, so that what they cost is their set-up
 * and their rows. Their depth fits one register: see tiny.h for when, and why the pixels are those that all others
 * would have. Whatever is not tiny takes small_triangle.h's way, or triangle.h's. */
#ifndef EL_RASTER_TINY_TRIANGLE_H
#define EL_RASTER_TINY_TRIANGLE_H

#include "raster/plain.h"
#include "raster/tiny.h"
#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

#if EL_WITH_SMALL_PLANES

/* One under way. Pixels are numbered from the first one of row y on, row after row: in the next row they are as many more as a
 * row has pixels. So one addition moves a side along and a row down. */
typedef struct el_tiny_triangle {
    el_edge_q18 left, right; /* in the next row */
    el_edge_q18
        lower; /* the lower part's other edge, in the first row of that part; it follows on the side that is bent */
    el_tiny_plane z; /* in the next row: `value` is what pixel 0 would have, `dy` what is added for the row after it */
    uint16_t y;      /* where it began */
    uint16_t y_middle; /* first row of the lower part; UINT16_MAX when there is none, or it has begun */
    uint16_t y_end;
    uint16_t colour; /* RGB565 */
    bool short_is_left;
} el_tiny_triangle;

/* Sets up a record's triangle from the target's first row on, or from its own below that. Returns false where it is not tiny, reaches
 * beside the screen or has no row in the target. */
bool el_tiny_triangle_make(el_tiny_triangle *t, const el_record *record, const el_run_look *look,
                           const el_target *target);

/* Draws the rows that are in the target and moves it on to the row below. Returns whether it has more rows. Pre: it has one in
 * the target. */
bool el_tiny_triangle_draw(el_tiny_triangle *t, const el_target *target, el_stats *stats);

#endif

#ifdef __cplusplus
}
#endif

#endif
