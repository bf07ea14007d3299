/* Shadings and lights side by side: in one directional light, in lamps, from both sides, and in haze. It is there if
 * base/options.h has them. */
#ifndef EL_SIM_LAMPS_SCENE_H
#define EL_SIM_LAMPS_SCENE_H

#include "scene.h"

#define EL_HAS_LAMPS_SCENE (EL_WITH_MIXED && EL_WITH_GOURAUD && EL_WITH_TEXTURE && EL_WITH_LIGHT && EL_WITH_DITHER)

extern const el_scene el_lamps_scene;

#endif
