/* A product that somebody turns: a and d, w and s turn it, q and e go nearer and farther, a space takes the next
 * finish. A touch panel's drag is the same two calls with its pixels. */
#include "example.h"

#include "demo/meshes/teapot.h"
#include "paint/fonts/aileron_11.h"
#include "paint/fonts/aileron_22.h"

enum { FINISHES = 3, TURN = 178956971, NEARER_Q8 = 32 }; /* TURN is EL_DEGREES(15, 1) */

static uint8_t memory[EL_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT, EXAMPLE_BAND, 900, 900, 1)];
static uint8_t edges[EL_POLYGON_BYTES(EL_ROUND_EDGES(8), EXAMPLE_WIDTH)];
static el_renderer renderer;
static el_camera camera = {.fov_y = EL_DEGREES(40, 1), .near_q16 = EL_UNIT_Q16 / 2, .far_q16 = 40 * EL_UNIT_Q16};
static el_orbit_camera orbit;
static unsigned finish;

static const char *const names[FINISHES] = {"Copper", "Celadon", "Cobalt"};
static const uint8_t colours[FINISHES][3] = {{226, 146, 74}, {150, 200, 170}, {70, 110, 210}};

static void draw_caption(void *context, el_band *band)
{
    (void)context;
    const el_canvas canvas = el_canvas_of(band);
    el_canvas_text(&canvas, &aileron_22, 14, 32, EL_ALIGN_LEFT, "Teapot", el_solid(0xFFFF));
    el_canvas_text(&canvas, &aileron_11, 14, 50, EL_ALIGN_LEFT, names[finish], el_solid(0xBDF7));
    for (int32_t i = 0; i < FINISHES; i++) {
        const int32_t x = EXAMPLE_WIDTH - 28 * (FINISHES - i), y = EXAMPLE_HEIGHT - 20;
        if (!el_canvas_sees(&canvas, (el_rect){x - 10, y - 10, x + 10, y + 10})) {
            continue;
        }
        for (int32_t radius = i == (int32_t)finish ? 9 : 7; radius >= 7; radius -= 2) { /* the chosen one has a ring */
            const uint8_t *const c = colours[i];
            el_polygon p;
            el_polygon_begin(&p, edges, sizeof edges);
            el_polygon_ellipse(&p, EL_SUB(x), EL_SUB(y), EL_SUB(radius), EL_SUB(radius));
            (void)el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SMOOTH_8,
                                  el_solid(radius == 9 ? 0xFFFF : el_rgb565(c[0], c[1], c[2])));
        }
    }
}

static const el_layer over = {.draw = draw_caption};

el_status example_setup(const example_screen *screen)
{
    orbit = el_orbit_camera_at((const int32_t[]){0, 0, 0}, 9 * EL_UNIT_Q16);
    el_orbit_camera_turn(&orbit, TURN, TURN);
    return el_init(&renderer, &(el_config){.width = EXAMPLE_WIDTH,
                                           .height = EXAMPLE_HEIGHT,
                                           .band_lines = EXAMPLE_BAND,
                                           .background = el_rgb565(28, 30, 36),
                                           .memory = memory,
                                           .memory_bytes = sizeof memory,
                                           .over = &over,
                                           .sinks = {screen->sink}});
}

el_status example_frame(const example_input *input)
{
    const char key = input->key;
    el_orbit_camera_turn(&orbit,
                         key == 'a'   ? -TURN
                         : key == 'd' ? TURN
                                      : 0,
                         key == 's'   ? -TURN
                         : key == 'w' ? TURN
                                      : 0);
    el_orbit_camera_zoom(&orbit, key == 'q' ? NEARER_Q8 : key == 'e' ? -NEARER_Q8 : 0);
    el_orbit_camera_place(&orbit, &camera);
    finish = (finish + (key == ' ')) % FINISHES;
    const uint8_t *const c = colours[finish];
    static el_material material; /* it has to stay until the frame is done */
    material = (el_material){.shading = EL_SHADE_GOURAUD, .colour = {c[0], c[1], c[2]}, .light = &example_light};
    const el_pose pose = el_pose_identity();
    return example_show(&renderer, &camera, &teapot, &pose, &material);
}
