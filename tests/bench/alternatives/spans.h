/* Attributes along spans: triangles are set up by the renderer, outside of what is measured, and then drawn row by row by
 * the span function under test or, for comparison, by the renderer itself. */
#ifndef EL_BENCH_SPANS_H
#define EL_BENCH_SPANS_H

#include "alternatives.h"
#include "platform.h"

/* Where a span goes: rows of the picture, and of what is recorded (NULL when work is measured). */
typedef struct span_target {
    uint16_t *colour;
    uint16_t *depth;
    int32_t *record; /* `values` per pixel */
} span_target;

/* Draws pixels [x, x_end) of the triangle's current row; the target's pointers are those of the row. */
typedef void span_function(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end);

enum { BATCH = 64 };

/* A plane's value at pixel x of the triangle's current row. */
BENCH_INLINE uint64_t plane_at(const el_plane *plane, int32_t x)
{
    return plane->value + plane->dx * (uint64_t)(int64_t)x;
}

/* Steps the triangle over all of its rows. */
BENCH_INLINE void draw_spans(el_triangle *triangle, const span_target *picture, unsigned values, span_function *span)
{
    while (triangle->y < triangle->y_end) {
        const int32_t x = el_edge_x(&triangle->left);
        const int32_t x_end = el_edge_x(&triangle->right);
        if (x < x_end) {
            const int32_t at = triangle->y * WIDTH;
            const span_target row = {picture->colour + at, picture->depth + at,
                                     picture->record == NULL ? NULL : picture->record + at * (int32_t)values};
            span(triangle, &row, x, x_end);
        }
        el_triangle_next_row(triangle);
    }
}

/* The triangles of a range, BATCH at a time: set up, then drawn while it counts. `span` NULL: by the renderer. */
BENCH_INLINE void draw_all(const el_surface *surface, bench_range which, unsigned values, int32_t *record,
                           span_function *span)
{
    static el_triangle batch[BATCH];
    uint32_t pictures[BATCH];
    el_stats stats = {0};
    for (uint32_t i = which.begin; i < which.end;) {
        unsigned count = 0;
        for (; i < which.end && count < BATCH; i++) {
            if (el_triangle_setup(&batch[count], bench_triangles[i].corners, surface, 0)) {
                pictures[count] = bench_triangles[i].picture;
                count++;
            }
        }
        bench_start();
        for (unsigned k = 0; k < count; k++) {
            const uint32_t picture = pictures[k];
            if (span == NULL) {
                const el_target target = {bench_colour[picture], bench_depth[picture], WIDTH, 0, HEIGHT, EL_FIELD_NONE};
                el_triangle_draw(&batch[k], &target, &stats);
            } else {
                const span_target target = {bench_colour[picture], bench_depth[picture],
                                            record == NULL ? NULL : record + picture * PIXELS * values};
                draw_spans(&batch[k], &target, values, span);
            }
        }
        bench_stop();
    }
}

/* The `run` of a case, NAME_case, that draws with SPAN. Whether it records is decided here, once. */
#define SPAN_CASE(span_name, values, span)                                                                             \
    static void span_name##_case(const bench_case *self, int32_t *record)                                              \
    {                                                                                                                  \
        const el_surface surface = surface_of(self);                                                                   \
        if (record != NULL) {                                                                                          \
            draw_all(&surface, self->triangles, values, record, span);                                                 \
        } else {                                                                                                       \
            draw_all(&surface, self->triangles, values, NULL, span);                                                   \
        }                                                                                                              \
    }

#endif
