/* Where things are: rotations, poses of models, and the camera.
 *
 * World space is right-handed. Positions are Q16.16 world units within +-16384; rotations are 3x3 matrices in Q2.30,
 * row by row, applied to column vectors. */
#ifndef EL_GEOMETRY_POSE_H
#define EL_GEOMETRY_POSE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/angle.h"
#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define EL_UNIT_Q16 65536
#define EL_UNIT_Q30 (1 << 30)

/* A model's place: world = rotation * (scale * model) + position. `rotation_q30` may be any matrix whose elements lie
 * within +-1; lighting assumes a rotation or a reflection. */
typedef struct el_pose {
    int32_t rotation_q30[3][3];
    int32_t position_q16[3];
    uint32_t scale_q16; /* 1 to 2^32 - 1 */
} el_pose;

/* Whether the determinant of m is negative, taken from its elements without their `dropped` lowest bits, at least 12 and such
 * that no more than 20 are left. */
bool el_determinant_is_negative(const int32_t m[3][3], unsigned dropped);

/* v * the matrix' column, |elements| such that the products' sum stays below 2^63. */
int64_t el_dot_column(const int32_t v[3], const int32_t m[3][3], unsigned column);

typedef enum el_axis { EL_AXIS_X, EL_AXIS_Y, EL_AXIS_Z } el_axis;

/* Unit rotation, the origin, scale 1. */
el_pose el_pose_identity(void);

/* Turns the model about its own axis, counter-clockwise seen from the axis' tip: rotation = rotation * R(axis). */
void el_pose_turn(el_pose *pose, el_axis axis, el_angle angle);

typedef enum el_projection { EL_PERSPECTIVE, EL_ORTHOGRAPHIC } el_projection;

/* The camera looks along its own -z, its y is up. Zeroed members mean what is said beside them. */
typedef struct el_camera {
    int32_t axes_q30[3][3]; /* rows: right, up and backward in world space; orthonormal */
    int32_t position_q16[3];
    el_projection projection;
    el_angle fov_y;      /* perspective: the whole vertical field of view, 1 to 179 degrees */
    uint32_t height_q16; /* orthographic: world units from the lower to the upper edge of the screen,
                            2^-8 to 2^15 */
    uint32_t aspect_q16; /* width / height of the picture, 2^-8 to 2^8; 0: that of the screen's pixels */
    uint32_t near_q16;   /* distance of the near plane, > 0, at least 2^-12 units */
    uint32_t far_q16;    /* distance of the far plane, at least 9/8 of near, at most 16384 units */
} el_camera;

/* Places the camera at `eye` with `target` in the middle of its picture and `up` (any length) upwards.
 * EL_ERROR_CAMERA when eye and target coincide or `up` points along the view; the camera is unchanged then. */
el_status el_camera_look_at(el_camera *camera, const int32_t eye_q16[3], const int32_t target_q16[3],
                            const int32_t up_q16[3]);

#ifdef __cplusplus
}
#endif

#endif
