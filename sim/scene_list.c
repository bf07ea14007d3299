/* The simulator's list of scenes: those of the boards, and those that show what few boards have room for. */
#include "bench/bench_scenes.h"
#include "demo/demo_scenes.h"
#include "lamps_scene.h"
#include "materials_scene.h"
#include "scene.h"
#include "wires_scene.h"

static const el_scene *const own_scenes[] = {
#if EL_HAS_MATERIALS_SCENE
    &el_materials_scene,
#endif
#if EL_HAS_LAMPS_SCENE
    &el_lamps_scene,
#endif
#if EL_HAS_WIRES_SCENE
    &el_wires_scene,
#endif
    NULL /* never without an entry */
};
enum { OWN_SCENES = sizeof own_scenes / sizeof own_scenes[0] - 1 };

size_t el_scene_count(void)
{
    return el_demo_scene_count + el_bench_scene_count + OWN_SCENES;
}

const el_scene *el_scene_at(size_t index)
{
    if (index < el_demo_scene_count) {
        return el_demo_scenes[index];
    }
    index -= el_demo_scene_count;
    return index < el_bench_scene_count ? &el_bench_scenes[index] : own_scenes[index - el_bench_scene_count];
}
