/* Byte links of a POSIX system as an el_port: a pseudo-terminal, a TCP server, standard output.
 *
 * Each is one link for the device, whoever is at its other end: hosts may come and go. While nobody is there a pty takes
 * what its buffer holds and TCP takes nothing, so a session sees a full link, never a gone one. Standard output is gone
 * when its reader is.
 *
 * Opening ignores SIGPIPE for the whole process. On failure it reports one line (report.h) and returns false. */
#ifndef EL_SIM_PORT_POSIX_H
#define EL_SIM_PORT_POSIX_H

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/port.h"

/* Private but for the rate; all of it is the caller's, and stays where it is while the port is in use. */
typedef struct el_posix_port {
    int in;       /* -1: nothing to read from (now) */
    int out;      /* -1: nobody to write to (now) */
    int listener; /* TCP: the socket that accepts; else -1 */
    int slave;    /* pty: the other end, held open; else -1 */
    bool full;    /* the last write was cut short */

    /* 0: as fast as it goes. Else `write` takes what a UART of so many bits per second takes that has a queue of 1,024
     * bytes: the other end has them early by as much, and no more of them in the long run. The host changes it. */
    uint32_t baud;
    uint64_t sent_ns; /* when the last bit of what was taken has left */

    /* Standard output: since when it is full, or 0, and how long its reader has been waited for before. */
    uint64_t full_since_ns;
    uint64_t waited_ns;
    const volatile sig_atomic_t *stopped; /* not 0: whoever waits shall give up; NULL: nothing says so */
} el_posix_port;

/* Opens a pseudo-terminal and prints the path of the host's end as a line on stdout. */
bool el_posix_port_open_pty(el_posix_port *port);

/* Listens on 127.0.0.1:`tcp_port`, 0 for any free one, and prints "listening on 127.0.0.1:PORT" as a line on stdout. One
 * client at a time; another one waits until the first has gone. */
bool el_posix_port_open_tcp(el_posix_port *port, uint16_t tcp_port);

/* Writes to standard output and reads nothing: for a stream with `one_way`. Nothing else may print there. Its reader may
 * take any time: the clock stands still while the pipe is full, unless `stopped` says that nobody is to wait any more. */
bool el_posix_port_open_stdout(el_posix_port *port);

/* The link as the stream sees it; it has rates if `baud` is not 0 now. `wait` returns when there is something to read
 * or room to write, after 1 ms at most. */
el_port el_posix_port_link(el_posix_port *port);

/* Closes what was opened. Standard output stays open. */
void el_posix_port_close(el_posix_port *port);

#endif
