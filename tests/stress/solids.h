/* Convex solids, where they are in view space, and what a ray through a pixel meets, in double precision with a margin:
 * the reference for whole scenes. Inflated by the margin a solid holds whatever snapping and rounding can make of it;
 * deflated by it, it lies inside all of that. */
#ifndef EL_STRESS_SOLIDS_H
#define EL_STRESS_SOLIDS_H

#include "edgeline.h"
#include "stress.h"

enum { SOLID_MAX_VERTICES = 66, SOLID_MAX_TRIANGLES = 128 };

typedef struct solid {
    int16_t positions[SOLID_MAX_VERTICES][3];
    uint16_t triangles[SOLID_MAX_TRIANGLES][3]; /* front faces outside */
    uint8_t colours[SOLID_MAX_VERTICES][3];     /* one colour for all */
    int16_t uvs[SOLID_MAX_VERTICES][2];         /* one texture coordinate for all */
    bool is_box;                                /* or an octahedron: few faces, none of them small */
    uint16_t vertex_count;
    uint16_t triangle_count;
    int32_t radius; /* of the bounding sphere about the origin, position units */
} solid;

/* A tetrahedron, a box, an octahedron or a sphere of 32 or 128 faces. */
void solid_make(dice *random, solid *solid);

/* The solid as a mesh. */
el_mesh solid_mesh(const solid *solid, int8_t scale_log2);

/* A pinhole or parallel camera's rays: point(d) = origin + d * direction, in view space: right, up, distance d. */
typedef struct viewpoint {
    double half[2]; /* half the picture's size: at distance 1 in perspective, anywhere in orthographic projection */
    bool perspective;
    int32_t width, height;
} viewpoint;

viewpoint viewpoint_of(const el_camera *camera, int32_t width, int32_t height);

typedef struct solid_view {
    double normals[SOLID_MAX_TRIANGLES][3]; /* outwards, length 1 */
    double offsets[SOLID_MAX_TRIANGLES];    /* inside: normal . p <= offset */
    unsigned faces;
    double nearest, farthest; /* distances of the vertices along the view */
    double reach;             /* largest |coordinate| of a vertex on the screen's scale: what rounding is relative to */
} solid_view;

void solid_view_make(solid_view *view, const solid *solid, const el_mesh *mesh, const el_pose *pose,
                     const el_camera *camera, const viewpoint *from);

/* The distances at which the ray through a pixel's centre enters and leaves the solid, moved outwards by `margin` world
 * units. *enters > *leaves where it misses. */
void solid_meet(const solid_view *view, const viewpoint *from, int32_t column, int32_t row, double margin,
                double *enters, double *leaves);

#endif
