/* The demo: a teapot, a room to walk through, a solid, an island of many triangles, and all of them in turn. */
#ifndef EL_APPS_DEMO_SCENES_H
#define EL_APPS_DEMO_SCENES_H

#include "scene.h"

extern const el_scene el_demo_scenes[];
extern const size_t el_demo_scene_count;

#endif
