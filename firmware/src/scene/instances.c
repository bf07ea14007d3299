#include "scene/instances.h"

static const el_mesh *mesh_of(const el_instance *instance)
{
    return instance->levels[instance->level < instance->level_count ? instance->level : 0].mesh;
}

el_status el_instances_draw(el_renderer *renderer, el_instance instances[], uint32_t count)
{
    el_status first = EL_OK;
    for (uint32_t i = 0; i < count; i++) {
        el_instance *const instance = &instances[i];
        if (instance->level_count > 1) {
            const uint32_t size_q4 = el_screen_size_q4(&renderer->view, instance->levels[0].mesh, instance->pose);
            instance->level = el_level_choose(instance->levels, instance->level_count, size_q4, instance->level);
        }
        const el_status status = el_draw(renderer, mesh_of(instance), instance->pose, instance->material);
        first = first == EL_OK ? status : first;
    }
    return first;
}

el_status el_instances_pick(el_pick *pick, const el_instance instances[], uint32_t count)
{
    el_status first = EL_OK;
    for (uint32_t i = 0; i < count; i++) {
        const el_instance *const instance = &instances[i];
        const el_status status = el_pick_draw(pick, mesh_of(instance), instance->pose, instance->material);
        first = first == EL_OK ? status : first;
    }
    return first;
}
