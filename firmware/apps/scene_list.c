/* The list of all scenes. It stands alone so that a program with little flash can link another one (demo/short_list.c,
 * tiny/scene_list.c). */
#include "bench/bench_scenes.h"
#include "demo/demo_scenes.h"
#include "scene.h"

size_t el_scene_count(void)
{
    return el_demo_scene_count + el_bench_scene_count;
}

const el_scene *el_scene_at(size_t index)
{
    return index < el_demo_scene_count ? el_demo_scenes[index] : &el_bench_scenes[index - el_demo_scene_count];
}
