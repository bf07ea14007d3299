/* Materials side by side: every kind of texture, alpha, fog and lamp. */
#ifndef EL_SIM_MATERIALS_SCENE_H
#define EL_SIM_MATERIALS_SCENE_H

#include "scene.h"

extern const el_scene el_materials_scene;

#endif
