/* One triangle for the rasterizer, with all its attributes, and the same for the exact reference. */
#ifndef EL_STRESS_SUBJECT_H
#define EL_STRESS_SUBJECT_H

#include "raster/triangle.h"
#include "shapes.h"
#include "stress.h"

typedef enum filling_kind {
    FILL_ANY,
    FILL_DEPTH_EXTREMES, /* z at 0 and 65535 */
    FILL_W_EXTREMES,     /* 1/w with ratios of 64, 512 and 65535, and near 1 */
    FILL_EQUAL_LEVELS    /* one depth, one colour, one 1/w: planes without a slope */
} filling_kind;

typedef struct subject {
    point given[3];
    exact_triangle exact;
    el_corner corners[3];
    uint8_t uv_error_log2;
    int32_t width; /* of the screen, pixels */
    int32_t height;
} subject;

/* `is_wide`: on a screen of 481 to EL_MAX_WIDTH columns, instead of one of a usual display or less. */
subject subject_make(dice *random, shape_kind shape, filling_kind filling, bool is_wide);

/* Draws the triangle into the canvas, in bands of any heights, set up anew or carried on from band to band. */
void subject_draw(dice *random, const subject *subject, const el_corner corners[3], const el_surface *surface,
                  const canvas_buffers *canvas);

/* The triangle in words. */
void subject_print(const subject *subject);

#endif
