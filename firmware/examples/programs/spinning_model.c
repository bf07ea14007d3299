/* A model of your own, turning: `edgeline convert FILE -o my_model.h` makes the header, and CMake's
 * -DEDGELINE_EXAMPLE_MODEL names it. Without that it is a gem.
 *
 * Whatever its units and its middle are, the pose makes a model of radius 1 about the origin of it. */
#include "example.h"

#include EXAMPLE_MODEL_FILE /* EXAMPLE_MODEL is its mesh */

enum { LIST_TRIANGLES = 1000, LIST_VERTICES = 1000 }; /* that one pass has room for; more take more passes */

static uint8_t memory[EL_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT, EXAMPLE_BAND, LIST_VERTICES, LIST_TRIANGLES, 1)];
static el_renderer renderer;
static el_camera camera = {.fov_y = EL_DEGREES(40, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 8 * EL_UNIT_Q16};
static el_material material = {.colour = {226, 146, 74}};

el_status example_setup(const example_screen *screen)
{
    static const el_mesh *const mesh = &EXAMPLE_MODEL;
#ifdef EXAMPLE_TEXTURE
    material.texture = &EXAMPLE_TEXTURE;
    material.shading = EL_SHADE_TEXTURED;
#else
    material.shading = mesh->colours != NULL || mesh->normals != NULL ? EL_SHADE_GOURAUD : EL_SHADE_FLAT;
#endif
    material.light = mesh->normals != NULL && material.shading != EL_SHADE_TEXTURED ? &example_light : NULL;
    const el_orbit_camera orbit = el_orbit_camera_at((const int32_t[]){0, 0, 0}, 32 * (EL_UNIT_Q16 / 10));
    el_orbit_camera_place(&orbit, &camera);
    return el_init(&renderer, &(el_config){.width = EXAMPLE_WIDTH,
                                           .height = EXAMPLE_HEIGHT,
                                           .band_lines = EXAMPLE_BAND,
                                           .background = el_rgb565(16, 20, 32),
                                           .memory = memory,
                                           .memory_bytes = sizeof memory,
                                           .sinks = {screen->sink}});
}

/* 1 over the mesh's radius, and its middle at the origin. */
static void fit(const el_mesh *mesh, el_pose *pose)
{
    const int8_t scale = mesh->scale_log2;
    const uint64_t one_q16 = EL_UNIT_Q16;
    const uint64_t unit_q16 = scale <= 0 ? one_q16 << -scale : one_q16 >> scale; /* scale is -30 to 8 */
    const uint32_t radius = mesh->radius > 0 ? mesh->radius : 1;
    const uint64_t scale_q16 = unit_q16 / radius;
    pose->scale_q16 = scale_q16 == 0 ? 1 : scale_q16 > UINT32_MAX ? UINT32_MAX : (uint32_t)scale_q16;
    for (unsigned row = 0; row < 3; row++) {
        int64_t sum_q30 = 0; /* of three products below 2^45 */
        for (unsigned i = 0; i < 3; i++) {
            sum_q30 += (int64_t)pose->rotation_q30[row][i] * mesh->centre[i];
        }
        pose->position_q16[row] = (int32_t)(-(sum_q30 >> 14) / (int64_t)radius);
    }
}

el_status example_frame(const example_input *input)
{
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(20, 1));
    el_pose_turn(&pose, EL_AXIS_Y, input->ms * (EL_DEGREES(45, 1000)));
    fit(&EXAMPLE_MODEL, &pose);
    return example_show(&renderer, &camera, &EXAMPLE_MODEL, &pose, &material);
}
