/* Two textured rooms to walk through: w and s go, a and d turn, q and e look up and down.
 *
 * The camera is an orbit without a distance, which walks. Walls are rectangles that nobody walks out of. */
#include "example.h"

#include "demo/meshes/room.h"

enum { EYES_Q16 = 14 * EL_UNIT_Q16 / 10, STEP_Q16 = EL_UNIT_Q16 / 8 };
enum { LIST_TRIANGLES = 400 };

static uint8_t memory[EL_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT, EXAMPLE_BAND, 400, LIST_TRIANGLES, 1)];
static el_renderer renderer;
static el_camera camera = {.fov_y = EL_DEGREES(65, 1), .near_q16 = EL_UNIT_Q16 / 10, .far_q16 = 20 * EL_UNIT_Q16};
static el_orbit_camera eyes;
static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &room_texture};

/* Where one may stand, in tenths of a unit: each room, and the doorway between them. */
static const int32_t free_q16[3][4] = {
    {-47 * EL_UNIT_Q16 / 10, -47 * EL_UNIT_Q16 / 10, 47 * EL_UNIT_Q16 / 10, -5 * EL_UNIT_Q16 / 10},
    {-47 * EL_UNIT_Q16 / 10, 5 * EL_UNIT_Q16 / 10, 47 * EL_UNIT_Q16 / 10, 47 * EL_UNIT_Q16 / 10},
    {-8 * EL_UNIT_Q16 / 10, -5 * EL_UNIT_Q16 / 10, 8 * EL_UNIT_Q16 / 10, 5 * EL_UNIT_Q16 / 10},
};

static bool is_free(const int32_t at_q16[3])
{
    for (unsigned i = 0; i < 3; i++) {
        if (at_q16[0] >= free_q16[i][0] && at_q16[2] >= free_q16[i][1] && at_q16[0] <= free_q16[i][2] &&
            at_q16[2] <= free_q16[i][3]) {
            return true;
        }
    }
    return false;
}

el_status example_setup(const example_screen *screen)
{
    eyes = el_orbit_camera_at((const int32_t[]){EL_UNIT_Q16 / 2, EYES_Q16, 4 * EL_UNIT_Q16}, 0);
    return el_init(&renderer, &(el_config){.width = EXAMPLE_WIDTH,
                                           .height = EXAMPLE_HEIGHT,
                                           .band_lines = EXAMPLE_BAND,
                                           .memory = memory,
                                           .memory_bytes = sizeof memory,
                                           .sinks = {screen->sink}});
}

static void move(char key)
{
    const el_orbit_camera before = eyes;
    switch (key) {
    case 'w':
    case 's':
        el_orbit_camera_walk(&eyes, key == 'w' ? STEP_Q16 : -STEP_Q16, 0);
        break;
    case 'a':
    case 'd':
        el_orbit_camera_turn(&eyes, (key == 'a' ? 1 : -1) * (int32_t)EL_DEGREES(5, 1), 0);
        break;
    case 'q':
    case 'e':
        el_orbit_camera_turn(&eyes, 0, (key == 'e' ? 1 : -1) * (int32_t)EL_DEGREES(5, 1));
        break;
    default:
        break;
    }
    if (!is_free(eyes.target_q16)) {
        eyes = before;
    }
}

el_status example_frame(const example_input *input)
{
    move(input->key);
    el_orbit_camera_place(&eyes, &camera);
    const el_pose pose = el_pose_identity();
    return example_show(&renderer, &camera, &room, &pose, &material);
}
