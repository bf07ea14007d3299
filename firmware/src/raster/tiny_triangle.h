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

/* What is left of one for the bands below. Pixels are numbered from the first one of the row where it was set up, row after row:
 * in the next row they are as many more as a row has pixels. So one addition moves a side along and a row down. */
typedef struct el_tiny_triangle {
    uint16_t colour;         /* RGB565 */
    uint8_t rows_above;      /* that are drawn */
    uint8_t rows;            /* that are left */
    uint8_t upper_rows;      /* before the lower part; EL_TINY_NO_BEND where that has begun, or there is none */
    bool short_is_left;      /* the side that bends there */
    el_edge_q18 left, right; /* in the next row */
    el_edge_q18 lower;       /* the lower part's other edge, in the first row of that part */
    el_tiny_plane z; /* in the next row: `value` is what pixel 0 would have, `dy` what is added for the row after it */
} el_tiny_triangle;

enum { EL_TINY_NO_BEND = UINT8_MAX };

typedef enum el_tiny_result {
    EL_TINY_REFUSED,   /* nothing was done: the triangle is not tiny, reaches beside the screen, or has no row there */
    EL_TINY_DRAWN,     /* all of it, as far as it is not above the target */
    EL_TINY_REACHES_ON /* there are rows below, of which `rest` knows */
} el_tiny_result;

/* Draws a record's triangle into the target. */
el_tiny_result el_tiny_triangle_draw(const el_record *record, const el_run_look *look, const el_target *target,
                                     el_stats *stats, el_tiny_triangle *rest);

/* Draws what is left into the next target. Returns whether there are more rows below, of which it knows then. */
bool el_tiny_triangle_go_on(el_tiny_triangle *rest, const el_target *target, el_stats *stats);

#endif

#ifdef __cplusplus
}
#endif

#endif
