/* Cameras that somebody turns: one that circles a target, or walks; and offsets from where a scene puts its own, as a host's
 * controls send them.
 *
 * A camera has a place and a direction; what it is turned about lies before it, at the distance of its focus. */
#ifndef EL_GEOMETRY_ORBIT_H
#define EL_GEOMETRY_ORBIT_H

#include <stdint.h>

#include "base/angle.h"
#include "geometry/pose.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* A camera that looks at a target from some distance; from none, it stands where the target is, and walks
 * (el_orbit_camera_walk). It stands still where nothing moves it: what a program adds per frame it takes from the time that
 * has passed, rate * ms / 1000. */
typedef struct el_orbit_camera {
    int32_t target_q16[3];
    uint32_t distance_q16; /* at most 2^30; 0: the target is the camera's place */
    el_angle yaw;          /* around the target to the right, about the world's y; at 0 the camera looks along -z */
    int32_t pitch; /* around it upwards, el_angle as a signed number, within a quarter turn: it looks down where it is
                              positive */
    int32_t least_pitch; /* its limits for el_orbit_camera_turn ... */
    int32_t most_pitch;
    uint32_t least_distance_q16; /* ... and for el_orbit_camera_zoom */
    uint32_t most_distance_q16;
} el_orbit_camera;

/* At `distance_q16` from `target_q16`, level, with limits of a quarter turn less EL_DEGREES(1, 1), a sixteenth and 16 times
 * the distance, 2^30 at most. */
el_orbit_camera el_orbit_camera_at(const int32_t target_q16[3], uint32_t distance_q16);

/* Turns it by the two angles, which may be negative, within its limits. */
void el_orbit_camera_turn(el_orbit_camera *orbit, int32_t yaw, int32_t pitch);

/* Divides the distance by 2^(zoom / 256), within its limits. |zoom_q8| <= EL_ORBIT_MAX_ZOOM_Q8; what is more counts as
 * that. Rounded to 2^-16 units. */
void el_orbit_camera_zoom(el_orbit_camera *orbit, int32_t zoom_q8);

/* Moves the target, and the camera with it, across the picture by so many 1/256 of the distance; to the world's edge at
 * most. */
void el_orbit_camera_pan(el_orbit_camera *orbit, int32_t right_q8, int32_t up_q8);

/* Moves the target, and the camera with it, on the level: into the picture and to its right, in Q16 units, whatever the
 * pitch; to the world's edge at most. */
void el_orbit_camera_walk(el_orbit_camera *orbit, int32_t forward_q16, int32_t right_q16);

/* Places `camera` and turns it; its other members stay, also an orthographic picture's height. At the world's edge it goes
 * no further. */
void el_orbit_camera_place(const el_orbit_camera *orbit, el_camera *camera);

#ifdef __cplusplus
}
#endif

#endif
