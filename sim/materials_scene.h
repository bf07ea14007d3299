/* Materials side by side: every kind of texture, alpha, fog and lamp. It is there if base/options.h has them. */
#ifndef EL_SIM_MATERIALS_SCENE_H
#define EL_SIM_MATERIALS_SCENE_H

#include "scene.h"

#define EL_HAS_MATERIALS_SCENE (EL_WITH_MIXED && EL_WITH_MIPMAPS)

extern const el_scene el_materials_scene;

#endif
