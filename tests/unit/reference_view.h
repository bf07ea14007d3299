/* Where a vertex lies, in long double, straight from the conventions of edgeline.h: an independent reference for the
 * integer transform. Shared by its tests. */
#ifndef EL_TEST_REFERENCE_VIEW_H
#define EL_TEST_REFERENCE_VIEW_H

#include <math.h>
#include <stdbool.h>

#include "geometry/transform.h"

/* x, y in pixels, y down; depth 0..EL_DEPTH_MAX; distance along the view in world units. */
typedef struct reference_point {
    long double x, y, depth, distance;
} reference_point;

/* A plain picture of 90 degrees height, from the origin along -z. */
static inline el_camera plain_camera(void)
{
    return (el_camera){
        .axes_q30 = {{EL_UNIT_Q30, 0, 0}, {0, EL_UNIT_Q30, 0}, {0, 0, EL_UNIT_Q30}},
        .projection = EL_PERSPECTIVE,
        .fov_y = EL_DEGREES(90, 1),
        .near_q16 = EL_UNIT_Q16,
        .far_q16 = 100 * EL_UNIT_Q16,
    };
}

static inline long double reference_tangent(el_angle fov)
{
    return tanl((long double)fov / 4294967296.0L * 3.14159265358979323846264338327950288L);
}

/* right, up, distance in world units. */
static inline void reference_view_space(const el_camera *camera, const el_mesh *mesh, const el_pose *pose,
                                        const int16_t p[3], long double view[3])
{
    long double relative[3];
    for (unsigned i = 0; i < 3; i++) {
        long double turned = 0;
        for (unsigned j = 0; j < 3; j++) {
            turned += (long double)pose->rotation_q30[i][j] / EL_UNIT_Q30 * p[j];
        }
        const long double world = turned * ldexpl((long double)pose->scale_q16 / 65536, mesh->scale_log2) +
                                  (long double)pose->position_q16[i] / 65536;
        relative[i] = world - (long double)camera->position_q16[i] / 65536;
    }
    for (unsigned i = 0; i < 3; i++) {
        view[i] = 0;
        for (unsigned j = 0; j < 3; j++) {
            view[i] += (long double)camera->axes_q30[i][j] / EL_UNIT_Q30 * relative[j];
        }
    }
    view[2] = -view[2];
}

/* Half the picture's size at distance 1 (perspective) or anywhere (orthographic), in world units. */
static inline void reference_half_size(const el_camera *camera, uint16_t width, uint16_t height, long double half[2])
{
    half[1] = camera->projection == EL_PERSPECTIVE ? reference_tangent(camera->fov_y)
                                                   : (long double)camera->height_q16 / 65536 / 2;
    half[0] =
        half[1] * (camera->aspect_q16 != 0 ? (long double)camera->aspect_q16 / 65536 : (long double)width / height);
}

static inline reference_point reference_project(const el_camera *camera, uint16_t width, uint16_t height,
                                                const el_mesh *mesh, const el_pose *pose, const int16_t p[3])
{
    long double view[3];
    long double half[2];
    reference_view_space(camera, mesh, pose, p, view);
    reference_half_size(camera, width, height, half);
    const bool perspective = camera->projection == EL_PERSPECTIVE;
    const long double w = perspective ? view[2] : 1;
    const long double near = (long double)camera->near_q16 / 65536;
    const long double far = (long double)camera->far_q16 / 65536;
    const long double linear = (view[2] - near) / (far - near);
    return (reference_point){
        .x = (1 + view[0] / (half[0] * w)) * width / 2,
        .y = (1 - view[1] / (half[1] * w)) * height / 2,
        .depth = EL_DEPTH_MAX * (perspective ? linear * far / view[2] : linear),
        .distance = view[2],
    };
}

#endif
