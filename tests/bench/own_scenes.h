/* Scenes that the benchmark alone has: layers over the whole screen, materials that are mixed, and models that others made
 * (model_scenes.c; none where they are not at hand). */
#ifndef EL_BENCH_OWN_SCENES_H
#define EL_BENCH_OWN_SCENES_H

#include "scene.h"

extern const el_scene overdraw_scenes[];
extern const size_t overdraw_scene_count;

extern const el_scene mixed_scenes[];
extern const size_t mixed_scene_count;

extern const el_scene model_scenes[];
extern const size_t model_scene_count;

#endif
