/* An oscilloscope: a grid, two traces and their labels, without a triangle. w and s change the time base, a space holds
 * the picture.
 *
 * The renderer is the loop over bands: two of them go to the display in turn, one by DMA while the other is drawn. */
#include "example.h"

#include "paint/fonts/aileron_11.h"

enum { POINTS = 81, STEP = (EXAMPLE_WIDTH + POINTS - 2) / (POINTS - 1), DIVISION = 40 };
enum { GRID = 0x2945, AXIS = 0x528A, FIRST = 0xFFE0, SECOND = 0x07FF };

static uint8_t memory[EL_MIN_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT, EXAMPLE_BAND)];
static uint8_t edges[EL_POLYGON_BYTES(EL_STROKE_EDGES(POINTS), EXAMPLE_WIDTH)];
static el_renderer renderer;
static el_camera camera; /* it sees nothing */
static int32_t traces[2][POINTS][2];
static uint32_t base = 3, held_ms;
static bool held;

/* What an ADC would have measured: a sine, and a square wave behind a low pass. */
static void sample(uint32_t ms)
{
    int32_t slow_q30 = 0;
    for (int32_t i = -POINTS; i < POINTS; i++) {
        const el_angle phase = ms * EL_DEGREES(36, 1000) + (el_angle)i * base * EL_DEGREES(4, 1);
        const int32_t sine_q30 = el_sin_q30(phase);
        slow_q30 += ((sine_q30 > 0 ? 1 << 30 : -(1 << 30)) / 4 - slow_q30 / 4);
        if (i >= 0) {
            const int32_t levels_q30[2] = {sine_q30, slow_q30};
            for (int32_t trace = 0; trace < 2; trace++) {
                const int64_t swing = ((int64_t)levels_q30[trace] * EL_SUB(DIVISION)) >> 30;
                traces[trace][i][0] = EL_SUB(i * STEP);
                traces[trace][i][1] = EL_SUB(EXAMPLE_HEIGHT * (1 + 2 * trace) / 4) - (int32_t)swing;
            }
        }
    }
}

static void draw_grid(const el_canvas *canvas)
{
    for (int32_t x = EXAMPLE_WIDTH / 2 % DIVISION; x < EXAMPLE_WIDTH; x += DIVISION) {
        el_canvas_fill(canvas, (el_rect){x, 0, x + 1, EXAMPLE_HEIGHT}, el_solid(x == EXAMPLE_WIDTH / 2 ? AXIS : GRID));
    }
    for (int32_t y = EXAMPLE_HEIGHT / 2 % DIVISION; y < EXAMPLE_HEIGHT; y += DIVISION) {
        el_canvas_fill(canvas, (el_rect){0, y, EXAMPLE_WIDTH, y + 1}, el_solid(y == EXAMPLE_HEIGHT / 2 ? AXIS : GRID));
    }
}

static void draw(void *context, el_band *band)
{
    (void)context;
    static const uint16_t colours[2] = {FIRST, SECOND};
    static const char *const labels[2] = {"CH1  1 V", "CH2  2 V"};
    const el_canvas canvas = el_canvas_of(band);
    draw_grid(&canvas);
    for (int32_t trace = 0; trace < 2; trace++) {
        const int32_t middle = EXAMPLE_HEIGHT * (1 + 2 * trace) / 4;
        const el_rect reach = {0, middle - DIVISION - 2, EXAMPLE_WIDTH, middle + DIVISION + 2};
        if (el_canvas_sees(&canvas, reach)) { /* a stroke is not built for bands that do not show it */
            el_polygon p;
            el_polygon_begin(&p, edges, sizeof edges);
            el_polygon_stroke(&p, (const int32_t(*)[2])traces[trace], POINTS, false,
                              &(el_stroke){.width = EL_SUB(2), .join = EL_JOIN_BEVEL});
            (void)el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SMOOTH_4, el_solid(colours[trace]));
        }
        el_canvas_text(&canvas, &aileron_11, (int16_t)(6 + 70 * trace), EXAMPLE_HEIGHT - 6, EL_ALIGN_LEFT,
                       labels[trace], el_solid(colours[trace]));
    }
    el_canvas_text(&canvas, &aileron_11, EXAMPLE_WIDTH - 6, EXAMPLE_HEIGHT - 6, EL_ALIGN_RIGHT, held ? "HOLD" : "RUN",
                   el_solid(0xFFFF));
}

static const el_layer under = {.draw = draw};

el_status example_setup(const example_screen *screen)
{
    camera = (el_camera){.fov_y = EL_DEGREES(45, 1), .near_q16 = EL_UNIT_Q16, .far_q16 = 2 * EL_UNIT_Q16};
    return el_init(&renderer, &(el_config){.width = EXAMPLE_WIDTH,
                                           .height = EXAMPLE_HEIGHT,
                                           .band_lines = EXAMPLE_BAND,
                                           .memory = memory,
                                           .memory_bytes = sizeof memory,
                                           .under = &under,
                                           .sinks = {screen->sink}});
}

el_status example_frame(const example_input *input)
{
    base += input->key == 's' && base < 8 ? 1U : 0U;
    base -= input->key == 'w' && base > 1 ? 1U : 0U;
    held ^= input->key == ' ';
    held_ms = held ? held_ms : input->ms;
    sample(held_ms);
    const el_status status = el_frame_begin(&renderer, &camera);
    while (status == EL_OK && el_frame_next(&renderer) > 0) {
    }
    return status;
}
