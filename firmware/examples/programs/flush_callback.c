/* Beside another GUI, which owns the display and has a flush callback, as LVGL's: a sink hands each band of the 3D to
 * the same function that the GUI's pieces go through, at its own place on the screen. Neither draws where the other
 * does, and neither copies: a band is given back when its pixels are sent. */
#include "example.h"

#include "demo/meshes/solid.h"
#include "gui_stand_in.h"

enum { WIDTH = EXAMPLE_WIDTH, HEIGHT = EXAMPLE_HEIGHT - GUI_HEIGHT, GUI_LINES = 10 };

static uint8_t memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, EXAMPLE_BAND, 180, 116, 1)];
static uint16_t gui_pixels[WIDTH * GUI_LINES];
static el_renderer renderer;
static el_camera camera = {.fov_y = EL_DEGREES(40, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 10 * EL_UNIT_Q16};
static const el_material material = {.shading = EL_SHADE_FLAT, .light = &example_light};
static const el_bus *bus;

/* The display's driver as the GUI's program has it: a window, then its pixels; for glass that fills its controller. */
static void send(const gui_area *area, const uint16_t *pixels, void (*done)(void *argument), void *argument)
{
    const uint8_t columns[4] = {(uint8_t)(area->x1 >> 8), (uint8_t)area->x1, (uint8_t)(area->x2 >> 8),
                                (uint8_t)area->x2};
    const uint8_t rows[4] = {(uint8_t)(area->y1 >> 8), (uint8_t)area->y1, (uint8_t)(area->y2 >> 8), (uint8_t)area->y2};
    bus->command(bus->context, 0x2A, columns, sizeof columns); /* column address set, of MIPI DCS */
    bus->command(bus->context, 0x2B, rows, sizeof rows);       /* row address set */
    bus->command(bus->context, 0x2C, NULL, 0);                 /* memory write */
    const uint32_t width = (uint32_t)(area->x2 - area->x1 + 1), lines = (uint32_t)(area->y2 - area->y1 + 1);
    bus->pixels(bus->context, pixels, width * lines, done, argument);
}

static void wait(void *context)
{
    (void)context;
    if (bus->wait != NULL) {
        bus->wait(bus->context);
    }
}

static void gui_sent(void *display)
{
    gui_display_flush_ready(display);
}

static void gui_flush(gui_display *display, const gui_area *area, uint8_t *px_map)
{
    send(area, (const uint16_t *)(void *)px_map, gui_sent, display);
}

static gui_display gui = {
    .draw_buf = gui_pixels, .draw_buf_pixels = WIDTH * GUI_LINES, .flush_cb = gui_flush, .wait_cb = wait};

/* --- Edgeline's side: a sink, whose bands lie below the GUI's lines --------------------------------------------- */

static void begin(void *context, uint16_t width, uint16_t height)
{
    (void)context, (void)width, (void)height;
}

static void end(void *context, const el_stats *stats)
{
    (void)context, (void)stats;
}

static void band_sent(void *band)
{
    el_band_release(band, 0);
}

static void rows(void *context, el_band *band, unsigned slot)
{
    (void)context, (void)slot; /* it is the renderer's only sink, number 0 */
    const int32_t y = GUI_HEIGHT + band->y;
    send(&(gui_area){0, y, band->width - 1, y + band->lines - 1}, band->pixels, band_sent, band);
}

static const el_sink window = {.begin = begin, .rows = rows, .end = end, .wait = wait};

el_status example_setup(const example_screen *screen)
{
    bus = screen->bus;
    const el_orbit_camera orbit = el_orbit_camera_at((const int32_t[]){0, 0, 0}, 35 * EL_UNIT_Q16 / 10);
    el_orbit_camera_place(&orbit, &camera);
    return el_init(&renderer, &(el_config){.width = WIDTH,
                                           .height = HEIGHT,
                                           .band_lines = EXAMPLE_BAND,
                                           .background = el_rgb565(16, 20, 32),
                                           .memory = memory,
                                           .memory_bytes = sizeof memory,
                                           .sinks = {&window}});
}

el_status example_frame(const example_input *input)
{
    gui_refresh(&gui, WIDTH, "Another GUI, and below it Edgeline", (int32_t)(input->ms / 20 % 101));
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(25, 1));
    el_pose_turn(&pose, EL_AXIS_Y, input->ms * (EL_DEGREES(45, 1000)));
    return example_show(&renderer, &camera, &solid, &pose, &material);
}
