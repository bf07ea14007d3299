/* stream: the product with a serial link, sending what a board would send; with --baud as fast as a board's UART would. */
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "commands.h"
#include "common_options.h"
#include "machine.h"
#include "options.h"
#include "player.h"
#include "port_posix.h"
#include "report.h"
#include "stream/sink.h"
#include "subject.h"

typedef enum link_kind { LINK_NONE, LINK_PTY, LINK_TCP, LINK_STDOUT } link_kind;

typedef struct stream_options {
    el_common_options common; /* frames 0: until stopped */
    link_kind link;
    long tcp_port;
    long baud; /* 0: as fast as the link goes */
    long max_baud;
} stream_options;

/* The most that common USB adapters have, and a Pico's UART with ease. */
enum { USUAL_MAX_BAUD = 3000000, LEAST_BAUD = 1200, MOST_BAUD = 100000000 };

static volatile sig_atomic_t stopped;

static void stop(int signal_number)
{
    (void)signal_number;
    stopped = 1;
}

static bool parse(int argc, char **argv, stream_options *o)
{
    enum { BAUD = EL_OPTION_OWN, MAX_BAUD, PTY, TCP, STDOUT };
    static const struct option options[] = {
        EL_COMMON_OPTIONS,
        {"baud", required_argument, NULL, BAUD},
        {"max-baud", required_argument, NULL, MAX_BAUD},
        {"pty", no_argument, NULL, PTY},
        {"tcp", required_argument, NULL, TCP},
        {"stdout", no_argument, NULL, STDOUT},
        {NULL, 0, NULL, 0},
    };
    *o = (stream_options){.common = el_common_options_default(0)};
    int which;
    int links = 0;
    optind = 0;
    opterr = 0;
    while ((which = getopt_long(argc, argv, "+", options, NULL)) != -1) {
        bool good = true;
        switch (which) {
        case BAUD:
            good = el_option_integer("--baud", optarg, LEAST_BAUD, MOST_BAUD, &o->baud);
            break;
        case MAX_BAUD:
            good = el_option_integer("--max-baud", optarg, LEAST_BAUD, MOST_BAUD, &o->max_baud);
            break;
        case PTY:
            o->link = LINK_PTY;
            links++;
            break;
        case TCP:
            good = el_option_integer("--tcp", optarg, 0, 65535, &o->tcp_port);
            o->link = LINK_TCP;
            links++;
            break;
        case STDOUT:
            o->link = LINK_STDOUT;
            links++;
            break;
        case '?':
            el_report("stream: '%s' is unknown or lacks its value", argv[optind - 1]);
            good = false;
            break;
        default:
            good = el_common_options_take(&o->common, which, optarg);
        }
        if (!good) {
            return false;
        }
    }
    if (optind != argc) {
        el_report("stream: '%s' is no option", argv[optind]);
        return false;
    }
    if (links != 1) {
        el_report("stream needs one of --pty, --tcp PORT and --stdout");
        return false;
    }
    if (o->max_baud != 0 && o->max_baud < o->baud) {
        el_report("--max-baud %ld is below --baud %ld", o->max_baud, o->baud);
        return false;
    }
    if (o->max_baud != 0 && o->baud == 0) {
        el_report("--max-baud goes with --baud, the rate at the start");
        return false;
    }
    if (o->baud != 0 && o->max_baud == 0) {
        o->max_baud = o->baud < USUAL_MAX_BAUD ? USUAL_MAX_BAUD : o->baud;
    }
    return el_common_options_check(&o->common);
}

static bool open_link(const stream_options *o, el_posix_port *port)
{
    switch (o->link) {
    case LINK_PTY:
        return el_posix_port_open_pty(port);
    case LINK_TCP:
        return el_posix_port_open_tcp(port, (uint16_t)o->tcp_port);
    default:
        return el_posix_port_open_stdout(port);
    }
}

/* After the last frame: closing a pty or a connection throws away what the host has not read, so wait for its ACK, or
 * until the session ends because nothing comes. */
static void wait_for_host(el_stream *stream, const el_port *link)
{
    if (!el_stream_flush(stream) || stream->config.one_way) {
        return;
    }
    const uint8_t credits = stream->credits;
    const uint32_t begin_us = link->micros(link->context);
    while (!stopped && stream->state == EL_STREAM_RUNNING && stream->credits <= credits &&
           link->micros(link->context) - begin_us < 2U * EL_STREAM_PATIENCE_US) {
        (void)el_stream_poll(stream);
        link->wait(link->context);
    }
}

/* Renders when the host has credit for a frame, so that none is drawn for nobody and, unless the host chooses, frame n of
 * the stream is frame n of the scene. A mesh has no other scene to choose. */
static bool play(const stream_options *o, const el_subject *subject, el_player *player, el_machine *machine,
                 el_stream *stream, const el_port *link)
{
    uint32_t frame = 0;
    while (!stopped && (o->common.frames == 0 || frame < (uint32_t)o->common.frames)) {
        if (el_stream_poll(stream) == EL_STREAM_LINK_GONE) {
            return true; /* the reader has what it wanted */
        }
        if (!el_stream_ready(stream)) {
            link->wait(link->context);
            continue;
        }
        const el_status status = player->scene != NULL ? el_player_play(player, &machine->renderer)
                                                       : el_subject_play(subject, frame, &machine->renderer);
        if (status != EL_OK) {
            el_report("frame %u: %s", frame, el_machine_message(status));
            return false;
        }
        frame++;
    }
    wait_for_host(stream, link);
    return true;
}

static bool run(const stream_options *o, const el_subject *subject, el_posix_port *port)
{
    port->baud = (uint32_t)o->baud;
    const el_port link = el_posix_port_link(port);

    /* No board has pictures of this size. */
    static uint8_t memory[EL_STREAM_MEMORY_BYTES(EL_MAX_WIDTH, EL_MAX_HEIGHT) +
                          EL_STREAM_SEGMENT_MEMORY_BYTES(EL_MAX_WIDTH, EL_MAX_HEIGHT)];
    el_player player = {.scene = subject->scene};
    const el_stream_config config = {
        .port = &link,
        .width = o->common.machine.width,
        .height = o->common.machine.height,
        .target = "simulator",
        .firmware = "edgeline " EDGELINE_VERSION,
        .boot_id = (uint32_t)time(NULL) * 2654435761U ^ (uint32_t)getpid(),
        .baud = (uint32_t)o->baud,
        .max_baud = (uint32_t)o->max_baud,
        .one_way = o->link == LINK_STDOUT,
        .input = subject->scene != NULL ? el_player_input : NULL,
        .input_context = &player,
        .scenes = subject->scene != NULL ? (uint8_t)el_scene_count() : 0,
        .controls = subject->scene != NULL ? EL_PLAYER_CONTROLS : 0,
        .views = subject->scene != NULL ? EL_PLAYER_VIEWS : 0,
        .segments = true,
        .memory = memory,
        .memory_bytes = sizeof memory,
    };
    el_stream stream;
    if (el_stream_init(&stream, &config) != 0) {
        el_report("the stream refuses its configuration");
        return false;
    }
    const el_sink sink = el_stream_sink(&stream);
    el_machine_config machine_config = o->common.machine;
    machine_config.background = el_subject_background(subject);
    machine_config.extra_sink = &sink;
    el_machine machine = {0};
    const bool good = el_machine_open(&machine, &machine_config) && play(o, subject, &player, &machine, &stream, &link);
    el_machine_close(&machine);
    return good;
}

int el_command_stream(int argc, char **argv)
{
    stream_options o;
    if (!parse(argc + 1, argv - 1, &o)) {
        return EL_EXIT_BAD;
    }
    el_subject subject = {0};
    el_posix_port port = {0};
    bool good = el_subject_open(&subject, &o.common.subject, el_common_options_aspect(&o.common));
    if (good && open_link(&o, &port)) {
        fflush(stdout);
        const struct sigaction action = {.sa_handler = stop};
        sigaction(SIGINT, &action, NULL);
        sigaction(SIGTERM, &action, NULL);
        port.stopped = &stopped;
        good = run(&o, &subject, &port);
        el_posix_port_close(&port);
    } else {
        good = false;
    }
    el_subject_close(&subject);
    return good ? EL_EXIT_OK : EL_EXIT_BAD;
}
