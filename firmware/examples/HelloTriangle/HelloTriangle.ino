/* A triangle that turns, on an ILI9341 of 320x240 in landscape.
 *
 * Wiring: SCK and MOSI (SDI) of the board's SPI, and the pins below. For another display change `el_ili9341`
 * (el_st7789, el_st7789_240x240, el_st7735), WIDTH and HEIGHT; for one that is mounted otherwise, the rotation. */
#include <edgeline.h>
#include <edgeline_arduino.hpp>
#include <panel/ili9341.h>
#include <panel/tft.h>

enum { DC_PIN = 9, CS_PIN = 10, RESET_PIN = 8 };
enum { WIDTH = 320, HEIGHT = 240, BAND_LINES = 8 };

EdgelineBus bus(SPI, 24000000, DC_PIN, CS_PIN, RESET_PIN);
el_tft panel;
el_sink display;
el_renderer renderer;
uint8_t memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, BAND_LINES, 3, 1, 1)]; /* 3 vertices, 1 triangle, 1 call of el_draw */

const int16_t corners[3][3] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
const uint8_t colours[3][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
const uint16_t faces[1][3] = {{0, 1, 2}};

el_mesh triangle;
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
    tft.model = &el_ili9341;
    tft.rotation = EL_ROTATION_90;
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

    triangle.positions = corners;
    triangle.colours = colours;
    triangle.triangles = faces;
    triangle.vertex_count = 3;
    triangle.triangle_count = 1;
    triangle.scale_log2 = 0; /* one unit of `corners` is one of the world */
    triangle.radius = 2;

    material.shading = EL_SHADE_GOURAUD;
    material.flags = EL_MATERIAL_TWO_SIDED;

    const int32_t eye[3] = {0, 0, 3 * EL_UNIT_Q16}, middle[3] = {0, 0, 0}, up[3] = {0, EL_UNIT_Q16, 0};
    camera.fov_y = EL_DEGREES(45, 1);
    camera.near_q16 = EL_UNIT_Q16;
    camera.far_q16 = 10 * EL_UNIT_Q16;
    must(el_camera_look_at(&camera, eye, middle, up) == EL_OK);
    pose = el_pose_identity();
}

void loop()
{
    must(el_frame_begin(&renderer, &camera) == EL_OK);
    do {
        el_draw(&renderer, &triangle, &pose, &material); /* asked again only when the frame needs another pass */
    } while (el_frame_next(&renderer) > 0);
    el_pose_turn(&pose, EL_AXIS_Y, EL_DEGREES(3, 1));
}
