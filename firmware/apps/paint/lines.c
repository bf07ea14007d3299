/* Lines of all widths: of single pixels, and smooth ones from half a pixel on; curves, closed shapes and a clip rectangle. */
#include "paint/page_functions.h"
#include "paint/paint_colours.h"

enum { LINES_WIDTH = 320, SPOKES = 24, CURVE_POINTS = 21, CURVE_STEP = 15 };

/* A line from (x0, y0) to (x1, y1), in 1/EL_SUBPIXELS px. */
static void smooth_line(const el_canvas *canvas, const int32_t points[2][2], uint16_t width, el_smooth smooth,
                        uint16_t colour)
{
    uint8_t memory[EL_POLYGON_BYTES(EL_STROKE_EDGES(2), LINES_WIDTH)];
    const el_stroke stroke = {.width = width};
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_stroke(&p, points, 2, false, &stroke);
    (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, smooth, el_solid(colour));
}

/* Spokes of a wheel, which turns by a degree per frame; of width 0 those of single pixels. */
static void wheel(const el_canvas *canvas, uint32_t frame, int32_t x, int32_t y, uint16_t width, el_smooth smooth)
{
    for (uint32_t i = 0; i < SPOKES; i++) {
        const el_angle angle = i * EL_DEGREES(15, 1) + frame * EL_DEGREES(1, 1) + EL_DEGREES(4, 1);
        const int32_t dx_q4 = el_cos_q30(angle) >> 26; /* 16 */
        const int32_t dy_q4 = el_sin_q30(angle) >> 26;
        const int32_t points[2][2] = {{EL_SUB(x) + dx_q4 * EL_SUBPIXELS / 2, EL_SUB(y) + dy_q4 * EL_SUBPIXELS / 2},
                                      {EL_SUB(x) + dx_q4 * EL_SUBPIXELS * 2, EL_SUB(y) + dy_q4 * EL_SUBPIXELS * 2}};
        if (width == 0) {
            el_canvas_line(canvas, (int16_t)(points[0][0] / EL_SUBPIXELS), (int16_t)(points[0][1] / EL_SUBPIXELS),
                           (int16_t)(points[1][0] / EL_SUBPIXELS), (int16_t)(points[1][1] / EL_SUBPIXELS),
                           el_solid(WHITE));
        } else {
            smooth_line(canvas, points, width, smooth, (i & 1U) != 0 ? CYAN : WHITE);
        }
    }
}

/* A wave that moves, as a plot has it. */
static void curve(const el_canvas *canvas, uint32_t frame, int32_t y, uint16_t width, uint16_t colour)
{
    uint8_t memory[EL_POLYGON_BYTES(EL_STROKE_EDGES(CURVE_POINTS), LINES_WIDTH)];
    int32_t points[CURVE_POINTS][2];
    for (uint32_t i = 0; i < CURVE_POINTS; i++) {
        const el_angle angle = i * EL_DEGREES(18, 1) + frame * EL_DEGREES(6, 1);
        points[i][0] = EL_SUB(10 + CURVE_STEP * (int32_t)i);
        points[i][1] = EL_SUB(y) + (int32_t)((int64_t)EL_SUB(12) * el_sin_q30(angle) >> 30);
    }
    const el_stroke stroke = {.width = width, .cap = EL_CAP_SQUARE};
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_stroke(&p, (const int32_t(*)[2])points, CURVE_POINTS, false, &stroke);
    (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_8, el_solid(colour));
}

/* Closed shapes with each join, cut off at a clip rectangle. */
static void corners(const el_canvas *canvas)
{
    static const uint16_t colours[3] = {RED, GREEN, BLUE};
    const el_rect frame = {10, 178, 310, 230};
    const el_canvas inner = el_canvas_clipped(canvas, frame);
    uint8_t memory[EL_POLYGON_BYTES(EL_STROKE_EDGES(3) + 3U * EL_ROUND_EDGES(15), LINES_WIDTH)];
    for (int32_t i = 0; i < 3; i++) {
        const int32_t x = EL_SUB(60 + 100 * i);
        const int32_t points[3][2] = {{x - EL_SUB(30), EL_SUB(222)}, {x, EL_SUB(182)}, {x + EL_SUB(30), EL_SUB(222)}};
        const el_stroke stroke = {.width = (uint16_t)EL_SUB(6 + 4 * i), .join = (uint8_t)(EL_JOIN_MITER + i)};
        el_polygon p;
        el_polygon_begin(&p, memory, sizeof memory);
        el_polygon_stroke(&p, points, 3, true, &stroke);
        (void)el_polygon_fill(&p, &inner, EL_NON_ZERO, EL_SMOOTH_4, el_glaze(colours[i], 210));
    }
    el_canvas_frame(canvas, frame, 1, el_solid(GREY));
}

void el_lines_draw(uint32_t frame, const el_canvas *canvas)
{
    static const struct {
        uint16_t width;
        el_smooth smooth;
    } wheels[4] = {{0, EL_SHARP},
                   {EL_SUBPIXELS / 2, EL_SMOOTH_16},
                   {EL_SUBPIXELS, EL_SMOOTH_16},
                   {EL_SUBPIXELS * 5 / 2, EL_SMOOTH_4}};
    if (el_canvas_sees(canvas, (el_rect){0, 10, LINES_WIDTH, 80})) {
        for (int32_t i = 0; i < 4; i++) {
            wheel(canvas, frame, 44 + 77 * i, 44, wheels[i].width, wheels[i].smooth);
        }
    }
    curve(canvas, frame, 104, EL_SUBPIXELS, YELLOW);
    curve(canvas, frame, 134, EL_SUBPIXELS * 3 / 2, ORANGE);
    curve(canvas, frame, 160, EL_SUBPIXELS * 3, GREEN);
    corners(canvas);
}
