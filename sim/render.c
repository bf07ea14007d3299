/* render: frames into files, checksums and counters. */
#include <getopt.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/crc32.h"
#include "commands.h"
#include "files.h"
#include "machine.h"
#include "options.h"
#include "png_file.h"
#include "report.h"
#include "subject.h"

typedef struct render_options {
    el_subject_options subject;
    el_machine_config machine;
    long frames;
    const char *png, *raw, *depth;
    bool crc, stats;
} render_options;

static bool parse(int argc, char **argv, render_options *o)
{
    enum {
        SCENE = 1,
        MESH,
        SIZE,
        BAND,
        ARENA,
        FRAMES,
        PNG_FILE,
        RAW,
        DEPTH,
        CRC,
        STATS,
        EYE,
        LOOK_AT,
        FOV,
        NEAR,
        FAR,
        SHADING
    };
    static const struct option options[] = {
        {"scene", required_argument, NULL, SCENE},     {"mesh", required_argument, NULL, MESH},
        {"size", required_argument, NULL, SIZE},       {"band", required_argument, NULL, BAND},
        {"arena", required_argument, NULL, ARENA},     {"frames", required_argument, NULL, FRAMES},
        {"png", required_argument, NULL, PNG_FILE},    {"raw", required_argument, NULL, RAW},
        {"depth", required_argument, NULL, DEPTH},     {"crc", no_argument, NULL, CRC},
        {"stats", no_argument, NULL, STATS},           {"eye", required_argument, NULL, EYE},
        {"look-at", required_argument, NULL, LOOK_AT}, {"fov", required_argument, NULL, FOV},
        {"near", required_argument, NULL, NEAR},       {"far", required_argument, NULL, FAR},
        {"shading", required_argument, NULL, SHADING}, {NULL, 0, NULL, 0},
    };
    *o = (render_options){.machine = {.width = 320, .height = 240}, .frames = 1};
    const char *band = NULL;
    long value;
    int which;
    optind = 0; /* argv begins with the first argument's predecessor, see el_command_render */
    opterr = 0;
    while ((which = getopt_long(argc, argv, "+", options, NULL)) != -1) {
        bool good = true;
        switch (which) {
        case SCENE:
            o->subject.scene = optarg;
            break;
        case MESH:
            o->subject.mesh = optarg;
            break;
        case SIZE:
            good = el_option_size("--size", optarg, &o->machine.width, &o->machine.height);
            break;
        case BAND:
            band = optarg;
            break;
        case ARENA:
            good = el_option_integer("--arena", optarg, 1, 1L << 28, &value);
            o->machine.arena_bytes = good ? (size_t)value : 0;
            break;
        case FRAMES:
            good = el_option_integer("--frames", optarg, 1, INT_MAX, &o->frames);
            break;
        case PNG_FILE:
            o->png = optarg;
            break;
        case RAW:
            o->raw = optarg;
            break;
        case DEPTH:
            o->depth = optarg;
            break;
        case CRC:
            o->crc = true;
            break;
        case STATS:
            o->stats = true;
            break;
        case EYE:
            o->subject.eye = optarg;
            break;
        case LOOK_AT:
            o->subject.look_at = optarg;
            break;
        case FOV:
            o->subject.fov = optarg;
            break;
        case NEAR:
            o->subject.near = optarg;
            break;
        case FAR:
            o->subject.far = optarg;
            break;
        case SHADING:
            o->subject.shading = optarg;
            break;
        default:
            el_report("render: '%s' is unknown or lacks its value", argv[optind - 1]);
            good = false;
        }
        if (!good) {
            return false;
        }
    }
    if (optind != argc) {
        el_report("render: '%s' is no option", argv[optind]);
        return false;
    }
    if (!el_option_band(band, o->machine.height, &o->machine.band_lines)) {
        return false;
    }
    return true;
}

static const char *const stat_names[] = {
    "passes",
    "draws",
    "draws_culled",
    "vertices",
    "triangles",
    "triangles_outside",
    "triangles_clipped",
    "triangles_backface",
    "triangles_empty",
    "triangles_other",
    "triangles_listed",
    "setups",
    "rows",
    "spans",
    "pixels",
    "bands",
    "flushes",
    "memory_peak",
};
_Static_assert(sizeof stat_names / sizeof stat_names[0] == EL_STATS_COUNT, "a name for each counter");

static void print_stats(uint32_t frame, const el_stats *stats)
{
    uint32_t values[EL_STATS_COUNT];
    memcpy(values, stats, sizeof values);
    printf("{\"frame\": %u", frame);
    for (unsigned i = 0; i < EL_STATS_COUNT; i++) {
        printf(", \"%s\": %u", stat_names[i], values[i]);
    }
    puts("}");
}

/* Little-endian whatever the host is. */
static void write_u16(FILE *stream, const uint16_t *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint8_t bytes[2] = {(uint8_t)values[i], (uint8_t)(values[i] >> 8)};
        fwrite(bytes, 1, sizeof bytes, stream);
    }
}

static uint32_t crc_of(const uint16_t *values, size_t count)
{
    uint32_t crc = 0;
    for (size_t i = 0; i < count; i++) {
        const uint8_t bytes[2] = {(uint8_t)values[i], (uint8_t)(values[i] >> 8)};
        crc = el_crc32(crc, bytes, sizeof bytes);
    }
    return crc;
}

typedef struct outputs {
    el_output png, raw, depth;
} outputs;

static bool open_outputs(outputs *out, const render_options *o)
{
    return (o->png == NULL || el_output_open(&out->png, o->png)) &&
           (o->raw == NULL || el_output_open(&out->raw, o->raw)) &&
           (o->depth == NULL || el_output_open(&out->depth, o->depth));
}

static bool render_frames(const render_options *o, const el_subject *subject, el_machine *machine, outputs *out)
{
    const size_t pixels = (size_t)o->machine.width * o->machine.height;
    for (uint32_t frame = 0; frame < (uint32_t)o->frames; frame++) {
        const el_status status = el_subject_play(subject, frame, &machine->renderer);
        if (status != EL_OK) {
            el_report("frame %u: %s", frame, el_machine_message(status));
            return false;
        }
        if (!el_machine_look(machine)) {
            return false;
        }
        if (out->raw.stream != NULL) {
            write_u16(out->raw.stream, machine->picture, pixels);
        }
        if (out->depth.stream != NULL) {
            write_u16(out->depth.stream, machine->depth, pixels);
        }
        if (o->crc) {
            printf("%08x\n", crc_of(machine->picture, pixels));
        }
        if (o->stats) {
            print_stats(frame, el_frame_stats(&machine->renderer));
        }
    }
    if (out->png.stream != NULL &&
        !el_png_write(out->png.stream, machine->picture, o->machine.width, o->machine.height)) {
        el_report("cannot write %s", o->png);
        return false;
    }
    return true;
}

static bool commit(el_output *output)
{
    return output->stream == NULL || el_output_commit(output);
}

int el_command_render(int argc, char **argv)
{
    render_options o;
    /* getopt_long skips the first word, which is the command's name. */
    if (!parse(argc + 1, argv - 1, &o)) {
        return EL_EXIT_BAD;
    }
    el_subject subject = {0};
    el_machine machine = {0};
    outputs out = {0};
    bool good = el_subject_open(&subject, &o.subject);
    if (good) {
        o.machine.background = el_subject_background(&subject);
        good = el_machine_open(&machine, &o.machine) && open_outputs(&out, &o) &&
               render_frames(&o, &subject, &machine, &out);
    }
    if (good) {
        good = commit(&out.png) && commit(&out.raw) && commit(&out.depth);
    }
    el_output_discard(&out.png);
    el_output_discard(&out.raw);
    el_output_discard(&out.depth);
    el_machine_close(&machine);
    el_subject_close(&subject);
    return good ? EL_EXIT_OK : EL_EXIT_BAD;
}
