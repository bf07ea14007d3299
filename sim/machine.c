#include "machine.h"

#include <stdlib.h>
#include <string.h>

#include "report.h"

enum { CHUNK = 192 }; /* the simulated DMA sends that much while the renderer waits once; no divisor of a line */

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
        return "the mesh has no texture, texture coordinates or normals for this shading, or its material does not go "
               "with the settings, as wires with several samples (raster/material.h)";
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

/* They have the depths that they had. */
static bool depth_unchanged(void *context, uint16_t y, uint16_t lines)
{
    (void)context;
    (void)y;
    (void)lines;
    return true;
}

static void depth_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

/* The display that was asked for, or one for the frames, mounted so that they are upright. */
static el_display_config choose_display(const el_machine_config *config)
{
    el_display_config display = {
        .panel = config->panel,
        .rotation = config->rotation,
        .band_lines = config->band_lines,
        .chunk = CHUNK,
        .tap = config->tap,
        .sparing = config->sparing,
    };
    if (config->panel == NULL) {
        const el_lcd_profile *const usual = &EL_LCD_ILI9341;
        const bool upright = config->width <= usual->columns && config->height <= usual->rows;
        const bool lying = config->width <= usual->rows && config->height <= usual->columns;
        display.panel = upright || lying ? usual->panel : NULL;
        display.rotation = upright ? EL_ROTATION_0 : EL_ROTATION_90;
        display.columns = config->height;
        display.rows = config->width;
    }
    return display;
}

/* Pixels of a line while it is drawn. */
static unsigned columns_of(const el_machine_config *config)
{
    return config->stripes != EL_STRIPES_NONE ? EL_STRIPED_WIDTH((unsigned)config->width) : config->width;
}

/* What threads and samples take beside what every renderer has. */
static unsigned added_bytes(const el_machine_config *config, unsigned band_lines)
{
    const unsigned columns = columns_of(config);
    const unsigned cores = config->threads > 1 ? config->threads : 1;
    return EL_WORKERS_BYTES(columns, (unsigned)config->height, band_lines, config->threads) +
           cores * EL_SAMPLES_BYTES(columns, band_lines, config->samples);
}

static bool open_renderer(el_machine *machine)
{
    const el_machine_config *const config = &machine->config;
    machine->depth_sink = (el_sink){
        .context = machine, .begin = depth_begin, .rows = depth_rows, .unchanged = depth_unchanged, .end = depth_end};
    const el_config renderer_config = {
        .width = config->width,
        .height = config->height,
        .band_lines = config->band_lines,
        .background = config->background,
        .uv_error_log2 = config->uv_error_log2,
        .depth_prepass = config->depth_prepass,
        .samples = config->samples,
        .stripes = config->stripes,
        .reuse = config->sparing ? EL_REUSES : 0,
        .memory = machine->arena,
        .memory_bytes = machine->arena_bytes,
        .workers = machine->threads != NULL ? el_threads_workers(machine->threads) : NULL,
        .sinks = {&machine->depth_sink, config->extra_sink, &machine->display.sink}, /* the last may move pixels */
    };
    const el_status status = el_init(&machine->renderer, &renderer_config);
    if (status == EL_ERROR_MEMORY) {
        const unsigned band_lines = config->band_lines < 1 ? 1 : config->band_lines;
        el_report("an arena of %zu bytes is too small: %u x %u in bands of %u lines needs %u at least",
                  machine->arena_bytes, config->width, config->height, config->band_lines,
                  EL_MIN_MEMORY_BYTES(columns_of(config), (unsigned)config->height, band_lines) +
                      added_bytes(config, band_lines));
    } else if (status != EL_OK) {
        el_report("%s", el_machine_message(status));
    }
    return status == EL_OK;
}

bool el_machine_open(el_machine *machine, const el_machine_config *config)
{
    *machine = (el_machine){.config = *config};
    const el_display_config display = choose_display(config);
    if (!el_display_open(&machine->display, &display)) {
        return false;
    }
    machine->picture_width = config->panel != NULL ? machine->display.width : config->width;
    machine->picture_height = config->panel != NULL ? machine->display.height : config->height;

    const unsigned band_lines = config->band_lines < 1 ? 1 : config->band_lines;
    machine->arena_bytes = config->arena_bytes != 0
                               ? config->arena_bytes
                               : EL_MEMORY_BYTES(columns_of(config), (unsigned)config->height, band_lines,
                                                 EL_MACHINE_VERTICES, EL_MACHINE_TRIANGLES, EL_MACHINE_DRAWS) +
                                     added_bytes(config, band_lines);
    if (config->threads > 1) {
        machine->threads = el_threads_open(config->threads);
        if (machine->threads == NULL) {
            return false;
        }
    }
    machine->arena = malloc(machine->arena_bytes);
    machine->glass = calloc((size_t)machine->display.width * machine->display.height, sizeof machine->glass[0]);
    machine->picture = calloc((size_t)machine->picture_width * machine->picture_height, sizeof machine->picture[0]);
    machine->depth = calloc((size_t)config->width * config->height, sizeof machine->depth[0]);
    if (machine->arena == NULL || machine->glass == NULL || machine->picture == NULL || machine->depth == NULL) {
        el_report("no memory for %u x %u pixels and an arena of %zu bytes", config->width, config->height,
                  machine->arena_bytes);
        return false;
    }
    return open_renderer(machine);
}

void el_machine_close(el_machine *machine)
{
    el_threads_close(machine->threads);
    free(machine->arena);
    free(machine->picture);
    free(machine->depth);
    free(machine->glass);
    el_display_close(&machine->display);
    *machine = (el_machine){0};
}

bool el_machine_look(el_machine *machine)
{
    if (!el_display_look(&machine->display, machine->glass)) {
        return false;
    }
    for (size_t y = 0; y < machine->picture_height; y++) {
        memcpy(machine->picture + y * machine->picture_width, machine->glass + y * machine->display.width,
               machine->picture_width * sizeof machine->picture[0]);
    }
    return true;
}
