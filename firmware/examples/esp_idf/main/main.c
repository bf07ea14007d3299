/* A triangle that turns, on an ST7789 of 240x240. Pins: bus.c. */
#include "bus.h"
#include "edgeline.h"
#include "freertos/FreeRTOS.h"
#include "freertos/task.h"
#include "panel/st7789.h"
#include "panel/tft.h"

enum { WIDTH = 240, HEIGHT = 240, BAND_LINES = 8 };

static const int16_t corners[][3] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
static const uint8_t colours[][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
static const uint16_t faces[][3] = {{0, 1, 2}};
static const el_mesh triangle = {
    .positions = corners, .colours = colours, .triangles = faces, .vertex_count = 3, .triangle_count = 1, .radius = 2};
static const el_material material = {.shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_TWO_SIDED};

static uint8_t memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, BAND_LINES, 3, 1, 1)];

/* What the configuration cannot have is found out at the first start: see the status in the debugger. */
static void must(bool good)
{
    while (!good) {
        vTaskDelay(1);
    }
}

void app_main(void)
{
    static el_tft panel;
    static el_renderer renderer;
    static const int32_t eye[3] = {0, 0, 3 * EL_UNIT_Q16}, middle[3], up[3] = {0, EL_UNIT_Q16, 0};
    const el_bus *const bus = bus_start(2 * WIDTH * BAND_LINES);

    must(el_tft_init(&panel, &(el_tft_config){.bus = bus, .model = &el_st7789_240x240}) == EL_OK);
    const el_sink display = el_tft_sink(&panel);
    must(el_init(&renderer, &(el_config){.width = WIDTH,
                                         .height = HEIGHT,
                                         .band_lines = BAND_LINES,
                                         .memory = memory,
                                         .memory_bytes = sizeof memory,
                                         .sinks = {&display}}) == EL_OK);
    el_camera camera = {.fov_y = EL_DEGREES(45, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 10 * EL_UNIT_Q16};
    must(el_camera_look_at(&camera, eye, middle, up) == EL_OK);
    el_pose pose = el_pose_identity();
    for (;;) {
        must(el_frame_begin(&renderer, &camera) == EL_OK);
        do {
            el_draw(&renderer, &triangle, &pose, &material); /* asked again only when the frame needs another pass */
        } while (el_frame_next(&renderer) > 0);
        el_pose_turn(&pose, EL_AXIS_Y, EL_DEGREES(3, 1));
        vTaskDelay(1); /* other tasks, and the watchdog's among them, get their turn */
    }
}
