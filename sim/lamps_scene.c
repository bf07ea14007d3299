#include "lamps_scene.h"

#include "scene_units.h"

#if EL_HAS_LAMPS_SCENE

enum {
    NIGHT = 0x10A4,
    HAZE = 0x9492,
    TEXELS = 16, /* of the texture's sides */
    RINGS = 8,
    SLICES = 12,
    ROW = SLICES + 1,
    RADIUS = 256, /* position units */
    COLUMNS = 6,
    THINGS = 3 * COLUMNS
};

/* --- A sphere, and its front half as a bowl --------------------------------------------------------------------------- */

static int16_t positions[(RINGS + 1) * ROW][3];
static int8_t normals[COUNT(positions)][3];
static int16_t uvs[COUNT(positions)][2];
static uint8_t colours[COUNT(positions)][3];
static uint16_t triangles[2 * RINGS * SLICES][3];
static uint8_t triangle_colours[COUNT(triangles)][3];
static uint16_t bowl_triangles[RINGS * SLICES][3];
static uint16_t texels[TEXELS * TEXELS];
static const el_texture texture = {.texels = texels, .width_log2 = 4, .height_log2 = 4};

#define SPHERE                                                                                                         \
    .positions = (const int16_t(*)[3])positions, .normals = (const int8_t(*)[3])normals,                               \
    .uvs = (const int16_t(*)[2])uvs, .vertex_count = COUNT(positions), .scale_log2 = -9, .radius = RADIUS + 2
#define WHOLE .triangles = (const uint16_t(*)[3])triangles, .triangle_count = COUNT(triangles)
#define HALF .triangles = (const uint16_t(*)[3])bowl_triangles, .triangle_count = COUNT(bowl_triangles)

static const el_mesh plain = {SPHERE, WHOLE};
static const el_mesh by_vertex = {SPHERE, WHOLE, .colours = (const uint8_t (*)[3])colours};
static const el_mesh by_triangle = {SPHERE, WHOLE, .triangle_colours = (const uint8_t (*)[3])triangle_colours};
static const el_mesh bowl = {SPHERE, HALF};

static void make_vertex(int ring, int slice)
{
    const int at = ring * ROW + slice;
    const el_angle down = (el_angle)ring * (0x80000000U / RINGS);
    const el_angle around = (el_angle)slice * (0xFFFFFFFFU / SLICES + 1U);
    const int64_t across_q30 = el_sin_q30(down);
    const int64_t axes_q30[3] = {across_q30 * el_sin_q30(around) >> 30, el_cos_q30(down),
                                 across_q30 * el_cos_q30(around) >> 30};
    for (unsigned i = 0; i < 3; i++) {
        positions[at][i] = (int16_t)(axes_q30[i] * RADIUS >> 30);
        normals[at][i] = (int8_t)(axes_q30[i] * 127 >> 30);
        colours[at][i] = (uint8_t)(155 + (axes_q30[i] * 100 >> 30));
    }
    uvs[at][0] = (int16_t)(slice * 3 * TEXELS * 16 / SLICES);
    uvs[at][1] = (int16_t)(ring * 2 * TEXELS * 16 / RINGS);
}

static void make_cell(int ring, int slice)
{
    const int at = ring * SLICES + slice;
    const uint16_t corner = (uint16_t)(ring * ROW + slice);
    const uint16_t cell[4] = {corner, (uint16_t)(corner + ROW), (uint16_t)(corner + ROW + 1), (uint16_t)(corner + 1)};
    for (unsigned k = 0; k < 3; k++) {
        triangles[2 * at][k] = cell[k];
        triangles[2 * at + 1][k] = cell[k == 0 ? 0 : k + 1];
        triangle_colours[2 * at][k] = (uint8_t)(k == 0 ? 230 : 90 + 10 * ring);
        triangle_colours[2 * at + 1][k] = (uint8_t)(k == 2 ? 230 : 90 + 10 * slice);
    }
}

static void make(void)
{
    static bool done;
    if (done) {
        return;
    }
    done = true;
    for (int ring = 0; ring <= RINGS; ring++) {
        for (int slice = 0; slice <= SLICES; slice++) {
            make_vertex(ring, slice);
        }
    }
    unsigned taken = 0;
    for (int ring = 0; ring < RINGS; ring++) {
        for (int slice = 0; slice < SLICES; slice++) {
            make_cell(ring, slice);
            if (slice < SLICES / 4 || slice >= SLICES * 3 / 4) {
                for (unsigned k = 0; k < 6; k++) {
                    bowl_triangles[taken + k / 3][k % 3] = triangles[2 * (ring * SLICES + slice) + (int)(k / 3)][k % 3];
                }
                taken += 2;
            }
        }
    }
    for (unsigned i = 0; i < COUNT(texels); i++) {
        const bool light = ((i / TEXELS / 4 + i % TEXELS / 4) & 1U) != 0;
        texels[i] = light ? el_rgb565(250, 240, 200) : el_rgb565(60, 110, 190);
    }
}

/* --- Lights -------------------------------------------------------------------------------------------------------------- */

/* From the upper left, a little from behind the viewer; (-2, 3, 2) / sqrt(17). */
#define KEY_Q30                                                                                                        \
    {                                                                                                                  \
        -520841137, 781261706, 520841137                                                                               \
    }
static const el_light key = {.direction_q30 = KEY_Q30, .ambient = 40, .diffuse = 215};

/* Those of the second row, in its things' own places, and which of them each has, a bit for each. */
enum { SUN = 1, BULB = 2, TORCH = 4, LAMPS = 3 };
static const el_lamp lamps[LAMPS] = {
    {.kind = EL_LAMP_DIRECTIONAL, .colour = {255, 250, 220}, .direction_q30 = KEY_Q30},
    {.kind = EL_LAMP_POINT,
     .colour = {255, 140, 60},
     .position_q16 = {TENTHS_Q16(-6), TENTHS_Q16(-2), TENTHS_Q16(8)},
     .half_q16 = TENTHS_Q16(8)},
    {.kind = EL_LAMP_SPOT,
     .colour = {120, 220, 255},
     .direction_q30 = {0, 0, -EL_UNIT_Q30},
     .position_q16 = {TENTHS_Q16(1), TENTHS_Q16(1), TENTHS_Q16(30)},
     .inner_q30 = 1069000000, /* cos 5.4 degrees, and 8.1 */
     .outer_q30 = 1063000000},
};
static const uint8_t lamps_of[COLUMNS] = {SUN, BULB, TORCH, SUN | BULB, SUN, SUN | BULB | TORCH};

#define OWN .colour = {220, 200, 190}, .ambient = {20, 20, 28}
static el_highlight highlight;
#define SHINY .highlight = &highlight, .specular = {220, 220, 220}

static const el_lighting lightings[COLUMNS] = {
    {OWN}, {OWN}, {OWN}, {SHINY}, {OWN, .emissive = {0, 90, 30}}, {OWN, SHINY},
};
static const el_lighting one_sided = {OWN, .lamps = lamps, .lamp_count = 1};
static const el_lighting two_sided = {OWN, .lamps = lamps, .lamp_count = 1, .two_sided = true};

/* --- The scene ----------------------------------------------------------------------------------------------------------- */

static uint8_t lit[THINGS][COUNT(positions)][3];
static el_mesh lit_meshes[THINGS];

static void place_camera(uint32_t frame, el_camera *camera)
{
    static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};
    static const int32_t target_q16[3] = {0, 0, 0};
    static const int32_t eye_q16[3] = {0, 0, TENTHS_Q16(70)};
    (void)frame;
    *camera = (el_camera){.fov_y = EL_DEGREES(36, 1), .near_q16 = TENTHS_Q16(10), .far_q16 = TENTHS_Q16(400)};
    (void)el_camera_look_at(camera, eye_q16, target_q16, up_q16); /* neither equal nor in line with `up` */
}

static el_pose pose_of(unsigned thing, uint32_t frame)
{
    el_pose pose = el_pose_identity();
    pose.position_q16[0] = TENTHS_Q16(10) * ((int32_t)(thing % COLUMNS) * 2 - COLUMNS + 1) / 2;
    pose.position_q16[1] = TENTHS_Q16(14) * (1 - (int32_t)(thing / COLUMNS));
    pose.scale_q16 = TENTHS_Q16(9);
    el_pose_turn(&pose, EL_AXIS_Y, frame * (0xFFFFFFFFU / 240 + 1U));
    return pose;
}

/* What is drawn in one light, the library's own. */
static el_status draw_in_light(uint32_t frame, el_renderer *renderer)
{
    static const struct {
        const el_mesh *mesh;
        el_material material;
    } things[COLUMNS] = {
        {&by_triangle, {.shading = EL_SHADE_FLAT, .light = &key}},
        {&by_vertex, {.shading = EL_SHADE_FLAT, .flags = EL_MATERIAL_FLAT_MEAN, .light = &key}},
        {&by_vertex, {.shading = EL_SHADE_GOURAUD, .light = &key}},
        {&plain, {.shading = EL_SHADE_TEXTURED, .texture = &texture}},
        {&plain, {.shading = EL_SHADE_TEXTURED_GOURAUD, .colour = {255, 255, 255}, .texture = &texture, .light = &key}},
        {&by_vertex,
         {.shading = EL_SHADE_TEXTURED_GOURAUD, .flags = EL_MATERIAL_DITHER, .texture = &texture, .light = &key}},
    };
    el_status status = EL_OK;
    for (unsigned i = 0; i < COLUMNS && status == EL_OK; i++) {
        const el_pose pose = pose_of(i, frame);
        status = el_draw(renderer, things[i].mesh, &pose, &things[i].material);
    }
    return status;
}

static el_status draw_lit(el_renderer *renderer, unsigned thing, const el_lighting *lighting, const el_mesh *mesh,
                          const el_pose *pose, const el_material *material)
{
    el_camera camera;
    place_camera(0, &camera);
    const el_status status = el_light_vertices(lighting, mesh, pose, camera.position_q16, lit[thing]);
    lit_meshes[thing] = *mesh;
    lit_meshes[thing].colours = (const uint8_t(*)[3])lit[thing];
    return status == EL_OK ? el_draw(renderer, &lit_meshes[thing], pose, material) : status;
}

/* Each in the light of its own lamps, which go along with it. */
static el_status draw_in_lamps(uint32_t frame, el_renderer *renderer)
{
    static const el_material gouraud = {.shading = EL_SHADE_GOURAUD};
    static const el_material textured = {.shading = EL_SHADE_TEXTURED_GOURAUD, .texture = &texture};
    el_status status = EL_OK;
    for (unsigned i = 0; i < COLUMNS && status == EL_OK; i++) {
        const el_pose pose = pose_of(COLUMNS + i, frame);
        el_lamp placed[LAMPS];
        el_lighting lighting = lightings[i];
        lighting.lamps = placed;
        for (unsigned k = 0; k < LAMPS; k++) {
            if ((lamps_of[i] >> k & 1U) != 0) {
                el_lamp *const lamp = &placed[lighting.lamp_count++];
                *lamp = lamps[k];
                for (unsigned axis = 0; axis < 3; axis++) {
                    lamp->position_q16[axis] += pose.position_q16[axis];
                }
            }
        }
        status = draw_lit(renderer, COLUMNS + i, &lighting, &plain, &pose, i == COLUMNS - 1 ? &textured : &gouraud);
    }
    return status;
}

/* Bowls: from outside, and three from inside, of which the second is lit as if it were the outside. */
static el_status draw_bowls(uint32_t frame, el_renderer *renderer)
{
    static const el_material own = {
        .shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_TWO_SIDED, .colour = {220, 200, 190}, .light = &key};
    static const el_material gouraud = {.shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_TWO_SIDED};
    el_status status = EL_OK;
    for (unsigned i = 0; i < 4 && status == EL_OK; i++) {
        const unsigned thing = 2 * COLUMNS + i;
        el_pose pose = pose_of(thing, frame);
        if (i > 0) {
            el_pose_turn(&pose, EL_AXIS_Y, EL_DEGREES(160, 1));
        }
        if (i < 1 || i == 3) {
            status = el_draw(renderer, &bowl, &pose, &own);
        } else {
            status = draw_lit(renderer, thing, i == 1 ? &one_sided : &two_sided, &bowl, &pose, &gouraud);
        }
    }
    return status;
}

/* One behind the other. */
static el_status draw_in_haze(uint32_t frame, el_renderer *renderer)
{
    static el_fog fog;
    static el_material material;
    el_camera camera;
    place_camera(frame, &camera);
    el_status status = el_fog_exponential(&fog, &camera, HAZE, TENTHS_Q16(1));
    material = (el_material){.shading = EL_SHADE_GOURAUD, .colour = {230, 120, 40}, .light = &key, .fog = &fog};
    for (int32_t i = 0; i < 5 && status == EL_OK; i++) {
        el_pose pose = pose_of(3 * COLUMNS - 2, frame);
        pose.position_q16[0] += TENTHS_Q16(11) * i;
        pose.position_q16[1] -= TENTHS_Q16(3) * i;
        pose.position_q16[2] -= TENTHS_Q16(25) * i;
        status = el_draw(renderer, &plain, &pose, &material);
    }
    return status;
}

static el_status draw(uint32_t frame, el_renderer *renderer)
{
    make();
    el_status status = el_highlight_make(&highlight, 32);
    if (status == EL_OK) {
        status = draw_in_light(frame, renderer);
    }
    if (status == EL_OK) {
        status = draw_in_lamps(frame, renderer);
    }
    if (status == EL_OK) {
        status = draw_bowls(frame, renderer);
    }
    return status == EL_OK ? draw_in_haze(frame, renderer) : status;
}

const el_scene el_lamps_scene = {"lamps", "shadings, lights and lamps side by side", NIGHT, place_camera, draw, NULL};
#endif
