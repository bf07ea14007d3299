/* Non-blocking descriptors behind el_port.
 *
 * The three links differ in how they are opened and in what an end of file means; reading, writing and waiting are the
 * same. */
#define _XOPEN_SOURCE 600 /* posix_openpt. NOLINT(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp) */

#include "port_posix.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "report.h"

enum {
    WAIT_MS = 1,
    QUEUE_BYTES = 1024, /* of a link with a rate; the Pico's ring has as many */
    BITS_PER_BYTE = 10, /* a start bit, 8 bits, a stop bit */
    NS_PER_S = 1000000000
};

static uint64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * NS_PER_S + (uint64_t)now.tv_nsec;
}

/* Whoever reads a pipe may take any time to begin, or to go on, and nothing is lost on it: so the clock, by which a session
 * gives up, stands still meanwhile. */
static bool stands_still(const el_posix_port *port)
{
    return port->full_since_ns != 0 && (port->stopped == NULL || *port->stopped == 0);
}

static uint32_t port_micros(void *context)
{
    const el_posix_port *port = context;
    const uint64_t until_ns = stands_still(port) ? port->full_since_ns : now_ns();
    return (uint32_t)((until_ns - port->waited_ns) / 1000U);
}

/* --- The other end comes and goes ------------------------------------------------------------------------------ */

static bool make_non_blocking(int descriptor)
{
    int flags = fcntl(descriptor, F_GETFL);
    return flags >= 0 && fcntl(descriptor, F_SETFL, flags | O_NONBLOCK) == 0;
}

static void accept_client(el_posix_port *port)
{
    int one = 1;
    int client = accept(port->listener, NULL, NULL);

    if (client < 0) {
        return;
    }
    /* Packets are small and credits wait for answers: Nagle's algorithm would hold both back. */
    if (!make_non_blocking(client) || setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one) != 0) {
        close(client);
        return;
    }
    port->in = client;
    port->out = client;
}

static void drop_client(el_posix_port *port)
{
    close(port->in);
    port->in = -1;
    port->out = -1;
}

/* What a read or write that moved nothing means: 0 for "not now", -1 for a link that is gone. */
static int32_t nothing_moved(el_posix_port *port, bool not_now)
{
    if (not_now) {
        return 0;
    }
    if (port->listener >= 0) {
        drop_client(port);
        return 0;
    }
    return -1;
}

static bool is_not_now(int error)
{
    return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

/* --- el_port --------------------------------------------------------------------------------------------------- */

/* What the rest of the queue leaves room for. A wire that was idle has saved nothing up. */
static size_t throttled(el_posix_port *port, size_t count)
{
    const uint64_t now = now_ns();

    if (port->sent_ns < now) {
        port->sent_ns = now;
    }
    const uint64_t queued = (port->sent_ns - now) * port->baud / ((uint64_t)BITS_PER_BYTE * NS_PER_S);
    const size_t room = queued < QUEUE_BYTES ? (size_t)(QUEUE_BYTES - queued) : 0;
    return count < room ? count : room;
}

static uint32_t port_find_baud(void *context, uint32_t rate)
{
    (void)context;
    return rate;
}

static bool port_set_baud(void *context, uint32_t rate)
{
    el_posix_port *port = context;
    const bool idle = port->sent_ns <= now_ns();
    port->baud = idle ? rate : port->baud;
    return idle;
}

static bool has_room(el_posix_port *port)
{
    struct pollfd writable = {.fd = port->out, .events = POLLOUT};
    if (poll(&writable, 1, 0) <= 0) {
        port->full_since_ns = port->full_since_ns != 0 ? port->full_since_ns : now_ns();
        return false;
    }
    port->waited_ns += stands_still(port) ? now_ns() - port->full_since_ns : 0;
    port->full_since_ns = 0;
    return true;
}

static int32_t port_write(void *context, const uint8_t *bytes, size_t count)
{
    el_posix_port *port = context;
    size_t wanted = count;

    port->full = true;
    if (port->out < 0) {
        accept_client(port);
    }
    if (port->out < 0) {
        return 0;
    }
    if (port->baud != 0) {
        count = throttled(port, count);
    }
    if (count == 0) {
        return 0;
    }
    /* Standard output may be shared with other processes, so it is not made non-blocking. A pipe that poll() calls
     * writable takes PIPE_BUF bytes without blocking. */
    if (port->out == STDOUT_FILENO) {
        count = count < PIPE_BUF ? count : PIPE_BUF;
        if (!has_room(port)) {
            return 0;
        }
    }
    ssize_t took = write(port->out, bytes, count);
    if (took < 0) {
        return nothing_moved(port, is_not_now(errno));
    }
    if (port->baud != 0) {
        port->sent_ns += (uint64_t)took * BITS_PER_BYTE * NS_PER_S / port->baud;
    }
    port->full = (size_t)took < wanted;
    return (int32_t)took;
}

static int32_t port_read(void *context, uint8_t *bytes, size_t capacity)
{
    el_posix_port *port = context;

    if (port->in < 0 && port->listener >= 0) {
        accept_client(port);
    }
    if (port->in < 0) {
        return 0;
    }
    ssize_t got = read(port->in, bytes, capacity);
    return got > 0 ? (int32_t)got : nothing_moved(port, got < 0 && is_not_now(errno));
}

static void port_wait(void *context)
{
    el_posix_port *port = context;
    struct pollfd events[2] = {
        {.fd = port->in >= 0 ? port->in : port->listener, .events = POLLIN},
        {.fd = port->full && port->baud == 0 ? port->out : -1, .events = POLLOUT},
    };
    poll(events, 2, WAIT_MS);
}

el_port el_posix_port_link(el_posix_port *port)
{
    return (el_port){.context = port,
                     .write = port_write,
                     .read = port_read,
                     .micros = port_micros,
                     .wait = port_wait,
                     .find_baud = port->baud != 0 ? port_find_baud : NULL,
                     .set_baud = port->baud != 0 ? port_set_baud : NULL};
}

/* --- Opening and closing --------------------------------------------------------------------------------------- */

static void reset(el_posix_port *port)
{
    *port = (el_posix_port){.in = -1, .out = -1, .listener = -1, .slave = -1};
    (void)signal(SIGPIPE, SIG_IGN); /* a reader that goes away is an error of write(), not the end of the process */
}

/* No echo, no line editing, no translation of any byte. cfmakeraw would do it, but POSIX does not have it. */
static bool make_raw(int terminal)
{
    struct termios mode;

    if (tcgetattr(terminal, &mode) != 0) {
        return false;
    }
    mode.c_iflag &= (tcflag_t) ~(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON);
    mode.c_oflag &= (tcflag_t)~OPOST;
    mode.c_lflag &= (tcflag_t) ~(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
    mode.c_cflag = (mode.c_cflag & (tcflag_t) ~(CSIZE | PARENB)) | CS8;
    mode.c_cc[VMIN] = 1;
    mode.c_cc[VTIME] = 0;
    return tcsetattr(terminal, TCSANOW, &mode) == 0;
}

bool el_posix_port_open_pty(el_posix_port *port)
{
    reset(port);
    port->in = posix_openpt(O_RDWR | O_NOCTTY);
    port->out = port->in;
    const char *path = NULL;
    if (port->in >= 0 && grantpt(port->in) == 0 && unlockpt(port->in) == 0) {
        path = ptsname(port->in);
    }
    if (path != NULL) {
        /* While this end of it is open, a host that closes its own leaves neither EIO nor a mode that is not raw. */
        port->slave = open(path, O_RDWR | O_NOCTTY);
    }
    if (port->slave < 0 || !make_raw(port->slave) || !make_non_blocking(port->in)) {
        el_report("cannot open a pseudo-terminal: %s; use --tcp PORT instead", strerror(errno));
        el_posix_port_close(port);
        return false;
    }
    (void)printf("%s\n", path);
    (void)fflush(stdout);
    return true;
}

bool el_posix_port_open_tcp(el_posix_port *port, uint16_t tcp_port)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(tcp_port)};
    socklen_t size = sizeof address;
    int one = 1;

    reset(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    port->listener = socket(AF_INET, SOCK_STREAM, 0);
    /* Without SO_REUSEADDR the port would stay taken for a minute after the simulator has ended. */
    if (port->listener < 0 || setsockopt(port->listener, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one) != 0 ||
        bind(port->listener, (struct sockaddr *)&address, sizeof address) != 0 || listen(port->listener, 1) != 0 ||
        !make_non_blocking(port->listener) || getsockname(port->listener, (struct sockaddr *)&address, &size) != 0) {
        el_report("cannot listen on 127.0.0.1:%u: %s; choose another --tcp port, or 0 for any", tcp_port,
                  strerror(errno));
        el_posix_port_close(port);
        return false;
    }
    (void)printf("listening on 127.0.0.1:%u\n", ntohs(address.sin_port));
    (void)fflush(stdout);
    return true;
}

bool el_posix_port_open_stdout(el_posix_port *port)
{
    reset(port);
    if (fcntl(STDOUT_FILENO, F_GETFL) < 0) {
        el_report("cannot write the stream: standard output is closed; redirect it to a file");
        return false;
    }
    port->out = STDOUT_FILENO;
    return true;
}

static void close_one(int descriptor)
{
    if (descriptor > STDERR_FILENO) {
        close(descriptor);
    }
}

void el_posix_port_close(el_posix_port *port)
{
    close_one(port->in);
    close_one(port->listener);
    close_one(port->slave);
    port->in = -1;
    port->out = -1;
    port->listener = -1;
    port->slave = -1;
}
