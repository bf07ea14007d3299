/* The simulator's list of scenes: those of the boards, and `materials` and `wires`, which show what few boards have room
 * for. */
#include "bench/bench_scenes.h"
#include "demo/demo_scenes.h"
#include "materials_scene.h"
#include "scene.h"
#include "wires_scene.h"

size_t el_scene_count(void)
{
    return el_demo_scene_count + el_bench_scene_count + EL_HAS_MATERIALS_SCENE + EL_HAS_WIRES_SCENE;
}

const el_scene *el_scene_at(size_t index)
{
    if (index < el_demo_scene_count) {
        return el_demo_scenes[index];
    }
    index -= el_demo_scene_count;
#if EL_HAS_MATERIALS_SCENE
    if (index == el_bench_scene_count) {
        return &el_materials_scene;
    }
#endif
#if EL_HAS_WIRES_SCENE
    if (index == el_bench_scene_count + EL_HAS_MATERIALS_SCENE) {
        return &el_wires_scene;
    }
#endif
    return &el_bench_scenes[index];
}
