/* Draws the triangle of the sketch HelloTriangle and prints the CRC-32 of the picture's little-endian RGB565. */
#include <stdio.h>

#include "base/crc32.h"
#include "edgeline.h"

enum { WIDTH = 320, HEIGHT = 240, BAND_LINES = 8 };

static const int16_t corners[][3] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
static const uint8_t colours[][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
static const uint16_t faces[][3] = {{0, 1, 2}};
static const el_mesh mesh = {
    .positions = corners, .colours = colours, .triangles = faces, .vertex_count = 3, .triangle_count = 1, .radius = 2};
static uint8_t memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, BAND_LINES, 3, 1, 1)];

el_status turn(el_pose *pose);

static void begin(void *context, uint16_t width, uint16_t height)
{
    (void)width;
    (void)height;
    *(uint32_t *)context = 0;
}

static void rows(void *context, el_band *band, unsigned slot)
{
    uint32_t *const crc = context;
    for (size_t i = 0; i < (size_t)band->lines * band->width; i++) {
        const uint8_t bytes[2] = {(uint8_t)band->pixels[i], (uint8_t)(band->pixels[i] >> 8)};
        *crc = el_crc32(*crc, bytes, sizeof bytes);
    }
    el_band_release(band, slot);
}

static void end(void *context, const el_stats *stats)
{
    (void)stats;
    printf("%08x\n", *(const uint32_t *)context);
}

int main(void)
{
    static const el_material material = {.shading = EL_SHADE_GOURAUD};
    static const int32_t eye[3] = {0, 0, 3 * EL_UNIT_Q16}, middle[3], up[3] = {0, EL_UNIT_Q16, 0};
    uint32_t crc;
    const el_sink sink = {.context = &crc, .begin = begin, .rows = rows, .end = end};
    const el_config config = {.width = WIDTH,
                              .height = HEIGHT,
                              .band_lines = BAND_LINES,
                              .memory = memory,
                              .memory_bytes = sizeof memory,
                              .sinks = {&sink}};
    el_camera camera = {.fov_y = EL_DEGREES(45, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 10 * EL_UNIT_Q16};
    el_pose pose = el_pose_identity();
    el_renderer renderer;
    if (turn(&pose) != EL_OK || el_camera_look_at(&camera, eye, middle, up) != EL_OK ||
        el_init(&renderer, &config) != EL_OK || el_frame_begin(&renderer, &camera) != EL_OK) {
        return 1;
    }
    int more;
    do {
        if (el_draw(&renderer, &mesh, &pose, &material) != EL_OK) {
            return 1;
        }
        more = el_frame_next(&renderer);
    } while (more > 0);
    return more == 0 ? 0 : 1;
}
