/* The test card: one of everything that canvas/ draws. */
#include "paint/fonts/aileron_11.h"
#include "paint/fonts/aileron_13.h"
#include "paint/fonts/aileron_22.h"
#include "paint/page_functions.h"
#include "paint/paint_colours.h"

/* Half pixels. */
#define HALVES(n) ((n)*EL_SUBPIXELS / 2)

enum { CARD_EDGES = 170, CARD_WIDTH = 320 };

/* A rocket: 16 x 16 pixels of 4 bits. */
static const uint8_t rocket_pixels[16][8] = {
    {0x00, 0x00, 0x00, 0x03, 0x30, 0x00, 0x00, 0x00}, {0x00, 0x00, 0x00, 0x33, 0x33, 0x00, 0x00, 0x00},
    {0x00, 0x00, 0x00, 0x33, 0x33, 0x00, 0x00, 0x00}, {0x00, 0x00, 0x00, 0x11, 0x22, 0x00, 0x00, 0x00},
    {0x00, 0x00, 0x01, 0x11, 0x22, 0x20, 0x00, 0x00}, {0x00, 0x00, 0x01, 0x14, 0x42, 0x20, 0x00, 0x00},
    {0x00, 0x00, 0x01, 0x45, 0x54, 0x20, 0x00, 0x00}, {0x00, 0x00, 0x01, 0x45, 0x54, 0x20, 0x00, 0x00},
    {0x00, 0x00, 0x01, 0x14, 0x42, 0x20, 0x00, 0x00}, {0x00, 0x00, 0x01, 0x11, 0x22, 0x20, 0x00, 0x00},
    {0x00, 0x03, 0x31, 0x11, 0x22, 0x23, 0x30, 0x00}, {0x00, 0x33, 0x31, 0x11, 0x22, 0x23, 0x33, 0x00},
    {0x00, 0x33, 0x01, 0x11, 0x22, 0x20, 0x33, 0x00}, {0x03, 0x30, 0x00, 0x11, 0x22, 0x00, 0x03, 0x30},
    {0x03, 0x00, 0x00, 0x67, 0x76, 0x00, 0x00, 0x30}, {0x00, 0x00, 0x00, 0x07, 0x70, 0x00, 0x00, 0x00},
};
static const uint16_t rocket_palette[8] = {BLACK, WHITE, 0xB596, RED, DARK, BLUE, ORANGE, YELLOW};
static const el_image rocket = {.width = 16,
                                .height = 16,
                                .format = EL_IMAGE_INDEX4,
                                .has_key = true,
                                .key = 0,
                                .pixels = rocket_pixels,
                                .palette = rocket_palette};

/* An arrow of single bits. */
static const uint8_t arrow_pixels[8] = {0x10, 0x38, 0x7C, 0xFE, 0x38, 0x38, 0x38, 0x38};
static const uint16_t arrow_palette[1] = {CYAN};
static const el_image arrow = {
    .width = 8, .height = 8, .format = EL_IMAGE_MASK, .pixels = arrow_pixels, .palette = arrow_palette};

static const uint8_t hatching[8] = {0x11, 0x22, 0x44, 0x88, 0x11, 0x22, 0x44, 0x88};
static const uint8_t dots[8] = {0x88, 0x00, 0x22, 0x00, 0x88, 0x00, 0x22, 0x00};

/* A five-pointed star that crosses itself, of radius 26. */
static void star(const el_canvas *canvas, int32_t x, int32_t y, el_rule rule, el_smooth smooth, el_paint paint)
{
    uint8_t memory[EL_POLYGON_BYTES(5, 60)];
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    for (uint32_t i = 0; i < 5; i++) {
        const el_angle angle = i * EL_DEGREES(144, 1) - EL_DEGREES(90, 1);
        const int32_t dx = (int32_t)(((int64_t)EL_SUB(26) * el_cos_q30(angle)) >> 30);
        const int32_t dy = (int32_t)(((int64_t)EL_SUB(26) * el_sin_q30(angle)) >> 30);
        el_polygon_line(&p, EL_SUB(x) + dx, EL_SUB(y) + dy);
    }
    (void)el_polygon_fill(&p, canvas, rule, smooth, paint);
}

static void stars(const el_canvas *canvas)
{
    star(canvas, 30, 62, EL_NON_ZERO, EL_SHARP, el_solid(YELLOW));
    star(canvas, 86, 62, EL_EVEN_ODD, EL_SMOOTH_4, el_solid(ORANGE));
    star(canvas, 142, 62, EL_NON_ZERO, EL_SMOOTH_16, (el_paint){.colour = GREEN, .alpha = 255, .pattern = hatching});
}

static void strokes(const el_canvas *canvas)
{
    static const el_stroke kinds[3] = {
        {.width = EL_SUB(9), .cap = EL_CAP_BUTT, .join = EL_JOIN_MITER},
        {.width = EL_SUB(9), .cap = EL_CAP_ROUND, .join = EL_JOIN_ROUND},
        {.width = EL_SUB(9), .cap = EL_CAP_SQUARE, .join = EL_JOIN_BEVEL},
    };
    static const uint16_t colours[3] = {RED, CYAN, GREEN};
    uint8_t memory[EL_POLYGON_BYTES(CARD_EDGES, CARD_WIDTH)];
    for (int32_t i = 0; i < 3; i++) {
        const int32_t x = EL_SUB(186 + 44 * i);
        const int32_t points[3][2] = {{x, EL_SUB(82)}, {x + EL_SUB(14), EL_SUB(44)}, {x + EL_SUB(28), EL_SUB(82)}};
        el_polygon p;
        el_polygon_begin(&p, memory, sizeof memory);
        el_polygon_stroke(&p, points, 3, false, &kinds[i]);
        (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_8, el_glaze(colours[i], 200));
        for (unsigned k = 1; k < 3; k++) {
            el_canvas_line(canvas, (int16_t)(points[k - 1][0] / EL_SUBPIXELS),
                           (int16_t)(points[k - 1][1] / EL_SUBPIXELS), (int16_t)(points[k][0] / EL_SUBPIXELS),
                           (int16_t)(points[k][1] / EL_SUBPIXELS), el_solid(BLACK));
        }
    }
}

static void round_shapes(const el_canvas *canvas)
{
    uint8_t memory[EL_POLYGON_BYTES(CARD_EDGES, CARD_WIDTH)];
    el_polygon p;
    static const struct {
        int32_t x, y;
        uint16_t colour;
    } lamps[3] = {{24, 122, RED}, {40, 122, GREEN}, {32, 136, BLUE}};
    for (unsigned i = 0; i < 3; i++) {
        el_polygon_begin(&p, memory, sizeof memory);
        el_polygon_ellipse(&p, EL_SUB(lamps[i].x), EL_SUB(lamps[i].y), EL_SUB(15), EL_SUB(15));
        (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_16, el_glaze(lamps[i].colour, 150));
    }
    /* A sharp ring, and a smooth one of which sectors are drawn. */
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_ellipse(&p, EL_SUB(84), EL_SUB(128), EL_SUB(24), EL_SUB(18));
    el_polygon_ellipse(&p, EL_SUB(84), EL_SUB(128), EL_SUB(16), EL_SUB(10));
    (void)el_polygon_fill(&p, canvas, EL_EVEN_ODD, EL_SHARP, el_solid(GREY));
    static const uint16_t slices[3] = {BLUE, CYAN, YELLOW};
    for (uint32_t i = 0; i < 3; i++) {
        el_polygon_begin(&p, memory, sizeof memory);
        el_polygon_sector(&p, EL_SUB(142), EL_SUB(128), EL_SUB(25 - 3 * (int32_t)i), EL_SUB(10 - 5 * (int32_t)i),
                          EL_DEGREES(90, 1) * i + EL_DEGREES(6, 1), EL_DEGREES(70, 1) + i * EL_DEGREES(30, 1));
        (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_4, el_solid(slices[i]));
    }
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_rectangle(&p, HALVES(361), HALVES(205), HALVES(479), HALVES(307), EL_SUB(12));
    el_polygon_rectangle(&p, HALVES(367), HALVES(211), HALVES(473), HALVES(301), EL_SUB(9));
    (void)el_polygon_fill(&p, canvas, EL_EVEN_ODD, EL_SMOOTH_8, el_solid(ORANGE));
    el_canvas_fill(canvas, (el_rect){188, 110, 232, 146}, (el_paint){.colour = WHITE, .alpha = 255, .pattern = dots});
}

/* Lines in all directions, in a clip rectangle of their own. */
static void fan(const el_canvas *canvas)
{
    const el_rect frame = {252, 102, 312, 154};
    const el_canvas inner = el_canvas_clipped(canvas, (el_rect){253, 103, 311, 153});
    for (uint32_t i = 0; i < 24; i++) {
        const el_angle angle = i * EL_DEGREES(15, 1);
        el_canvas_line(&inner, 282, 128, (int16_t)(282 + (el_cos_q30(angle) >> 24)),
                       (int16_t)(128 + (el_sin_q30(angle) >> 24)), el_solid((i & 1U) != 0 ? CYAN : WHITE));
    }
    el_canvas_frame(canvas, frame, 1, el_solid(GREY));
}

static void images(const el_canvas *canvas, uint32_t frame)
{
    el_canvas_image(canvas, &rocket, 10, 166, 255);
    el_canvas_image(canvas, &rocket, 32, 166, 110);
    for (int32_t i = 0; i < 4; i++) {
        el_canvas_image(canvas, &arrow, 10 + 10 * i, 190, (uint8_t)(255 - 60 * i));
    }
    const el_angle angle = EL_DEGREES(30, 1) + frame * EL_DEGREES(3, 1);
    el_image_place place = {.x = EL_SUB(88), .y = EL_SUB(190), .angle = angle, .scale_q16 = 3 << 16, .alpha = 255};
    (void)el_canvas_image_turned(canvas, &rocket, &place);
    place.x = EL_SUB(146);
    place.smooth = true;
    (void)el_canvas_image_turned(canvas, &rocket, &place);
}

static void words(const el_canvas *canvas)
{
    el_canvas_text(canvas, &aileron_22, 8, 24, EL_ALIGN_LEFT, "Edgeline AV 2D", el_solid(WHITE));
    el_canvas_text(canvas, &aileron_13, 312, 15, EL_ALIGN_RIGHT,
                   "four bits per pixel\n\xE2\x82\xAC and \xFF are not there", el_solid(YELLOW));
    const el_rect box = {188, 162, 312, 218};
    el_canvas_fill(canvas, box, el_glaze(BLUE, 120));
    el_canvas_frame(canvas, box, 2, el_solid(CYAN));
    el_canvas_text(canvas, &aileron_13, 250, 180, EL_ALIGN_CENTRE,
                   "centred text\nin two lines, 21 \xC2\xB0"
                   "C",
                   el_solid(WHITE));
    el_canvas_text(canvas, &aileron_11, 250, 213, EL_ALIGN_CENTRE, "sharp, of one bit", el_glaze(WHITE, 200));
}

void el_card_draw(uint32_t frame, const el_canvas *canvas)
{
    for (int32_t i = 0; i < 16; i++) { /* what lies below shows through */
        el_canvas_fill(canvas, (el_rect){i * 20, 226, i * 20 + 20, 240}, el_glaze(WHITE, (uint8_t)(i * 17)));
    }
    /* What a band does not see need not be built for it. */
    if (el_canvas_sees(canvas, (el_rect){0, 30, 320, 95})) {
        stars(canvas);
        strokes(canvas);
    }
    if (el_canvas_sees(canvas, (el_rect){0, 100, 320, 160})) {
        round_shapes(canvas);
        fan(canvas);
    }
    images(canvas, frame);
    words(canvas);
}
