/* Scenes of which one thing grows: the `frame` of a growth scene is how much of it there is, not a time. Their meshes are
 * made in the program, so 50,000 triangles cost no flash. They share one set of arrays, so what was prepared is lost when
 * another scene or another amount is. */
#ifndef EL_BENCH_GROWTH_SCENES_H
#define EL_BENCH_GROWTH_SCENES_H

#include "scene.h"

enum {
    GROWTH_SPHERES = 500,    /* of the scenes that lie outside the view for the larger part */
    GROWTH_SPHERES_SEEN = 5, /* of those */
    GROWTH_SPHERE_TRIANGLES = 100,
    GROWTH_LAYERS = 16
};

typedef struct growth_scene {
    el_scene scene;
    void (*prepare)(uint32_t frame); /* before this frame is drawn, and no part of it */
} growth_scene;

/* A sphere of 200 px on the screen, of 100 to 50,000 triangles; `frame` is that number, one of growth_sphere_sizes. Flat. */
extern const uint32_t growth_sphere_sizes[];
extern const size_t growth_sphere_size_count;
extern const growth_scene growth_sphere;

/* A tilted board of 24 triangles; `frame` is its distance in 1/16: 1720 for 100 pixels, 32 for the whole screen. */
extern const growth_scene growth_board_flat;
extern const growth_scene growth_board_gouraud;
extern const growth_scene growth_board_textured;

/* `frame` such boards, 1 to GROWTH_LAYERS, one behind the other, which cover the whole screen with the same triangles. */
extern const growth_scene growth_layers_back_to_front;
extern const growth_scene growth_layers_front_to_back;
extern const growth_scene growth_layers_back_to_front_textured;
extern const growth_scene growth_layers_front_to_back_textured;

/* `frame` spheres of GROWTH_SPHERE_TRIANGLES each, GROWTH_SPHERES_SEEN to GROWTH_SPHERES; the first GROWTH_SPHERES_SEEN
 * are in the view, the others lie on its left, right, upper and lower side and behind the camera. Each a mesh; or all
 * one; or those in the view each, and the others, which all lie behind the camera then, one. */
extern const growth_scene growth_outside_meshes;
extern const growth_scene growth_outside_mesh;
extern const growth_scene growth_outside_behind;

#endif
