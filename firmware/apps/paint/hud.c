/* A HUD over a scene in three dimensions: glass that shows what is below it, text, a cross-hair and a scale. */
#include "paint/fonts/aileron_11.h"
#include "paint/fonts/aileron_13.h"
#include "paint/page_functions.h"
#include "paint/paint_colours.h"

static void corners(const el_canvas *canvas)
{
    static const int32_t points[4][3][2] = {
        {{EL_SUB(118), EL_SUB(96)}, {EL_SUB(118), EL_SUB(84)}, {EL_SUB(130), EL_SUB(84)}},
        {{EL_SUB(190), EL_SUB(84)}, {EL_SUB(202), EL_SUB(84)}, {EL_SUB(202), EL_SUB(96)}},
        {{EL_SUB(202), EL_SUB(144)}, {EL_SUB(202), EL_SUB(156)}, {EL_SUB(190), EL_SUB(156)}},
        {{EL_SUB(130), EL_SUB(156)}, {EL_SUB(118), EL_SUB(156)}, {EL_SUB(118), EL_SUB(144)}},
    };
    uint8_t memory[EL_POLYGON_BYTES(4 * EL_STROKE_EDGES(3), 320)];
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    for (unsigned i = 0; i < 4; i++) {
        el_polygon_stroke(&p, points[i], 3, false, &(el_stroke){.width = EL_SUB(2)});
    }
    (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_4, el_solid(CYAN));
}

static void compass(const el_canvas *canvas, uint32_t frame)
{
    uint8_t memory[EL_POLYGON_BYTES(150, 320)];
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_ellipse(&p, EL_SUB(280), EL_SUB(200), EL_SUB(30), EL_SUB(30));
    (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_8, el_glaze(BLACK, 130));
    const el_angle heading = frame * EL_DEGREES(3, 2);
    const int32_t sine = el_sin_q30(heading) >> 16;
    const int32_t cosine = el_cos_q30(heading) >> 16;
    for (int32_t i = 0; i < 2; i++) { /* the needle's two halves share an edge */
        const int32_t length = (i == 0 ? 1 : -1) * EL_SUB(24);
        el_polygon_begin(&p, memory, sizeof memory);
        el_polygon_move(&p, EL_SUB(280) + ((EL_SUB(7) * cosine) >> 14), EL_SUB(200) + ((EL_SUB(7) * sine) >> 14));
        el_polygon_line(&p, EL_SUB(280) + ((length * sine) >> 14), EL_SUB(200) - ((length * cosine) >> 14));
        el_polygon_line(&p, EL_SUB(280) - ((EL_SUB(7) * cosine) >> 14), EL_SUB(200) - ((EL_SUB(7) * sine) >> 14));
        (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SHARP, el_solid(i == 0 ? RED : WHITE));
    }
    el_canvas_text(canvas, &aileron_11, 280, 180, EL_ALIGN_CENTRE, "N", el_solid(WHITE));
}

void el_hud_draw(uint32_t frame, const el_canvas *canvas)
{
    const el_rect bar = {8, 8, 150, 44};
    el_canvas_fill(canvas, bar, el_glaze(BLACK, 130));
    el_canvas_text(canvas, &aileron_13, 16, 22, EL_ALIGN_LEFT, "ISLAND SURVEY", el_solid(WHITE));
    el_canvas_text(canvas, &aileron_11, 16, 38, EL_ALIGN_LEFT, "51.5\xC2\xB0 N  2,592 triangles", el_solid(CYAN));
    el_canvas_frame(canvas, (el_rect){8, 218, 112, 230}, 1, el_solid(WHITE));
    el_canvas_fill(canvas, (el_rect){10, 220, 11 + (int32_t)(20 + frame) % 100, 228}, el_glaze(GREEN, 200));
    el_canvas_line(canvas, 150, 120, 170, 120, el_solid(CYAN));
    el_canvas_line(canvas, 160, 110, 160, 130, el_solid(CYAN));
    /* What a band does not see need not be built for it. */
    if (el_canvas_sees(canvas, (el_rect){117, 83, 203, 157})) {
        corners(canvas);
    }
    if (el_canvas_sees(canvas, (el_rect){250, 170, 310, 230})) {
        compass(canvas, frame);
    }
}
