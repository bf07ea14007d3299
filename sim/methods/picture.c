#include "methods/picture.h"

#include "methods/reference.h"
#include "methods/tables.h"
#include "methods/triangles.h"

enum {
    COLUMNS = 5,
    CELL_WIDTH = EL_METHODS_PICTURE_WIDTH / COLUMNS,
    CELL_HEIGHT = 168,
    TITLE_HEIGHT = 28, /* over each family */
    PIXEL = 6,
    ACROSS = 30, /* pixels of a small picture */
    DOWN = 20,
    INDENT = 10,
    LINE = 12
};

_Static_assert(ACROSS *PIXEL + INDENT <= CELL_WIDTH, "a picture fits its cell");

#define INK 0x2104U
#define GREY 0x8410U
#define PAPER 0xFFFFU
#define EMPTY 0xE73CU
#define RIGHT 0x6D9AU
#define MISSING 0xD8A3U
#define EXTRA 0xFD20U

/* A corner on a pixel's centre: the cases in which rules and rounding show. */
#define CENTRE(column, row)                                                                                            \
    {                                                                                                                  \
        (column) * EL_SUBPIXELS + EL_SUBPIXELS / 2, (row)*EL_SUBPIXELS + EL_SUBPIXELS / 2                              \
    }

enum { RIM = 7 };

static const el_spot hub = CENTRE(15, 10);
static const el_spot rim[RIM] = {CENTRE(1, 10),  CENTRE(4, 1),   CENTRE(15, 1), CENTRE(28, 2),
                                 CENTRE(26, 16), CENTRE(18, 19), CENTRE(3, 18)};

/* A star that crosses itself, and a hexagon with level edges and a diamond as its hole. */
static const el_spot star[] = {CENTRE(2, 7), CENTRE(14, 7), CENTRE(4, 16), CENTRE(8, 1), CENTRE(12, 16)};
static const el_spot hexagon[] = {CENTRE(16, 9), CENTRE(19, 2),  CENTRE(25, 2),
                                  CENTRE(28, 9), CENTRE(25, 17), CENTRE(19, 17)};
static const el_spot diamond[] = {CENTRE(22, 6), CENTRE(25, 9), CENTRE(22, 13), CENTRE(19, 9)};

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static void draw_line(el_sheet *canvas, int32_t x, int32_t y, el_spot a, el_spot b)
{
    enum { STEPS = ACROSS * PIXEL };
    for (int32_t i = 0; i <= STEPS; i++) {
        const int32_t along_x = a.x * (STEPS - i) + b.x * i;
        const int32_t along_y = a.y * (STEPS - i) + b.y * i;
        el_sheet_fill(canvas, x + along_x * PIXEL / (STEPS * EL_SUBPIXELS),
                      y + along_y * PIXEL / (STEPS * EL_SUBPIXELS), 1, 1, INK);
    }
}

static void draw_pixels(el_sheet *canvas, int32_t x, int32_t y, const uint16_t *expected, const uint16_t *got)
{
    for (int32_t i = 0; i < ACROSS * DOWN; i++) {
        uint16_t colour = expected[i] != 0 ? RIGHT : EMPTY;
        if (got[i] != expected[i]) {
            colour = got[i] < expected[i] ? MISSING : EXTRA;
        }
        el_sheet_fill(canvas, x + i % ACROSS * PIXEL, y + i / ACROSS * PIXEL, PIXEL - 1, PIXEL - 1, colour);
    }
}

/* The upper left corner of a cell's picture, with its two lines of text written above. */
static el_spot begin_cell(el_sheet *canvas, int32_t top, unsigned index, const char *title, const char *rule)
{
    const int32_t x = (int32_t)(index % COLUMNS) * CELL_WIDTH + INDENT;
    const int32_t y = top + (int32_t)(index / COLUMNS) * CELL_HEIGHT + INDENT;
    el_sheet_write(canvas, x, y, 2, INK, title);
    el_sheet_write(canvas, x, y + LINE, 2, GREY, rule);
    return (el_spot){x, y + 2 * LINE};
}

static void draw_triangle_cell(el_sheet *canvas, int32_t top, unsigned index)
{
    const el_triangle_method *const method = &el_triangle_methods[index];
    uint16_t expected[ACROSS * DOWN] = {0};
    uint16_t got[ACROSS * DOWN] = {0};
    uint16_t one[ACROSS * DOWN];
    el_hits reference = {ACROSS, DOWN, one};
    el_hits hits = {ACROSS, DOWN, got};
    const el_spot at = begin_cell(canvas, top, index, method->title, el_edge_rule_names[method->rule]);
    for (unsigned i = 0; i < RIM; i++) {
        const el_spot corners[3] = {hub, rim[i], rim[(i + 1) % RIM]};
        method->draw(corners, &hits);
        el_reference_triangle(corners, EL_EDGES_LEFT_TOP, &reference);
        for (int32_t p = 0; p < ACROSS * DOWN; p++) {
            expected[p] = (uint16_t)(expected[p] + one[p]);
        }
    }
    draw_pixels(canvas, at.x, at.y, expected, got);
    for (unsigned i = 0; i < RIM; i++) {
        draw_line(canvas, at.x, at.y, hub, rim[i]);
        draw_line(canvas, at.x, at.y, rim[i], rim[(i + 1) % RIM]);
    }
}

static void draw_polygon_cell(el_sheet *canvas, int32_t top, unsigned index)
{
    const el_polygon_method *const method = &el_polygon_methods[index];
    uint16_t expected[ACROSS * DOWN] = {0};
    uint16_t got[ACROSS * DOWN] = {0};
    el_hits reference = {ACROSS, DOWN, expected};
    el_hits hits = {ACROSS, DOWN, got};
    el_polygon polygon = {0};
    el_polygon_add(&polygon, star, COUNT(star));
    el_polygon_add(&polygon, hexagon, COUNT(hexagon));
    el_polygon_add(&polygon, diamond, COUNT(diamond));
    const el_spot at = begin_cell(canvas, top, index, method->title, el_fill_rule_names[method->rule]);
    method->draw(&polygon, method->rule, &hits);
    el_reference_polygon(&polygon, method->rule, &reference);
    draw_pixels(canvas, at.x, at.y, expected, got);
    for (size_t i = 0; i < polygon.edge_count; i++) {
        draw_line(canvas, at.x, at.y, polygon.edges[i].a, polygon.edges[i].b);
    }
}

static int32_t draw_legend(el_sheet *canvas, int32_t x, int32_t y, uint16_t colour, const char *text)
{
    el_sheet_fill(canvas, x, y, 2 * PIXEL, 2 * PIXEL - 2, colour);
    el_sheet_write(canvas, x + 3 * PIXEL, y, 2, INK, text);
    int32_t letters = 0;
    for (; text[letters] != '\0'; letters++) {
    }
    return x + 5 * PIXEL + 8 * letters;
}

void el_methods_picture(el_sheet *canvas)
{
    el_sheet_fill(canvas, 0, 0, canvas->width, canvas->height, PAPER);
    int32_t y = INDENT;
    int32_t x = draw_legend(canvas, INDENT, y, RIGHT, "right");
    x = draw_legend(canvas, x, y, MISSING, "missing");
    draw_legend(canvas, x, y, EXTRA, "too much or twice");
    y += TITLE_HEIGHT - INDENT;
    el_sheet_write(canvas, INDENT, y + INDENT, 2, INK,
                   "Triangles: a closed fan, corners on pixel centres, against left and top edges");
    y += TITLE_HEIGHT;
    for (unsigned i = 0; i < EL_TRIANGLE_METHODS; i++) {
        draw_triangle_cell(canvas, y, i);
    }
    y += (EL_TRIANGLE_METHODS + COLUMNS - 1) / COLUMNS * CELL_HEIGHT;
    el_sheet_write(canvas, INDENT, y + INDENT, 2, INK,
                   "Polygons: a crossing star, a hexagon with a hole, against the fill rule");
    y += TITLE_HEIGHT;
    for (unsigned i = 0; i < EL_POLYGON_METHODS; i++) {
        draw_polygon_cell(canvas, y, i);
    }
}
