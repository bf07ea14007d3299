/* budget, memory: what RAM a program needs and what its display's wire carries, from the macros that firmware sizes its
 * arrays with and from the panel's real driver. `memory` is a table, `budget` the same as JSON, which tests compare with
 * the host's `edgeline budget`. Sizes of structs are this machine's: pointers of microcontrollers are shorter. */
#include "budget.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "display.h"
#include "edgeline.h"
#include "options.h"
#include "panel/ssd0323.h"
#include "panel/ssd1306.h"
#include "report.h"
#include "stream/session.h"

typedef struct wish {
    const el_lcd_profile *panel; /* NULL: a controller that does not exist, with glass as large as the picture */
    el_rotation rotation;
    uint16_t width, height; /* of the picture */
    long band, vertices, triangles, draws, samples;
    bool textured;
    bool stream;
} wish;

/* --- The command line --------------------------------------------------------------------------------------------- */

static bool parse_shading(const char *text, bool *textured)
{
    *textured = strcmp(text, "textured") == 0;
    if (!*textured && strcmp(text, "gouraud") != 0 && strcmp(text, "flat") != 0) {
        el_report("--shading takes flat, gouraud or textured, not '%s'", text);
        return false;
    }
    return true;
}

/* Upright where the picture fits so, else on its side: turned so that lines run along the glass as they come. Without a
 * panel's name it is an ILI9341 unless the picture is larger. */
static bool mount(const char *command, const char *panel, const char *size, wish *w)
{
    w->panel = panel == NULL ? &EL_LCD_ILI9341 : el_display_profile(panel);
    if (w->panel == NULL) {
        return false;
    }
    const uint16_t columns = w->panel->columns;
    const uint16_t rows = w->panel->rows;
    w->width = columns > rows ? columns : rows;
    w->height = columns > rows ? rows : columns;
    if (size != NULL && !el_option_size("--size", size, &w->width, &w->height)) {
        return false;
    }
    const bool upright = w->width <= columns && w->height <= rows;
    const bool lying = w->width <= rows && w->height <= columns;
    w->rotation = upright ? EL_ROTATION_0 : EL_ROTATION_270;
    if (upright || lying) {
        return true;
    }
    if (panel != NULL) {
        el_report("%s: %u x %u pixels are more than %s has: %u x %u", command, w->width, w->height, panel, columns,
                  rows);
        return false;
    }
    w->panel = NULL;
    w->rotation = EL_ROTATION_0;
    return true;
}

static bool parse_samples(const char *text, long *samples)
{
    if (!el_option_integer("--samples", text, 1, 8, samples)) {
        return false;
    }
    if (*samples != 1 && *samples != 4 && *samples != 8) {
        el_report("--samples takes 1, 4 or 8, not '%s'", text);
        return false;
    }
    return true;
}

static bool parse(int argc, char **argv, const char *command, wish *w)
{
    enum { PANEL = 1, SIZE, BAND, VERTICES, TRIANGLES, DRAWS, SHADING, SAMPLES, STREAM };
    static const struct option options[] = {
        {"panel", required_argument, NULL, PANEL},
        {"size", required_argument, NULL, SIZE},
        {"band", required_argument, NULL, BAND},
        {"vertices", required_argument, NULL, VERTICES},
        {"triangles", required_argument, NULL, TRIANGLES},
        {"draws", required_argument, NULL, DRAWS},
        {"shading", required_argument, NULL, SHADING},
        {"samples", required_argument, NULL, SAMPLES},
        {"stream", no_argument, NULL, STREAM},
        {NULL, 0, NULL, 0},
    };
    const char *panel = NULL;
    const char *size = NULL;
    const char *band = NULL;
    *w = (wish){.vertices = 600, .triangles = 1000, .draws = 4, .samples = 1, .textured = true};
    int which;
    optind = 0;
    opterr = 0;
    while ((which = getopt_long(argc, argv, "+", options, NULL)) != -1) {
        bool good = true;
        switch (which) {
        case PANEL:
            panel = optarg;
            break;
        case SIZE:
            size = optarg;
            break;
        case BAND:
            band = optarg;
            break;
        case VERTICES:
            good = el_option_integer("--vertices", optarg, 0, EL_MESH_MAX_VERTICES, &w->vertices);
            break;
        case TRIANGLES:
            good = el_option_integer("--triangles", optarg, 0, UINT16_MAX, &w->triangles);
            break;
        case DRAWS:
            good = el_option_integer("--draws", optarg, 0, UINT16_MAX, &w->draws);
            break;
        case SHADING:
            good = parse_shading(optarg, &w->textured);
            break;
        case SAMPLES:
            good = parse_samples(optarg, &w->samples);
            break;
        case STREAM:
            w->stream = true;
            break;
        default:
            el_report("%s: '%s' is unknown or lacks its value", command, argv[optind - 1]);
            good = false;
        }
        if (!good) {
            return false;
        }
    }
    if (optind != argc) {
        el_report("%s: '%s' is no option", command, argv[optind]);
        return false;
    }
    uint16_t lines = 0;
    if (!mount(command, panel, size, w) || !el_option_band(band, w->height, &lines)) {
        return false;
    }
    w->band = lines;
    return true;
}

static const char *panel_name(const wish *w)
{
    return w->panel != NULL ? w->panel->panel : "larger";
}

/* --- Memory ------------------------------------------------------------------------------------------------------- */

typedef struct part {
    const char *key;   /* of JSON */
    const char *title; /* of the table */
    size_t bytes;
} part;

enum { ARENA_PARTS = 7, PARTS = 12 };

typedef struct account {
    part parts[PARTS]; /* those of the arena first */
    size_t arena;
    size_t total;
} account;

static size_t panel_buffer_bytes(const wish *w)
{
    const long band = w->band;
    if (w->panel == &EL_LCD_SSD1306) {
        return (size_t)EL_SSD1306_MEMORY_BYTES(band);
    }
    return w->panel == &EL_LCD_SSD0323 ? (size_t)EL_SSD0323_MEMORY_BYTES(band) : 0;
}

static account make_account(const wish *w)
{
    const size_t width = w->width;
    const size_t height = w->height;
    const size_t band = (size_t)w->band;
    const size_t vertices = (size_t)w->vertices;
    const size_t triangles = (size_t)w->triangles;
    const size_t draws = (size_t)w->draws;
    const size_t triangle_bytes = w->textured ? EL_TEXTURED_TRIANGLE_BYTES : EL_TRIANGLE_BYTES;
    const size_t least = EL_MIN_MEMORY_BYTES(width, height, band);
    const size_t wished = EL_MEMORY_BYTES(width, height, band, vertices, triangles, draws) -
                          triangles * (EL_TEXTURED_TRIANGLE_BYTES - triangle_bytes);
    const size_t samples = EL_SAMPLES_BYTES(width, band, (size_t)w->samples);
    const size_t without = EL_MAX_OF(least, wished);
    const size_t arena = without + samples;

    const size_t colour = 2 * EL_COLOUR_BAND_BYTES(width, band);
    const size_t depth = EL_DEPTH_BAND_BYTES(width, band);
    const size_t vertex_bytes = EL_ROUND_UP_8(vertices * EL_VERTEX_BYTES);
    const size_t beyond = vertex_bytes > depth ? vertex_bytes - depth : 0;
    const size_t bins = EL_BIN_BYTES(height, band);
    const bool is_oled = w->panel == &EL_LCD_SSD1306 || w->panel == &EL_LCD_SSD0323;
    account a = {
        .parts =
            {
                {"colour_bands", "two colour bands", colour},
                {"depth_band", "depth band", depth},
                {"vertices", "vertices, beyond what fits the depth band", beyond},
                {"bins", "bins", bins},
                {"triangles", w->textured ? "triangles, textured" : "triangles, not textured",
                 triangles * triangle_bytes},
                {"draws", "draws, and slack", without - colour - depth - beyond - bins - triangles * triangle_bytes},
                {"samples", "samples of a band", samples},
                {"renderer", "el_renderer, this machine's", sizeof(el_renderer)},
                {"panel_driver", "the panel's driver, this machine's", is_oled ? sizeof(el_oled) : sizeof(el_tft)},
                {"panel_buffer", "the driver's memory", panel_buffer_bytes(w)},
                {"stream", "stream, this machine's",
                 w->stream ? sizeof(el_stream) + EL_STREAM_MEMORY_BYTES(width, height) : 0},
                {"stack", "stack", EL_BUDGET_STACK_BYTES},
            },
        .arena = arena,
    };
    for (size_t i = 0; i < PARTS; i++) {
        a.total += a.parts[i].bytes;
    }
    return a;
}

/* --- The wire ----------------------------------------------------------------------------------------------------- */

/* Has the panel's driver send a frame. */
static void send_frame(el_display *display, const wish *w, uint16_t *pixels)
{
    const el_sink *const sink = &display->sink;
    sink->begin(sink->context, w->width, w->height);
    for (long y = 0; y < w->height; y += w->band) {
        const long left = w->height - y;
        el_band band = {
            .pixels = pixels,
            .width = w->width,
            .y = (uint16_t)y,
            .lines = (uint16_t)(left < w->band ? left : w->band),
            .held = {1},
        };
        sink->rows(sink->context, &band, 0);
    }
    sink->end(sink->context, NULL);
}

/* What the second frame takes: the first may make the rest of the glass black. */
static bool count_wire(const wish *w, el_lcd_bus_traffic *frame)
{
    static uint16_t black[EL_MAX_WIDTH * EL_LCD_MAX_SIDE];
    el_display display;
    const el_display_config config = {
        .panel = w->panel != NULL ? w->panel->panel : NULL,
        .columns = w->width,
        .rows = w->height,
        .rotation = w->rotation,
        .band_lines = (uint16_t)w->band,
    };
    const bool open = el_display_open(&display, &config);
    if (open) {
        send_frame(&display, w, black);
        const el_lcd_bus_traffic before = display.bus_state.traffic;
        send_frame(&display, w, black);
        *frame = display.bus_state.traffic;
        frame->command_bytes -= before.command_bytes;
        frame->pixel_bytes -= before.pixel_bytes;
    }
    el_display_close(&display);
    return open;
}

/* --- The commands ------------------------------------------------------------------------------------------------- */

int el_command_memory(int argc, char **argv)
{
    wish w;
    if (!parse(argc + 1, argv - 1, "memory", &w)) {
        return EL_EXIT_BAD;
    }
    const account a = make_account(&w);
    printf("%s, %u x %u, bands of %ld lines, %ld vertices in the largest mesh, %ld visible triangles, %ld draws\n",
           panel_name(&w), w.width, w.height, w.band, w.vertices, w.triangles, w.draws);
    for (size_t i = 0; i < PARTS; i++) {
        printf("%-44s %8zu\n", a.parts[i].title, a.parts[i].bytes);
        if (i + 1 == ARENA_PARTS) {
            printf("%-44s %8zu\n", "arena (EL_MEMORY_BYTES)", a.arena);
        }
    }
    printf("%-44s %8zu\n", "in all", a.total);
    return EL_EXIT_OK;
}

int el_command_budget(int argc, char **argv)
{
    wish w;
    el_lcd_bus_traffic frame;
    if (!parse(argc + 1, argv - 1, "budget", &w) || !count_wire(&w, &frame)) {
        return EL_EXIT_BAD;
    }
    const account a = make_account(&w);
    printf("{\"panel\": \"%s\", \"width\": %u, \"height\": %u, \"band\": %ld, \"pointer_bits\": %zu, \"ram\": {",
           panel_name(&w), w.width, w.height, w.band, 8 * sizeof(void *));
    for (size_t i = 0; i < PARTS; i++) {
        printf("%s\"%s\": %zu", i == 0 ? "" : ", ", a.parts[i].key, a.parts[i].bytes);
    }
    printf("}, \"arena\": %zu, \"total\": %zu, \"wire\": {\"pixel_bytes\": %llu, \"command_bytes\": %llu}}\n", a.arena,
           a.total, (unsigned long long)frame.pixel_bytes, (unsigned long long)frame.command_bytes);
    return EL_EXIT_OK;
}
