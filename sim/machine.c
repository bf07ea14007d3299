#include "machine.h"

#include <stdlib.h>
#include <string.h>

#include "report.h"

enum {
    SCK_HZ = 62500000,
    CHUNK_WORDS = 192 /* the simulated DMA sends that much while the renderer waits once; no divisor of a line */
};

const char *el_machine_message(el_status status)
{
    switch (status) {
    case EL_OK:
        return "no error";
    case EL_ERROR_ARGUMENT:
        return "the renderer was called in the wrong order";
    case EL_ERROR_SIZE:
        return "a size is out of range: bands have 1 line to the screen's height";
    case EL_ERROR_MEMORY:
        return "the arena is too small";
    case EL_ERROR_CAMERA:
        return "the camera is out of range: fov 1 to 179 degrees, near at least 1/4096, far at least 9/8 of near";
    case EL_ERROR_RANGE:
        return "the mesh or the camera is outside +-16384 units, or the mesh is too large for so narrow a view";
    case EL_ERROR_MATERIAL:
        return "the mesh has no texture, texture coordinates or normals for this shading";
    }
    return "unknown error";
}

static void depth_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
}

static void depth_rows(void *context, el_band *band, unsigned slot)
{
    const el_machine *const machine = context;
    memcpy(machine->depth + (size_t)band->y * band->width, band->depth,
           (size_t)band->lines * band->width * sizeof band->depth[0]);
    el_band_release(band, slot);
}

static void depth_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

/* The chip for the picture, and how it is mounted so that the picture is upright. */
static el_lcd_profile choose_glass(const el_machine_config *config, el_rotation *rotation)
{
    if (config->width <= EL_ILI9341_COLUMNS && config->height <= EL_ILI9341_ROWS) {
        *rotation = EL_ROTATION_0;
        return EL_LCD_ILI9341;
    }
    *rotation = EL_ROTATION_90;
    if (config->width <= EL_ILI9341_ROWS && config->height <= EL_ILI9341_COLUMNS) {
        return EL_LCD_ILI9341;
    }
    return el_lcd_dcs(config->height, config->width);
}

bool el_machine_open(el_machine *machine, const el_machine_config *config)
{
    *machine = (el_machine){.config = *config};
    el_rotation rotation;
    const el_lcd_profile glass = choose_glass(config, &rotation);
    const bool upright = rotation == EL_ROTATION_0;
    machine->mounting = upright ? 0 : 270;
    machine->glass_width = upright ? glass.columns : glass.rows;
    machine->glass_height = upright ? glass.rows : glass.columns;

    const unsigned band_lines = config->band_lines < 1 ? 1 : config->band_lines;
    machine->arena_bytes = config->arena_bytes != 0
                               ? config->arena_bytes
                               : EL_MEMORY_BYTES((unsigned)config->width, (unsigned)config->height, band_lines,
                                                 EL_MACHINE_VERTICES, EL_MACHINE_TRIANGLES, EL_MACHINE_DRAWS);
    const size_t pixels = (size_t)config->width * config->height;
    machine->arena = malloc(machine->arena_bytes);
    machine->picture = calloc(pixels, sizeof machine->picture[0]);
    machine->depth = calloc(pixels, sizeof machine->depth[0]);
    machine->glass = calloc((size_t)machine->glass_width * machine->glass_height, sizeof machine->glass[0]);
    machine->lcd = el_lcd_create(&glass);
    if (machine->arena == NULL || machine->picture == NULL || machine->depth == NULL || machine->glass == NULL ||
        machine->lcd == NULL) {
        el_report("no memory for %u x %u pixels and an arena of %zu bytes", config->width, config->height,
                  machine->arena_bytes);
        return false;
    }

    el_lcd_bus_init(&machine->bus_state,
                    &(el_lcd_bus_config){.lcd = machine->lcd, .sck_hz = SCK_HZ, .chunk_words = CHUNK_WORDS});
    machine->bus = el_lcd_bus_functions(&machine->bus_state);
    el_ili9341_init(&machine->panel, &(el_ili9341_config){.bus = &machine->bus, .rotation = rotation});
    machine->panel_sink = el_ili9341_sink(&machine->panel);
    machine->depth_sink = (el_sink){.context = machine, .begin = depth_begin, .rows = depth_rows, .end = depth_end};

    const el_config renderer_config = {
        .width = config->width,
        .height = config->height,
        .band_lines = config->band_lines,
        .background = config->background,
        .uv_error_log2 = config->uv_error_log2,
        .memory = machine->arena,
        .memory_bytes = machine->arena_bytes,
        .sinks = {&machine->panel_sink, &machine->depth_sink, config->extra_sink},
    };
    const el_status status = el_init(&machine->renderer, &renderer_config);
    if (status == EL_ERROR_MEMORY) {
        el_report("an arena of %zu bytes is too small: %u x %u in bands of %u lines needs %u at least",
                  machine->arena_bytes, config->width, config->height, config->band_lines,
                  EL_MIN_MEMORY_BYTES((unsigned)config->width, (unsigned)config->height, band_lines));
    } else if (status != EL_OK) {
        el_report("%s", el_machine_message(status));
    }
    return status == EL_OK;
}

void el_machine_close(el_machine *machine)
{
    free(machine->arena);
    free(machine->picture);
    free(machine->depth);
    free(machine->glass);
    if (machine->lcd != NULL) {
        el_lcd_destroy(machine->lcd);
    }
    *machine = (el_machine){0};
}

bool el_machine_look(el_machine *machine)
{
    el_lcd_bus_drain(&machine->bus_state);
    const el_lcd_error *const error = el_lcd_error_at(machine->lcd, 0);
    if (error != NULL) {
        el_report("the LCD would not have taken this: %s", error->text);
        return false;
    }
    (void)el_lcd_look(machine->lcd, machine->mounting, machine->glass);
    for (size_t y = 0; y < machine->config.height; y++) {
        memcpy(machine->picture + y * machine->config.width, machine->glass + y * machine->glass_width,
               machine->config.width * sizeof machine->picture[0]);
    }
    return true;
}
