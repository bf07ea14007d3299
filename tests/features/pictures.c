/* Surfaces with pictures: formats, what lies beyond their borders, smaller ones for what is far, and what shows through. */
#include "feature.h"
#include "paint/paint_colours.h"
#include "things.h"

#if FEATURES_MIXED

/* --- formats ---------------------------------------------------------------------------------------------------------------- */

/* RGB565, 8 bits, 4 bits, a mask; above as they are, below smooth. */
static el_status draw_formats(uint32_t frame, el_renderer *renderer)
{
    static const el_image *const images[4] = {&image_rgb565, &image_index8, &image_index4, &image_mask};
    static el_texture textures[8];
    static el_material materials[8];
    (void)frame;
    make_things();
    el_status status = EL_OK;
    for (unsigned i = 0; i < 8; i++) {
        textures[i] = (el_texture){.image = images[i % 4], .smooth = i >= 4};
        materials[i] = (el_material){.shading = EL_SHADE_TEXTURED, .texture = &textures[i]};
        const el_pose pose =
            turned(at(28 * (int32_t)(i % 4) - 42, i < 4 ? 20 : -20, 0, 12), EL_DEGREES(350, 1), EL_DEGREES(15, 1));
        status = worse(status, el_draw(renderer, &card, &pose, &materials[i]));
    }
    return status;
}

const feature feature_formats = {
    .scene = {.name = "formats", .background = NIGHT, .place_camera = place_camera, .draw = draw_formats}};

/* --- wraps ------------------------------------------------------------------------------------------------------------------ */

/* Repeated, clamped and mirrored, u from left to right, v from top to bottom: 16 x 16 texels as they are, 12 x 10 smooth. */
static el_status draw_wraps(uint32_t frame, el_renderer *renderer)
{
    static el_texture textures[18];
    static el_material materials[18];
    (void)frame;
    make_things();
    el_status status = EL_OK;
    for (unsigned i = 0; i < 18; i++) {
        const unsigned column = i % 6;
        textures[i] = (el_texture){.texels = picture,
                                   .width_log2 = 4,
                                   .height_log2 = 4,
                                   .wrap_u = (uint8_t)(column % 3),
                                   .wrap_v = (uint8_t)(i / 6),
                                   .smooth = column >= 3,
                                   .image = column >= 3 ? &image_odd : NULL};
        materials[i] = (el_material){.shading = EL_SHADE_TEXTURED, .texture = &textures[i]};
        const el_pose pose = at(20 * (int32_t)column - 50, 26 - 26 * (int32_t)(i / 6), 0, 9);
        status = worse(status, el_draw(renderer, &wide_card, &pose, &materials[i]));
    }
    return status;
}

const feature feature_wraps = {
    .scene = {.name = "wraps", .background = NIGHT, .place_camera = place_camera, .draw = draw_wraps}};

/* --- mipmaps ---------------------------------------------------------------------------------------------------------------- */

enum { CHAIN_LOG2 = 6, CHAIN = CHAIN_LOG2 + 1, FLOOR_ROWS = 12 };

/* Checks, whose light squares have a colour for each level: white, red, green, blue, and so on. */
static void paint_chain(el_texture chain[CHAIN])
{
    static const uint16_t colours[4] = {WHITE, RED, GREEN, BLUE};
    static uint16_t texels[CHAIN][1 << 2 * CHAIN_LOG2];
    for (unsigned level = 0; level < CHAIN; level++) {
        const unsigned side_log2 = CHAIN_LOG2 - level;
        for (unsigned i = 0; i < 1U << 2 * side_log2; i++) {
            const unsigned x = i & ((1U << side_log2) - 1U);
            const unsigned y = i >> side_log2;
            const bool is_dark = side_log2 >= 3 && (((x ^ y) >> (side_log2 - 3)) & 1U) != 0;
            texels[level][i] = is_dark ? DARK : colours[level % 4];
        }
        chain[level] = (el_texture){.texels = texels[level],
                                    .width_log2 = (uint8_t)side_log2,
                                    .height_log2 = (uint8_t)side_log2,
                                    .smaller = level < CHAIN - 1 ? &chain[level + 1] : NULL};
    }
}

/* A floor of squares that goes away: to the left with its first texture alone, to the right with all of them; every other
 * column smooth. */
static el_status draw_mipmaps(uint32_t frame, el_renderer *renderer)
{
    static el_texture textures[4][CHAIN]; /* with the chain or without, smooth or not */
    static el_material materials[4];
    (void)frame;
    make_things();
    for (unsigned kind = 0; kind < 4; kind++) {
        paint_chain(textures[kind]);
        for (unsigned level = 0; level < CHAIN; level++) {
            textures[kind][level].smooth = (kind & 2U) != 0;
        }
        textures[kind][0].smaller = (kind & 1U) != 0 ? textures[kind][0].smaller : NULL;
        materials[kind] = (el_material){.shading = EL_SHADE_TEXTURED, .texture = &textures[kind][0]};
    }
    el_status status = EL_OK;
    for (unsigned i = 0; i < FLOOR_ROWS * 4; i++) {
        const unsigned column = i % 4;
        const unsigned kind = column / 2 + (column % 2 != 0 ? 2 : 0);
        const el_pose pose =
            turned(at(30 * (int32_t)column - 45, -20, 40 - 30 * (int32_t)(i / 4), 15), EL_DEGREES(270, 1), 0);
        status = worse(status, el_draw(renderer, &floor_card, &pose, &materials[kind]));
    }
    return status;
}

const feature feature_mipmaps = {
    .scene = {.name = "mipmaps", .background = 0x7DDD, .place_camera = place_camera, .draw = draw_mipmaps}};

/* --- alpha ------------------------------------------------------------------------------------------------------------------ */

typedef struct pane {
    int16_t x, y, z, scale; /* tenths */
    el_material material;
} pane;

/* Before a row of balls. Above: a colour that is left out, as it is and smooth; a mask; alpha per texel, as it is and smooth,
 * and again with half of it. In the middle: alpha of 1, 64, 128, 192, 254, 255. Below pairs, red behind blue: drawn from the
 * back, from the front, from the front with depth; and a card without depth over a pane before it. */
static el_status draw_alpha(uint32_t frame, el_renderer *renderer)
{
    static el_image keyed, glowing;
    static const el_texture textures[5] = {
        {.image = &keyed},   {.image = &keyed, .smooth = true},   {.image = &image_mask},
        {.image = &glowing}, {.image = &glowing, .smooth = true},
    };
#define PICTURE(number) .shading = EL_SHADE_TEXTURED, .texture = &textures[number]
#define RED_PANE .colour = {255, 60, 60}, .alpha = 128
#define BLUE_PANE .colour = {60, 100, 255}, .alpha = 128
    static const pane panes[] = {
        {-50, 27, 0, 9, {PICTURE(0)}},
        {-30, 27, 0, 9, {PICTURE(1)}},
        {-10, 27, 0, 9, {PICTURE(2)}},
        {10, 27, 0, 9, {PICTURE(3)}},
        {30, 27, 0, 9, {PICTURE(4)}},
        {50, 27, 0, 9, {PICTURE(4), .alpha = 128}},
        {-50, 0, 0, 9, {.shading = EL_SHADE_GOURAUD, .alpha = 1}},
        {-30, 0, 0, 9, {.shading = EL_SHADE_GOURAUD, .alpha = 64}},
        {-10, 0, 0, 9, {.shading = EL_SHADE_GOURAUD, .alpha = 128}},
        {10, 0, 0, 9, {.shading = EL_SHADE_GOURAUD, .alpha = 192}},
        {30, 0, 0, 9, {.shading = EL_SHADE_GOURAUD, .alpha = 254}},
        {50, 0, 0, 9, {.shading = EL_SHADE_GOURAUD, .alpha = 255}},
        {-48, -24, 0, 8, {RED_PANE}},
        {-42, -30, 5, 8, {BLUE_PANE}},
        {-12, -30, 5, 8, {BLUE_PANE}},
        {-18, -24, 0, 8, {RED_PANE}},
        {18, -30, 5, 8, {BLUE_PANE, .flags = EL_MATERIAL_BLEND_DEPTH}},
        {12, -24, 0, 8, {RED_PANE, .flags = EL_MATERIAL_BLEND_DEPTH}},
        {46, -27, 0, 9, {BLUE_PANE}},
        {46, -27, -20, 6, {.colour = {255, 220, 60}, .flags = EL_MATERIAL_NO_DEPTH}},
    };
    static const el_material gouraud = {.shading = EL_SHADE_GOURAUD};
    static el_mesh bare;
    (void)frame;
    make_things();
    keyed = image_index8;
    keyed.has_key = true;
    keyed.key = 255;
    glowing = image_rgb565;
    glowing.alpha = glow;
    bare = card;
    bare.colours = NULL;
    el_status status = EL_OK;
    for (int32_t i = 0; i < 18; i++) {
        const el_pose pose = at(i % 6 * 20 - 50, 26 - 26 * (i / 6), -10, 6);
        status = worse(status, el_draw(renderer, &ball, &pose, &gouraud));
    }
    for (unsigned i = 0; i < COUNT(panes); i++) {
        const pane *const p = &panes[i];
        const el_pose pose = at(p->x, p->y, p->z, p->scale);
        const bool has_colours = p->material.shading == EL_SHADE_GOURAUD;
        status = worse(status, el_draw(renderer, has_colours ? &card : &bare, &pose, &p->material));
    }
    return status;
}

const feature feature_alpha = {
    .scene = {.name = "alpha", .background = DARK, .place_camera = place_camera, .draw = draw_alpha},
    .blends_depth = true};
#endif
