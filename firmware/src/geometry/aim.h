/* Turning models: towards a point, and pictures on a quad towards the camera.
 *
 * A model looks along its own +z, as a quad in its own x and y does whose front is seen: a camera, which looks along -z, sees
 * a model that looks at it from the front. Position and scale stay as they are. */
#ifndef EL_GEOMETRY_AIM_H
#define EL_GEOMETRY_AIM_H

#include <stdint.h>

#include "base/status.h"
#include "geometry/pose.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Turns the model so that it looks at `target_q16` with `up` (any length) upwards. EL_ERROR_RANGE when the target is where
 * the model is, or `up` is zero or along the line between them; the pose is unchanged then. */
el_status el_pose_look_at(el_pose *pose, const int32_t target_q16[3], const int32_t up[3]);

/* A billboard: turns the model so that its x and y are the screen's. A quad is a rectangle on the screen then, wherever it
 * stands. */
void el_billboard_face(el_pose *pose, const el_camera *camera);

/* A billboard that stays upright: turns the model about `axis` alone (world space, any length), which its y then is, until
 * it faces the camera as much as it can. EL_ERROR_RANGE when the axis is zero or points at the camera, where all turns look
 * alike; the pose is unchanged then. */
el_status el_billboard_about(el_pose *pose, const el_camera *camera, const int32_t axis[3]);

#ifdef __cplusplus
}
#endif

#endif
