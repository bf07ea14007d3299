/* Whole pictures through the public interface, in bands and arenas of any size, with the depth that the sinks see. */
#ifndef EL_STRESS_RENDERS_H
#define EL_STRESS_RENDERS_H

#include "edgeline.h"
#include "stress.h"

enum { PICTURE_PIXELS = 128 * 128 };

typedef struct picture {
    uint16_t width, height; /* at most PICTURE_PIXELS together */
    uint16_t colour[PICTURE_PIXELS];
    uint16_t depth[PICTURE_PIXELS];
    el_stats stats;
} picture;

typedef struct drawing {
    const el_mesh *mesh;
    const el_pose *pose;
    const el_material *material;
} drawing;

/* Draws them in order into `into`, whose size is set, on a background of 0. False, and told by stress_fail, when the
 * renderer answered an error or handed over something else than whole bands from the top to the bottom. */
bool render(stress *s, const el_camera *camera, const drawing drawings[], unsigned count, picture *into);

#endif
