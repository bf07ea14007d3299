#include "geometry/pose.h"

#include "base/fixed.h"
#include "geometry/vector.h"

el_pose el_pose_identity(void)
{
    return (el_pose){
        .rotation_q30 = {{EL_UNIT_Q30, 0, 0}, {0, EL_UNIT_Q30, 0}, {0, 0, EL_UNIT_Q30}},
        .scale_q16 = EL_UNIT_Q16,
    };
}

bool el_determinant_is_negative(const int32_t m[3][3], unsigned dropped)
{
    int64_t determinant = 0;
    for (unsigned j = 0; j < 3; j++) {
        const unsigned k = j < 2 ? j + 1U : 0U;
        const unsigned l = j > 0 ? j - 1U : 2U;
        const int64_t minor =
            (int64_t)(m[1][k] >> dropped) * (m[2][l] >> dropped) - (int64_t)(m[1][l] >> dropped) * (m[2][k] >> dropped);
        determinant += (m[0][j] >> dropped) * minor;
    }
    return determinant < 0;
}

int64_t el_dot_column(const int32_t v[3], const int32_t m[3][3], unsigned column)
{
    int64_t sum = 0;
    for (unsigned i = 0; i < 3; i++) {
        sum += (int64_t)v[i] * m[i][column];
    }
    return sum;
}

void el_pose_turn(el_pose *pose, el_axis axis, el_angle angle)
{
    const int64_t sine = el_sin_q30(angle);
    const int64_t cosine = el_cos_q30(angle);
    const unsigned j = ((unsigned)axis + 1U) % 3U;
    const unsigned k = ((unsigned)axis + 2U) % 3U;
    for (unsigned i = 0; i < 3; i++) {
        const int64_t a = pose->rotation_q30[i][j];
        const int64_t b = pose->rotation_q30[i][k];
        pose->rotation_q30[i][j] = el_clamp_unit(el_shift_i64(a * cosine + b * sine, 30));
        pose->rotation_q30[i][k] = el_clamp_unit(el_shift_i64(b * cosine - a * sine, 30));
    }
}

el_status el_camera_look_at(el_camera *camera, const int32_t eye_q16[3], const int32_t target_q16[3],
                            const int32_t up_q16[3])
{
    const int64_t towards_eye[3] = {(int64_t)eye_q16[0] - target_q16[0], (int64_t)eye_q16[1] - target_q16[1],
                                    (int64_t)eye_q16[2] - target_q16[2]};
    const int64_t up[3] = {up_q16[0], up_q16[1], up_q16[2]};
    int32_t right_q30[3];
    int32_t up_q30[3];
    int32_t back_q30[3];
    int64_t product[3];
    if (el_vector_normalise(towards_eye, 3, back_q30) == 0 || el_vector_normalise(up, 3, up_q30) == 0) {
        return EL_ERROR_CAMERA;
    }
    el_vector_cross(up_q30, back_q30, product);
    if (el_vector_normalise(product, 3, right_q30) < EL_DIRECTION_BITS) {
        return EL_ERROR_CAMERA;
    }
    el_vector_cross(back_q30, right_q30, product);
    (void)el_vector_normalise(product, 3, up_q30);
    for (unsigned i = 0; i < 3; i++) {
        camera->axes_q30[0][i] = right_q30[i];
        camera->axes_q30[1][i] = up_q30[i];
        camera->axes_q30[2][i] = back_q30[i];
        camera->position_q16[i] = eye_q16[i];
    }
    return EL_OK;
}
