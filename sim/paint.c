/* paint: pages of canvas/ into files and checksums. A page without a scene is drawn as a board without 3D would draw it: a
 * loop over bands, without a renderer. */
#include <getopt.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/fill.h"
#include "commands.h"
#include "files.h"
#include "machine.h"
#include "options.h"
#include "paint/pages.h"
#include "png_file.h"
#include "report.h"

enum { WIDTH = 320, HEIGHT = 240, PIXELS = WIDTH * HEIGHT };

typedef struct paint_options {
    const el_page *page;
    long band, frames;
    const char *png, *raw;
    bool crc;
} paint_options;

static bool parse_page(const char *name, paint_options *o)
{
    o->page = el_page_find(name);
    if (o->page == NULL) {
        el_report("paint: no page '%s'; `edgeline-sim list pages` names them", name);
    }
    return o->page != NULL;
}

static bool parse(int argc, char **argv, paint_options *o)
{
    enum { PAGE = 1, BAND, FRAMES, PNG_FILE, RAW, CRC };
    static const struct option options[] = {
        {"page", required_argument, NULL, PAGE},
        {"band", required_argument, NULL, BAND},
        {"frames", required_argument, NULL, FRAMES},
        {"png", required_argument, NULL, PNG_FILE},
        {"raw", required_argument, NULL, RAW},
        {"crc", no_argument, NULL, CRC},
        {NULL, 0, NULL, 0},
    };
    *o = (paint_options){.page = el_pages[0], .band = 8, .frames = 1};
    int which;
    bool good = true;
    optind = 0; /* argv begins with the first argument's predecessor, see el_command_paint */
    opterr = 0;
    while (good && (which = getopt_long(argc, argv, "+", options, NULL)) != -1) {
        switch (which) {
        case PAGE:
            good = parse_page(optarg, o);
            break;
        case BAND:
            good = el_option_integer("--band", optarg, 1, HEIGHT, &o->band);
            break;
        case FRAMES:
            good = el_option_integer("--frames", optarg, 1, 1000000, &o->frames);
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
        default:
            el_report("paint: '%s' is unknown or lacks its value", argv[optind - 1]);
            good = false;
        }
    }
    if (good && optind != argc) {
        el_report("paint: '%s' is no option", argv[optind]);
        good = false;
    }
    return good;
}

/* Without a renderer. */
static void paint_alone(const paint_options *o, el_page_frame *at, uint16_t *picture)
{
    for (int32_t y = 0; y < HEIGHT; y += (int32_t)o->band) {
        const int32_t lines = HEIGHT - y < o->band ? HEIGHT - y : (int32_t)o->band;
        el_band band = {.pixels = picture + y * WIDTH, .width = WIDTH, .y = (uint16_t)y, .lines = (uint16_t)lines};
        el_fill_u16(band.pixels, o->page->background, (uint32_t)(lines * WIDTH));
        el_page_draw(at, &band);
    }
}

static bool paint_over(const el_scene *scene, el_machine *machine, uint32_t frame, uint16_t *picture)
{
    const el_status status = el_scene_play(scene, frame, &machine->renderer);
    if (status != EL_OK) {
        el_report("frame %u: %s", frame, el_machine_message(status));
        return false;
    }
    if (!el_machine_look(machine)) {
        return false;
    }
    memcpy(picture, machine->picture, PIXELS * sizeof picture[0]);
    return true;
}

/* `machine` is open where the page has a scene. Of several frames the PNG has the last. */
static bool paint_frames(const paint_options *o, el_machine *machine, el_page_frame *at, uint16_t *picture,
                         el_output *raw, el_output *png)
{
    for (at->frame = 0; at->frame < (uint32_t)o->frames; at->frame++) {
        if (o->page->scene == NULL) {
            paint_alone(o, at, picture);
        } else if (!paint_over(el_scene_find(o->page->scene), machine, at->frame, picture)) {
            return false;
        }
        if (raw->stream != NULL) {
            el_output_pixels(raw, picture, PIXELS);
        }
        if (o->crc) {
            printf("%08" PRIx32 "\n", el_pixels_crc(picture, PIXELS));
        }
    }
    return (png->stream == NULL || el_png_write(png, picture, WIDTH, HEIGHT)) &&
           (raw->stream == NULL || el_output_commit(raw)) && (png->stream == NULL || el_output_commit(png));
}

int el_command_paint(int argc, char **argv)
{
    paint_options o;
    /* getopt_long skips the first word, which is the command's name. */
    if (!parse(argc + 1, argv - 1, &o)) {
        return EL_EXIT_BAD;
    }
    el_page_frame at = {.page = o.page};
    const el_layer layer = {.context = &at, .draw = el_page_draw};
    el_machine machine = {0};
    el_output raw = {0};
    el_output png = {0};
    bool good = (o.raw == NULL || el_output_open(&raw, o.raw)) && (o.png == NULL || el_output_open(&png, o.png));
    if (good && o.page->scene != NULL) {
        const el_machine_config config = {.width = WIDTH,
                                          .height = HEIGHT,
                                          .band_lines = (uint16_t)o.band,
                                          .background = el_scene_find(o.page->scene)->background};
        good = el_machine_open(&machine, &config);
        machine.renderer.config.over = &layer;
    }
    uint16_t *const picture = malloc(PIXELS * sizeof *picture);
    if (good && picture == NULL) {
        el_report("no memory for %d x %d pixels", WIDTH, HEIGHT);
        good = false;
    }
    good = good && paint_frames(&o, &machine, &at, picture, &raw, &png);
    free(picture);
    el_output_discard(&raw);
    el_output_discard(&png);
    el_machine_close(&machine);
    return good ? EL_EXIT_OK : EL_EXIT_BAD;
}
