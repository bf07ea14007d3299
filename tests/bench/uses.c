/* What using a feature takes: a scene, and the same again with one thing more (bench_tool/features.py).
 *
 * One line per measurement: the scene without it, and of how many of which units is told what one more takes.
 *
 *     NAME PLAIN UNIT crc CRC count UNITS
 */
#include "bench/bench_scenes.h"
#include "bench/meshes/s1.h"
#include "bench/meshes/s2.h"
#include "bench/meshes/s3.h"
#include "demo/demo_scenes.h"
#include "demo/meshes/teapot.h"
#include "frame.h"
#include "own_scenes.h"
#include "platform.h"

enum { BAND_LINES = 8, ARENA = 200 * 1024, LAMPS = 16 };

/* A picture that has no power of two for its sides, and ends a little before S2's coordinates do, which are up to 256. */
enum { ODD_WIDTH = 253, ODD_HEIGHT = 251 };

/* What a use adds to its scene's material, or to the frame. */
typedef enum extra {
    NOTHING,
    DITHER,
    BLEND,
    FOG,
    SAMPLES_4,
    SAMPLES_8,
    PREPASS,
    HUD,
    WIRES,
    INTERLACED,
    COLOURS,
    IMAGE,
    MIRROR,
    SMOOTH,
    ODD,
    ODD_SMOOTH,
    PALETTE_SMOOTH,
    KEYED_SMOOTH,
    LIGHT,
    ONE_LAMP,
    ALL_LAMPS
} extra;

typedef struct use {
    const char *name, *plain, *unit;
    const el_scene *scene; /* whose camera it is */
    const el_mesh *mesh;
    uint8_t shading;
    extra what;
} use;

#define S1(name, what)                                                                                                 \
    {                                                                                                                  \
        name, "S1", "pixel", &el_bench_scenes[0], &s1, EL_SHADE_GOURAUD, what                                          \
    }
#define S2(name, what)                                                                                                 \
    {                                                                                                                  \
        name, "S2", "pixel", &el_bench_scenes[0], &s2, EL_SHADE_TEXTURED, what                                         \
    }
#define S3(name, what)                                                                                                 \
    {                                                                                                                  \
        name, "S3", "pixel", &el_bench_scenes[0], &s3, EL_SHADE_FLAT, what                                             \
    }
#define TEAPOT(name, what)                                                                                             \
    {                                                                                                                  \
        name, "teapot", "vertex", &el_teapot_scene, &teapot, EL_SHADE_GOURAUD, what                                    \
    }

static const use uses[] = {
    S1("S1", NOTHING),
    S1("S1-dithered", DITHER),
    S1("S1-blended", BLEND),
    S1("S1-fog", FOG),
    S1("S1-4-samples", SAMPLES_4),
    S1("S1-8-samples", SAMPLES_8),
    S1("S1-pre-pass", PREPASS),
    {"S1-hud", "S1", "frame", &el_bench_scenes[0], &s1, EL_SHADE_GOURAUD, HUD},
    {"S1-wires", "S1", "edge", &el_bench_scenes[0], &s1, EL_SHADE_GOURAUD, WIRES},
    {"S1-interlaced", "S1", "frame", &el_bench_scenes[0], &s1, EL_SHADE_GOURAUD, INTERLACED},
    S2("S2", NOTHING),
    S2("S2-in-a-colour", COLOURS),
    S2("S2-pre-pass", PREPASS),
    S2("S2-blended", BLEND),
    S2("S2-fog", FOG),
    S2("S2-image", IMAGE),
    S2("S2-mirrored", MIRROR),
    S2("S2-bilinear", SMOOTH),
    S2("S2-odd", ODD),
    S2("S2-odd-bilinear", ODD_SMOOTH),
    S2("S2-palette-bilinear", PALETTE_SMOOTH),
    S2("S2-keyed-bilinear", KEYED_SMOOTH),
    {"S2-interlaced", "S2", "frame", &el_bench_scenes[0], &s2, EL_SHADE_TEXTURED, INTERLACED},
    S3("S3", NOTHING),
    S3("S3-blended", BLEND),
    S3("S3-fog", FOG),
    S3("S3-4-samples", SAMPLES_4),
    {"S3-interlaced", "S3", "frame", &el_bench_scenes[0], &s3, EL_SHADE_FLAT, INTERLACED},
    TEAPOT("teapot", NOTHING),
    TEAPOT("teapot-light", LIGHT),
    TEAPOT("teapot-1-lamp", ONE_LAMP),
    TEAPOT("teapot-16-lamps", ALL_LAMPS),
};

static _Alignas(8) uint8_t arena[ARENA];
static el_camera camera;
static el_texture texture;
static el_image image;
static uint16_t odd_texels[ODD_WIDTH * ODD_HEIGHT];
static uint8_t indices[sizeof s2_texels / sizeof s2_texels[0]];
static uint16_t palette[256];
static el_fog fog;
static el_lamp lamps[LAMPS];
static uint8_t colours[sizeof teapot_positions / sizeof teapot_positions[0]][3];
static el_mesh lit;
static el_highlight highlight;

static const el_light light = {.direction_q30 = {-520841137, 781261706, 520841137}, .ambient = 80, .diffuse = 175};

static el_material material_of(const use *u)
{
    el_material material = {.shading = u->shading, .colour = {226, 146, 74}};
    if (u->mesh == &s2) {
        material.texture = &texture;
    }
    switch (u->what) {
    case DITHER:
        material.flags = EL_MATERIAL_DITHER;
        break;
    case BLEND:
        material.alpha = 128;
        break;
    case FOG:
        material.fog = &fog;
        break;
    case COLOURS:
        material.shading = EL_SHADE_TEXTURED_GOURAUD;
        break;
    case LIGHT:
        material.light = &light;
        break;
    default:
        break;
    }
    return material;
}

/* S2's picture, over and over, clamped where it ends. */
static void make_odd(void)
{
    const uint32_t width_log2 = s2_texture.width_log2;
    const uint32_t u_mask = (1U << width_log2) - 1U;
    const uint32_t v_mask = (1U << s2_texture.height_log2) - 1U;
    for (uint32_t y = 0; y < ODD_HEIGHT; y++) {
        for (uint32_t x = 0; x < ODD_WIDTH; x++) {
            odd_texels[y * ODD_WIDTH + x] = s2_texels[(y & v_mask) << width_log2 | (x & u_mask)];
        }
    }
    image.width = ODD_WIDTH;
    image.height = ODD_HEIGHT;
    image.pixels = odd_texels;
    texture.image = &image;
    texture.wrap_u = EL_WRAP_CLAMP;
    texture.wrap_v = EL_WRAP_CLAMP;
}

/* S2's picture in 256 colours. */
static void make_palette(void)
{
    for (uint32_t i = 0; i < sizeof indices; i++) {
        indices[i] = (uint8_t)(s2_texels[i] >> 8);
        palette[indices[i]] = s2_texels[i];
    }
    image.format = EL_IMAGE_INDEX8;
    image.pixels = indices;
    image.palette = palette;
    texture.image = &image;
}

/* What is there before the frame begins. */
static void prepare(const use *u)
{
    u->scene->place_camera(0, &camera);
    (void)el_fog_linear(&fog, &camera, 0xBDF7, 4 * EL_UNIT_Q16, 32 * EL_UNIT_Q16);
    (void)el_highlight_make(&highlight, 16);
    texture = s2_texture;
    image = (el_image){.width = (uint16_t)(1U << s2_texture.width_log2),
                       .height = (uint16_t)(1U << s2_texture.height_log2),
                       .pixels = s2_texture.texels};
    texture.image = u->what == IMAGE ? &image : NULL;
    texture.wrap_u = u->what == MIRROR ? EL_WRAP_MIRROR : EL_WRAP_REPEAT;
    texture.wrap_v = texture.wrap_u;
    texture.smooth = u->what == SMOOTH || u->what == ODD_SMOOTH || u->what == PALETTE_SMOOTH || u->what == KEYED_SMOOTH;
    if (u->what == ODD || u->what == ODD_SMOOTH) {
        make_odd();
    } else if (u->what == PALETTE_SMOOTH) {
        make_palette();
    } else if (u->what == KEYED_SMOOTH) {
        image.has_key = true;
        image.key = s2_texels[0];
        texture.image = &image;
    }
    for (int32_t i = 0; i < LAMPS; i++) {
        lamps[i] =
            (el_lamp){.kind = EL_LAMP_POINT,
                      .colour = {40, 60, 80},
                      .position_q16 = {(i % 4 - 2) * 2 * EL_UNIT_Q16, 3 * EL_UNIT_Q16, (i / 4 - 1) * 2 * EL_UNIT_Q16},
                      .half_q16 = 3 * EL_UNIT_Q16};
    }
    lit = *u->mesh;
}

static const el_material wires = {.flags = EL_MATERIAL_WIRES, .colour = {20, 20, 60}};

static const use *in_use;

static el_status draw(uint32_t frame, el_renderer *renderer)
{
    static el_material material;
    const el_pose pose = el_pose_identity();
    (void)frame;
    material = material_of(in_use);
    if (in_use->what == ONE_LAMP || in_use->what == ALL_LAMPS) {
        const el_lighting lighting = {.lamps = lamps,
                                      .lamp_count = in_use->what == ONE_LAMP ? 1 : LAMPS,
                                      .highlight = &highlight,
                                      .ambient = {40, 40, 40},
                                      .specular = {120, 120, 120},
                                      .colour = {226, 146, 74}};
        const el_status status = el_light_vertices(&lighting, &teapot, &pose, camera.position_q16, colours);
        if (status != EL_OK) {
            return status;
        }
        lit.colours = (const uint8_t(*)[3])colours;
    }
    const el_status status = el_draw(renderer, &lit, &pose, &material);
    return status == EL_OK && in_use->what == WIRES ? el_draw(renderer, &lit, &pose, &wires) : status;
}

/* Of how many of its units is told: those of its scene without it. */
static uint32_t units_of(const use *u, const el_stats *plain)
{
    switch (u->unit[0]) {
    case 'p':
        return plain->pixels;
    case 'v':
        return u->mesh->vertex_count;
    case 'e': /* each triangle's, so an inner edge counts twice */
        return 3 * plain->triangles_listed;
    default:
        return 1;
    }
}

static int measure(const use *u)
{
    static el_renderer renderer;
    static el_stats plain;
    const el_scene scene = {u->name, "", 0, u->scene->place_camera, draw, NULL};
    const bench_setting setting = {
        .band_lines = BAND_LINES,
        .depth_prepass = u->what == PREPASS,
        .interlaced = u->what == INTERLACED,
        .samples = u->what == SAMPLES_4   ? 4
                   : u->what == SAMPLES_8 ? 8
                                          : 1,
        .over = u->what == HUD ? &bench_hud : NULL,
        .arena = arena,
        .arena_bytes = sizeof arena,
    };
    bench_picture picture;
    in_use = u;
    prepare(u);
    const el_status status = bench_frame(&scene, 0, &setting, &renderer, &picture);
    if (u->what == NOTHING) {
        plain = *el_frame_stats(&renderer);
    }
    bench_print(u->name);
    bench_print(" ");
    bench_print(u->plain);
    bench_print(" ");
    bench_print(u->unit);
    bench_print(" crc ");
    bench_print_hex(picture.crc);
    bench_print_item(" count ", units_of(u, &plain));
    bench_print("\n");
    return status == EL_OK ? 0 : 1;
}

int bench_main(void)
{
    int failed = 0;
    bench_empty();
    for (size_t i = 0; i < sizeof uses / sizeof uses[0]; i++) {
        failed |= measure(&uses[i]);
    }
    return failed;
}
