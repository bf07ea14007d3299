/* An attitude indicator: sky, earth and a ladder as polygons under a model of the aircraft, and text over it.
 *
 * Both layers are asked for each band; what is in three dimensions is drawn between them. */
#include "example.h"

#include "paint/fonts/aileron_13.h"

enum { X = EL_SUB(EXAMPLE_WIDTH / 2), Y = EL_SUB(EXAMPLE_HEIGHT / 2), FAR = EL_SUB(400), DEGREE = EL_SUB(4) };
enum { SKY = 0x3D1F, EARTH = 0x8A84, WHITE = 0xFFFF };

static uint8_t memory[EL_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT, EXAMPLE_BAND, 6, 8, 1)];
static uint8_t edges[EL_POLYGON_BYTES(8, EXAMPLE_WIDTH)];
static el_renderer renderer;
static el_camera camera = {.fov_y = EL_DEGREES(30, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 40 * EL_UNIT_Q16};
static int32_t bank_q30[2]; /* sine and cosine of the bank */
static int32_t pitch;       /* of the nose above the horizon, as DEGREE has it */

/* Nose, tail, wing tips, fin and belly, in quarters of a unit. */
static const int16_t corners[6][3] = {{0, 0, -10}, {0, 0, 8}, {-14, 0, 4}, {14, 0, 4}, {0, 6, 8}, {0, -2, 2}};
static const uint16_t faces[6][3] = {{0, 2, 1}, {0, 1, 3}, {0, 5, 2}, {0, 3, 5}, {0, 4, 1}, {2, 5, 3}};
static const uint8_t colours[6][3] = {{250, 200, 40}, {220, 170, 30},  {150, 110, 20},
                                      {130, 95, 15},  {240, 240, 240}, {110, 80, 10}};
static const el_mesh aircraft = {.positions = corners,
                                 .triangles = faces,
                                 .triangle_colours = colours,
                                 .vertex_count = 6,
                                 .triangle_count = 6,
                                 .scale_log2 = -2,
                                 .radius = 15};
static const el_material material = {.flags = EL_MATERIAL_TWO_SIDED};

/* Corner (x, y) of the horizon's frame, x along it and y down from the middle of the screen. */
static void add(el_polygon *p, int32_t x, int32_t y)
{
    const int64_t dx_q30 = (int64_t)x * bank_q30[1] - (int64_t)y * bank_q30[0];
    const int64_t dy_q30 = (int64_t)x * bank_q30[0] + (int64_t)y * bank_q30[1];
    el_polygon_line(p, X + (int32_t)(dx_q30 >> 30), Y + (int32_t)(dy_q30 >> 30));
}

static void box(const el_canvas *canvas, int32_t half, int32_t y, int32_t y_end, uint16_t colour)
{
    el_polygon p;
    el_polygon_begin(&p, edges, sizeof edges);
    add(&p, -half, y);
    add(&p, half, y);
    add(&p, half, y_end);
    add(&p, -half, y_end);
    (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_4, el_solid(colour));
}

static void draw_world(void *context, el_band *band)
{
    (void)context;
    const el_canvas canvas = el_canvas_of(band);
    el_canvas_fill(&canvas, canvas.clip, el_solid(SKY));
    box(&canvas, FAR, pitch, pitch + FAR, EARTH);
    for (int32_t degrees = -20; degrees <= 20; degrees += 5) {
        const int32_t y = pitch - degrees * DEGREE;
        box(&canvas, degrees == 0 ? FAR : EL_SUB(degrees % 10 == 0 ? 40 : 18), y - EL_SUB(1), y + EL_SUB(1), WHITE);
    }
}

static void draw_glass(void *context, el_band *band)
{
    (void)context;
    const el_canvas canvas = el_canvas_of(band);
    const char *const words = bank_q30[0] < 0 ? "LEFT WING UP" : "RIGHT WING UP";
    el_canvas_fill(&canvas, (el_rect){6, 8, 126, 28}, el_glaze(0, 130));
    el_canvas_text(&canvas, &aileron_13, 66, 22, EL_ALIGN_CENTRE, words, el_solid(WHITE));
}

static const el_layer under = {.draw = draw_world}, over = {.draw = draw_glass};

el_status example_setup(const example_screen *screen)
{
    static const int32_t eye[3] = {0, 3 * EL_UNIT_Q16, 18 * EL_UNIT_Q16}, up[3] = {0, 1, 0}, target[3] = {0, 0, 0};
    const el_status status = el_camera_look_at(&camera, eye, target, up);
    return status != EL_OK ? status
                           : el_init(&renderer, &(el_config){.width = EXAMPLE_WIDTH,
                                                             .height = EXAMPLE_HEIGHT,
                                                             .band_lines = EXAMPLE_BAND,
                                                             .memory = memory,
                                                             .memory_bytes = sizeof memory,
                                                             .under = &under,
                                                             .over = &over,
                                                             .sinks = {screen->sink}});
}

el_status example_frame(const example_input *input)
{
    const int32_t swing_q30 = el_sin_q30(input->ms * EL_DEGREES(40, 1000) + EL_DEGREES(35, 1));
    const el_angle bank = (el_angle)(((int64_t)EL_DEGREES(30, 1) * swing_q30) >> 30);
    bank_q30[0] = el_sin_q30(bank);
    bank_q30[1] = el_cos_q30(bank);
    pitch = (int32_t)((12 * (int64_t)DEGREE * el_cos_q30(input->ms * EL_DEGREES(25, 1000))) >> 30);
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Z, (el_angle)((int32_t)bank / 4));
    return example_show(&renderer, &camera, &aircraft, &pose, &material);
}
