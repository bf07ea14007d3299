/* look: a recording of a display's wire, judged and shown as its glass would show it. */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

#include "commands.h"
#include "display.h"
#include "files.h"
#include "lcd/lcd.h"
#include "options.h"
#include "png_file.h"
#include "report.h"
#include "wire_trace.h"

typedef struct look_options {
    const el_lcd_profile *profile;
    el_rotation rotation;
    const char *trace, *png, *raw;
} look_options;

static bool parse(int argc, char **argv, look_options *o)
{
    enum { PANEL = 1, ROTATION, PNG_FILE, RAW };
    static const struct option options[] = {
        {"panel", required_argument, NULL, PANEL},
        {"rotation", required_argument, NULL, ROTATION},
        {"png", required_argument, NULL, PNG_FILE},
        {"raw", required_argument, NULL, RAW},
        {NULL, 0, NULL, 0},
    };
    *o = (look_options){.rotation = EL_ROTATION_0};
    int which;
    optind = 0;
    opterr = 0;
    while ((which = getopt_long(argc, argv, "", options, NULL)) != -1) {
        bool good = true;
        switch (which) {
        case PANEL:
            o->profile = el_display_profile(optarg);
            good = o->profile != NULL;
            break;
        case ROTATION:
            good = el_option_rotation("--rotation", optarg, &o->rotation);
            break;
        case PNG_FILE:
            o->png = optarg;
            break;
        case RAW:
            o->raw = optarg;
            break;
        default:
            el_report("look: '%s' is unknown or lacks its value", argv[optind - 1]);
            good = false;
        }
        if (!good) {
            return false;
        }
    }
    if (argc - optind != 1) {
        el_report("look takes one trace, as `render --wire` writes it");
        return false;
    }
    o->trace = argv[optind];
    if (o->profile == NULL) {
        el_report("look needs --panel NAME: a trace does not say what it was sent to");
        return false;
    }
    return true;
}

/* False after one line on stderr. */
static bool play(const look_options *o, el_lcd *lcd)
{
    size_t size;
    uint8_t *const trace = el_file_read(o->trace, &size);
    if (trace == NULL) {
        return false;
    }
    const bool complete = el_wire_play(o->trace, trace, size, lcd);
    free(trace);
    if (!complete) {
        return false;
    }
    el_lcd_finish(lcd);
    const el_lcd_error *const error = el_lcd_error_at(lcd, 0);
    if (error != NULL) {
        el_report("%s: %s", o->trace, error->text);
        return false;
    }
    return true;
}

static bool write_picture(const look_options *o, const el_lcd *lcd)
{
    const unsigned degrees = el_display_degrees(o->rotation);
    const bool lies = degrees == 90 || degrees == 270;
    const uint16_t width = lies ? o->profile->rows : o->profile->columns;
    const uint16_t height = lies ? o->profile->columns : o->profile->rows;
    const size_t pixels = (size_t)width * height;
    uint16_t *const picture = malloc(pixels * sizeof picture[0]);
    if (picture == NULL) {
        el_report("no memory for %u x %u pixels", width, height);
        return false;
    }
    (void)el_lcd_look(lcd, degrees, picture);
    el_output raw = {0};
    el_output png = {0};
    bool good = (o->raw == NULL || el_output_open(&raw, o->raw)) && (o->png == NULL || el_output_open(&png, o->png));
    good = good && (png.stream == NULL || el_png_write(&png, picture, width, height));
    if (good && raw.stream != NULL) {
        el_output_pixels(&raw, picture, pixels);
    }
    good = good && (raw.stream == NULL || el_output_commit(&raw)) && (png.stream == NULL || el_output_commit(&png));
    el_output_discard(&raw);
    el_output_discard(&png);
    free(picture);
    return good;
}

int el_command_look(int argc, char **argv)
{
    look_options o;
    if (!parse(argc + 1, argv - 1, &o)) {
        return EL_EXIT_BAD;
    }
    el_lcd *const lcd = el_lcd_create(o.profile);
    if (lcd == NULL) {
        return el_report("no memory for the model of %s", o.profile->panel);
    }
    const bool good = play(&o, lcd) && write_picture(&o, lcd);
    if (good) {
        printf("%s: %llu pixels written, no errors\n", o.profile->name, (unsigned long long)el_lcd_pixels(lcd));
    }
    el_lcd_destroy(lcd);
    return good ? EL_EXIT_OK : EL_EXIT_BAD;
}
