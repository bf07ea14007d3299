/* A list without the benchmark's scenes, for boards whose flash they do not fit; the demo's keep their numbers. */
#include "demo/demo_scenes.h"
#include "scene.h"

size_t el_scene_count(void)
{
    return el_demo_scene_count;
}

const el_scene *el_scene_at(size_t index)
{
    return el_demo_scenes[index];
}
