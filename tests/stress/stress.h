/* What the categories of the stress test share: the case that runs, its tally, and how a failure is told.
 *
 * A category is a function that makes and checks one case from the case's own random numbers. It returns the number of
 * triangles that it checked, and calls stress_fail when something is wrong: the program prints what is known, the
 * command that runs this case alone, and goes on with the next category. */
#ifndef EL_STRESS_STRESS_H
#define EL_STRESS_STRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "exact.h"
#include "random.h"

enum { MAX_SIDE = EL_MAX_WIDTH, MAX_UV_ERROR_LOG2 = 5 };

/* Largest errors and shares of a category. What it does not measure stays 0. */
typedef struct category_tally {
    uint64_t cases;
    uint64_t triangles;
    uint64_t samples;       /* pixels or vertices that were compared with a reference */
    uint64_t depths;        /* of those, depths at pixels */
    uint64_t depths_exact;  /* equal to the correctly rounded plane */
    int64_t depth_most_off; /* units of 16 bits */
    double colour_most_off; /* units of 8 bits, before the last rounding */
    uint64_t texels;        /* coordinates inside the domain of their bound, and beyond it */
    uint64_t texels_beyond;
    double texel_most_off[MAX_UV_ERROR_LOG2 + 1]; /* in texels, by uv_error_log2 */
    double texel_most_off_beyond[MAX_UV_ERROR_LOG2 + 1];
    uint64_t vertices;
    uint64_t vertices_exact;
    double vertex_most_off;       /* in 1/16 px */
    double vertex_depth_most_off; /* units of 16 bits */
} category_tally;

/* Buffers for pictures of up to MAX_SIDE x MAX_SIDE pixels. Between two checks colour is 0 and depth 65535 all over. */
typedef struct canvas_buffers {
    uint16_t *colour;
    uint16_t *depth;
    uint16_t *zeros; /* one row each, to compare with */
    uint16_t *ones;
    uint16_t *empty; /* 65535 */
} canvas_buffers;

typedef struct stress {
    const char *program;
    const char *category;
    uint64_t seed;
    uint64_t index;
    dice random;
    const canvas_buffers *canvas;
    category_tally tally;
    bool failed;
} stress;

typedef struct category {
    const char *name;
    unsigned share;    /* of all triangles, relative to the other categories' */
    unsigned argument; /* for functions that serve several categories */
    unsigned (*run)(stress *s, unsigned argument);
} category;

/* Prints what is wrong and how to see it again, and marks the case as failed. */
__attribute__((format(printf, 2, 3))) void stress_fail(stress *s, const char *format, ...);

/* Prints rows of a picture around a pixel, which stands between brackets. symbol(context, column, row) says what to show. */
void stress_picture(int64_t width, int64_t height, int64_t column, int64_t row,
                    char (*symbol)(const void *context, int64_t column, int64_t row), const void *context);

static inline void keep_largest(double *largest, double value)
{
    *largest = value > *largest ? value : *largest;
}

/* The categories, each list ended by one without a name. */
extern const category triangle_categories[];
extern const category solid_categories[];
extern const category flat_categories[];
extern const category vertex_categories[];

#endif
