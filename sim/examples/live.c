#include "live.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "display.h"
#include "example.h"
#include "machine.h"
#include "port_posix.h"
#include "report.h"
#include "stream/sink.h"

enum { FRAME_US = 33333 }; /* 30 frames a second at most */

static volatile sig_atomic_t stopped;

static void stop(int signal_number)
{
    (void)signal_number;
    stopped = 1;
}

/* Letters come one by one and unseen, as on a serial line. What is no terminal has them too. */
static void open_keys(struct termios *before, bool *is_terminal)
{
    *is_terminal = tcgetattr(STDIN_FILENO, before) == 0;
    if (*is_terminal) {
        struct termios raw = *before;
        raw.c_lflag &= (tcflag_t) ~(ICANON | ECHO);
        (void)tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    }
    (void)fcntl(STDIN_FILENO, F_SETFL, fcntl(STDIN_FILENO, F_GETFL) | O_NONBLOCK);
}

static char last_key(void)
{
    uint8_t key = 0;
    while (read(STDIN_FILENO, &key, 1) > 0) {
    }
    return (char)(key & 0x7FU);
}

static el_status play(long frames, el_stream *stream, const el_port *link)
{
    const uint32_t begin_us = link->micros(link->context);
    uint32_t drawn_us = begin_us - FRAME_US;
    for (long frame = 0; !stopped && (frames == 0 || frame < frames);) {
        (void)el_stream_poll(stream);
        const uint32_t now_us = link->micros(link->context);
        if (!el_stream_ready(stream) || now_us - drawn_us < FRAME_US) {
            link->wait(link->context);
            continue;
        }
        drawn_us = now_us;
        const el_status status = example_frame(&(example_input){.ms = (now_us - begin_us) / 1000U, .key = last_key()});
        if (status != EL_OK) {
            return status;
        }
        frame++;
    }
    (void)el_stream_flush(stream);
    return EL_OK;
}

static bool watch(long frames, el_posix_port *port)
{
    const el_port link = el_posix_port_link(port);
    static uint8_t memory[EL_STREAM_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT) +
                          EL_STREAM_SEGMENT_MEMORY_BYTES(EXAMPLE_WIDTH, EXAMPLE_HEIGHT)];
    static el_stream stream;
    const el_stream_config config = {.port = &link,
                                     .width = EXAMPLE_WIDTH,
                                     .height = EXAMPLE_HEIGHT,
                                     .target = "simulator",
                                     .firmware = EXAMPLE_NAME,
                                     .boot_id = (uint32_t)time(NULL) * 2654435761U ^ (uint32_t)getpid(),
                                     .segments = true,
                                     .memory = memory,
                                     .memory_bytes = sizeof memory};
    if (el_stream_init(&stream, &config) != 0) {
        el_report("the stream refuses its configuration");
        return false;
    }
    /* The wire is there for programs that use it, and its display shows nobody anything. */
    el_display display = {0};
    const el_display_config panel = {.panel = EXAMPLE_PANEL, .rotation = EXAMPLE_ROTATION, .band_lines = EXAMPLE_BAND};
    if (!el_display_open(&display, &panel)) {
        el_display_close(&display);
        return false;
    }
    const el_sink sink = el_stream_sink(&stream);
    el_status status = example_setup(&(example_screen){.sink = &sink, .bus = &display.bus});
    if (status == EL_OK) {
        status = play(frames, &stream, &link);
    }
    el_display_close(&display);
    if (status != EL_OK) {
        el_report("%s", el_machine_message(status));
    }
    return status == EL_OK;
}

bool example_watch(long frames)
{
    el_posix_port port = {0};
    if (!el_posix_port_open_pty(&port)) {
        return false;
    }
    (void)fflush(stdout);
    const struct sigaction action = {.sa_handler = stop};
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
    struct termios before;
    bool is_terminal;
    open_keys(&before, &is_terminal);
    const bool good = watch(frames, &port);
    if (is_terminal) {
        (void)tcsetattr(STDIN_FILENO, TCSANOW, &before);
    }
    el_posix_port_close(&port);
    return good;
}
