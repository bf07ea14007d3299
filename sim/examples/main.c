/* An example of firmware/examples/programs on a PC: its display is a model of the panel's controller, its clock counts
 * frames, and its keys are a text, so that each run is the same. */
#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "display.h"
#include "example.h"
#include "files.h"
#include "frame_name.h"
#include "live.h"
#include "machine.h"
#include "options.h"
#include "png_file.h"
#include "report.h"

enum { CHUNK = 192 }; /* what the simulated DMA sends while the program waits once; no divisor of a line */

typedef struct example_options {
    long frames, step_ms;
    const char *keys, *png, *raw;
    bool crc, pty;
} example_options;

static const char usage[] =
    "usage: " EXAMPLE_NAME " [--frames N] [--step MS] [--keys TEXT] [--png FILE] [--raw FILE] [--crc]\n"
    "  --keys: a letter for each frame, as a terminal would send it to a board; '.' for none\n"
    "  --png: the last frame; with %d or %04d in FILE each of them\n"
    "       " EXAMPLE_NAME " --pty [--frames N]\n"
    "  prints a port for `edgeline view -p PORT`, and takes keys where it was started\n";

/* False after one line on stderr. */
static bool parse(int argc, char **argv, example_options *o)
{
    enum { FRAMES = 1, STEP, KEYS, PNG_FILE, RAW, CRC, PTY };
    static const struct option options[] = {
        {"frames", required_argument, NULL, FRAMES},
        {"step", required_argument, NULL, STEP},
        {"keys", required_argument, NULL, KEYS},
        {"png", required_argument, NULL, PNG_FILE},
        {"raw", required_argument, NULL, RAW},
        {"crc", no_argument, NULL, CRC},
        {"pty", no_argument, NULL, PTY},
        {NULL, 0, NULL, 0},
    };
    *o = (example_options){.step_ms = 33};
    int which;
    bool good = true;
    opterr = 0;
    while (good && (which = getopt_long(argc, argv, "", options, NULL)) != -1) {
        switch (which) {
        case FRAMES:
            good = el_option_integer("--frames", optarg, 1, 1000000, &o->frames);
            break;
        case STEP:
            good = el_option_integer("--step", optarg, 0, 1000000, &o->step_ms);
            break;
        case KEYS:
            o->keys = optarg;
            break;
        case PNG_FILE:
            o->png = optarg;
            break;
        case RAW:
            o->raw = optarg;
            break;
        case CRC:
            o->crc = true;
            break;
        case PTY:
            o->pty = true;
            break;
        default:
            el_report("'%s' is unknown or lacks its value", argv[optind - 1]);
            good = false;
        }
    }
    if (good && optind != argc) {
        el_report("'%s' is no option", argv[optind]);
        good = false;
    }
    if (good && o->pty && (o->keys != NULL || o->png != NULL || o->raw != NULL || o->crc)) {
        el_report("--pty goes with --frames alone");
        good = false;
    }
    if (o->frames == 0 && !o->pty) {
        o->frames = 1;
    }
    return good;
}

static bool write_png(const char *path, const uint16_t *picture)
{
    el_output png = {0};
    const bool good = el_output_open(&png, path) && el_png_write(&png, picture, EXAMPLE_WIDTH, EXAMPLE_HEIGHT) &&
                      el_output_commit(&png);
    el_output_discard(&png);
    return good;
}

/* A picture that is complete on the glass. */
static bool keep(const example_options *o, uint32_t frame, el_output *raw, const uint16_t *picture)
{
    const size_t pixels = (size_t)EXAMPLE_WIDTH * EXAMPLE_HEIGHT;
    if (raw->stream != NULL) {
        el_output_pixels(raw, picture, pixels);
    }
    if (o->crc) {
        printf("%08" PRIx32 "\n", el_pixels_crc(picture, pixels));
    }
    if (o->png != NULL && el_frame_name_is_pattern(o->png)) {
        char name[EL_FRAME_NAME_MAX];
        return el_frame_name(o->png, frame, name) && write_png(name, picture);
    }
    return o->png == NULL || frame + 1U < (uint32_t)o->frames || write_png(o->png, picture);
}

static bool play(const example_options *o, el_display *display, el_output *raw)
{
    static uint16_t picture[EXAMPLE_WIDTH * EXAMPLE_HEIGHT];
    const example_screen screen = {.sink = &display->sink, .bus = &display->bus};
    const size_t keys = o->keys != NULL ? strlen(o->keys) : 0;
    el_status status = example_setup(&screen);
    for (uint32_t frame = 0; status == EL_OK && frame < (uint32_t)o->frames; frame++) {
        example_input input = {.ms = frame * (uint32_t)o->step_ms};
        if (frame < keys && o->keys[frame] != '.') {
            input.key = o->keys[frame];
        }
        status = example_frame(&input);
        if (status == EL_OK && (!el_display_look(display, picture) || !keep(o, frame, raw, picture))) {
            return false;
        }
    }
    if (status != EL_OK) {
        el_report("%s", el_machine_message(status));
    }
    return status == EL_OK;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        fputs(usage, stdout);
        return EL_EXIT_OK;
    }
    example_options o;
    if (!parse(argc, argv, &o)) {
        return EL_EXIT_BAD;
    }
    if (o.pty) {
        return example_watch(o.frames) ? EL_EXIT_OK : EL_EXIT_BAD;
    }
    el_display display = {0};
    el_output raw = {0};
    const el_display_config config = {
        .panel = EXAMPLE_PANEL, .rotation = EXAMPLE_ROTATION, .band_lines = EXAMPLE_BAND, .chunk = CHUNK};
    const bool good = (o.raw == NULL || el_output_open(&raw, o.raw)) && el_display_open(&display, &config) &&
                      play(&o, &display, &raw) && (raw.stream == NULL || el_output_commit(&raw));
    el_output_discard(&raw);
    el_display_close(&display);
    return good ? EL_EXIT_OK : EL_EXIT_BAD;
}
