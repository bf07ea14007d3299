/* Materials that are mixed of several things (raster/fill_mixed.h), on the sphere of S1 and in the room of S2, so that what
 * they cost is seen against the same triangles without: S1 and S2 themselves, and S2-flat. */
#include "own_scenes.h"

#include "bench/meshes/s1.h"
#include "bench/meshes/s2.h"

enum { SIDE = 64, HALF = 128 };

static void place_camera(uint32_t frame, el_camera *camera)
{
    el_scene_find("S2")->place_camera(frame, camera); /* S1's, too */
}

static el_status draw(el_renderer *renderer, const el_mesh *mesh, const el_material *material)
{
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, mesh, &pose, material);
}

/* From three units away on, dense at the wall. */
static el_status draw_in_fog(uint32_t frame, el_renderer *renderer, const el_mesh *mesh, const el_material *material)
{
    static el_fog fog;
    static el_material in_fog;
    el_camera camera;
    place_camera(frame, &camera);
    const el_status status = el_fog_linear(&fog, &camera, 0x8C71, 3 * EL_UNIT_Q16, 16 * EL_UNIT_Q16);
    in_fog = *material;
    in_fog.fog = &fog;
    return status == EL_OK ? draw(renderer, mesh, &in_fog) : status;
}

static el_status s1_blend(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_GOURAUD, .alpha = HALF};
    (void)frame;
    return draw(renderer, &s1, &material);
}

static el_status s1_fog(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_GOURAUD};
    return draw_in_fog(frame, renderer, &s1, &material);
}

static const el_material flat = {.shading = EL_SHADE_FLAT, .colour = {200, 120, 60}};

static el_status s2_flat(uint32_t frame, el_renderer *renderer)
{
    (void)frame;
    return draw(renderer, &s2, &flat);
}

static el_status s2_flat_blend(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_FLAT, .colour = {200, 120, 60}, .alpha = HALF};
    (void)frame;
    return draw(renderer, &s2, &material);
}

static el_status s2_flat_fog(uint32_t frame, el_renderer *renderer)
{
    return draw_in_fog(frame, renderer, &s2, &flat);
}

/* A palette of 256 colours, of which one is not drawn. */
static el_status s2_palette(uint32_t frame, el_renderer *renderer)
{
    static uint8_t indices[SIDE * SIDE];
    static uint16_t palette[256];
    static const el_image image = {.width = SIDE,
                                   .height = SIDE,
                                   .format = EL_IMAGE_INDEX8,
                                   .has_key = true,
                                   .key = 0,
                                   .pixels = indices,
                                   .palette = palette};
    static const el_texture texture = {.image = &image};
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &texture};
    (void)frame;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        indices[i] = (uint8_t)(s2_texels[i] >> 8);
        palette[indices[i]] = s2_texels[i];
    }
    return draw(renderer, &s2, &material);
}

static el_status s2_mirror(uint32_t frame, el_renderer *renderer)
{
    static const el_texture texture = {
        .texels = s2_texels, .width_log2 = 6, .height_log2 = 6, .wrap_u = EL_WRAP_MIRROR, .wrap_v = EL_WRAP_MIRROR};
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &texture};
    (void)frame;
    return draw(renderer, &s2, &material);
}

static el_status s2_blend(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &s2_texture, .alpha = HALF};
    (void)frame;
    return draw(renderer, &s2, &material);
}

/* An alpha for each texel. */
static el_status s2_alpha(uint32_t frame, el_renderer *renderer)
{
    static uint8_t shown[SIDE * SIDE];
    static const el_image image = {.width = SIDE, .height = SIDE, .pixels = s2_texels, .alpha = shown};
    static const el_texture texture = {.image = &image};
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &texture};
    (void)frame;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        shown[i] = (uint8_t)(i * 4U);
    }
    return draw(renderer, &s2, &material);
}

static const el_texture smooth = {.texels = s2_texels, .width_log2 = 6, .height_log2 = 6, .smooth = true};

static el_status s2_bilinear(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &smooth};
    (void)frame;
    return draw(renderer, &s2, &material);
}

static el_status s2_fog(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &s2_texture};
    return draw_in_fog(frame, renderer, &s2, &material);
}

#define GREY 0x630C

const el_scene mixed_scenes[] = {
    {"S1-blend", "S1, half transparent", GREY, place_camera, s1_blend, NULL},
    {"S1-fog", "S1 in fog", GREY, place_camera, s1_fog, NULL},
    {"S2-flat", "S2 in one colour", GREY, place_camera, s2_flat, NULL},
    {"S2-flat-blend", "the same, half transparent", GREY, place_camera, s2_flat_blend, NULL},
    {"S2-flat-fog", "the same in fog", GREY, place_camera, s2_flat_fog, NULL},
    {"S2-palette", "S2, 256 colours, one is not drawn", GREY, place_camera, s2_palette, NULL},
    {"S2-mirror", "S2, mirrored", GREY, place_camera, s2_mirror, NULL},
    {"S2-blend", "S2, half transparent", GREY, place_camera, s2_blend, NULL},
    {"S2-alpha", "S2, an alpha for each texel", GREY, place_camera, s2_alpha, NULL},
    {"S2-bilinear", "S2, bilinear", GREY, place_camera, s2_bilinear, NULL},
    {"S2-fog", "S2 in fog", GREY, place_camera, s2_fog, NULL},
};
const size_t mixed_scene_count = sizeof mixed_scenes / sizeof mixed_scenes[0];
