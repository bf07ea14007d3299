/* What a scene is: a camera path and a list of things to draw, both functions of the frame's number alone, so that any
 * program that plays it gets the same pictures. */
#ifndef EL_APPS_SCENE_H
#define EL_APPS_SCENE_H

#include <stddef.h>

#include "edgeline.h"

typedef struct el_scene {
    const char *name;
    const char *summary; /* one line */
    uint16_t background; /* RGB565 */
    void (*place_camera)(uint32_t frame, el_camera *camera);
    /* Submits the scene; called once per pass. */
    el_status (*draw)(uint32_t frame, el_renderer *renderer);
    /* How far before the camera lies what it is turned about (geometry/orbit.h), Q16 units, 1 to 2^30. Where that is 0 or this is
     * NULL: el_orbit_focus_q16. */
    uint32_t (*focus_q16)(uint32_t frame);
} el_scene;

/* The scenes of this program: the demo's, then the benchmark's (scene_list.c), unless it links a list of its own. */
size_t el_scene_count(void);
const el_scene *el_scene_at(size_t index);

/* NULL when there is no such scene. */
const el_scene *el_scene_find(const char *name);

/* Draws frame number `frame` of `scene`, all passes, and hands it to the renderer's sinks. EL_OK or an error. */
el_status el_scene_play(const el_scene *scene, uint32_t frame, el_renderer *renderer);

/* The same as `camera` sees it. */
el_status el_scene_show(const el_scene *scene, uint32_t frame, const el_camera *camera, el_renderer *renderer);

#endif
