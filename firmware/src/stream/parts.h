/* What the files of a session give each other; programs have session.h and sink.h.
 *
 *     session.c   the host's packets, who is there, the public door        rate.c    the link's rate
 *     output.c    the queue, waiting for the link, HELLO and LOG           bands.c   BAND packets of lines
 *     sink.c      frames: which lines, FRAME_END                           changes.c which segments of a line */
#ifndef EL_STREAM_PARTS_H
#define EL_STREAM_PARTS_H

#include "stream/session.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    EL_STREAM_PROTOCOL_MAJOR = 1,
    EL_STREAM_PROTOCOL_MINOR = 2,
    EL_STREAM_OLD_CODECS = EL_STREAM_RAW | EL_STREAM_RUNS, /* what every host knows */
    EL_STREAM_CODECS = EL_STREAM_OLD_CODECS | (EL_STREAM_WITH_SPLIT ? EL_STREAM_SPLIT : 0)
};

static inline uint32_t el_stream_now_us(const el_stream *stream)
{
    return stream->config.port->micros(stream->config.port->context);
}

/* --- session.c ---------------------------------------------------------------------------------------------------- */

/* Reads what the host sent, 256 bytes at most. */
void el_stream_receive(el_stream *stream);

/* Ends the session: the host is gone or has not come yet. */
void el_stream_wait_for_start(el_stream *stream);

/* Makes lines y0..y1-1 due; y0 <= y1 <= height. */
void el_stream_make_due(el_stream *stream, uint32_t y0, uint32_t y1);

/* True where the queue holds what ROLL needs. */
bool el_stream_knows_roll(const el_stream *stream);

/* --- output.c ----------------------------------------------------------------------------------------------------- */

/* For el_packet_writer_init. */
bool el_stream_drain(void *stream);

/* The port said -1: it is not called again. */
void el_stream_lose_link(el_stream *stream);

/* Sends what the port takes now. False when the link is gone. */
bool el_stream_push(el_stream *stream);

/* Bytes of whole packets that the port has not taken. */
size_t el_stream_unsent(const el_stream *stream);

/* True if a packet with this many bytes of body goes into the queue now, FRAME_END's place apart while a frame in ROLL
 * is under way. */
bool el_stream_fits(const el_stream *stream, size_t body_bytes);

/* Sends what waits for a chance between two packets and fits without waiting. */
void el_stream_send_pending(el_stream *stream);

/* --- rate.c ------------------------------------------------------------------------------------------------------- */

bool el_stream_has_rates(const el_stream *stream);

/* SET_BAUD: prepares the answer and, where the link can have that rate, the change. */
void el_stream_take_rate(el_stream *stream, uint32_t rate);

/* The change, once the last bit is out; and back to the first rate when nobody is heard. */
void el_stream_poll_rate(el_stream *stream);

/* --- bands.c ------------------------------------------------------------------------------------------------------ */

/* A line that the host is to have. */
typedef struct el_stream_line {
    const uint16_t *pixels;
    const uint16_t *above; /* the line above as the host will have it, or NULL */
    uint32_t y;
    uint32_t changed; /* a bit for each segment that is to be sent, one at least */
} el_stream_line;

/* Forgets what is being built. */
void el_stream_begin_bands(el_stream *stream);

/* Adds a line, of a frame whose lines come in ascending order, to the packet that is being built; sends that first where the
 * line does not go into it. In mode ROLL: false if the link does not take the line, which is then left out. */
bool el_stream_add_line(el_stream *stream, const el_stream_line *line);

/* The pixels of the lines so far are needed by others: sends what holds on to them. */
void el_stream_release_lines(el_stream *stream);

/* Sends what is being built. */
void el_stream_end_bands(el_stream *stream);

#ifdef __cplusplus
}
#endif

#endif
