#include "materials_scene.h"

#include "demo/meshes/teapot.h"
#include "scene_units.h"

#if EL_HAS_MATERIALS_SCENE

enum {
    SKY = 0xBDF7,
    SIDE = 16,      /* of a small picture */
    ODD_SIDE = 12,  /* of one whose size is no power of two */
    FLOOR_LOG2 = 6, /* the floor's texture, and its smaller ones */
    FLOOR_SIDE = 1 << FLOOR_LOG2,
    FLOOR_CELLS = 24
};

/* --- Pictures, painted once ------------------------------------------------------------------------------------------ */

static uint16_t floor_texels[FLOOR_LOG2 + 1][FLOOR_SIDE * FLOOR_SIDE];
static el_texture floor_textures[FLOOR_LOG2 + 1];
static uint16_t texels[SIDE * SIDE];
static uint16_t odd_texels[ODD_SIDE * ODD_SIDE];
static uint8_t indices8[SIDE * SIDE];
static uint8_t indices4[SIDE * SIDE / 2];
static uint8_t mask[SIDE * SIDE / 8];
static uint8_t glow[SIDE * SIDE];
static uint16_t palette[256];
static uint16_t palette4[16];
static uint16_t ink[1];

static uint16_t mix(unsigned red, unsigned green, unsigned blue)
{
    return el_rgb565((uint8_t)red, (uint8_t)green, (uint8_t)blue);
}

/* Squared distance from the middle, in half texels: 2 to 450. */
static int from_middle(int x, int y)
{
    return (2 * x - SIDE + 1) * (2 * x - SIDE + 1) + (2 * y - SIDE + 1) * (2 * y - SIDE + 1);
}

static void paint_floor(void)
{
    for (unsigned level = 0; level <= FLOOR_LOG2; level++) {
        const unsigned side = (unsigned)FLOOR_SIDE >> level;
        /* Each level has a tint of its own, so that it shows which is used. */
        for (unsigned i = 0; i < side * side; i++) {
            const bool dark = side < 2 || (((i % side) * 4 / side + (i / side) * 4 / side) & 1U) != 0;
            const unsigned light = side < 4 ? 150 : (dark ? 105 : 195);
            floor_texels[level][i] = mix(light, light - (level % 2 == 1 ? 40 : 0), light - (level % 3 == 2 ? 60 : 20));
        }
        floor_textures[level] = (el_texture){.texels = floor_texels[level],
                                             .width_log2 = (uint8_t)(FLOOR_LOG2 - level),
                                             .height_log2 = (uint8_t)(FLOOR_LOG2 - level),
                                             .smooth = true,
                                             .smaller = level < FLOOR_LOG2 ? &floor_textures[level + 1] : NULL};
    }
}

/* An arrow to the upper right, which tells a picture from its mirror image. */
static bool arrow(int x, int y, int side)
{
    const bool shaft = x + y >= side - 2 && x + y <= side && x > 1 && y > 1;
    const bool head = (y > 0 && y <= 2 && x >= side / 2) || (x < side - 1 && x >= side - 3 && y <= side / 2);
    return shaft || head;
}

static void paint(void)
{
    static bool done;
    if (done) {
        return;
    }
    done = true;
    paint_floor();
    ink[0] = mix(20, 40, 120);
    for (int i = 0; i < 256; i++) {
        palette[i] = mix((unsigned)i, (unsigned)(255 - i), 128 + (unsigned)i / 2);
    }
    for (unsigned i = 0; i < 16; i++) {
        palette4[i] = palette[i * 17];
    }
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const int at = y * SIDE + x;
            const int far = from_middle(x, y);
            texels[at] = arrow(x, y, SIDE) ? mix(240, 240, 240) : mix(200, 40 + 10 * (unsigned)y, 20);
            indices8[at] = (uint8_t)(far / 2);
            indices4[at / 2] |= (uint8_t)((far / 30) << (x % 2 == 0 ? 4 : 0));
            mask[at / 8] |= (uint8_t)((arrow(x, y, SIDE) ? 1U : 0U) << (7 - x % 8));
            glow[at] = (uint8_t)(far > 255 ? 0 : 255 - far);
        }
    }
    for (int y = 0; y < ODD_SIDE; y++) {
        for (int x = 0; x < ODD_SIDE; x++) {
            odd_texels[y * ODD_SIDE + x] =
                arrow(x, y, ODD_SIDE) ? mix(240, 240, 240) : mix(20, 90, 60 + 12 * (unsigned)x);
        }
    }
}

static const el_image odd_image = {.width = ODD_SIDE, .height = ODD_SIDE, .pixels = odd_texels};
static const el_image keyed_image = {
    .width = ODD_SIDE, .height = ODD_SIDE, .has_key = true, .key = 0xF79E, .pixels = odd_texels};
static const el_image image8 = {
    .width = SIDE, .height = SIDE, .format = EL_IMAGE_INDEX8, .pixels = indices8, .palette = palette};
static const el_image image4 = {
    .width = SIDE, .height = SIDE, .format = EL_IMAGE_INDEX4, .pixels = indices4, .palette = palette4};
static const el_image mask_image = {
    .width = SIDE, .height = SIDE, .format = EL_IMAGE_MASK, .pixels = mask, .palette = ink};
static const el_image glow_image = {.width = SIDE, .height = SIDE, .pixels = texels, .alpha = glow};

#define PLAIN .texels = texels, .width_log2 = 4, .height_log2 = 4

static const el_texture textures[] = {
    {PLAIN},
    {PLAIN, .smooth = true},
    {PLAIN, .wrap_u = EL_WRAP_CLAMP, .wrap_v = EL_WRAP_CLAMP},
    {PLAIN, .wrap_u = EL_WRAP_MIRROR, .wrap_v = EL_WRAP_MIRROR},
    {.image = &odd_image},
    {.image = &odd_image, .wrap_u = EL_WRAP_MIRROR, .wrap_v = EL_WRAP_CLAMP, .smooth = true},
    {.image = &image8},
    {.image = &image4, .smooth = true},
    {.image = &mask_image},
    {.image = &keyed_image},
    {.image = &keyed_image, .smooth = true},
    {.image = &glow_image},
};

/* --- Things ------------------------------------------------------------------------------------------------------------ */

/* A square with a picture and a half in each direction, from a quarter before its beginning on. */
static const int16_t card_positions[4][3] = {{-256, -256, 0}, {256, -256, 0}, {256, 256, 0}, {-256, 256, 0}};
static const uint16_t card_triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
static const int16_t card_uvs[4][2] = {{-64, 320}, {320, 320}, {320, -64}, {-64, -64}};
static const el_mesh card = {.positions = card_positions,
                             .triangles = card_triangles,
                             .uvs = card_uvs,
                             .vertex_count = 4,
                             .triangle_count = 2,
                             .scale_log2 = -9,
                             .radius = 363};

static int16_t floor_positions[(FLOOR_CELLS + 1) * (FLOOR_CELLS + 1)][3];
static int16_t floor_uvs[COUNT(floor_positions)][2];
static uint16_t floor_cells[2 * FLOOR_CELLS * FLOOR_CELLS][3];
static const el_mesh floor_mesh = {.positions = (const int16_t (*)[3])floor_positions,
                                   .triangles = (const uint16_t (*)[3])floor_cells,
                                   .uvs = (const int16_t (*)[2])floor_uvs,
                                   .vertex_count = COUNT(floor_positions),
                                   .triangle_count = COUNT(floor_cells),
                                   .radius = 18};

/* Cells of one unit, on each of which the texture is once. */
static void lay_floor(void)
{
    enum { ROW = FLOOR_CELLS + 1 };
    for (int i = 0; i < ROW * ROW; i++) {
        floor_positions[i][0] = (int16_t)(i % ROW - FLOOR_CELLS / 2);
        floor_positions[i][2] = (int16_t)(i / ROW - FLOOR_CELLS / 2);
        floor_uvs[i][0] = (int16_t)(floor_positions[i][0] * FLOOR_SIDE * 16);
        floor_uvs[i][1] = (int16_t)(floor_positions[i][2] * FLOOR_SIDE * 16);
    }
    for (int i = 0; i < FLOOR_CELLS * FLOOR_CELLS; i++) {
        const uint16_t corner = (uint16_t)(i / FLOOR_CELLS * ROW + i % FLOOR_CELLS);
        const uint16_t corners[4] = {corner, (uint16_t)(corner + ROW), (uint16_t)(corner + ROW + 1),
                                     (uint16_t)(corner + 1)};
        for (unsigned k = 0; k < 3; k++) {
            floor_cells[2 * i][k] = corners[k];
            floor_cells[2 * i + 1][k] = corners[k == 0 ? 0 : k + 1];
        }
    }
}

/* cos 20 and 30 degrees. */
static const el_lamp lamps[] = {
    {.kind = EL_LAMP_DIRECTIONAL, .colour = {90, 90, 110}, .direction_q30 = {-520841137, 781261706, 520841137}},
    {.kind = EL_LAMP_POINT,
     .colour = {255, 120, 40},
     .position_q16 = {TENTHS_Q16(-28), TENTHS_Q16(12), TENTHS_Q16(34)},
     .half_q16 = TENTHS_Q16(20)},
    {.kind = EL_LAMP_SPOT,
     .colour = {80, 200, 255},
     .direction_q30 = {0, -759250125, -759250125},
     .position_q16 = {TENTHS_Q16(14), TENTHS_Q16(30), TENTHS_Q16(46)},
     .half_q16 = TENTHS_Q16(60),
     .inner_q30 = 1058764063,
     .outer_q30 = 1042446551},
};
static el_highlight highlight;
static const el_lighting lighting = {.lamps = lamps,
                                     .lamp_count = COUNT(lamps),
                                     .highlight = &highlight,
                                     .ambient = {50, 50, 60},
                                     .emissive = {0, 0, 12},
                                     .specular = {180, 180, 180},
                                     .colour = {200, 190, 180}};

static uint8_t vertex_colours[COUNT(teapot_positions)][3];
static uint8_t triangle_colours[COUNT(teapot_triangles)][3];

/* --- The scene ----------------------------------------------------------------------------------------------------------- */

static void place_camera(uint32_t frame, el_camera *camera)
{
    static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};
    static const int32_t target_q16[3] = {0, TENTHS_Q16(11), 0};
    const el_angle swing = frame * (0xFFFFFFFFU / 240 + 1U);
    const int32_t eye_q16[3] = {(int32_t)((int64_t)TENTHS_Q16(18) * el_sin_q30(swing) >> 30), TENTHS_Q16(22),
                                TENTHS_Q16(80)};
    *camera = (el_camera){.fov_y = EL_DEGREES(36, 1), .near_q16 = TENTHS_Q16(10), .far_q16 = TENTHS_Q16(300)};
    (void)el_camera_look_at(camera, eye_q16, target_q16, up_q16); /* never from above */
}

static el_pose at(int32_t x_q16, int32_t y_q16, int32_t z_q16, uint32_t scale_q16)
{
    el_pose pose = el_pose_identity();
    pose.position_q16[0] = x_q16;
    pose.position_q16[1] = y_q16;
    pose.position_q16[2] = z_q16;
    pose.scale_q16 = scale_q16;
    return pose;
}

static el_status draw_floor(el_renderer *renderer, const el_fog *fog)
{
    static el_material material;
    material = (el_material){.shading = EL_SHADE_TEXTURED, .texture = &floor_textures[0], .fog = fog};
    const el_pose pose = at(0, 0, TENTHS_Q16(-30), EL_UNIT_Q16);
    return el_draw(renderer, &floor_mesh, &pose, &material);
}

/* Two rows of cards, a texture each. */
static el_status draw_cards(el_renderer *renderer)
{
    static el_material materials[COUNT(textures)];
    el_status status = EL_OK;
    for (unsigned i = 0; i < COUNT(textures) && status == EL_OK; i++) {
        materials[i] = (el_material){.shading = EL_SHADE_TEXTURED, .texture = &textures[i]};
        const el_pose pose = at(TENTHS_Q16(11) * ((int32_t)(i % 6) * 2 - 5) / 2,
                                i < 6 ? TENTHS_Q16(30) : TENTHS_Q16(19), 0, EL_UNIT_Q16);
        status = el_draw(renderer, &card, &pose, &materials[i]);
    }
    return status;
}

/* One lit by its vertices, one by its triangles, and one that fades away in the fog. */
static el_status draw_teapots(uint32_t frame, el_renderer *renderer, const int32_t eye_q16[3], const el_fog *fog)
{
    static el_mesh smooth;
    static el_mesh facets;
    static const el_material gouraud = {.shading = EL_SHADE_GOURAUD};
    static const el_material flat;
    static el_material far;
    far = (el_material){.colour = {40, 160, 60}, .fog = fog};
    smooth = teapot;
    smooth.colours = (const uint8_t(*)[3])vertex_colours;
    facets = teapot;
    facets.triangle_colours = (const uint8_t(*)[3])triangle_colours;
    el_pose left = at(TENTHS_Q16(-16), 0, TENTHS_Q16(20), TENTHS_Q16(4));
    el_pose right = at(TENTHS_Q16(14), 0, TENTHS_Q16(20), TENTHS_Q16(4));
    const el_pose behind = at(TENTHS_Q16(-20), 0, TENTHS_Q16(-100), TENTHS_Q16(8));
    el_pose_turn(&left, EL_AXIS_Y, frame * (0xFFFFFFFFU / 240 + 1U));
    el_pose_turn(&right, EL_AXIS_Y, 0U - frame * (0xFFFFFFFFU / 240 + 1U));
    el_status status = el_light_vertices(&lighting, &teapot, &left, eye_q16, vertex_colours);
    if (status == EL_OK) {
        status = el_light_triangles(&lighting, &teapot, &right, eye_q16, triangle_colours);
    }
    if (status == EL_OK) {
        status = el_draw(renderer, &smooth, &left, &gouraud);
    }
    if (status == EL_OK) {
        status = el_draw(renderer, &facets, &right, &flat);
    }
    return status == EL_OK ? el_draw(renderer, &teapot, &behind, &far) : status;
}

/* After all that is opaque. */
static el_status draw_panes(el_renderer *renderer)
{
    static const el_material panes[] = {
        {.flags = EL_MATERIAL_TWO_SIDED, .colour = {255, 40, 40}, .alpha = 100},
        {.flags = EL_MATERIAL_TWO_SIDED, .colour = {40, 80, 255}, .alpha = 140},
        {.shading = EL_SHADE_TEXTURED, .flags = EL_MATERIAL_TWO_SIDED, .texture = &textures[5], .alpha = 160},
    };
    el_status status = EL_OK;
    for (unsigned i = 0; i < COUNT(panes) && status == EL_OK; i++) {
        const el_pose pose = at(TENTHS_Q16(-5) + TENTHS_Q16(4) * (int32_t)i, TENTHS_Q16(5) + TENTHS_Q16(1) * (int32_t)i,
                                TENTHS_Q16(32) + TENTHS_Q16(2) * (int32_t)i, EL_UNIT_Q16);
        status = el_draw(renderer, &card, &pose, &panes[i]);
    }
    return status;
}

static el_status draw(uint32_t frame, el_renderer *renderer)
{
    static el_fog fog;
    el_camera camera;
    paint();
    lay_floor();
    place_camera(frame, &camera);
    el_status status = el_fog_linear(&fog, &camera, SKY, TENTHS_Q16(80), TENTHS_Q16(220));
    status = status == EL_OK ? el_highlight_make(&highlight, 32) : status;
    if (status == EL_OK) {
        status = draw_floor(renderer, &fog);
    }
    if (status == EL_OK) {
        status = draw_teapots(frame, renderer, camera.position_q16, &fog);
    }
    if (status == EL_OK) {
        status = draw_cards(renderer);
    }
    return status == EL_OK ? draw_panes(renderer) : status;
}

const el_scene el_materials_scene = {
    "materials", "textures, lamps, fog and alpha side by side", SKY, place_camera, draw, NULL};
#endif
