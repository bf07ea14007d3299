/* A camera that somebody turns: offsets from where a scene puts it, as a host sends them (stream/session.h, EL_CONTROL_YAW
 * to EL_CONTROL_PAN_Y).
 *
 * A camera has a place and a direction; what it is turned about lies before it, at the distance of its focus. */
#ifndef EL_APPS_ORBIT_H
#define EL_APPS_ORBIT_H

#include <stdint.h>

#include "edgeline.h"

enum {
    EL_ORBIT_QUARTER_TURN = 16384,
    EL_ORBIT_MAX_ZOOM_Q8 = 4 * 256,
    EL_ORBIT_MAX_PAN_Q8 = 16 * 256,
};

/* Zeroed: the scene's own camera. */
typedef struct el_orbit {
    uint16_t yaw;      /* around the focus to the right, about the world's y; 65536 is a whole turn */
    int16_t pitch;     /* around it upwards, +-EL_ORBIT_QUARTER_TURN; before the yaw */
    int16_t zoom_q8;   /* the distance is divided by 2^(zoom / 256), +-EL_ORBIT_MAX_ZOOM_Q8 */
    int16_t pan_q8[2]; /* camera and focus move to the right and upwards, in 1/256 of their distance, zoom included;
                          +-EL_ORBIT_MAX_PAN_Q8 */
} el_orbit;

/* The focus of a camera of which nothing else is known: the point before it that is nearest to the world's origin, where
 * most scenes lie, but at least twice as far as the near plane and at most as far as the far plane. Q16 units. */
uint32_t el_orbit_focus_q16(const el_camera *camera);

/* Moves `camera`, whose focus is `focus_q16` before it (1 to 2^30). A zeroed orbit leaves it as it is, to the last bit. Near
 * and far plane go with the zoom, so that what the scene shows stays between them, and so does an orthographic camera's
 * height, in place of its distance. A camera that el_frame_begin takes is one that it takes afterwards: it stops at the
 * world's edge, and its planes at their limits. */
void el_orbit_apply(const el_orbit *orbit, uint32_t focus_q16, el_camera *camera);

#endif
