/* A menu over a scene in three dimensions: w and s move, a space chooses. The scene goes on behind glass. */
#include "example.h"

#include "demo/meshes/solid.h"
#include "paint/fonts/aileron_13.h"

enum { ENTRIES = 4, WIDTH = 150, LINE = 28, LEFT = (EXAMPLE_WIDTH - WIDTH) / 2 };
enum { TOP = (EXAMPLE_HEIGHT - ENTRIES * LINE) / 2, WHITE = 0xFFFF, DARK = 0x10A3 };

static uint8_t memory[EL_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT, EXAMPLE_BAND, 180, 116, 1)];
static uint8_t edges[EL_POLYGON_BYTES(EL_ROUND_EDGES(10) + 4, EXAMPLE_WIDTH)];
static el_renderer renderer;
static el_camera camera = {.fov_y = EL_DEGREES(40, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 10 * EL_UNIT_Q16};
static int32_t at, chosen;

static const char *const entries[ENTRIES] = {"Turn slowly", "Turn fast", "Stand still", "By night"};
static const el_angle speeds[ENTRIES] = {EL_DEGREES(20, 1000), EL_DEGREES(90, 1000), 0, EL_DEGREES(20, 1000)};
static const uint16_t skies[ENTRIES] = {0x7DDD, 0x7DDD, 0x7DDD, DARK};
static const el_material material = {.shading = EL_SHADE_FLAT, .light = &example_light};

static void plate(const el_canvas *canvas, el_rect rect, el_paint paint)
{
    if (el_canvas_sees(canvas, rect)) {
        el_polygon p;
        el_polygon_begin(&p, edges, sizeof edges);
        el_polygon_rectangle(&p, EL_SUB(rect.x), EL_SUB(rect.y), EL_SUB(rect.x_end), EL_SUB(rect.y_end), EL_SUB(10));
        (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_4, paint);
    }
}

static void draw_menu(void *context, el_band *band)
{
    (void)context;
    const el_canvas canvas = el_canvas_of(band);
    plate(&canvas, (el_rect){LEFT - 8, TOP - 8, LEFT + WIDTH + 8, TOP + ENTRIES * LINE + 8}, el_glaze(DARK, 170));
    for (int32_t i = 0; i < ENTRIES; i++) {
        const int32_t y = TOP + i * LINE;
        if (i == at) {
            plate(&canvas, (el_rect){LEFT, y, LEFT + WIDTH, y + LINE}, el_glaze(WHITE, 210));
        }
        const el_paint paint = el_solid(i == at ? DARK : WHITE);
        el_canvas_text(&canvas, &aileron_13, LEFT + 28, (int16_t)(y + 19), EL_ALIGN_LEFT, entries[i], paint);
        if (i == chosen) {
            el_canvas_fill(&canvas, (el_rect){LEFT + 12, y + 11, LEFT + 18, y + 17}, paint);
        }
    }
}

static const el_layer over = {.draw = draw_menu};

el_status example_setup(const example_screen *screen)
{
    const el_orbit_camera orbit = el_orbit_camera_at((const int32_t[]){0, 0, 0}, 33 * EL_UNIT_Q16 / 10);
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
    static el_angle angle;
    static uint32_t before_ms;
    at = (at + (input->key == 's') + (input->key == 'w') * (ENTRIES - 1)) % ENTRIES;
    chosen = input->key == ' ' ? at : chosen;
    angle += (input->ms - before_ms) * speeds[chosen];
    before_ms = input->ms;
    renderer.config.background = skies[chosen]; /* may be changed between frames */
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(25, 1));
    el_pose_turn(&pose, EL_AXIS_Y, angle);
    return example_show(&renderer, &camera, &solid, &pose, &material);
}
