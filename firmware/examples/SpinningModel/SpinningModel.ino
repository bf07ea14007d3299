/* A cut stone in the light, on an ST7789 of 240x240. Its mesh, gem.h, is made of gem.obj:
 *
 *     edgeline convert gem.obj -o gem.h --crease 0
 *
 * Do the same with a model of your own, and give its counts to EL_MEMORY_BYTES. Wiring: SCK and MOSI (SDA) of the
 * board's SPI, and the pins below; the clock is what short wires carry. */
#include <edgeline.h>
#include <edgeline_arduino.hpp>
#include <panel/st7789.h>
#include <panel/tft.h>

#include "gem.h"

enum { DC_PIN = 9, CS_PIN = 10, RESET_PIN = 8 };
enum { WIDTH = 240, HEIGHT = 240, BAND_LINES = 8 };
enum { VERTICES = sizeof gem_positions / sizeof gem_positions[0] };
enum { TRIANGLES = sizeof gem_triangles / sizeof gem_triangles[0] };

EdgelineBus bus(SPI, 40000000, DC_PIN, CS_PIN, RESET_PIN);
el_tft panel;
el_sink display;
el_renderer renderer;
uint8_t memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, BAND_LINES, VERTICES, TRIANGLES, 1)];

/* From the upper left, in front: (-2, 3, 2) / sqrt(17), Q2.30. */
const el_light light = {{-520841137, 781261706, 520841137}, 70, 185};
el_material material;
el_camera camera;
el_pose pose;

/* What the configuration cannot have is said where the board's messages go. */
void must(bool good)
{
    while (!good) {
        Serial.println("Edgeline: impossible configuration");
        delay(1000);
    }
}

void setup()
{
    Serial.begin(115200);
    bus.begin();
    el_tft_config tft = {};
    tft.bus = bus.bus();
    tft.model = &el_st7789_240x240;
    must(el_tft_init(&panel, &tft) == EL_OK);
    display = el_tft_sink(&panel);

    el_config config = {};
    config.width = WIDTH;
    config.height = HEIGHT;
    config.band_lines = BAND_LINES;
    config.memory = memory;
    config.memory_bytes = sizeof memory;
    config.sinks[0] = &display;
    must(el_init(&renderer, &config) == EL_OK);

    material.shading = EL_SHADE_GOURAUD;
    material.light = &light;

    const int32_t eye[3] = {0, EL_UNIT_Q16, 3 * EL_UNIT_Q16}, middle[3] = {0, 0, 0}, up[3] = {0, EL_UNIT_Q16, 0};
    camera.fov_y = EL_DEGREES(45, 1);
    camera.near_q16 = EL_UNIT_Q16;
    camera.far_q16 = 8 * EL_UNIT_Q16;
    must(el_camera_look_at(&camera, eye, middle, up) == EL_OK);
    pose = el_pose_identity();
}

void loop()
{
    must(el_frame_begin(&renderer, &camera) == EL_OK);
    do {
        el_draw(&renderer, &gem, &pose, &material);
    } while (el_frame_next(&renderer) > 0);
    el_pose_turn(&pose, EL_AXIS_Y, EL_DEGREES(2, 1));
}
