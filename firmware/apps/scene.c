#include "scene.h"

#include <string.h>

const el_scene *el_scene_find(const char *name)
{
    for (size_t i = 0; i < el_scene_count(); i++) {
        if (strcmp(el_scene_at(i)->name, name) == 0) {
            return el_scene_at(i);
        }
    }
    return NULL;
}

static inline el_status show(const el_scene *scene, uint32_t frame, const el_camera *camera, el_renderer *renderer)
{
    el_status status = el_frame_begin(renderer, camera);
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

el_status el_scene_play(const el_scene *scene, uint32_t frame, el_renderer *renderer)
{
    el_camera camera = {0};
    scene->place_camera(frame, &camera);
    return show(scene, frame, &camera, renderer);
}

el_status el_scene_show(const el_scene *scene, uint32_t frame, const el_camera *camera, el_renderer *renderer)
{
    return show(scene, frame, camera, renderer);
}
