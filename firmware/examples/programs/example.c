#include "example.h"

const el_light example_light = {
    .direction_q30 = {-520841137, 781261706, 520841137}, .ambient = 80, .diffuse = 190}; /* (-2, 3, 2) / sqrt(17) */

el_status example_show(el_renderer *renderer, const el_camera *camera, const el_mesh *mesh, const el_pose *pose,
                       const el_material *material)
{
    el_status status = el_frame_begin(renderer, camera);
    if (status != EL_OK) {
        return status;
    }
    do {
        status = el_draw(renderer, mesh, pose, material);
    } while (el_frame_next(renderer) > 0);
    return status;
}
