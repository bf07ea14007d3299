#include "geometry/pose.h"

#include "base/fixed.h"

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

/* Rounding may carry an element of a product of rotations a few units beyond 1; the pose's range ends there. */
static int32_t clamp_unit(int64_t value_q30)
{
    if (value_q30 > EL_UNIT_Q30) {
        return EL_UNIT_Q30;
    }
    return value_q30 < -EL_UNIT_Q30 ? -EL_UNIT_Q30 : (int32_t)value_q30;
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
        pose->rotation_q30[i][j] = clamp_unit(el_shift_i64(a * cosine + b * sine, 30));
        pose->rotation_q30[i][k] = clamp_unit(el_shift_i64(b * cosine - a * sine, 30));
    }
}

/* Scales v to length 1, Q30. False when it has none. */
static bool normalise(const int64_t v[3], int32_t unit_q30[3])
{
    uint64_t bits = 0;
    for (unsigned i = 0; i < 3; i++) {
        bits |= el_abs_u64(v[i]);
    }
    if (bits == 0) {
        return false;
    }
    /* 30 bits each: the sum of squares stays below 2^62. */
    const int shift = el_bit_length_u64(bits) - 30;
    int64_t scaled[3];
    uint64_t sum = 0;
    for (unsigned i = 0; i < 3; i++) {
        scaled[i] = el_shift_i64(v[i], shift);
        sum += (uint64_t)(scaled[i] * scaled[i]);
    }
    const int64_t length = el_sqrt_u64(sum);
    for (unsigned i = 0; i < 3; i++) {
        unit_q30[i] = clamp_unit((scaled[i] * EL_UNIT_Q30) / length);
    }
    return true;
}

static void cross(const int32_t a_q30[3], const int32_t b_q30[3], int64_t product[3])
{
    for (unsigned i = 0; i < 3; i++) {
        const unsigned j = (i + 1U) % 3U;
        const unsigned k = (i + 2U) % 3U;
        product[i] = (int64_t)a_q30[j] * b_q30[k] - (int64_t)a_q30[k] * b_q30[j];
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
    if (!normalise(towards_eye, back_q30) || !normalise(up, up_q30)) {
        return EL_ERROR_CAMERA;
    }
    cross(up_q30, back_q30, product);
    /* Shorter than 2^-20 of a unit vector, the cross product is rounding, not a direction. */
    if ((el_abs_u64(product[0]) | el_abs_u64(product[1]) | el_abs_u64(product[2])) < (1ULL << 40) ||
        !normalise(product, right_q30)) {
        return EL_ERROR_CAMERA;
    }
    cross(back_q30, right_q30, product);
    (void)normalise(product, up_q30);
    for (unsigned i = 0; i < 3; i++) {
        camera->axes_q30[0][i] = right_q30[i];
        camera->axes_q30[1][i] = up_q30[i];
        camera->axes_q30[2][i] = back_q30[i];
        camera->position_q16[i] = eye_q16[i];
    }
    return EL_OK;
}
