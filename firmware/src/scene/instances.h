/* Instances: things that are drawn from a list, each with its mesh, or several of more or less detail, its pose and its
 * material. The same mesh may be there many times; one outside the view costs el_draw's one test.
 *
 * The list is the caller's. Poses are named, not copied: el_hierarchy_update or el_animation_pose may write them anew for
 * every frame. */
#ifndef EL_SCENE_INSTANCES_H
#define EL_SCENE_INSTANCES_H

#include <stdint.h>

#include "frame/pick.h"
#include "frame/renderer.h"
#include "geometry/detail.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct el_instance {
    const el_level
        *levels; /* [level_count], the finest first; their bounding spheres are taken for that of the first */
    const el_pose *pose;
    const el_material *material;
    uint8_t level_count; /* at least 1; 1: as it is, its size is not asked for */
    uint8_t level;       /* drawn last; the list's, 0 at first */
} el_instance;

/* Draws all, in their order, in a frame's passes: each pass chooses the same levels. EL_OK, or the first error of
 * el_draw; the others are drawn all the same. */
el_status el_instances_draw(el_renderer *renderer, el_instance instances[], uint32_t count);

/* The same for picking, with the levels that were drawn last; el_picked.draw counts instances then. */
el_status el_instances_pick(el_pick *pick, const el_instance instances[], uint32_t count);

#ifdef __cplusplus
}
#endif

#endif
