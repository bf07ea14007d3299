/* Everything is done in 64 bits and cut to the camera's limits (geometry/pose.h) at the end. */
#include "geometry/orbit.h"

#include <string.h>

#include "base/fixed.h"

/* geometry/pose.h's limits of a camera. */
enum { LEAST_NEAR_Q16 = 16, LEAST_HEIGHT_Q16 = 256, WORLD_Q16 = 1 << 30 };
/* A way that leaves the world from anywhere in it; times an axis, which is at most 2^31 where it is none, it is below 2^63. */
#define FAR_AWAY_Q16 (4LL * WORLD_Q16 - 1)
#define MOST_HEIGHT_Q16 (2U * WORLD_Q16)

static uint64_t clamp_u64(uint64_t value, uint64_t least, uint64_t most)
{
    return value < least ? least : (value > most ? most : value);
}

static int64_t clamp_i64(int64_t value, int64_t least, int64_t most)
{
    return value < least ? least : (value > most ? most : value);
}

/* 2^(x / 256) as a Q26, 2^22 to 2^30; |x| <= 1024. The roots of 2 whose product it is are made on the way. */
static uint32_t power_of_2_q26(int32_t x_q8)
{
    uint64_t power_q30 = 1ULL << 30;
    uint64_t root_q30 = 1ULL << 31;
    for (uint32_t bit = 128; bit != 0; bit >>= 1) {
        root_q30 = el_sqrt_u64(root_q30 << 30);
        if (((uint32_t)x_q8 & bit) != 0) {
            power_q30 = power_q30 * root_q30 >> 30;
        }
    }
    return (uint32_t)(power_q30 >> (4 - (x_q8 >> 8)));
}

/* value < 2^34 */
static uint64_t times_q26(uint64_t value, uint32_t factor_q26)
{
    return value * factor_q26 >> 26;
}

uint32_t el_orbit_focus_q16(const el_camera *camera)
{
    uint64_t distance_q46 = 0; /* three products of 2^30 * 2^30; modulo 2^64 where the camera is none */
    for (unsigned i = 0; i < 3; i++) {
        distance_q46 += (uint64_t)((int64_t)camera->position_q16[i] * camera->axes_q30[2][i]);
    }
    return (uint32_t)clamp_i64((int64_t)distance_q46 >> 30,
                               (int64_t)el_min_i32((int32_t)camera->near_q16, WORLD_Q16 / 2) * 2,
                               el_max_i32((int32_t)camera->far_q16, LEAST_NEAR_Q16));
}

static void transpose(int32_t to[3][3], const int32_t from[3][3])
{
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            to[i][j] = from[j][i];
        }
    }
}

/* The camera's pose has its axes as columns: to turn it about its own axis is what el_pose_turn does. Its rows are the
 * world's axes as the camera sees them, and to turn the camera about y one way is to turn the world the other way. */
static void turn(el_camera *camera, el_angle yaw, el_angle pitch)
{
    el_pose pose = el_pose_identity();
    if (pitch != 0) {
        transpose(pose.rotation_q30, (const int32_t(*)[3])camera->axes_q30);
        el_pose_turn(&pose, EL_AXIS_X, 0U - pitch);
        transpose(camera->axes_q30, (const int32_t(*)[3])pose.rotation_q30);
    }
    if (yaw != 0) {
        memcpy(pose.rotation_q30, camera->axes_q30, sizeof pose.rotation_q30);
        el_pose_turn(&pose, EL_AXIS_Y, 0U - yaw);
        memcpy(camera->axes_q30, pose.rotation_q30, sizeof camera->axes_q30);
    }
}

/* What the scene shows lies between near and far, seen from its own distance. From a longer one, all lengths grow alike;
 * from a shorter one it may reach as far as before. */
static void move_planes(el_camera *camera, uint32_t scale_q26)
{
    const uint64_t far_q16 = times_q26(camera->far_q16, scale_q26);
    camera->far_q16 = (uint32_t)clamp_u64(far_q16, camera->far_q16, WORLD_Q16);
    /* far is at least 9/8 of near, also where it was cut and both were rounded. */
    const uint32_t most_q16 = camera->far_q16 - camera->far_q16 / 8;
    camera->near_q16 = (uint32_t)clamp_u64(times_q26(camera->near_q16, scale_q26), LEAST_NEAR_Q16, most_q16);
}

/* From a place by three ways along the axes, as far as the world goes. */
static void move(const int64_t from_q16[3], const int32_t axes_q30[3][3], const int64_t ways_q16[3],
                 int32_t position_q16[3])
{
    for (unsigned i = 0; i < 3; i++) {
        int64_t place_q16 = from_q16[i];
        for (unsigned axis = 0; axis < 3; axis++) {
            place_q16 += clamp_i64(ways_q16[axis], -FAR_AWAY_Q16, FAR_AWAY_Q16) * axes_q30[axis][i] >> 30;
        }
        position_q16[i] = (int32_t)clamp_i64(place_q16, -WORLD_Q16, WORLD_Q16);
    }
}

void el_orbit_apply(const el_orbit *orbit, uint32_t focus_q16, el_camera *camera)
{
    if (orbit->yaw == 0 && orbit->pitch == 0 && orbit->zoom_q8 == 0 && orbit->pan_q8[0] == 0 && orbit->pan_q8[1] == 0) {
        return;
    }
    const uint32_t scale_q26 = power_of_2_q26(-orbit->zoom_q8);
    const int64_t zoomed_q16 = (int64_t)times_q26(focus_q16, scale_q26); /* below 2^35 */
    int64_t away_q16 = focus_q16;
    int64_t place_q16[3];
    for (unsigned i = 0; i < 3; i++) {
        place_q16[i] = camera->position_q16[i] - (camera->axes_q30[2][i] * away_q16 >> 30);
    }
    turn(camera, orbit->yaw * 65536U, (uint32_t)(int32_t)orbit->pitch * 65536U);
    if (camera->projection == EL_ORTHOGRAPHIC) {
        camera->height_q16 =
            (uint32_t)clamp_u64(times_q26(camera->height_q16, scale_q26), LEAST_HEIGHT_Q16, MOST_HEIGHT_Q16);
    } else if (orbit->zoom_q8 != 0) {
        move_planes(camera, scale_q26);
        away_q16 = zoomed_q16;
    }
    const int64_t ways_q16[3] = {zoomed_q16 * orbit->pan_q8[0] >> 8, zoomed_q16 * orbit->pan_q8[1] >> 8, away_q16};
    move(place_q16, (const int32_t(*)[3])camera->axes_q30, ways_q16, camera->position_q16);
}

el_orbit_camera el_orbit_camera_at(const int32_t target_q16[3], uint32_t distance_q16)
{
    const int32_t most_pitch = (int32_t)EL_DEGREES(89, 1);
    return (el_orbit_camera){
        .target_q16 = {target_q16[0], target_q16[1], target_q16[2]},
        .distance_q16 = distance_q16,
        .least_pitch = -most_pitch,
        .most_pitch = most_pitch,
        .least_distance_q16 = distance_q16 / 16,
        .most_distance_q16 = (uint32_t)clamp_u64(16ULL * distance_q16, 0, WORLD_Q16),
    };
}

void el_orbit_camera_turn(el_orbit_camera *orbit, int32_t yaw, int32_t pitch)
{
    orbit->yaw += (uint32_t)yaw;
    orbit->pitch = (int32_t)clamp_i64((int64_t)orbit->pitch + pitch, orbit->least_pitch, orbit->most_pitch);
}

void el_orbit_camera_zoom(el_orbit_camera *orbit, int32_t zoom_q8)
{
    const int32_t octaves_q8 = (int32_t)clamp_i64(zoom_q8, -EL_ORBIT_MAX_ZOOM_Q8, EL_ORBIT_MAX_ZOOM_Q8);
    const uint64_t distance_q16 = times_q26(orbit->distance_q16, power_of_2_q26(-octaves_q8));
    orbit->distance_q16 = (uint32_t)clamp_u64(distance_q16, orbit->least_distance_q16, orbit->most_distance_q16);
}

void el_orbit_camera_pan(el_orbit_camera *orbit, int32_t right_q8, int32_t up_q8)
{
    el_camera camera;
    el_orbit_camera_place(orbit, &camera);
    const int64_t ways_q16[3] = {(int64_t)orbit->distance_q16 * right_q8 >> 8,
                                 (int64_t)orbit->distance_q16 * up_q8 >> 8, 0};
    const int64_t from_q16[3] = {orbit->target_q16[0], orbit->target_q16[1], orbit->target_q16[2]};
    move(from_q16, (const int32_t(*)[3])camera.axes_q30, ways_q16, orbit->target_q16);
}

void el_orbit_camera_walk(el_orbit_camera *orbit, int32_t forward_q16, int32_t right_q16)
{
    const el_orbit_camera level = {.yaw = orbit->yaw};
    el_camera camera;
    el_orbit_camera_place(&level, &camera);
    const int64_t ways_q16[3] = {right_q16, 0, -(int64_t)forward_q16};
    const int64_t from_q16[3] = {orbit->target_q16[0], orbit->target_q16[1], orbit->target_q16[2]};
    move(from_q16, (const int32_t(*)[3])camera.axes_q30, ways_q16, orbit->target_q16);
}

void el_orbit_camera_place(const el_orbit_camera *orbit, el_camera *camera)
{
    const el_pose identity = el_pose_identity();
    const int64_t from_q16[3] = {orbit->target_q16[0], orbit->target_q16[1], orbit->target_q16[2]};
    memcpy(camera->axes_q30, identity.rotation_q30, sizeof camera->axes_q30);
    turn(camera, orbit->yaw, (uint32_t)orbit->pitch);
    move(from_q16, (const int32_t(*)[3])camera->axes_q30, (const int64_t[3]){0, 0, orbit->distance_q16},
         camera->position_q16);
}
