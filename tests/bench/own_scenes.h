/* Scenes that the benchmark alone has: layers over the whole screen, materials that are mixed, and models that others made
 * (model_scenes.c; none where they are not at hand). And what lies over a scene: a HUD. */
#ifndef EL_BENCH_OWN_SCENES_H
#define EL_BENCH_OWN_SCENES_H

#include "scene.h"

extern const el_scene overdraw_scenes[];
extern const size_t overdraw_scene_count;

extern const el_scene mixed_scenes[];
extern const size_t mixed_scene_count;

extern const el_scene model_scenes[];
extern const size_t model_scene_count;

/* For 320 x 240 pixels: a glazed bar with text, a compass of polygons, and sprites, one of them turned. */
extern const el_layer bench_hud;

#endif
