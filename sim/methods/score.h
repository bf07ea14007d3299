/* All methods on the same shapes: how long they take, how much they ask, and where they differ from the reference. */
#ifndef EL_METHODS_SCORE_H
#define EL_METHODS_SCORE_H

#include "methods/cases.h"
#include "methods/polygons.h"
#include "methods/triangles.h"
#include "methods/values.h"

/* One method on all shapes of one kind. */
typedef struct el_score {
    uint32_t shapes;
    uint64_t covered;     /* pixels of the reference */
    uint64_t edge_pixels; /* of those, pixels with a neighbour above, below, left or right that is not covered */
    uint64_t work;        /* pixels that the method asked about or touched */
    uint64_t missing;     /* covered by the reference, of the method's own rule, but not by the method */
    uint64_t extra;       /* the other way around; a pixel hit twice by one shape is extra too */
    double ns_per_shape;  /* median of the runs */
} el_score;

/* What the triangles of closed fans do together. `inner` are the pixels that the exact triangles with left and top edges
 * cover, each exactly once; what the methods do on the rim alone is no crack. */
typedef struct el_fan_score {
    uint32_t fans;
    uint64_t inner;
    uint64_t cracks; /* inner pixels that no triangle covers, rim pixels (where the rule decides) left out */
    uint64_t double_hits;
} el_fan_score;

enum { EL_VALUE_DEPTH, EL_VALUE_COLOUR, EL_VALUE_USES };
/* Values are measured on the kinds up to EL_TRIANGLES_SLIVER. */
enum { EL_VALUE_KINDS = EL_TRIANGLES_SLIVER + 1 };

typedef struct el_value_score {
    uint32_t triangles;
    uint64_t pixels;
    uint64_t off;       /* pixels that are not the correctly rounded value */
    uint64_t outside;   /* of those, outside of the corners' range */
    uint32_t max_error; /* the largest distance from the correctly rounded value */
    double mean_error;
    double ns_per_pixel; /* medians of the runs of each triangle, set-up included */
} el_value_score;

typedef struct el_scores {
    uint32_t seed;
    uint32_t count; /* shapes of each kind, fans */
    el_score triangles[EL_TRIANGLE_METHODS][EL_TRIANGLE_KINDS];
    el_fan_score fans[EL_TRIANGLE_METHODS];
    el_score polygons[EL_POLYGON_METHODS][EL_POLYGON_KINDS];
    el_value_score values[EL_VALUE_METHODS][EL_VALUE_USES][EL_VALUE_KINDS];
} el_scores;

/* Measures everything for scores->seed and scores->count (1 to 10000). False when there is no memory. */
bool el_score_all(el_scores *scores);

/* missing + extra per 1000 edge pixels; 0 without any. */
double el_score_wrong(const el_score *score);

/* The sum over `kinds` scores; ns_per_shape is the mean per shape. */
el_score el_score_sum(const el_score *scores, size_t kinds);

#endif
