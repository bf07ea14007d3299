/* Hello, triangle: the least that draws. It turns once in six seconds.
 *
 * A mesh, a pose, a camera, a renderer: `memory` is all that it takes, two bands of colour, one of depth and a list. */
#include "example.h"

static uint8_t memory[EL_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT, EXAMPLE_BAND, 3, 1, 1)];
static el_renderer renderer;
static el_camera camera = {
    .fov_y = EL_DEGREES(45, 1), .near_q16 = EL_UNIT_Q16 / 4, .far_q16 = 16 * EL_UNIT_Q16}; /* near and far plane */

static const int16_t corners[3][3] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
static const uint8_t colours[3][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
static const uint16_t faces[1][3] = {{0, 1, 2}}; /* counter-clockwise: this is its front */
static const el_mesh triangle = {.positions = corners,
                                 .colours = colours,
                                 .triangles = faces,
                                 .vertex_count = 3,
                                 .triangle_count = 1,
                                 .radius = 2}; /* of a sphere around it all, here about the origin */
static const el_material material = {.shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_TWO_SIDED};

el_status example_setup(const example_screen *screen)
{
    static const int32_t eye[3] = {0, 0, 4 * EL_UNIT_Q16}, target[3] = {0, 0, 0}, up[3] = {0, EL_UNIT_Q16, 0};
    const el_status status = el_camera_look_at(&camera, eye, target, up);
    return status != EL_OK ? status
                           : el_init(&renderer, &(el_config){.width = EXAMPLE_WIDTH,
                                                             .height = EXAMPLE_HEIGHT,
                                                             .band_lines = EXAMPLE_BAND,
                                                             .background = el_rgb565(16, 20, 32),
                                                             .memory = memory,
                                                             .memory_bytes = sizeof memory,
                                                             .sinks = {screen->sink}});
}

el_status example_frame(const example_input *input)
{
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Y, input->ms * (EL_DEGREES(60, 1000)));
    el_status status = el_frame_begin(&renderer, &camera);
    if (status != EL_OK) {
        return status;
    }
    do {
        status = el_draw(&renderer, &triangle, &pose, &material);
    } while (el_frame_next(&renderer) > 0); /* again only where memory asks for another pass */
    return status;
}
