/* Ten parallel layers, each of two triangles that reach beyond the screen's edges, drawn from the front to the back and
 * the other way around: the same picture at the least and at the greatest cost. They are turned a little out of the
 * screen's plane, so that their textures need perspective. */
#include "own_scenes.h"

enum { LAYERS = 10, NEAREST = 10 };

static const int16_t corners[4][3] = {{-6400, -5120, 320}, {6400, -5120, -320}, {6400, 5120, -320}, {-6400, 5120, 320}};
static const int16_t uvs[4][2] = {{0, 2048}, {2048, 2048}, {2048, 0}, {0, 0}};
static const uint16_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};

/* 50 x 40 units; at the farthest layer, 19 units away, the screen is 38 x 28.5. */
static const el_mesh sheet = {
    .positions = corners,
    .triangles = triangles,
    .uvs = uvs,
    .vertex_count = 4,
    .triangle_count = 2,
    .scale_log2 = -8,
    .radius = 8203, /* of (6400, 5120, 320), rounded up */
};

#define LIGHT_ROW 0xFFFF, 0xFFFF, 0xD69A, 0xD69A, 0x7BEF, 0x7BEF, 0x39E7, 0x39E7
#define DARK_ROW 0x39E7, 0x39E7, 0x7BEF, 0x7BEF, 0xD69A, 0xD69A, 0xFFFF, 0xFFFF
static const uint16_t texels[64] = {LIGHT_ROW, LIGHT_ROW, DARK_ROW, DARK_ROW, LIGHT_ROW, LIGHT_ROW, DARK_ROW, DARK_ROW};
static const el_texture texture = {.texels = texels, .width_log2 = 3, .height_log2 = 3};

#define LAYER(n)                                                                                                       \
    {                                                                                                                  \
        .shading = EL_SHADE_FLAT, .colour = { 250 - 20 * (n), 20 + 20 * (n), 128 }                                     \
    }
static const el_material flat[LAYERS] = {LAYER(0), LAYER(1), LAYER(2), LAYER(3), LAYER(4),
                                         LAYER(5), LAYER(6), LAYER(7), LAYER(8), LAYER(9)};
static const el_material lit = {
    .shading = EL_SHADE_TEXTURED_GOURAUD, .flags = EL_MATERIAL_DITHER, .colour = {250, 200, 150}, .texture = &texture};
static const el_material textured = {.shading = EL_SHADE_TEXTURED, .texture = &texture};

static void place_camera(uint32_t frame, el_camera *camera)
{
    static const int32_t eye_q16[3] = {0, 0, 0};
    static const int32_t target_q16[3] = {0, 0, -EL_UNIT_Q16};
    static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};
    (void)frame;
    *camera = (el_camera){
        .projection = EL_PERSPECTIVE,
        .fov_y = 879750026, /* 2 * atan(120 / 160), as S1 to S4 have it */
        .near_q16 = EL_UNIT_Q16,
        .far_q16 = 64 * EL_UNIT_Q16,
    };
    (void)el_camera_look_at(camera, eye_q16, target_q16, up_q16); /* neither equal nor in line with `up` */
}

static el_status draw_layer(el_renderer *renderer, int32_t layer, const el_material *material)
{
    el_pose pose = el_pose_identity();
    pose.position_q16[2] = -(NEAREST + layer) * EL_UNIT_Q16;
    return el_draw(renderer, &sheet, &pose, material);
}

static el_status flat_front_to_back(uint32_t frame, el_renderer *renderer)
{
    el_status status = EL_OK;
    (void)frame;
    for (int32_t layer = 0; layer < LAYERS && status == EL_OK; layer++) {
        status = draw_layer(renderer, layer, &flat[layer]);
    }
    return status;
}

static el_status flat_back_to_front(uint32_t frame, el_renderer *renderer)
{
    el_status status = EL_OK;
    (void)frame;
    for (int32_t layer = LAYERS - 1; layer >= 0 && status == EL_OK; layer--) {
        status = draw_layer(renderer, layer, &flat[layer]);
    }
    return status;
}

static el_status textured_front_to_back(uint32_t frame, el_renderer *renderer)
{
    el_status status = EL_OK;
    (void)frame;
    for (int32_t layer = 0; layer < LAYERS && status == EL_OK; layer++) {
        status = draw_layer(renderer, layer, &textured);
    }
    return status;
}

static el_status textured_back_to_front(uint32_t frame, el_renderer *renderer)
{
    el_status status = EL_OK;
    (void)frame;
    for (int32_t layer = LAYERS - 1; layer >= 0 && status == EL_OK; layer--) {
        status = draw_layer(renderer, layer, &textured);
    }
    return status;
}

static el_status lit_back_to_front(uint32_t frame, el_renderer *renderer)
{
    el_status status = EL_OK;
    (void)frame;
    for (int32_t layer = LAYERS - 1; layer >= 0 && status == EL_OK; layer--) {
        status = draw_layer(renderer, layer, &lit);
    }
    return status;
}

const el_scene overdraw_scenes[] = {
    {"layers-front-to-back", "ten layers over the whole screen, flat, depth", 0, place_camera, flat_front_to_back,
     NULL},
    {"layers-back-to-front", "the same, the farthest first", 0, place_camera, flat_back_to_front, NULL},
    {"sheets-front-to-back", "ten textured layers, depth", 0, place_camera, textured_front_to_back, NULL},
    {"sheets-back-to-front", "the same, the farthest first", 0, place_camera, textured_back_to_front, NULL},
    {"lit-back-to-front", "ten textured layers in a colour, dithered: dear pixels", 0, place_camera, lit_back_to_front,
     NULL},
};
const size_t overdraw_scene_count = sizeof overdraw_scenes / sizeof overdraw_scenes[0];
