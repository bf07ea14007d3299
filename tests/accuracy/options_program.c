/* One line for each way of drawing: its name, what the library answers, and the CRC-32 of the frames it drew. What
 * test_options_leave_the_rest_as_it_is.py compiles with each set of options.
 *
 * The scene is a cloud of 300 triangles around the camera, so that some are cut, some are large and some have no area; in
 * an arena that is too small for one pass, and bands of 5 lines, so that triangles reach through several. */
#include <stdio.h>
#include <string.h>

#include "base/crc32.h"
#include "edgeline.h"

enum { WIDTH = 96, HEIGHT = 64, LINES = 5, TRIANGLES = 300, FRAMES = 3 };

static int16_t positions[3 * TRIANGLES][3];
static uint16_t triangles[TRIANGLES][3];
static uint8_t colours[3 * TRIANGLES][3];
static int8_t normals[3 * TRIANGLES][3];
static int16_t uvs[3 * TRIANGLES][2];
static uint16_t texels[16 * 16];
static uint8_t memory[EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, LINES) + 6000];

static const el_mesh mesh = {.positions = (const int16_t (*)[3])positions,
                             .triangles = (const uint16_t (*)[3])triangles,
                             .colours = (const uint8_t (*)[3])colours,
                             .normals = (const int8_t (*)[3])normals,
                             .uvs = (const int16_t (*)[2])uvs,
                             .vertex_count = 3 * TRIANGLES,
                             .triangle_count = TRIANGLES,
                             .scale_log2 = -9,
                             .radius = 7100};
static const el_texture texture = {.texels = texels, .width_log2 = 4, .height_log2 = 4};
static const el_light light = {.direction_q30 = {0, 1 << 29, 929887697}, .ambient = 60, .diffuse = 190};

static uint32_t state = 1;

/* Xorshift (Marsaglia, 2003): 0 to below `end`. */
static int32_t any(int32_t end)
{
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return (int32_t)(state % (uint32_t)end);
}

static void fill(void)
{
    for (unsigned i = 0; i < TRIANGLES; i++) {
        const int32_t size = i % 8 == 0 ? 4000 : 600;
        const int32_t middle[3] = {any(4000) - 2000, any(4000) - 2000, any(4000) - 2000};
        for (unsigned corner = 0; corner < 3; corner++) {
            const unsigned v = 3 * i + corner;
            triangles[i][corner] = (uint16_t)v;
            for (unsigned axis = 0; axis < 3; axis++) {
                positions[v][axis] = (int16_t)(middle[axis] + any(size) - size / 2);
                colours[v][axis] = (uint8_t)any(256);
                normals[v][axis] = (int8_t)(any(147) - 73);
            }
            uvs[v][0] = (int16_t)any(4096);
            uvs[v][1] = (int16_t)any(4096);
        }
    }
    for (unsigned i = 0; i < sizeof texels / sizeof texels[0]; i++) {
        texels[i] = (uint16_t)any(65536);
    }
}

static void sink_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
}

static void sink_rows(void *context, el_band *band, unsigned slot)
{
    uint32_t *const crc = context;
    *crc = el_crc32(*crc, band->pixels, (size_t)band->lines * band->width * sizeof band->pixels[0]);
    el_band_release(band, slot);
}

static void sink_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

static el_camera camera_of(el_projection projection)
{
    return (el_camera){.projection = projection,
                       .fov_y = EL_DEGREES(70, 1),
                       .height_q16 = 8 * EL_UNIT_Q16,
                       .near_q16 = EL_UNIT_Q16 / 8,
                       .far_q16 = 5 * EL_UNIT_Q16,
                       .axes_q30 = {{EL_UNIT_Q30, 0, 0}, {0, EL_UNIT_Q30, 0}, {0, 0, EL_UNIT_Q30}}};
}

static void draw(const char *name, el_projection projection, const el_material *material)
{
    static el_renderer renderer;
    uint32_t crc = 0;
    const el_sink sink = {.context = &crc, .begin = sink_begin, .rows = sink_rows, .end = sink_end};
    int status = el_init(&renderer, &(el_config){.width = WIDTH,
                                                 .height = HEIGHT,
                                                 .band_lines = LINES,
                                                 .background = 0x1234,
                                                 .memory = memory,
                                                 .memory_bytes = sizeof memory,
                                                 .sinks = {&sink}});
    const el_camera camera = camera_of(projection);
    for (unsigned frame = 0; frame < FRAMES && status == EL_OK; frame++) {
        el_pose pose = el_pose_identity();
        el_pose_turn(&pose, EL_AXIS_Y, frame * EL_DEGREES(40, 1));
        status = el_frame_begin(&renderer, &camera);
        if (status != EL_OK) {
            break;
        }
        do {
            status = el_draw(&renderer, &mesh, &pose, material);
        } while (el_frame_next(&renderer) > 0);
    }
    printf("%s %d %08x %u\n", name, status, (unsigned)crc, (unsigned)renderer.stats.pixels);
}

int main(void)
{
    fill();
    const el_material plain = {.flags = EL_MATERIAL_TWO_SIDED, .texture = &texture, .colour = {200, 100, 50}};
    el_material material = plain;
    draw("flat", EL_PERSPECTIVE, &material);
    material.flags |= EL_MATERIAL_FLAT_MEAN;
    draw("flat-mean", EL_PERSPECTIVE, &material);
    draw("orthographic", EL_ORTHOGRAPHIC, &material);
    material.flags = EL_MATERIAL_NO_DEPTH;
    draw("no-depth", EL_PERSPECTIVE, &material);
#if EL_WITH_WIRES
    material.flags = EL_MATERIAL_WIRES;
    draw("wires", EL_PERSPECTIVE, &material);
#endif
    material = plain;
    material.light = &light;
    draw("lit", EL_PERSPECTIVE, &material);
    material.shading = EL_SHADE_GOURAUD;
    draw("gouraud-lit", EL_PERSPECTIVE, &material);
    material = plain;
    material.shading = EL_SHADE_GOURAUD;
    draw("gouraud", EL_PERSPECTIVE, &material);
    material.flags |= EL_MATERIAL_DITHER;
    draw("gouraud-dithered", EL_PERSPECTIVE, &material);
    material.flags = EL_MATERIAL_TWO_SIDED;
    material.shading = EL_SHADE_TEXTURED;
    draw("textured", EL_PERSPECTIVE, &material);
    material.shading = EL_SHADE_TEXTURED_GOURAUD;
    draw("textured-gouraud", EL_PERSPECTIVE, &material);
    material.flags |= EL_MATERIAL_DITHER;
    draw("textured-gouraud-dithered", EL_PERSPECTIVE, &material);
    material = plain;
#if EL_WITH_MIXED
    material.alpha = 90;
    draw("blended", EL_PERSPECTIVE, &material);
    material.alpha = 0;
    static el_fog fog;
    const el_camera camera = camera_of(EL_PERSPECTIVE);
    if (el_fog_exponential(&fog, &camera, 0xFFFF, EL_UNIT_Q16 / 4) != EL_OK) {
        return 1;
    }
    material.fog = &fog;
    draw("fogged", EL_PERSPECTIVE, &material);
    material = plain;
    material.shading = EL_SHADE_TEXTURED;
    const el_texture smooth = {
        .texels = texels, .width_log2 = 4, .height_log2 = 4, .wrap_u = EL_WRAP_MIRROR, .smooth = true};
    material.texture = &smooth;
    draw("textured-smooth", EL_PERSPECTIVE, &material);
    material = plain;
#endif
#if EL_WITH_MIPMAPS
    material.shading = EL_SHADE_TEXTURED;
    const el_texture smaller = {.texels = texels + 7, .width_log2 = 3, .height_log2 = 3};
    const el_texture larger = {.texels = texels, .width_log2 = 4, .height_log2 = 4, .smaller = &smaller};
    material.texture = &larger;
    draw("textured-smaller", EL_PERSPECTIVE, &material);
    material = plain;
#endif
    material.shading = EL_SHADE_OVERDRAW;
    draw("overdraw", EL_PERSPECTIVE, &material);
    return 0;
}
