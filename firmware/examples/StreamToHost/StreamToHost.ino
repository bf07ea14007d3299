/* The same frames on a small OLED (SSD1306, 128x64) and on the PC, over the board's USB or Serial:
 *
 *     edgeline view
 *
 * shows them, each proven by its digest. Without a host the OLED goes on alone. Wiring: SCK (D0) and MOSI (D1) of the
 * board's SPI, and the pins below. */
#include <edgeline.h>
#include <edgeline_arduino.hpp>
#include <panel/ssd1306.h>
#include <stream/sink.h>

enum { WIDTH = 128, HEIGHT = 64, BAND_LINES = 8 };

EdgelineBus bus(SPI, 8000000, 9, 10, 8); /* pins of D/C, chip select, reset */
EdgelinePort port(Serial);
el_ssd1306 panel;
el_stream stream;
el_sink sinks[2];
el_renderer renderer;
uint8_t panel_memory[EL_SSD1306_MEMORY_BYTES(BAND_LINES)];
uint8_t stream_memory[EL_STREAM_MEMORY_BYTES(WIDTH, HEIGHT)];
uint8_t memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, BAND_LINES, 4, 4, 1)];

/* A tetrahedron. */
const int16_t corners[4][3] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
const uint8_t colours[4][3] = {{255, 255, 255}, {255, 64, 0}, {0, 160, 64}, {32, 32, 255}};
const uint16_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

el_mesh tetrahedron;
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
    el_ssd1306_config oled = {};
    oled.bus = bus.bus();
    oled.memory = panel_memory;
    oled.memory_bytes = sizeof panel_memory;
    must(el_ssd1306_init(&panel, &oled) == EL_OK);

    el_stream_config wire = {};
    wire.port = port.port();
    wire.width = WIDTH;
    wire.height = HEIGHT;
    wire.target = "Arduino";
    wire.firmware = "StreamToHost 1.0";
    wire.boot_id = micros();
    wire.memory = stream_memory;
    wire.memory_bytes = sizeof stream_memory;
    must(el_stream_init(&stream, &wire) == 0);

    sinks[0] = el_stream_sink(&stream); /* the panel comes last: some change a band's bytes */
    sinks[1] = el_ssd1306_sink(&panel);

    el_config config = {};
    config.width = WIDTH;
    config.height = HEIGHT;
    config.band_lines = BAND_LINES;
    config.memory = memory;
    config.memory_bytes = sizeof memory;
    config.sinks[0] = &sinks[0];
    config.sinks[1] = &sinks[1];
    must(el_init(&renderer, &config) == EL_OK);

    tetrahedron.positions = corners;
    tetrahedron.colours = colours;
    tetrahedron.triangles = faces;
    tetrahedron.vertex_count = 4;
    tetrahedron.triangle_count = 4;
    tetrahedron.radius = 2;
    material.shading = EL_SHADE_GOURAUD;
    const int32_t eye[3] = {2 * EL_UNIT_Q16, EL_UNIT_Q16, 4 * EL_UNIT_Q16}, middle[3] = {}, up[3] = {0, EL_UNIT_Q16, 0};
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
        el_draw(&renderer, &tetrahedron, &pose, &material);
    } while (el_frame_next(&renderer) > 0);
    el_pose_turn(&pose, EL_AXIS_Y, EL_DEGREES(5, 1));
}
