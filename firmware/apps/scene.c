#include "scene.h"

#include <string.h>

#include "bench/bench_scenes.h"
#include "demo/demo_scenes.h"

size_t el_scene_count(void)
{
    return el_demo_scene_count + el_bench_scene_count;
}

const el_scene *el_scene_at(size_t index)
{
    return index < el_demo_scene_count ? &el_demo_scenes[index] : &el_bench_scenes[index - el_demo_scene_count];
}

const el_scene *el_scene_find(const char *name)
{
    for (size_t i = 0; i < el_scene_count(); i++) {
        if (strcmp(el_scene_at(i)->name, name) == 0) {
            return el_scene_at(i);
        }
    }
    return NULL;
}

el_status el_scene_play(const el_scene *scene, uint32_t frame, el_renderer *renderer)
{
    el_camera camera = {0};
    scene->place_camera(frame, &camera);
    el_status status = el_frame_begin(renderer, &camera);
    if (status != EL_OK) {
        return status;
    }
    int more;
    do {
        const el_status drawn = scene->draw(frame, renderer);
        status = drawn != EL_OK ? drawn : status;
        more = el_frame_next(renderer);
    } while (more > 0);
    return more < 0 ? (el_status)more : status;
}
