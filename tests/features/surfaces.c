/* Surfaces without pictures: colours, light, sides, fog, and what the view cuts. */
#include "feature.h"
#include "paint/paint_colours.h"
#include "things.h"

enum { CELLS = 8 };

/* Four to a row, two rows. */
static el_pose cell(unsigned number, int32_t scale)
{
    return turned(at(28 * (int32_t)(number % 4) - 42, number < 4 ? 20 : -20, 0, scale), EL_DEGREES(25, 1), 0);
}

/* --- shading ---------------------------------------------------------------------------------------------------------------- */

/* The first vertex' colour, the mean of three, a colour per triangle, Gouraud; the same dithered, a texture, texture times
 * colours, light. */
static el_status draw_shading(uint32_t frame, el_renderer *renderer)
{
    static uint8_t colours[ROUND_TRIANGLES][3];
    static el_mesh meshes[CELLS];
    static const el_texture texture = {.texels = picture, .width_log2 = 4, .height_log2 = 4};
    static const el_material materials[CELLS] = {
        {.shading = EL_SHADE_FLAT},
        {.shading = EL_SHADE_FLAT, .flags = EL_MATERIAL_FLAT_MEAN},
        {.shading = EL_SHADE_FLAT},
        {.shading = EL_SHADE_GOURAUD},
        {.shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_DITHER},
        {.shading = EL_SHADE_TEXTURED, .texture = &texture},
        {.shading = EL_SHADE_TEXTURED_GOURAUD, .texture = &texture},
        {.shading = EL_SHADE_GOURAUD, .light = &white_light},
    };
    (void)frame;
    make_things();
    for (unsigned i = 0; i < ROUND_TRIANGLES; i++) {
        colours[i][0] = (uint8_t)(i * 37);
        colours[i][1] = (uint8_t)(255 - i % 32 * 8);
        colours[i][2] = (uint8_t)(i / 32 * 30);
    }
    el_status status = EL_OK;
    for (unsigned i = 0; i < CELLS; i++) {
        const el_pose pose = cell(i, 13);
        meshes[i] = ball;
        meshes[i].triangle_colours = i == 2 ? (const uint8_t(*)[3])colours : NULL;
        status = worse(status, el_draw(renderer, &meshes[i], &pose, &materials[i]));
    }
    return status;
}

const feature feature_shading = {
    .scene = {.name = "shading", .background = NIGHT, .place_camera = place_camera, .draw = draw_shading}};

/* --- lamps ------------------------------------------------------------------------------------------------------------------ */

/* Beside the ball that they light, before it to the left. */
static el_lamp lamp_of(el_lamp_kind kind, unsigned number)
{
    const el_pose pose = cell(number, 0);
    el_lamp lamp = {.kind = (uint8_t)kind,
                    .colour = {255, 240, 200},
                    .position_q16 = {pose.position_q16[0] - TENTHS_Q16(12), pose.position_q16[1], TENTHS_Q16(30)},
                    .half_q16 = TENTHS_Q16(20)};
    /* Directional: towards the lamp; spot: the other way, (2, 0, -5) / sqrt(29); cosines of 10 and 16 degrees. */
    const int32_t sign = kind == EL_LAMP_SPOT ? 1 : -1;
    lamp.direction_q30[0] = sign * 398776731;
    lamp.direction_q30[2] = -sign * 996941827;
    lamp.inner_q30 = 1057429273;
    lamp.outer_q30 = 1032146886;
    return lamp;
}

/* Ambient light alone, a directional lamp, one at a point, a spot; highlights of two widths, what shines by itself beside two
 * lamps of colours, and a light per triangle. */
static el_status draw_lamps(uint32_t frame, el_renderer *renderer)
{
    static uint8_t colours[CELLS][ROUND_TRIANGLES][3];
    static el_mesh meshes[CELLS];
    static el_highlight highlights[2];
    static const el_material smooth = {.shading = EL_SHADE_GOURAUD};
    static const el_material facets = {.shading = EL_SHADE_FLAT};
    static const el_lamp_kind kinds[CELLS] = {EL_LAMP_POINT,       EL_LAMP_DIRECTIONAL, EL_LAMP_POINT, EL_LAMP_SPOT,
                                              EL_LAMP_DIRECTIONAL, EL_LAMP_DIRECTIONAL, EL_LAMP_POINT, EL_LAMP_SPOT};
    el_camera camera;
    make_things();
    place_camera(frame, &camera);
    el_status status = EL_OK;
    for (unsigned i = 0; i < CELLS; i++) {
        const el_pose pose = cell(i, 13);
        el_lamp lamps[2] = {lamp_of(kinds[i], i), lamp_of(EL_LAMP_DIRECTIONAL, i)};
        el_lighting lighting = {
            .lamps = lamps, .lamp_count = i > 0, .ambient = {40, 40, 50}, .colour = {200, 180, 160}};
        if (i == 4 || i == 5) {
            lighting.specular[0] = lighting.specular[1] = lighting.specular[2] = 255;
            status = worse(status, el_highlight_make(&highlights[i - 4], i == 4 ? 8 : 40));
            lighting.highlight = &highlights[i - 4];
        } else if (i == 6) {
            lighting.lamp_count = 2;
            lighting.emissive[1] = 70;
            lamps[0].colour[1] = lamps[0].colour[2] = 0;
            lamps[1].colour[0] = lamps[1].colour[1] = 0;
            lamps[1].direction_q30[0] = 398776731;
        }
        const bool is_smooth = i < CELLS - 1;
        el_mesh bare = ball;
        bare.colours = NULL;
        meshes[i] = bare;
        *(is_smooth ? &meshes[i].colours : &meshes[i].triangle_colours) = (const uint8_t(*)[3])colours[i];
        status = worse(status, (is_smooth ? el_light_vertices : el_light_triangles)(&lighting, &bare, &pose,
                                                                                    camera.position_q16, colours[i]));
        status = worse(status, el_draw(renderer, &meshes[i], &pose, is_smooth ? &smooth : &facets));
    }
    return status;
}

const feature feature_lamps = {
    .scene = {.name = "lamps", .background = BLACK, .place_camera = place_camera, .draw = draw_lamps}};

/* --- two_sided ---------------------------------------------------------------------------------------------------------------- */

/* Open tubes that lean towards the camera: front faces alone; both, in their colours; both, lit; both, lit by a lamp. */
static el_status draw_two_sided(uint32_t frame, el_renderer *renderer)
{
    static uint8_t colours[ROUND_VERTICES][3];
    static el_mesh lit;
    static const el_material materials[4] = {
        {.shading = EL_SHADE_GOURAUD},
        {.shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_TWO_SIDED},
        {.shading = EL_SHADE_FLAT, .flags = EL_MATERIAL_TWO_SIDED, .light = &white_light},
        {.shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_TWO_SIDED},
    };
    const el_lamp lamp = lamp_of(EL_LAMP_DIRECTIONAL, 0);
    const el_lighting lighting = {
        .lamps = &lamp, .lamp_count = 1, .ambient = {30, 40, 60}, .colour = {255, 200, 120}, .two_sided = true};
    el_camera camera;
    make_things();
    place_camera(frame, &camera);
    lit = tube;
    lit.colours = (const uint8_t(*)[3])colours;
    el_mesh bare = tube;
    bare.colours = NULL;
    el_status status = EL_OK;
    for (unsigned i = 0; i < 4; i++) {
        const el_pose pose = turned(at(28 * (int32_t)i - 42, 0, 0, 12), EL_DEGREES(50, 1), 0);
        if (i == 3) {
            status = worse(status, el_light_vertices(&lighting, &bare, &pose, camera.position_q16, colours));
        }
        status = worse(status, el_draw(renderer, i == 3 ? &lit : &tube, &pose, &materials[i]));
    }
    return status;
}

const feature feature_two_sided = {
    .scene = {.name = "two_sided", .background = NIGHT, .place_camera = place_camera, .draw = draw_two_sided}};

/* --- fog ---------------------------------------------------------------------------------------------------------------------- */

#if FEATURES_MIXED
/* Balls that go away, flat, Gouraud and textured: to the left with linear fog, to the right with exponential one. */
static el_status draw_fog(uint32_t frame, el_renderer *renderer)
{
    static el_fog fogs[2];
    static el_material materials[2][3];
    static const el_texture texture = {.texels = picture, .width_log2 = 4, .height_log2 = 4};
    el_camera camera;
    make_things();
    place_camera(frame, &camera);
    el_status status = el_fog_linear(&fogs[0], &camera, GREY, TENTHS_Q16(80), TENTHS_Q16(400));
    status = worse(status, el_fog_exponential(&fogs[1], &camera, GREY, TENTHS_Q16(1)));
    for (int32_t i = 0; i < 18; i++) {
        const int32_t side = i % 2;
        const int32_t kind = i / 2 % 3;
        const int32_t row = i / 6;
        materials[side][kind] = (el_material){.shading = (uint8_t)kind,
                                              .flags = EL_MATERIAL_FLAT_MEAN,
                                              .colour = {200, 80, 40},
                                              .texture = kind == EL_SHADE_TEXTURED ? &texture : NULL,
                                              .fog = &fogs[side]};
        const int32_t away = 90 * row + 30 * kind;
        const int32_t x = (side == 0 ? -1 : 1) * (15 + away / 4 + 22 * row);
        const el_pose pose = turned(at(x, 22 - 22 * kind, -away, 16), EL_DEGREES(25, 1), 0);
        status = worse(status, el_draw(renderer, &ball, &pose, &materials[side][kind]));
    }
    return status;
}

const feature feature_fog = {
    .scene = {.name = "fog", .background = GREY, .place_camera = place_camera, .draw = draw_fog}};
#endif

/* --- wires ------------------------------------------------------------------------------------------------------------------ */

#if FEATURES_MIXED
/* All edges over nothing; those that are not hidden by a surface, by one that does not show, by a half transparent one; and
 * those that the mesh names: without diagonals. */
static el_status draw_wires(uint32_t frame, el_renderer *renderer)
{
    static uint8_t edges[ROUND_TRIANGLES];
    static el_mesh squares;
    static const el_material surfaces[5] = {
        {.shading = EL_SHADE_FLAT}, /* not drawn */
        {.shading = EL_SHADE_GOURAUD},
        {.flags = EL_MATERIAL_BLEND_DEPTH, .alpha = 1},
        {.shading = EL_SHADE_GOURAUD, .alpha = 128},
        {.flags = EL_MATERIAL_BLEND_DEPTH, .alpha = 1},
    };
    static const el_material lines[2] = {
        {.flags = EL_MATERIAL_WIRES, .colour = {255, 255, 255}},
        {.flags = EL_MATERIAL_WIRES | EL_MATERIAL_TWO_SIDED, .colour = {255, 220, 60}},
    };
    (void)frame;
    make_things();
    squares = ball;
    squares.edges = edges;
    for (unsigned i = 0; i < ROUND_TRIANGLES; i++) {
        edges[i] = i % 2 == 0 ? 3 : 6; /* corners are a, b, c and a, c, d: the diagonal is between a and c */
    }
    el_status status = EL_OK;
    for (int32_t i = 0; i < 5; i++) {
        const el_mesh *const mesh = i == 4 ? &squares : &ball;
        const el_pose pose = turned(at(20 * i - 40, i % 2 == 0 ? 17 : -17, 0, 14), EL_DEGREES(25, 1), 0);
        if (i > 0) {
            status = worse(status, el_draw(renderer, mesh, &pose, &surfaces[i]));
        }
        status = worse(status, el_draw(renderer, mesh, &pose, &lines[i == 0 || i == 3]));
    }
    return status;
}

const feature feature_wires = {
    .scene = {.name = "wires", .background = NIGHT, .place_camera = place_camera, .draw = draw_wires},
    .blends_depth = true,
    .has_wires = true};
#endif

/* --- clipping, orthographic --------------------------------------------------------------------------------------------------- */

/* In a ball, with tubes through the near plane and one far beyond the view on all sides. */
static el_status draw_clipping(uint32_t frame, el_renderer *renderer)
{
    static const el_texture texture = {.texels = picture, .width_log2 = 4, .height_log2 = 4};
    static const el_material materials[3] = {
        {.shading = EL_SHADE_TEXTURED, .flags = EL_MATERIAL_TWO_SIDED, .texture = &texture},
        {.shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_TWO_SIDED},
        {.shading = EL_SHADE_FLAT, .flags = EL_MATERIAL_TWO_SIDED, .light = &white_light},
    };
    (void)frame;
    make_things();
    const el_pose poses[3] = {
        at(0, 0, 0, 200),
        turned(at(-12, -4, 78, 10), EL_DEGREES(80, 1), 0),
        turned(at(100, 60, 20, 80), EL_DEGREES(40, 1), EL_DEGREES(20, 1)),
    };
    el_status status = EL_OK;
    for (unsigned i = 0; i < 3; i++) {
        status = worse(status, el_draw(renderer, i == 0 ? &ball : &tube, &poses[i], &materials[i]));
    }
    return status;
}

const feature feature_clipping = {
    .scene = {.name = "clipping", .background = NIGHT, .place_camera = place_camera, .draw = draw_clipping}};

static void place_orthographic(uint32_t frame, el_camera *camera)
{
    place_camera(frame, camera);
    camera->projection = EL_ORTHOGRAPHIC;
    camera->height_q16 = TENTHS_Q16(80);
}

/* As large far away as nearby. */
static el_status draw_orthographic(uint32_t frame, el_renderer *renderer)
{
    static const el_texture texture = {.texels = picture, .width_log2 = 4, .height_log2 = 4};
    static const el_material materials[4] = {
        {.shading = EL_SHADE_FLAT, .light = &white_light},
        {.shading = EL_SHADE_GOURAUD},
        {.shading = EL_SHADE_TEXTURED, .texture = &texture},
        {.shading = EL_SHADE_TEXTURED_GOURAUD, .texture = &texture},
    };
    (void)frame;
    make_things();
    el_status status = EL_OK;
    for (int32_t i = 0; i < 4; i++) {
        const el_pose pose = turned(at(22 * i - 33, 9 * i - 14, -100 * i, 16), EL_DEGREES(25, 1), 0);
        status = worse(status, el_draw(renderer, &ball, &pose, &materials[i]));
    }
    return status;
}

const feature feature_orthographic = {
    .scene = {
        .name = "orthographic", .background = NIGHT, .place_camera = place_orthographic, .draw = draw_orthographic}};
