/* A model of your own, turning: `edgeline convert FILE -o my_model.h` makes the header, and CMake's
 * -DEDGELINE_EXAMPLE_MODEL names it. Without that it is a gem.
 *
 * Each of the model's materials has a mesh of its own, with one unit and origin for all; what is blended comes last, as it
 * has to be drawn. Whatever that unit and the model's middle are, the pose makes a model of radius 1 about the origin. */
#include "example.h"

#include EXAMPLE_MODEL_FILE

/* EXAMPLE_MODEL_PARTS is PART(name) for each mesh of the file. */
#define PART(name) {.mesh = &(name), .material = &name##_material},
static const struct {
    const el_mesh *mesh;
    const el_material *material;
} parts[] = {EXAMPLE_MODEL_PARTS};

enum { PARTS = sizeof parts / sizeof parts[0] };
enum { TRIANGLES = 1000, VERTICES = 1000 }; /* that one pass has room for; more take more passes */

static uint8_t memory[EL_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT, EXAMPLE_BAND, VERTICES, TRIANGLES, PARTS)];
static el_renderer renderer;
static el_camera camera = {.fov_y = EL_DEGREES(40, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 8 * EL_UNIT_Q16};
static el_material materials[PARTS]; /* those of the file, in this program's light */

el_status example_setup(const example_screen *screen)
{
    for (unsigned i = 0; i < PARTS; i++) {
        materials[i] = *parts[i].material;
        if (parts[i].mesh->normals != NULL && materials[i].shading != EL_SHADE_TEXTURED) {
            materials[i].light = &example_light;
        }
    }
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

/* 1 over the radius of a ball around all parts, and its middle at the origin. */
static void fit(el_pose *pose)
{
    int32_t middle[3]; /* below 2^17, of the parts' unit: that of the box around their own balls */
    for (unsigned axis = 0; axis < 3; axis++) {
        int32_t low = INT32_MAX, high = INT32_MIN;
        for (unsigned i = 0; i < PARTS; i++) {
            const int32_t at = parts[i].mesh->centre[axis], radius = (int32_t)parts[i].mesh->radius;
            low = at - radius < low ? at - radius : low;
            high = at + radius > high ? at + radius : high;
        }
        middle[axis] = (low + high) / 2;
    }
    uint32_t radius = 1;
    for (unsigned i = 0; i < PARTS; i++) {
        uint64_t square = 0; /* of three distances below 2^18 */
        for (unsigned axis = 0; axis < 3; axis++) {
            const int64_t away = parts[i].mesh->centre[axis] - middle[axis];
            square += (uint64_t)(away * away);
        }
        const uint32_t reach = el_sqrt_u64(square) + parts[i].mesh->radius;
        radius = reach > radius ? reach : radius;
    }
    const int8_t scale = parts[0].mesh->scale_log2;
    const uint64_t one_q16 = EL_UNIT_Q16;
    const uint64_t unit_q16 = scale <= 0 ? one_q16 << -scale : one_q16 >> scale; /* scale is -30 to 8 */
    const uint64_t scale_q16 = unit_q16 / radius;
    pose->scale_q16 = scale_q16 == 0 ? 1 : scale_q16 > UINT32_MAX ? UINT32_MAX : (uint32_t)scale_q16;
    for (unsigned row = 0; row < 3; row++) {
        int64_t sum_q30 = 0; /* of three products below 2^47 */
        for (unsigned i = 0; i < 3; i++) {
            sum_q30 += (int64_t)pose->rotation_q30[row][i] * middle[i];
        }
        pose->position_q16[row] = (int32_t)(-(sum_q30 >> 14) / (int64_t)radius);
    }
}

el_status example_frame(const example_input *input)
{
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(20, 1));
    el_pose_turn(&pose, EL_AXIS_Y, input->ms * (EL_DEGREES(45, 1000)));
    fit(&pose);
    el_status status = el_frame_begin(&renderer, &camera);
    if (status != EL_OK) {
        return status;
    }
    do {
        for (unsigned i = 0; i < PARTS && status == EL_OK; i++) {
            status = el_draw(&renderer, parts[i].mesh, &pose, &materials[i]);
        }
    } while (el_frame_next(&renderer) > 0);
    return status;
}
