/* The device's end of a stream: who listens, what they are owed, and what the link takes.
 *
 * Wiring: el_stream_init with a port and memory, el_stream_sink (sink.h) among the renderer's sinks, el_stream_poll in
 * idle loops. Everything runs in the caller's thread, and the link cannot hold it for ever. What waits has a patience of
 * EL_STREAM_PATIENCE_US, which time uses up and each byte that the link takes restores by EL_STREAM_BYTE_US, up to the
 * full patience; when it is at its end the frame is given up. Each frame, and each call outside of one, begins with the
 * full patience. So a frame of W bytes on the wire holds the renderer for at most
 *
 *     EL_STREAM_PATIENCE_US + W * EL_STREAM_BYTE_US
 *
 * and one call of el_port.wait; a link that takes nothing, or next to nothing, for a second, and once: frames are not
 * sent to it again before it brings a START. Input costs at most 256 bytes a poll, whatever arrives.
 *
 * In mode ROLL, which START may ask for where the queue is large enough, a frame does not wait at all: it carries what the
 * link takes at once (sink.h).
 *
 *     WAITING   no host. HELLO once a second and as the answer to PING. Frames are not looked at.
 *        | START                        ^ STOP; patience at its end; no credits and nothing heard for 1 s
 *        v                              |
 *     RUNNING   frames are sent as long as there are credits; every line of the first.
 *
 *     GONE      the port said -1. It is neither read nor written again, frames are not looked at; el_stream_init starts
 *               anew.
 *
 * A START or STOP in the middle of a frame abandons it: the packet on its way is completed, the rest is not sent, and
 * no FRAME_END follows. The second without a host's packet counts from the end of the last frame or from the last
 * packet, whichever came later: a slow link is no absent host.
 *
 * A link with rates (el_port.set_baud) is brought to another one by the host, and comes back to its first rate by itself
 * when nobody is heard (rate.c).
 *
 * With `one_way` there is no host to listen to (a pipe, a UART without RX): the session is RUNNING from the start with
 * endless credits, HELLO comes once a second between packets, and each frame has all lines, so that a reader may begin
 * anywhere. Input is not read. After a frame that was given up none is sent before the link has taken a HELLO. */
#ifndef EL_STREAM_SESSION_H
#define EL_STREAM_SESSION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/port.h"
#include "base/stats.h"
#include "stream/packet.h"
#include "stream/runs.h"
#include "stream/split.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    EL_STREAM_PATIENCE_US = 1000000, /* most of the session's time limits, and the time between two HELLO */
    EL_STREAM_SILENCE_US = 3000000,  /* without a host for so long, the link goes back to its first rate */
    EL_STREAM_BYTE_US = 2000,  /* 500 bytes/s keep a link alive: half of what 9,600 baud take, the slowest in use */
    EL_STREAM_MAX_SIZE = 2040, /* width and height, in pixels */
    EL_STREAM_MAX_NAME_BYTES = 64,
    EL_STREAM_MAX_LOG_BYTES = 200,
    EL_STREAM_BAND_HEADER_BYTES = 8,
    EL_STREAM_REFRESH_LINES = 2, /* sent with each frame, in turn, whatever they hold: a line that changed without a
                                    change of its CRC is wrong for height/2 frames at most */
    EL_STREAM_RAW = 1,           /* codecs, as START and HELLO have them */
    EL_STREAM_RUNS = 2,
    EL_STREAM_SPLIT = 4,
    EL_STREAM_PARTIAL = 256,  /* capability: unchanged lines are left out */
    EL_STREAM_INPUT = 512,    /* capability: the device takes INPUT */
    EL_STREAM_ROLL = 1024,    /* capability: it knows the mode ROLL */
    EL_STREAM_SET_BAUD = 2048 /* capability: its link has other rates */
};

/* What INPUT sets; WIRE.md has the values. A device ignores controls and values that it does not know; 1..127 are the
 * protocol's, 128..255 a program's own. */
enum {
    EL_CONTROL_SCENE = 1, /* index into the device's scenes; the scene begins at frame 0 */
    EL_CONTROL_FRAME = 2, /* number of the scene's next frame */
    EL_CONTROL_PAUSE = 3, /* 1: the scene stays at its frame, which is drawn again and again; 0: it goes on */
    EL_CONTROL_STEP = 4,  /* a scene that stands still goes on by so many frames */
    EL_CONTROL_YAW = 5,   /* of the camera, beyond the scene's own; 65536 is a turn */
    EL_CONTROL_PITCH = 6,
    EL_CONTROL_ZOOM = 7,  /* 256 is twice as near */
    EL_CONTROL_PAN_X = 8, /* in 1/256 of the camera's distance from what it looks at */
    EL_CONTROL_PAN_Y = 9,
    EL_CONTROL_SHADING = 10,
    EL_CONTROL_TEXTURE_ERROR = 11, /* within 2^-value texel; 0: what the program chose */
    EL_CONTROL_ANTIALIASING = 12,  /* samples per pixel */
    EL_CONTROL_VIEW = 13           /* a debug view; 0: the picture */
};

/* The queue to the port, in bytes; defined for all files alike where memory is scarce: 260 do, more let the port take more
 * at once, and EL_STREAM_ROLL_WIRE_BYTES of the width let the host choose ROLL. This is what 320 pixels need for that. */
#ifndef EL_STREAM_WIRE_BYTES
#define EL_STREAM_WIRE_BYTES 860
#endif

/* 0 leaves codec 2 (split.h) out, and its memory and 2.3 KB of code with it; defined for all files alike. */
#ifndef EL_STREAM_WITH_SPLIT
#define EL_STREAM_WITH_SPLIT 1
#endif

/* The largest packets before COBS: about 1 KB, since longer ones gain little and cost more when they are damaged; and one
 * line, whatever it holds. Codec 2 finds out how long a line is by encoding it: there a packet is 1 KB and one line. */
#define EL_STREAM_LINE_PACKET_BYTES(width)                                                                             \
    (EL_PACKET_OVERHEAD_BYTES + (int)EL_STREAM_BAND_HEADER_BYTES + EL_RUNS_LINE_MAX_BYTES(width))
#define EL_STREAM_RUNS_PACKET_BYTES(width)                                                                             \
    (EL_STREAM_LINE_PACKET_BYTES(width) > 1024 ? EL_STREAM_LINE_PACKET_BYTES(width) : 1024)
#define EL_STREAM_SPLIT_PACKET_BYTES(width)                                                                            \
    (EL_PACKET_OVERHEAD_BYTES + (int)EL_STREAM_BAND_HEADER_BYTES + ((int)EL_SPLIT_MAX_LINES + 7) / 8 +                 \
     EL_SPLIT_BUFFER_BYTES(width))
#if EL_STREAM_WITH_SPLIT
#define EL_STREAM_PACKET_BYTES(width) EL_STREAM_SPLIT_PACKET_BYTES(width)
#else
#define EL_STREAM_PACKET_BYTES(width) EL_STREAM_RUNS_PACKET_BYTES(width)
#endif

/* What ROLL needs of the queue: the largest packet of one line, and behind it the place that is kept for FRAME_END. Both at
 * once, because nothing that was begun may wait. The last term is what COBS costs. */
#define EL_STREAM_FRAME_END_BYTES (33 + 4 * (int)EL_STATS_COUNT)
#define EL_STREAM_RESERVE_BYTES (EL_STREAM_FRAME_END_BYTES + (int)EL_PACKET_OVERHEAD_BYTES + 4)
#define EL_STREAM_ONE_LINE_BYTES(width)                                                                                \
    (EL_PACKET_OVERHEAD_BYTES + (int)EL_STREAM_BAND_HEADER_BYTES + 1 + EL_SPLIT_LINE_MAX_BYTES(width))
#define EL_STREAM_ROLL_WIRE_BYTES(width)                                                                               \
    (EL_STREAM_ONE_LINE_BYTES(width) + EL_STREAM_RESERVE_BYTES + 5 + (EL_STREAM_ONE_LINE_BYTES(width) + 200) / 250)

/* What a packet is built in. Codec 1: its tokens, each with a literal of two bytes, which stays where it is. Codec 2: its
 * tokens and literals, which hold the former as well, and the line above. */
#define EL_STREAM_TOKEN_BYTES(width) (EL_STREAM_RUNS_PACKET_BYTES(width) / 3)
#if EL_STREAM_WITH_SPLIT
#define EL_STREAM_BUILD_BYTES(width) (2 * (size_t)(width) + (size_t)EL_SPLIT_BUFFER_BYTES(width))
#else
#define EL_STREAM_BUILD_BYTES(width) ((size_t)EL_STREAM_TOKEN_BYTES(width))
#endif

/* What `memory` must hold: a CRC and a bit per line, a packet, and 3 bytes for the alignment. 3,325 bytes at 320 x 240, or
 * 1,334 without codec 2. */
#define EL_STREAM_MEMORY_BYTES(width, height)                                                                          \
    (3 + 4 * (size_t)(height) + ((size_t)(height) + 7) / 8 + EL_STREAM_BUILD_BYTES(width))

/* What it must hold besides for `segments`: a CRC per segment instead. 3,840 bytes at 320 x 240. */
#define EL_STREAM_SEGMENT_MEMORY_BYTES(width, height)                                                                  \
    (4 * (size_t)(height) * (((size_t)(width)-1) / (size_t)EL_SPLIT_SEGMENT_PIXELS))

/* Errors of el_stream_init and el_stream_log. */
enum {
    EL_STREAM_BAD_SIZE = -1,   /* width or height outside 1..EL_STREAM_MAX_SIZE */
    EL_STREAM_BAD_MEMORY = -2, /* memory is NULL or smaller than the macros above say */
    EL_STREAM_BAD_PORT = -3,   /* port is NULL or lacks write, read (unless one_way) or micros */
    EL_STREAM_BAD_NAME = -4,   /* a name is NULL or longer than EL_STREAM_MAX_NAME_BYTES */
    EL_STREAM_LINK_GONE = -5
};

typedef struct el_stream_config {
    const el_port *port;  /* outlives the stream */
    uint16_t width;       /* pixels, 1..EL_STREAM_MAX_SIZE; the renderer's */
    uint16_t height;      /* lines, likewise */
    const char *target;   /* what it runs on, UTF-8; outlives the stream */
    const char *firmware; /* name and version, likewise */
    uint32_t boot_id;     /* another one after each start */
    uint32_t baud;        /* rate of the link at its start, 0 when it has none */
    uint32_t max_baud;    /* its highest, 0 when it has none */
    bool one_way;         /* see above */
    /* What the host sets, as it arrives: within el_stream_poll, the sink's functions and whatever else waits for the
     * link, in the middle of a frame too. To be noted for the next frame; may not call the stream or the renderer.
     * NULL: the device takes no INPUT. */
    void (*input)(void *context, uint8_t control, int32_t value);
    void *input_context;
    uint8_t scenes;    /* that SCENE can choose among; 0: not told. These three are for HELLO alone */
    uint32_t controls; /* bit c: control c is known, 0..31 */
    uint16_t views;    /* bit v: VIEW takes the value v */
    /* Leave out what has not changed in units of 64 pixels, not of lines, towards hosts that know codec 2. Takes
     * EL_STREAM_SEGMENT_MEMORY_BYTES more; of no use without codec 2. */
    bool segments;
    void *memory; /* the stream's as long as it is used; any alignment */
    size_t memory_bytes;
} el_stream_config;

enum { EL_STREAM_WAITING, EL_STREAM_RUNNING, EL_STREAM_GONE };

/* The frame that is being drawn. */
typedef struct el_stream_frame {
    bool sending;
    bool alone;        /* the host asked for lines: each packet does without what the host may not have */
    bool full;         /* ROLL: the link took no more; the rest is left out, from `stop` on */
    bool mixed;        /* ROLL, or interlaced: a line is not what the host will have */
    uint8_t refreshed; /* bit i: line `refresh` + i has been sent */
    uint8_t input;     /* the INPUT that was taken last before it began */
    uint16_t number;   /* frames begun before it, modulo 65536 */
    uint16_t bands;    /* BAND packets sent */
    uint16_t stop;     /* see `full` */
#if EL_WITH_INTERLACED
    uint16_t next_line; /* interlaced: the one after the last that `digest` has; 0 in other frames */
#endif
    uint32_t begin_us;      /* when it began */
    uint32_t encode_us;     /* spent in the sink, waiting for the link included */
    uint32_t begin_cycles;  /* the same in cycles */
    uint32_t encode_cycles; /* the same */
    uint32_t wire_bytes;    /* of its bands */
    uint32_t digest;        /* of the lines so far */
} el_stream_frame;

/* The lines of a packet of codec 0 or 1 that is being built, all of the band that is being drawn. */
typedef struct el_stream_group {
    const uint16_t *pixels; /* of the first line; the others follow */
    uint32_t lines;         /* 0: none */
    uint32_t tokens;
    uint32_t literals;
} el_stream_group;

/* The link's rate. */
typedef struct el_stream_rate {
    uint32_t now;    /* 0: it has none */
    uint32_t next;   /* what it will be when `changing` is at its end */
    bool answer_due; /* BAUD, at the next chance between two packets */
    bool changing;   /* nothing is sent before the last bit of what was is out */
    bool proven;     /* a packet came at this rate */
} el_stream_rate;

/* One session. The caller owns it and gives it to the functions below; state, credits, rate.now, stalls, damaged and
 * missed may be read. */
typedef struct el_stream {
    el_stream_config config;
    el_packet_writer writer;
    el_packet_reader reader;
    uint8_t wire[EL_STREAM_WIRE_BYTES];

    uint32_t *crcs;     /* [height] times a line's segments, each as it was sent last */
    uint8_t *lines_due; /* a bit per line: send it whatever it holds */
    uint8_t *tokens;    /* of the codec 1 band that is being encoded */
    el_stream_group group;
#if EL_STREAM_WITH_SPLIT
    el_split split; /* the codec 2 band that is being encoded */
#endif
    uint16_t *last_line; /* of the band before, once it is no longer there; NULL without codec 2 */
    uint16_t band_y;     /* the first line of the packet that is being built */
    uint16_t segment;    /* pixels that a CRC in `crcs` covers; a line's last may cover fewer */

    uint8_t state;
    uint8_t credits;      /* frames that may be sent */
    uint8_t next_seq;     /* expected from the host */
    uint8_t input_number; /* of the INPUT that was taken last */
    uint8_t host_major;   /* of the host's wire, as far as it is known */
    bool hello_due;       /* at the next chance between two packets */
    bool refusal_due;     /* LOG that names host_major, likewise */
    bool input_came;      /* since the sink's last `begin` was called */
    bool asked;           /* START or KEY came since the last frame that was sent began */
    bool stalled;         /* a one-way link that has not taken a HELLO since its last frame was given up */
    bool rolling;         /* mode ROLL */
    uint16_t codecs;      /* EL_STREAM_RAW, _RUNS, _SPLIT: what the host decodes */
    uint16_t dropped;     /* frames not sent since the last one that was, or since START; stops at 65535 */
    uint16_t refresh;     /* the next line of EL_STREAM_REFRESH_LINES */
    uint16_t cursor;      /* ROLL: the line that the next frame begins with */
    const char *notice;   /* to be sent as LOG, between two packets */
    uint32_t period_us;   /* between two frames, at least */
    uint32_t frame_us;    /* when the last frame was due */
    uint32_t hello_us;    /* when the last HELLO was due */
    uint32_t heard_us;    /* the last sign of the host, or the last frame's end */
    uint32_t patience_us; /* left for the frame under way, or the call */
    uint32_t stalls;      /* times that patience was at its end */
    uint32_t damaged;     /* chunks of input that were no packets */
    uint32_t missed;      /* packets of the host that never came, by their seq */
    el_stream_rate rate;
    el_stream_frame frame;
} el_stream;

/* Starts a session. Returns 0 or an error; then the stream is unusable. Nothing is sent before el_stream_poll or the
 * first frame. */
int el_stream_init(el_stream *stream, const el_stream_config *config);

/* Reads what the host sent, sends what waits and HELLO when it is time; never waits. Call it often, between frames and
 * when idle; the sink calls it at both ends of a frame. Returns 0, or EL_STREAM_LINK_GONE. */
int el_stream_poll(el_stream *stream);

/* True when a frame that began now would be sent. */
bool el_stream_ready(const el_stream *stream);

/* Sends UTF-8 text for the host's log, cut to EL_STREAM_MAX_LOG_BYTES at a character's beginning. Returns the bytes
 * sent: 0 when there is no room and no host listens or the mode is ROLL, when the link stalled or changes its rate; or
 * EL_STREAM_LINK_GONE. Waits for the link in mode BLOCK alone. Not within the functions of a sink or a port. */
int32_t el_stream_log(el_stream *stream, const char *text, size_t count);

/* Waits until the port has taken everything. False when it did not: the session is over then (see above). */
bool el_stream_flush(el_stream *stream);

#ifdef __cplusplus
}
#endif

#endif
