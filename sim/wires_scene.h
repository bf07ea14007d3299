/* Wires of a mesh in their three ways. It is there if base/options.h has them. */
#ifndef EL_SIM_WIRES_SCENE_H
#define EL_SIM_WIRES_SCENE_H

#include "scene.h"

#define EL_HAS_WIRES_SCENE (EL_WITH_WIRES && EL_WITH_MIXED)

extern const el_scene el_wires_scene;

#endif
