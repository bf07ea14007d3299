/* Two dimensions in the same bands: under and over things, edge to edge with them, and pictures by themselves. */
#include "feature.h"
#include "paint/fonts/aileron_11.h"
#include "paint/fonts/aileron_13.h"
#include "paint/paint_colours.h"
#include "things.h"

/* --- layers ----------------------------------------------------------------------------------------------------------------- */

/* A sky of bars with a sun, under all. */
static void draw_sky(void *context, el_band *band)
{
    const el_canvas canvas = el_canvas_of(band);
    uint8_t memory[EL_POLYGON_BYTES(76, FEATURE_WIDTH)];
    el_polygon p;
    (void)context;
    for (int32_t i = 0; i < 16; i++) {
        el_canvas_fill(&canvas, (el_rect){0, 10 * i, FEATURE_WIDTH, 10 * i + 10},
                       el_solid(el_rgb565((uint8_t)(20 + 12 * i), (uint8_t)(40 + 8 * i), 120)));
    }
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_ellipse(&p, EL_SUB(60), EL_SUB(70), EL_SUB(44), EL_SUB(44));
    (void)el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SMOOTH_16, el_solid(YELLOW));
}

/* Glass with text, lines and a dial, over all; the text to the right is cut by a clip rectangle. */
static void draw_glass(void *context, el_band *band)
{
    static const int32_t needle[2][2] = {{EL_SUB(200), EL_SUB(120)}, {EL_SUB(222), EL_SUB(98)}};
    static const el_stroke thick = {.width = EL_SUB(5), .cap = EL_CAP_ROUND, .join = EL_JOIN_ROUND};
    const el_canvas canvas = el_canvas_of(band);
    const el_canvas inner = el_canvas_clipped(&canvas, (el_rect){120, 8, 216, 40});
    uint8_t memory[EL_POLYGON_BYTES(200, FEATURE_WIDTH)];
    el_polygon p;
    (void)context;
    el_canvas_fill(&canvas, (el_rect){8, 8, 112, 40}, el_glaze(BLACK, 140));
    el_canvas_frame(&canvas, (el_rect){8, 8, 112, 40}, 1, el_solid(CYAN));
    el_canvas_text(&canvas, &aileron_13, 14, 24, EL_ALIGN_LEFT, "Layers 21 \xC2\xB0", el_solid(WHITE));
    el_canvas_text(&canvas, &aileron_11, 14, 36, EL_ALIGN_LEFT, "over and under", el_glaze(WHITE, 180));
    el_canvas_fill(&inner, (el_rect){0, 0, FEATURE_WIDTH, FEATURE_HEIGHT}, el_glaze(RED, 100));
    el_canvas_text(&inner, &aileron_13, 168, 20, EL_ALIGN_CENTRE, "clipped to the left\nand to the right",
                   el_solid(WHITE));
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_ellipse(&p, EL_SUB(200), EL_SUB(120), EL_SUB(34), EL_SUB(34));
    el_polygon_ellipse(&p, EL_SUB(200), EL_SUB(120), EL_SUB(28), EL_SUB(28));
    (void)el_polygon_fill(&p, &canvas, EL_EVEN_ODD, EL_SMOOTH_8, el_glaze(WHITE, 200));
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_stroke(&p, needle, 2, false, &thick);
    (void)el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SMOOTH_8, el_solid(RED));
    el_canvas_line(&canvas, 0, 159, 239, 100, el_solid(GREEN));
}

static el_status draw_between(uint32_t frame, el_renderer *renderer)
{
    static const el_material gouraud = {.shading = EL_SHADE_GOURAUD};
    (void)frame;
    make_things();
    const el_pose left = turned(at(-22, -8, 0, 24), EL_DEGREES(25, 1), 0);
    const el_pose right = turned(at(32, 4, 0, 26), EL_DEGREES(40, 1), 0);
    return worse(el_draw(renderer, &ball, &left, &gouraud), el_draw(renderer, &cone, &right, &gouraud));
}

const feature feature_layers = {
    .scene = {.name = "layers", .background = BLACK, .place_camera = place_camera, .draw = draw_between},
    .under = {.draw = draw_sky},
    .over = {.draw = draw_glass}};

/* --- seams ------------------------------------------------------------------------------------------------------------------ */

/* Corners of a fan, in 1/EL_SUBPIXELS px of a screen of 20 px per unit, and as a mesh has them. */
enum { FAN = 12, FAN_SCALE_LOG2 = -10, PX_PER_UNIT = 20, FAN_X = 120, FAN_Y = 80 };

static void place_flat(uint32_t frame, el_camera *camera)
{
    place_camera(frame, camera);
    camera->projection = EL_ORTHOGRAPHIC;
    camera->height_q16 = FEATURE_HEIGHT / PX_PER_UNIT * EL_UNIT_Q16;
}

/* Numbers of 1/16 px; the even ones lie farther out. */
static void fan_corner(uint32_t number, int32_t *x_q4, int32_t *y_q4)
{
    const el_angle angle = number * (0xFFFFFFFFU / FAN + 1U) + EL_DEGREES(7, 1);
    const int32_t radius_q4 = number % 2 == 0 ? 74 * 16 : 52 * 16 + 5;
    *x_q4 = (int32_t)((int64_t)el_cos_q30(angle) * radius_q4 / (EL_UNIT_Q30 / 16 * 16));
    *y_q4 = (int32_t)((int64_t)el_sin_q30(angle) * radius_q4 / (EL_UNIT_Q30 / 16 * 16));
}

/* Every other triangle of a fan; polygons are the others, and a frame around all, half transparent, so that a pixel that were
 * drawn twice, or not at all, would have a colour of its own. */
static el_status draw_fan(uint32_t frame, el_renderer *renderer)
{
    static int16_t positions[FAN + 1][3];
    static uint16_t triangles[FAN / 2][3];
    static const el_material plain = {.colour = {60, 120, 250}};
    static el_mesh mesh;
    (void)frame;
    for (uint32_t i = 0; i < FAN; i++) {
        int32_t x_q4;
        int32_t y_q4;
        fan_corner(i, &x_q4, &y_q4);
        /* 1/16 px is 1/320 unit; rounding to the screen brings it back. */
        positions[i + 1][0] = (int16_t)(x_q4 * (1 << -FAN_SCALE_LOG2) / (PX_PER_UNIT * 16));
        positions[i + 1][1] = (int16_t)(-y_q4 * (1 << -FAN_SCALE_LOG2) / (PX_PER_UNIT * 16));
        if (i % 2 == 0) {
            triangles[i / 2][0] = 0;
            triangles[i / 2][1] = (uint16_t)(i + 2);
            triangles[i / 2][2] = (uint16_t)(i + 1);
        }
    }
    mesh = (el_mesh){.positions = (const int16_t(*)[3])positions,
                     .triangles = (const uint16_t(*)[3])triangles,
                     .vertex_count = FAN + 1,
                     .triangle_count = FAN / 2,
                     .scale_log2 = FAN_SCALE_LOG2,
                     .radius = 5000};
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, &mesh, &pose, &plain);
}

static void draw_rest_of_fan(void *context, el_band *band)
{
    const el_canvas canvas = el_canvas_of(band);
    uint8_t memory[EL_POLYGON_BYTES(FAN + 4, 0)];
    const int32_t middle[2] = {EL_SUB(FAN_X), EL_SUB(FAN_Y)};
    int32_t corners[FAN][2];
    el_polygon p;
    (void)context;
    for (uint32_t i = 0; i < FAN; i++) {
        fan_corner(i, &corners[i][0], &corners[i][1]);
        for (unsigned axis = 0; axis < 2; axis++) {
            corners[i][axis] = middle[axis] + corners[i][axis] * (EL_SUBPIXELS / 16);
        }
    }
    for (uint32_t i = 1; i < FAN; i += 2) {
        const int32_t *const next = corners[(i + 1) % FAN];
        el_polygon_begin(&p, memory, sizeof memory);
        el_polygon_move(&p, middle[0], middle[1]);
        el_polygon_line(&p, corners[i][0], corners[i][1]);
        el_polygon_line(&p, next[0], next[1]);
        (void)el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SHARP, el_glaze(YELLOW, 128));
    }
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_rectangle(&p, 0, 0, EL_SUB(FEATURE_WIDTH), EL_SUB(FEATURE_HEIGHT), 0);
    for (uint32_t i = 0; i < FAN; i++) {
        (i == 0 ? el_polygon_move : el_polygon_line)(&p, corners[i][0], corners[i][1]);
    }
    (void)el_polygon_fill(&p, &canvas, EL_EVEN_ODD, EL_SHARP, el_glaze(RED, 128));
}

const feature feature_seams = {
    .scene = {.name = "seams", .background = BLACK, .place_camera = place_flat, .draw = draw_fan},
    .over = {.draw = draw_rest_of_fan}};

/* --- sprites ---------------------------------------------------------------------------------------------------------------- */

enum { SPRITE_KINDS = 6 };

/* From left to right: RGB565, 8 and 4 bits, a mask, without its white, with alpha; from the top: as they are, half
 * transparent, turned and larger, the same smooth, smaller. */
static void draw_sprites(void *context, el_band *band)
{
    const el_canvas canvas = el_canvas_of(band);
    el_image images[SPRITE_KINDS] = {image_rgb565, image_index8, image_index4, image_mask, image_index8, image_rgb565};
    (void)context;
    images[4].has_key = true;
    images[4].key = 255;
    images[5].alpha = glow;
    for (int32_t i = 0; i < 20; i++) { /* what lies below shows through */
        el_canvas_fill(&canvas, (el_rect){12 * i, 0, 12 * i + 6, FEATURE_HEIGHT}, el_solid(BLUE));
    }
    for (int32_t i = 0; i < SPRITE_KINDS; i++) {
        const int32_t x = 20 + 40 * i;
        el_canvas_image(&canvas, &images[i], x - 8, 4, 255);
        el_canvas_image(&canvas, &images[i], x - 8, 24, 128);
        el_image_place place = {
            .x = EL_SUB(x), .y = EL_SUB(64), .angle = EL_DEGREES(20, 1), .scale_q16 = 2 << 16, .alpha = 255};
        (void)el_canvas_image_turned(&canvas, &images[i], &place);
        place.y = EL_SUB(112);
        place.smooth = true;
        (void)el_canvas_image_turned(&canvas, &images[i], &place);
        place.y = EL_SUB(148);
        place.scale_q16 = 1 << 15;
        (void)el_canvas_image_turned(&canvas, &images[i], &place);
    }
}

static el_status draw_nothing(uint32_t frame, el_renderer *renderer)
{
    (void)frame;
    (void)renderer;
    make_things();
    return EL_OK;
}

const feature feature_sprites = {
    .scene = {.name = "sprites", .background = NIGHT, .place_camera = place_camera, .draw = draw_nothing},
    .under = {.draw = draw_sprites}};
