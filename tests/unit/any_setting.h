/* Any mesh about a camera that is anywhere, for the tests of what is outside the view. */
#ifndef EL_TEST_ANY_SETTING_H
#define EL_TEST_ANY_SETTING_H

#include "geometry/transform.h"
#include "seeded.h"

typedef struct setting {
    el_camera camera;
    el_pose pose;
    el_mesh mesh;
} setting;

static inline void turn_freely(seeded *s, int32_t rotation_q30[3][3])
{
    el_pose pose = el_pose_identity();
    for (unsigned i = 0; i < 3; i++) {
        el_pose_turn(&pose, (el_axis)i, (el_angle)any_u64(s));
    }
    for (unsigned i = 0; i < 9; i++) {
        rotation_q30[i / 3][i % 3] = pose.rotation_q30[i / 3][i % 3];
    }
}

/* The two are up to `away_bits` bits of Q16 from each other, along each axis. */
static inline setting any_setting(seeded *s, unsigned away_bits)
{
    setting t = {.pose = el_pose_identity()};
    t.camera.projection = any_below(s, 4) == 0 ? EL_ORTHOGRAPHIC : EL_PERSPECTIVE;
    t.camera.fov_y = (el_angle)any_between(s, EL_DEGREES(1, 1), EL_DEGREES(179, 1));
    t.camera.height_q16 = (uint32_t)any_between(s, 256, 1 << 24);
    t.camera.near_q16 = 16 + (uint32_t)any_of_bits(s, 24);
    t.camera.far_q16 = t.camera.near_q16 * 2 + (uint32_t)any_of_bits(s, 29);
    turn_freely(s, t.camera.axes_q30);
    turn_freely(s, t.pose.rotation_q30);
    t.mesh = (el_mesh){.scale_log2 = (int8_t)any_between(s, -14, -4), .radius = (uint16_t)any_of_bits(s, 16)};
    t.pose.scale_q16 = 1 + (uint32_t)any_of_bits(s, 20);
    for (unsigned i = 0; i < 3; i++) {
        t.mesh.centre[i] = (int16_t)any_signed_of_bits(s, 15);
        t.camera.position_q16[i] = (int32_t)any_signed_of_bits(s, 29);
        t.pose.position_q16[i] = t.camera.position_q16[i] + (int32_t)any_signed_of_bits(s, away_bits);
    }
    return t;
}

#endif
