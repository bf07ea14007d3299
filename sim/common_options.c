#include "common_options.h"

#include <limits.h>
#include <string.h>

#include "options.h"
#include "report.h"

el_common_options el_common_options_default(long frames)
{
    return (el_common_options){.machine = {.width = 320, .height = 240}, .frames = frames};
}

/* 1/2 to 1/32 texel, given as 2 to 32. */
static bool take_uv_error(el_common_options *options, const char *text)
{
    long value;
    if (!el_option_integer("--uv-error", text, 2, 32, &value)) {
        return false;
    }
    for (uint8_t log2 = 1; log2 <= 5; log2++) {
        if (value == 1L << log2) {
            options->machine.uv_error_log2 = log2;
            return true;
        }
    }
    el_report("--uv-error takes 2, 4, 8, 16 or 32, for 1/2 to 1/32 texel, not '%s'", text);
    return false;
}

static bool take_samples(el_common_options *options, const char *text)
{
    long value;
    if (!el_option_integer("--samples", text, 1, EL_MAX_SAMPLES, &value)) {
        return false;
    }
    if (value != 1 && value != 4 && value != EL_MAX_SAMPLES) {
        el_report("--samples takes 1, 4 or 8, not '%s'", text);
        return false;
    }
    options->machine.samples = (uint8_t)value;
    return true;
}

static bool take_stripes(el_common_options *options, const char *text)
{
    static const char *const names[EL_STRIPES_COUNT] = {"none", "rgb", "bgr"};
    for (uint8_t i = 0; i < EL_STRIPES_COUNT; i++) {
        if (strcmp(text, names[i]) == 0) {
            options->machine.stripes = i;
            return true;
        }
    }
    el_report("--stripes takes none, rgb or bgr, not '%s'", text);
    return false;
}

bool el_common_options_take(el_common_options *options, int which, const char *text)
{
    long value;
    switch (which) {
    case EL_OPTION_SCENE:
        options->subject.scene = text;
        return true;
    case EL_OPTION_SIZE:
        options->size = text;
        return el_option_size("--size", text, &options->machine.width, &options->machine.height);
    case EL_OPTION_BAND:
        options->band = text;
        return true;
    case EL_OPTION_ARENA:
        if (!el_option_integer("--arena", text, 1, 1L << 28, &value)) {
            return false;
        }
        options->machine.arena_bytes = (size_t)value;
        return true;
    case EL_OPTION_THREADS:
        if (!el_option_integer("--threads", text, 1, EL_MAX_WORKERS, &value)) {
            return false;
        }
        options->machine.threads = (unsigned)value;
        return true;
    case EL_OPTION_SAMPLES:
        return take_samples(options, text);
    case EL_OPTION_STRIPES:
        return take_stripes(options, text);
    case EL_OPTION_FRAMES:
        return el_option_integer("--frames", text, 1, INT_MAX, &options->frames);
    case EL_OPTION_PANEL:
        options->machine.panel = text;
        return el_display_profile(text) != NULL;
    case EL_OPTION_ROTATION:
        options->rotation = text;
        return el_option_rotation("--rotation", text, &options->machine.rotation);
    default:
        return take_uv_error(options, text);
    }
}

/* Frames as large as the glass, or smaller ones if they were asked for. */
static bool fit_panel(el_common_options *options)
{
    el_machine_config *const machine = &options->machine;
    const el_lcd_profile *const glass = el_lcd_profile_find(machine->panel);
    const unsigned degrees = el_display_degrees(machine->rotation);
    const bool lies = degrees == 90 || degrees == 270;
    const uint16_t width = lies ? glass->rows : glass->columns;
    const uint16_t height = lies ? glass->columns : glass->rows;
    if (options->size == NULL) {
        machine->width = width;
        machine->height = height;
    } else if (machine->width > width || machine->height > height) {
        el_report("--size %s is larger than the %s, which shows %ux%u pixels as it is turned", options->size,
                  machine->panel, width, height);
        return false;
    }
    return true;
}

bool el_common_options_check(el_common_options *options)
{
    if (options->rotation != NULL && options->machine.panel == NULL) {
        el_report("--rotation goes with --panel");
        return false;
    }
    if (options->machine.panel != NULL && !fit_panel(options)) {
        return false;
    }
    if (options->machine.stripes != EL_STRIPES_NONE && options->machine.width > EL_MAX_STRIPED) {
        el_report("--stripes is for pictures of at most %d pixels' width", (int)EL_MAX_STRIPED);
        return false;
    }
    return el_option_band(options->band, options->machine.height, &options->machine.band_lines);
}

double el_common_options_aspect(const el_common_options *options)
{
    return (double)options->machine.width / options->machine.height;
}
