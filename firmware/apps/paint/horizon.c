/* An attitude indicator: sky and ground, a pitch ladder, a bank scale, and tapes of speed and height beside it. */
#include "paint/fonts/aileron_13.h"
#include "paint/fonts/aileron_22.h"
#include "paint/page_functions.h"
#include "paint/paint_colours.h"

enum {
    MIDDLE_X = EL_SUB(160),
    MIDDLE_Y = EL_SUB(120),
    RADIUS = EL_SUB(92),
    PIXELS_PER_DEGREE = 4,
    SKY = 0x3D1F,
    EARTH = 0x8A84
};

/* How the aircraft flies, a figure of the frame's number. */
typedef struct attitude {
    el_angle bank; /* the horizon's, clockwise */
    int32_t pitch; /* the horizon's place below the middle, 1/EL_SUBPIXELS px */
    int32_t speed, height;
} attitude;

static int32_t scaled(int32_t length, int32_t ratio_q30)
{
    return (int32_t)(((int64_t)length * ratio_q30) >> 30);
}

static attitude attitude_at(uint32_t frame)
{
    const el_angle phase = frame * EL_DEGREES(3, 1);
    const int32_t swing_q30 = el_sin_q30(phase + EL_DEGREES(40, 1));
    return (attitude){.bank = (el_angle)scaled((int32_t)EL_DEGREES(28, 1), swing_q30),
                      .pitch = scaled(EL_SUB(34), el_cos_q30(phase * 2)),
                      .speed = 120 + scaled(25, el_sin_q30(phase * 2)),
                      .height = 3250 + scaled(400, el_cos_q30(phase))};
}

/* A place (x, y) of the horizon's own frame, turned with it, on the screen. */
typedef struct place {
    int32_t x, y;
} place;

static place on_screen(const attitude *a, int32_t x, int32_t y)
{
    const int32_t cosine = el_cos_q30(a->bank);
    const int32_t sine = el_sin_q30(a->bank);
    return (place){MIDDLE_X + scaled(x, cosine) - scaled(y, sine), MIDDLE_Y + scaled(x, sine) + scaled(y, cosine)};
}

static void add(el_polygon *p, const attitude *a, int32_t x, int32_t y)
{
    const place at = on_screen(a, x, y);
    el_polygon_line(p, at.x, at.y);
}

static void quad(const el_canvas *canvas, const attitude *a, el_rect part, uint16_t colour)
{
    uint8_t memory[EL_POLYGON_BYTES(4, 320)];
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    add(&p, a, part.x, part.y);
    add(&p, a, part.x_end, part.y);
    add(&p, a, part.x_end, part.y_end);
    add(&p, a, part.x, part.y_end);
    (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_8, el_solid(colour));
}

static void number(char *text, int32_t value)
{
    char digits[12];
    int32_t count = 0;
    int32_t left = value < 0 ? -value : value;
    do {
        digits[count++] = (char)('0' + left % 10);
        left /= 10;
    } while (left > 0);
    for (int32_t i = 0; i < count; i++) {
        text[i] = digits[count - 1 - i];
    }
    text[count] = 0;
}

static void ladder(const el_canvas *canvas, const attitude *a)
{
    for (int32_t degrees = -30; degrees <= 30; degrees += 5) {
        const int32_t y = a->pitch - degrees * EL_SUB(PIXELS_PER_DEGREE);
        const int32_t half = EL_SUB(degrees % 10 == 0 ? 26 : 12);
        if (degrees == 0 || y < -EL_SUB(70) || y > EL_SUB(70)) {
            continue;
        }
        quad(canvas, a, (el_rect){-half, y - EL_SUBPIXELS / 2, half, y + EL_SUBPIXELS / 2}, WHITE);
        if (degrees % 10 == 0) {
            char text[12];
            number(text, degrees);
            const place right = on_screen(a, half + EL_SUB(10), y);
            el_canvas_text(canvas, &aileron_13, (int16_t)(right.x / EL_SUBPIXELS),
                           (int16_t)(right.y / EL_SUBPIXELS + 5), EL_ALIGN_CENTRE, text, el_solid(WHITE));
        }
    }
}

/* All but a disc, and its rim: a rectangle with a hole. */
static void bezel(const el_canvas *canvas, const attitude *a)
{
    uint8_t memory[EL_POLYGON_BYTES(192, 320)];
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_rectangle(&p, EL_SUB(50), 0, EL_SUB(270), EL_SUB(240), 0);
    el_polygon_ellipse(&p, MIDDLE_X, MIDDLE_Y, RADIUS, RADIUS);
    (void)el_polygon_fill(&p, canvas, EL_EVEN_ODD, EL_SMOOTH_8, el_solid(DARK));
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_ellipse(&p, MIDDLE_X, MIDDLE_Y, RADIUS + EL_SUB(3), RADIUS + EL_SUB(3));
    el_polygon_ellipse(&p, MIDDLE_X, MIDDLE_Y, RADIUS, RADIUS);
    (void)el_polygon_fill(&p, canvas, EL_EVEN_ODD, EL_SMOOTH_8, el_solid(GREY));
    static const int8_t marks[] = {-60, -45, -30, -20, -10, 0, 10, 20, 30, 45, 60};
    for (unsigned i = 0; i < sizeof marks; i++) {
        const int32_t up = marks[i] % 30 == 0 ? 16 : 10;
        const attitude fixed = {.bank = (el_angle)(marks[i] * (int32_t)EL_DEGREES(1, 1))};
        quad(canvas, &fixed, (el_rect){-EL_SUBPIXELS, -RADIUS - EL_SUB(up), EL_SUBPIXELS, -RADIUS - EL_SUB(4)}, WHITE);
    }
    /* The pointer moves with the horizon. */
    el_polygon_begin(&p, memory, sizeof memory);
    add(&p, a, 0, -RADIUS + EL_SUB(2));
    add(&p, a, EL_SUB(7), -RADIUS + EL_SUB(14));
    add(&p, a, -EL_SUB(7), -RADIUS + EL_SUB(14));
    (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_8, el_solid(YELLOW));
}

static void aircraft(const el_canvas *canvas)
{
    static const int32_t wings[5][2] = {{MIDDLE_X - EL_SUB(58), MIDDLE_Y},
                                        {MIDDLE_X - EL_SUB(20), MIDDLE_Y},
                                        {MIDDLE_X, MIDDLE_Y + EL_SUB(14)},
                                        {MIDDLE_X + EL_SUB(20), MIDDLE_Y},
                                        {MIDDLE_X + EL_SUB(58), MIDDLE_Y}};
    uint8_t memory[EL_POLYGON_BYTES(EL_STROKE_EDGES(5), 320)];
    static const struct {
        uint16_t width, colour;
    } passes[2] = {{EL_SUB(7), BLACK}, {EL_SUB(4), YELLOW}};
    for (unsigned i = 0; i < 2; i++) {
        el_polygon p;
        el_polygon_begin(&p, memory, sizeof memory);
        el_polygon_stroke(&p, wings, 5, false, &(el_stroke){.width = passes[i].width, .cap = EL_CAP_SQUARE});
        (void)el_polygon_fill(&p, canvas, EL_NON_ZERO, EL_SMOOTH_8, el_solid(passes[i].colour));
    }
}

/* A tape that moves behind its reading. */
static void tape(const el_canvas *canvas, int32_t x, int32_t value, int32_t step)
{
    const el_rect part = {x, 10, x + 46, 230};
    const el_canvas inner = el_canvas_clipped(canvas, part);
    el_canvas_fill(&inner, part, el_solid(DARK));
    char text[12];
    for (int32_t i = -6; i <= 6; i++) {
        const int32_t mark = (value / step + i) * step;
        const int32_t y = 120 - (mark - value) * 30 / step;
        number(text, mark);
        el_canvas_fill(&inner, (el_rect){x, y, x + 6, y + 1}, el_solid(WHITE));
        el_canvas_text(&inner, &aileron_13, (int16_t)(x + 42), (int16_t)(y + 5), EL_ALIGN_RIGHT, text, el_solid(GREY));
    }
    const el_rect reading = {x, 106, x + 46, 134};
    el_canvas_fill(&inner, reading, el_solid(BLACK));
    el_canvas_frame(&inner, reading, 1, el_solid(YELLOW));
    number(text, value);
    const bool is_long = value > 999;
    el_canvas_text(&inner, is_long ? &aileron_13 : &aileron_22, (int16_t)(x + 42), (int16_t)(is_long ? 125 : 128),
                   EL_ALIGN_RIGHT, text, el_solid(WHITE));
}

void el_horizon_draw(uint32_t frame, const el_canvas *canvas)
{
    const attitude a = attitude_at(frame);
    const el_canvas disc = el_canvas_clipped(canvas, (el_rect){66, 26, 254, 214});
    el_canvas_fill(&disc, disc.clip, el_solid(SKY));
    quad(&disc, &a, (el_rect){-EL_SUB(200), a.pitch, EL_SUB(200), a.pitch + EL_SUB(300)}, EARTH);
    quad(&disc, &a, (el_rect){-EL_SUB(200), a.pitch - EL_SUBPIXELS, EL_SUB(200), a.pitch + EL_SUBPIXELS}, WHITE);
    ladder(&disc, &a);
    bezel(canvas, &a);
    if (el_canvas_sees(canvas, (el_rect){90, 110, 230, 145})) {
        aircraft(canvas);
    }
    tape(canvas, 2, a.speed, 10);
    tape(canvas, 272, a.height, 100);
}
