/* The scenes of the demo in 8 KB of RAM and 128 KB of flash. Of the first one's 116 triangles 49 are seen at a time, which
 * takes one pass or two; the others take many, and have the same pixels. */
#include "demo/demo_scenes.h"
#include "scene.h"

static const el_scene *const scenes[] = {&el_solid_scene, &el_teapot_scene, &el_room_scene};

size_t el_scene_count(void)
{
    return sizeof scenes / sizeof scenes[0];
}

const el_scene *el_scene_at(size_t index)
{
    return scenes[index];
}
