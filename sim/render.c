/* render: frames into files, checksums and counters. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "common_options.h"
#include "files.h"
#include "frame_name.h"
#include "inputs.h"
#include "machine.h"
#include "png_file.h"
#include "report.h"
#include "subject.h"
#include "wire_trace.h"

typedef struct render_options {
    el_common_options common;
    el_inputs inputs;
    const char *png, *raw, *depth, *wire;
    bool crc, stats;
} render_options;

/* An option that only keeps its text: where that goes, or NULL for any other option. */
static const char **text_of(render_options *o, int which)
{
    enum { MESH = EL_OPTION_OWN };
    const char **const places[] = {
        &o->common.subject.meshes[o->common.subject.mesh_count],
        &o->png,
        &o->raw,
        &o->depth,
        &o->wire,
        &o->common.subject.eye,
        &o->common.subject.look_at,
        &o->common.subject.fov,
        &o->common.subject.near,
        &o->common.subject.far,
        &o->common.subject.shading,
        &o->inputs.view,
        &o->inputs.yaw,
        &o->inputs.pitch,
        &o->inputs.zoom,
        &o->inputs.pan_x,
        &o->inputs.pan_y,
    };
    const int index = which - MESH;
    return index >= 0 && index < (int)(sizeof places / sizeof places[0]) ? places[index] : NULL;
}

static bool parse(int argc, char **argv, render_options *o)
{
    /* In the order of text_of. */
    enum {
        MESH = EL_OPTION_OWN,
        PNG_FILE,
        RAW,
        DEPTH,
        WIRE,
        EYE,
        LOOK_AT,
        FOV,
        NEAR,
        FAR,
        SHADING,
        VIEW,
        YAW,
        PITCH,
        ZOOM,
        PAN_X,
        PAN_Y,
        CRC,
        STATS,
        SPARING,
        DEPTH_PREPASS
    };
    static const struct option options[] = {
        EL_COMMON_OPTIONS,
        {"mesh", required_argument, NULL, MESH},
        {"png", required_argument, NULL, PNG_FILE},
        {"raw", required_argument, NULL, RAW},
        {"depth", required_argument, NULL, DEPTH},
        {"wire", required_argument, NULL, WIRE},
        {"eye", required_argument, NULL, EYE},
        {"look-at", required_argument, NULL, LOOK_AT},
        {"fov", required_argument, NULL, FOV},
        {"near", required_argument, NULL, NEAR},
        {"far", required_argument, NULL, FAR},
        {"shading", required_argument, NULL, SHADING},
        {"view", required_argument, NULL, VIEW},
        {"yaw", required_argument, NULL, YAW},
        {"pitch", required_argument, NULL, PITCH},
        {"zoom", required_argument, NULL, ZOOM},
        {"pan-x", required_argument, NULL, PAN_X},
        {"pan-y", required_argument, NULL, PAN_Y},
        {"crc", no_argument, NULL, CRC},
        {"stats", no_argument, NULL, STATS},
        {"sparing", no_argument, NULL, SPARING},
        {"depth-prepass", no_argument, NULL, DEPTH_PREPASS},
        {NULL, 0, NULL, 0},
    };
    *o = (render_options){.common = el_common_options_default(1)};
    int which;
    optind = 0; /* argv begins with the first argument's predecessor, see el_command_render */
    opterr = 0;
    while ((which = getopt_long(argc, argv, "+", options, NULL)) != -1) {
        const char **const text = text_of(o, which);
        if (which == '?') {
            el_report("render: '%s' is unknown or lacks its value", argv[optind - 1]);
            return false;
        }
        if (text != NULL) {
            *text = optarg;
            if (which == MESH && ++o->common.subject.mesh_count == EL_SUBJECT_MESHES) {
                el_report("render: more than %d meshes", EL_SUBJECT_MESHES - 1);
                return false;
            }
        } else if (which == CRC) {
            o->crc = true;
        } else if (which == STATS) {
            o->stats = true;
        } else if (which == SPARING) {
            o->common.machine.sparing = true;
        } else if (which == DEPTH_PREPASS) {
            o->common.machine.depth_prepass = true;
        } else if (!el_common_options_take(&o->common, which, optarg)) {
            return false;
        }
    }
    if (optind != argc) {
        el_report("render: '%s' is no option", argv[optind]);
        return false;
    }
    char name[EL_FRAME_NAME_MAX];
    return el_common_options_check(&o->common) &&
           (o->png == NULL || !el_frame_name_is_pattern(o->png) || el_frame_name(o->png, 0, name));
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
    "clusters_outside",
    "clusters_turned",
    "triangles_skipped",
    "triangles_hidden",
    "pixels_prepass",
    "lines_background",
    "frames_unchanged",
};
_Static_assert(sizeof stat_names / sizeof stat_names[0] == EL_STATS_COUNT, "a name for each counter");

/* `wire_bytes`: sent to the display for this frame. */
static void print_stats(uint32_t frame, const el_stats *stats, uint64_t wire_bytes)
{
    uint32_t values[EL_STATS_COUNT];
    memcpy(values, stats, sizeof values);
    printf("{\"frame\": %u", frame);
    for (unsigned i = 0; i < EL_STATS_COUNT; i++) {
        printf(", \"%s\": %u", stat_names[i], values[i]);
    }
    printf(", \"wire_bytes\": %" PRIu64 "}\n", wire_bytes);
}

typedef struct outputs {
    el_output png; /* not open where each frame has a file of its own */
    el_output raw, depth, wire;
    el_wire_writer writer;
} outputs;

static bool open_outputs(outputs *out, const render_options *o)
{
    return (o->png == NULL || el_frame_name_is_pattern(o->png) || el_output_open(&out->png, o->png)) &&
           (o->raw == NULL || el_output_open(&out->raw, o->raw)) &&
           (o->depth == NULL || el_output_open(&out->depth, o->depth)) &&
           (o->wire == NULL || el_output_open(&out->wire, o->wire));
}

static bool write_png(el_output *output, const el_machine *machine)
{
    return el_png_write(output, machine->picture, machine->picture_width, machine->picture_height);
}

static bool write_numbered_png(const char *pattern, uint32_t frame, const el_machine *machine)
{
    char name[EL_FRAME_NAME_MAX];
    el_output output = {0};
    const bool good = el_frame_name(pattern, frame, name) && el_output_open(&output, name) &&
                      write_png(&output, machine) && el_output_commit(&output);
    el_output_discard(&output);
    return good;
}

static uint64_t wire_bytes(const el_machine *machine)
{
    const el_lcd_bus_traffic *const traffic = &machine->display.bus_state.traffic;
    return traffic->command_bytes + traffic->pixel_bytes;
}

/* `sent_before`: wire_bytes when the frame began. */
static bool write_frame(const render_options *o, uint32_t frame, uint64_t sent_before, el_machine *machine,
                        outputs *out)
{
    const size_t pixels = (size_t)machine->picture_width * machine->picture_height;
    if (out->raw.stream != NULL) {
        el_output_pixels(&out->raw, machine->picture, pixels);
    }
    if (out->depth.stream != NULL) {
        el_output_pixels(&out->depth, machine->depth, (size_t)machine->config.width * machine->config.height);
    }
    if (o->crc) {
        printf("%08x\n", el_pixels_crc(machine->picture, pixels));
    }
    if (o->stats) {
        print_stats(frame, el_frame_stats(&machine->renderer), wire_bytes(machine) - sent_before);
    }
    const bool is_last = frame + 1 == (uint32_t)o->common.frames;
    if (out->png.stream != NULL) {
        return !is_last || write_png(&out->png, machine);
    }
    return o->png == NULL || write_numbered_png(o->png, frame, machine);
}

/* A scene is played as a host would have a board play it. A mesh has its own shading and camera. */
static bool prepare_player(const render_options *o, const el_subject *subject, el_player *player)
{
    el_inputs inputs = o->inputs;
    if (subject->scene != NULL) {
        inputs.shading = o->common.subject.shading;
    } else if (el_inputs_move(&inputs)) {
        el_report("--yaw, --pitch, --zoom, --pan-x and --pan-y go with a scene; a mesh has --eye and --look-at");
        return false;
    }
    player->scene = subject->scene;
    return el_inputs_give(&inputs, player);
}

static bool render_frames(const render_options *o, const el_subject *subject, el_player *player, el_machine *machine,
                          outputs *out)
{
    machine->renderer.config.view = player->view;
    for (uint32_t frame = 0; frame < (uint32_t)o->common.frames; frame++) {
        const uint64_t sent_before = wire_bytes(machine);
        const el_status status = subject->scene != NULL ? el_player_play(player, &machine->renderer)
                                                        : el_subject_play(subject, frame, &machine->renderer);
        if (status != EL_OK) {
            el_report("frame %u: %s", frame, el_machine_message(status));
            return false;
        }
        if (!el_machine_look(machine) || !write_frame(o, frame, sent_before, machine, out)) {
            return false;
        }
    }
    return true;
}

/* Frames that nobody keeps are drawn for their time, or by who does not know yet what to ask for. */
static void say_what_could_be_kept(const render_options *o)
{
    if (o->png == NULL && o->raw == NULL && o->depth == NULL && o->wire == NULL && !o->crc && !o->stats) {
        el_report("render: %ld frame%s drawn and not kept; --png FILE keeps the last one, --help tells of others",
                  o->common.frames, o->common.frames == 1 ? "" : "s");
    }
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
    el_player player = {0};
    el_machine machine = {0};
    outputs out = {0};
    bool good = el_subject_open(&subject, &o.common.subject, el_common_options_aspect(&o.common)) &&
                prepare_player(&o, &subject, &player) && open_outputs(&out, &o);
    if (good) {
        o.common.machine.background = el_subject_background(&subject);
        if (out.wire.stream != NULL) {
            el_wire_begin(&out.writer, out.wire.stream);
            o.common.machine.tap = el_wire_tap(&out.writer);
        }
        good = el_machine_open(&machine, &o.common.machine) && render_frames(&o, &subject, &player, &machine, &out);
    }
    if (good) {
        good = commit(&out.png) && commit(&out.raw) && commit(&out.depth) && commit(&out.wire);
        say_what_could_be_kept(&o);
    }
    el_output_discard(&out.png);
    el_output_discard(&out.raw);
    el_output_discard(&out.depth);
    el_output_discard(&out.wire);
    el_machine_close(&machine);
    el_subject_close(&subject);
    return good ? EL_EXIT_OK : EL_EXIT_BAD;
}
