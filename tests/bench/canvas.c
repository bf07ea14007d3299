/* What canvas/ costs: single drawings, of which a figure per pixel, row, edge or character follows, and whole pages in bands
 * of 8 lines.
 *
 * One line per measurement, of a drawing and of how many of which units:
 *
 *     DRAWING UNIT crc CRC count UNITS
 */
#include "base/crc32.h"
#include "edgeline.h"
#include "paint/fonts/aileron_13.h"
#include "paint/pages.h"
#include "platform.h"

enum { WIDTH = 320, HEIGHT = 240, BAND_LINES = 8, EDGES = 400, SIDE = 64, INK = 0xFD20 };

static uint16_t pixels[WIDTH * HEIGHT] __attribute__((aligned(4)));
static uint8_t memory[EL_POLYGON_BYTES(EDGES, WIDTH)] __attribute__((aligned(8)));
static uint16_t sprite[SIDE * SIDE];
static el_polygon polygon;

/* A zigzag of `teeth` from the left to the right between two lines of the screen: so many edges, all of which cross the
 * rows between. */
static void zigzag(int32_t teeth, int32_t top, int32_t bottom)
{
    el_polygon_begin(&polygon, memory, sizeof memory);
    for (int32_t i = 0; i < teeth; i++) {
        el_polygon_line(&polygon, EL_SUB(10) + i * EL_SUB(300) / teeth, EL_SUB(top) + 3);
        el_polygon_line(&polygon, EL_SUB(14) + i * EL_SUB(300) / teeth, EL_SUB(bottom) + 5);
    }
}

static void rectangle(int32_t side)
{
    el_polygon_begin(&polygon, memory, sizeof memory);
    el_polygon_rectangle(&polygon, EL_SUB(11), EL_SUB(13), EL_SUB(11 + side), EL_SUB(13 + side), 0);
}

static void fill(const el_canvas *canvas, el_smooth smooth)
{
    (void)el_polygon_fill(&polygon, canvas, EL_NON_ZERO, smooth, el_solid(INK));
}

static void fill_rect(const el_canvas *canvas)
{
    el_canvas_fill(canvas, (el_rect){10, 10, 210, 210}, el_solid(INK));
}

static void glaze_rect(const el_canvas *canvas)
{
    el_canvas_fill(canvas, (el_rect){10, 10, 210, 210}, el_glaze(INK, 100));
}

static void thin_line(const el_canvas *canvas)
{
    el_canvas_line(canvas, 10, 10, 209, 97, el_solid(INK));
}

static void build_edges(const el_canvas *canvas)
{
    (void)canvas;
    zigzag(100, 20, 21);
}

static void begin_edges(const el_canvas *canvas)
{
    fill(canvas, EL_SHARP);
}

static void smooth_4(const el_canvas *canvas)
{
    fill(canvas, EL_SMOOTH_4);
}

static void smooth_16(const el_canvas *canvas)
{
    fill(canvas, EL_SMOOTH_16);
}

static void build_circle(const el_canvas *canvas)
{
    (void)canvas;
    el_polygon_begin(&polygon, memory, sizeof memory);
    el_polygon_ellipse(&polygon, EL_SUB(160), EL_SUB(120), EL_SUB(50), EL_SUB(50));
}

static void build_stroke(const el_canvas *canvas)
{
    static const int32_t points[5][2] = {{160, 160}, {1600, 320}, {800, 1600}, {2400, 2400}, {3200, 600}};
    (void)canvas;
    el_polygon_begin(&polygon, memory, sizeof memory);
    el_polygon_stroke(&polygon, points, 5, false, &(el_stroke){.width = EL_SUB(6)});
}

static const el_image image = {.width = SIDE, .height = SIDE, .format = EL_IMAGE_RGB565, .pixels = sprite};

static void blit(const el_canvas *canvas)
{
    el_canvas_image(canvas, &image, 20, 20, 255);
}

static void turn(const el_canvas *canvas, bool smooth)
{
    const el_image_place place = {.x = EL_SUB(100),
                                  .y = EL_SUB(100),
                                  .angle = EL_DEGREES(30, 1),
                                  .scale_q16 = 65536,
                                  .smooth = smooth,
                                  .alpha = 255};
    (void)el_canvas_image_turned(canvas, &image, &place);
}

static void turn_nearest(const el_canvas *canvas)
{
    turn(canvas, false);
}

static void turn_smooth(const el_canvas *canvas)
{
    turn(canvas, true);
}

static void write_text(const el_canvas *canvas)
{
    el_canvas_text(canvas, &aileron_13, 10, 100, EL_ALIGN_LEFT, "The quick brown fox jumps over it 40 wide",
                   el_solid(INK));
}

static uint32_t crc_of_picture(void)
{
    uint32_t crc = 0;
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        const uint8_t bytes[2] = {(uint8_t)pixels[i], (uint8_t)(pixels[i] >> 8)};
        crc = el_crc32(crc, bytes, sizeof bytes);
    }
    return crc;
}

static void report(const char *name, const char *unit, uint32_t count)
{
    bench_print(name);
    bench_print(" ");
    bench_print(unit);
    bench_print(" crc ");
    bench_print_hex(crc_of_picture());
    bench_print(" count ");
    bench_print_u64(count);
    bench_print("\n");
}

static void clear(void)
{
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        pixels[i] = (uint16_t)(i * 40503U >> 3);
    }
}

/* What the polygon is before the measurement begins. */
typedef enum prepared { NOTHING, SQUARE, TEETH, SHORT_TEETH } prepared;

static void prepare(prepared what)
{
    if (what == SQUARE) {
        rectangle(200);
    } else if (what == TEETH) {
        zigzag(20, 20, 220);
    } else if (what == SHORT_TEETH) {
        zigzag(100, 20, 21);
    }
    if (what != NOTHING) { /* sorted once, as it is for all but the first band */
        const el_band none = {.pixels = pixels, .width = WIDTH, .y = 0, .lines = 1};
        const el_canvas canvas = el_canvas_of(&none);
        (void)el_polygon_fill(&polygon, &canvas, EL_NON_ZERO, EL_SHARP, el_solid(INK));
    }
}

static void measure_page(const el_page *page)
{
    el_page_frame at = {.page = page, .frame = 0};
    clear();
    bench_next();
    bench_start();
    for (int32_t y = 0; y < HEIGHT; y += BAND_LINES) {
        el_band band = {.pixels = pixels + y * WIDTH, .width = WIDTH, .y = (uint16_t)y, .lines = BAND_LINES};
        el_page_draw(&at, &band);
    }
    bench_stop();
    report(page->name, "page", 1);
}

int bench_main(void)
{
    static const struct {
        const char *name, *unit;
        void (*draw)(const el_canvas *canvas);
        prepared before;
        uint32_t count;
    } drawings[] = {
        {"rectangle", "pixel", fill_rect, NOTHING, 200 * 200},
        {"glaze", "pixel", glaze_rect, NOTHING, 200 * 200},
        {"line", "pixel", thin_line, NOTHING, 200},
        {"polygon-build", "edge", build_edges, NOTHING, 200},
        {"polygon-begin", "edge", begin_edges, SHORT_TEETH, 200},
        {"square", "row", begin_edges, SQUARE, 200},
        {"square-smooth-4", "row", smooth_4, SQUARE, 200},
        {"square-smooth-16", "row", smooth_16, SQUARE, 200},
        {"teeth", "edge-and-row", begin_edges, TEETH, 40 * 200},
        {"teeth-smooth-4", "edge-and-row", smooth_4, TEETH, 40 * 200},
        {"teeth-smooth-16", "edge-and-row", smooth_16, TEETH, 40 * 200},
        {"circle-build", "edge", build_circle, NOTHING, 64},
        {"stroke-build", "segment", build_stroke, NOTHING, 4},
        {"image", "pixel", blit, NOTHING, SIDE * SIDE},
        {"image-turned", "pixel", turn_nearest, NOTHING, SIDE * SIDE},
        {"image-turned-smooth", "pixel", turn_smooth, NOTHING, SIDE * SIDE},
        {"text", "character", write_text, NOTHING, 41},
    };
    const el_band band = {.pixels = pixels, .width = WIDTH, .y = 0, .lines = HEIGHT};
    const el_canvas canvas = el_canvas_of(&band);
    for (unsigned i = 0; i < SIDE * SIDE; i++) {
        sprite[i] = (uint16_t)(i * 2654435761U >> 16);
    }

    /* What a pair of markers costs by itself. */
    bench_next();
    bench_start();
    bench_stop();
    bench_print("empty - crc 00000000 count 0\n");

    for (size_t i = 0; i < sizeof drawings / sizeof drawings[0]; i++) {
        clear();
        prepare(drawings[i].before);
        bench_next();
        bench_start();
        drawings[i].draw(&canvas);
        bench_stop();
        report(drawings[i].name, drawings[i].unit, drawings[i].count);
    }
    for (size_t i = 0; i < el_page_count; i++) {
        measure_page(el_pages[i]);
    }
    return 0;
}
