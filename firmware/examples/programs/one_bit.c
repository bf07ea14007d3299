/* On a display of single bits, an SSD1306 of 128x64 pixels: the driver dithers each band, the program draws as ever.
 *
 * There is no frame buffer here either: bands, a list of triangles, and two pages of 8 lines on their way. */
#include "example.h"

#include "demo/meshes/solid.h"
#include "paint/fonts/aileron_11.h"

static uint8_t memory[EL_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT, EXAMPLE_BAND, 180, 80, 1)];
static el_renderer renderer;
static el_camera camera = {.fov_y = EL_DEGREES(40, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 10 * EL_UNIT_Q16};
static const el_material material = {.shading = EL_SHADE_FLAT, .light = &example_light};

static void draw_text(void *context, el_band *band)
{
    (void)context;
    const el_canvas canvas = el_canvas_of(band);
    el_canvas_text(&canvas, &aileron_11, 2, 14, EL_ALIGN_LEFT, "Edgeline", el_solid(0xFFFF));
    el_canvas_text(&canvas, &aileron_11, 2, 28, EL_ALIGN_LEFT, "in 1 bit", el_solid(0xFFFF));
    el_canvas_line(&canvas, 2, 32, 44, 32, el_solid(0xFFFF));
}

static const el_layer over = {.draw = draw_text};

el_status example_setup(const example_screen *screen)
{
    /* To the left of the solid, which is right of the text then. */
    const el_orbit_camera orbit = el_orbit_camera_at((const int32_t[]){-EL_UNIT_Q16, 0, 0}, 3 * EL_UNIT_Q16);
    el_orbit_camera_place(&orbit, &camera);
    return el_init(&renderer, &(el_config){.width = EXAMPLE_WIDTH,
                                           .height = EXAMPLE_HEIGHT,
                                           .band_lines = EXAMPLE_BAND,
                                           .memory = memory,
                                           .memory_bytes = sizeof memory,
                                           .over = &over,
                                           .sinks = {screen->sink}});
}

el_status example_frame(const example_input *input)
{
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(25, 1));
    el_pose_turn(&pose, EL_AXIS_Y, input->ms * (EL_DEGREES(45, 1000)));
    return example_show(&renderer, &camera, &solid, &pose, &material);
}
