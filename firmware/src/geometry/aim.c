/* Each is a pair of directions, one of which is kept, and what stands across both. */
#include "geometry/aim.h"

#include "base/fixed.h"
#include "geometry/vector.h"

el_status el_pose_look_at(el_pose *pose, const int32_t target_q16[3], const int32_t up[3])
{
    /* A camera looks away from its backward axis: one at the target that looks at the model has the model's axes. */
    el_camera camera;
    if (el_camera_look_at(&camera, target_q16, pose->position_q16, up) != EL_OK) {
        return EL_ERROR_RANGE;
    }
    el_billboard_face(pose, &camera);
    return EL_OK;
}

void el_billboard_face(el_pose *pose, const el_camera *camera)
{
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            pose->rotation_q30[i][j] = camera->axes_q30[j][i];
        }
    }
}

el_status el_billboard_about(el_pose *pose, const el_camera *camera, const int32_t axis[3])
{
    int64_t towards[3];
    for (unsigned i = 0; i < 3; i++) {
        towards[i] = camera->projection == EL_ORTHOGRAPHIC ? camera->axes_q30[2][i]
                                                           : (int64_t)camera->position_q16[i] - pose->position_q16[i];
    }
    int32_t towards_q30[3];
    int32_t columns_q30[3][3];
    int64_t product[3];
    if (el_vector_normalise((const int64_t[3]){axis[0], axis[1], axis[2]}, 3, columns_q30[1]) == 0 ||
        el_vector_normalise(towards, 3, towards_q30) == 0) {
        return EL_ERROR_RANGE;
    }
    el_vector_cross(columns_q30[1], towards_q30, product);
    if (el_vector_normalise(product, 3, columns_q30[0]) < EL_DIRECTION_BITS) {
        return EL_ERROR_RANGE;
    }
    el_vector_cross(columns_q30[0], columns_q30[1], product);
    (void)el_vector_normalise(product, 3, columns_q30[2]);
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            pose->rotation_q30[i][j] = columns_q30[j][i];
        }
    }
    return EL_OK;
}
