/* The seeded triangles and polygons on which all methods are measured. The same seed and count give the same shapes on
 * every machine: integers only, the circle from Edgeline's own sine. */
#ifndef EL_METHODS_CASES_H
#define EL_METHODS_CASES_H

#include "methods/polygons.h"
#include "methods/shapes.h"

enum { EL_CASES_WIDTH = 160, EL_CASES_HEIGHT = 120 };

typedef enum el_triangle_kind {
    EL_TRIANGLES_SMALL,   /* up to 12 px */
    EL_TRIANGLES_MEDIUM,  /* up to 48 px */
    EL_TRIANGLES_LARGE,   /* corners anywhere in the picture */
    EL_TRIANGLES_SLIVER,  /* long, and a few sub-pixels wide */
    EL_TRIANGLES_FAN,     /* closed fans, every second one with its corners on pixel centres */
    EL_TRIANGLES_CENTRED, /* corners on pixel centres, so that edges run through others */
    EL_TRIANGLES_AXIS,    /* a level and an upright edge, half of the coordinates on centres */
    EL_TRIANGLE_KINDS
} el_triangle_kind;

typedef enum el_polygon_kind {
    EL_POLYGONS_CONVEX,
    EL_POLYGONS_STAR,    /* corners near and far from the middle in turn */
    EL_POLYGONS_CONCAVE, /* a comb with teeth of any length */
    EL_POLYGONS_HOLE,    /* a convex outline with one or two others inside, turned the same way or the other */
    EL_POLYGONS_CROSSING,
    EL_POLYGON_KINDS
} el_polygon_kind;

extern const char *const el_triangle_kind_names[EL_TRIANGLE_KINDS];
extern const char *const el_polygon_kind_names[EL_POLYGON_KINDS];

/* The triangles of a closed fan around its hub, all of the same winding; none has an angle of half a turn at the hub, so
 * that their interiors do not overlap. */
enum { EL_FAN_LEAST = 5, EL_FAN_MOST = 10 };

typedef struct el_fan {
    el_spot triangles[EL_FAN_MOST][3]; /* hub, rim, next of the rim */
    size_t count;
} el_fan;

typedef struct el_random {
    uint64_t state;
} el_random;

/* Another sequence for each kind, whatever the number of shapes that others take. */
el_random el_random_of(uint32_t seed, uint32_t kind);
/* least to most, both included. */
int32_t el_random_between(el_random *random, int32_t least, int32_t most);

/* The next shape; `index` counts the kind's shapes, and odd ones have their corners on pixel centres where the kind has
 * such. Not for EL_TRIANGLES_FAN. The triangle may have no area. */
void el_any_triangle(el_random *random, el_triangle_kind kind, el_spot corners[3]);
void el_any_fan(el_random *random, uint32_t index, el_fan *fan);
void el_any_polygon(el_random *random, el_polygon_kind kind, uint32_t index, el_polygon *polygon);

#endif
