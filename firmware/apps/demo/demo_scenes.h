/* The demo: a teapot, a room to walk through, a solid, an island of many triangles, and all of them in turn. */
#ifndef EL_APPS_DEMO_SCENES_H
#define EL_APPS_DEMO_SCENES_H

#include "scene.h"

/* One by one, for programs without room for all of them. */
extern const el_scene el_teapot_scene, el_room_scene, el_solid_scene, el_field_scene;

/* The demo, then each of the above. */
extern const el_scene *const el_demo_scenes[];
extern const size_t el_demo_scene_count;

#endif
