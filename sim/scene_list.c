/* The simulator's list of scenes: those of the boards, and `materials` and `lamps`, which show what few boards have room for. */
#include "bench/bench_scenes.h"
#include "demo/demo_scenes.h"
#include "lamps_scene.h"
#include "materials_scene.h"
#include "scene.h"

size_t el_scene_count(void)
{
    return el_demo_scene_count + el_bench_scene_count + EL_HAS_MATERIALS_SCENE + EL_HAS_LAMPS_SCENE;
}

const el_scene *el_scene_at(size_t index)
{
    if (index < el_demo_scene_count) {
        return el_demo_scenes[index];
    }
    index -= el_demo_scene_count;
    if (index < el_bench_scene_count) {
        return &el_bench_scenes[index];
    }
#if EL_HAS_MATERIALS_SCENE
    if (index == el_bench_scene_count) {
        return &el_materials_scene;
    }
#endif
#if EL_HAS_LAMPS_SCENE
    return &el_lamps_scene;
#else
    return NULL;
#endif
}
