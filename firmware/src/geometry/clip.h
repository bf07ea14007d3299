/* Cutting triangles at the near and far plane and at the guard band, in clip space.
 *
 * Sutherland and Hodgman, "Reentrant polygon clipping", CACM 17(1), 1974. A new vertex lies on an edge between a vertex
 * inside and one outside and is computed from the inside one to the outside one, whichever way the edge runs: both
 * triangles of an edge get the same vertex, so clipped meshes stay watertight. The planes are taken in one order for all
 * triangles for the same reason; a plane that is skipped for one triangle cuts none of its edges. */
#ifndef EL_GEOMETRY_CLIP_H
#define EL_GEOMETRY_CLIP_H

#include "geometry/transform.h"

enum {
    /* u, v, red, green, blue; or, of wires, three weights */
    EL_CLIP_ATTRIBUTES = EL_WITH_GOURAUD ? 5 : (EL_WITH_WIRES ? 3 : (EL_WITH_TEXTURE ? 2 : 0)),
    EL_CLIP_MAX_VERTICES = 9 /* a triangle and six planes */
};

typedef struct el_clip_corner {
    el_clip_vertex position;
    int32_t attributes[EL_CLIP_ATTRIBUTES > 0 ? EL_CLIP_ATTRIBUTES : 1]; /* |attribute| < 2^30, in any unit */
} el_clip_corner;

/* Cuts the polygon of `count` corners in place. Returns the corners that are left: 0, or 3 to EL_CLIP_MAX_VERTICES, all
 * of them without EL_CODE_CLIP bits but for rounding: project them with el_project. `codes` is the union of the corners'
 * outcodes. Pre: count == 3. */
unsigned el_clip_polygon(const el_transform *transform, el_clip_corner corners[EL_CLIP_MAX_VERTICES], unsigned count,
                         uint8_t codes);

#endif
