/* Frames into the stream: which of them, which of their lines, and what is said at their end. */
#include "stream/sink.h"

#include <string.h>

#include "base/crc32.h"
#include "base/options.h"
#include "stream/changes.h"
#include "stream/parts.h"

enum {
    MOST_SEGMENTS = EL_STREAM_WITH_SPLIT ? (EL_STREAM_MAX_SIZE - 1) / EL_SPLIT_SEGMENT_PIXELS + 1 : 1, /* of a line */
    FLAG_MIXED = 1,
    FLAG_OWING = 2
};

static uint32_t now_cycles(const el_stream *stream)
{
    const el_port *port = stream->config.port;
    return port->cycles != NULL ? port->cycles(port->context) : 0;
}

/* --- Begin -------------------------------------------------------------------------------------------------------- */

static void begin(void *context, uint16_t width, uint16_t height)
{
    el_stream *stream = context;
    el_stream_frame *frame = &stream->frame;

    stream->input_came = false;
    el_stream_poll(stream);
    *frame = (el_stream_frame){.number = frame->number,
                               .input = stream->input_number,
                               .begin_us = el_stream_now_us(stream),
                               .begin_cycles = now_cycles(stream)};
    if (!el_stream_ready(stream) || stream->input_came) { /* this frame was chosen before the input came */
        return;
    }
    if (width != stream->config.width || height != stream->config.height) {
        stream->notice = "the renderer's frames are not of the size that this stream has";
        return;
    }
    if (stream->rolling && !el_packet_fits(&stream->writer, EL_STREAM_FRAME_END_BYTES)) {
        return;
    }
    frame->sending = true;
    frame->alone = stream->asked;
    stream->asked = false;
    el_stream_begin_bands(stream); /* a frame that ended early may have left something */
    stream->patience_us = EL_STREAM_PATIENCE_US;
    if (stream->config.one_way) {
        el_stream_make_due(stream, 0, height);
    }
}

/* --- Lines -------------------------------------------------------------------------------------------------------- */

static bool is_due(const el_stream *stream, uint32_t y)
{
    return ((uint32_t)stream->lines_due[y / 8] >> y % 8 & 1U) != 0;
}

/* How far the line is behind the one that is to be refreshed next. */
static uint32_t refresh_turn(const el_stream *stream, uint32_t y)
{
    return y >= stream->refresh ? y - stream->refresh : y + stream->config.height - stream->refresh;
}

/* Sends a line if it is to be sent and goes; true when the host will have it as it is. */
static bool keep_up(el_stream *stream, el_stream_line *line)
{
    el_stream_frame *frame = &stream->frame;
    const bool due = is_due(stream, line->y);
    const uint32_t turn = refresh_turn(stream, line->y);
    const bool whole = due || turn < EL_STREAM_REFRESH_LINES;

    if (line->changed == 0 && !whole) {
        return true;
    }
    if (stream->segment >= stream->config.width || whole) {
        line->changed = UINT32_MAX;
    }
    /* It stops being due before it is sent: a KEY that arrives meanwhile stays. */
    stream->lines_due[line->y / 8] = (uint8_t)(stream->lines_due[line->y / 8] & ~(1U << line->y % 8));
    if (!el_stream_add_line(stream, line)) {
        frame->full = true;
        frame->stop = (uint16_t)line->y;
        el_stream_make_due(stream, line->y, line->y + due);
        return false;
    }
    if (turn < EL_STREAM_REFRESH_LINES) {
        frame->refreshed = (uint8_t)(frame->refreshed | 1U << turn);
    }
    return true;
}

/* A line that is left out in mode ROLL, above the cursor or behind the first that did not go, keeps the CRCs of what was
 * sent of it last. Whether it is as it was has to be found out until one is not. */
static void take_line(el_stream *stream, const uint16_t *pixels, const uint16_t *above, uint32_t y)
{
    const uint32_t width = stream->config.width;
    const uint32_t segments = (width - 1) / stream->segment + 1;
    uint32_t *const sent = stream->crcs + y * segments;
    uint32_t fresh[MOST_SEGMENTS];
    el_stream_frame *frame = &stream->frame;
    const bool in_turn = y >= stream->cursor && !frame->full;

    if (in_turn || !frame->mixed) {
        el_stream_line line = {.pixels = pixels, .above = y > stream->cursor ? above : NULL, .y = y};
        line.changed = el_changes_find(pixels, width, stream->segment, sent, fresh);
        const bool as_it_was = line.changed == 0;
        if (in_turn && keep_up(stream, &line)) {
            memcpy(sent, fresh, segments * sizeof fresh[0]);
        } else if (!as_it_was) {
            frame->mixed = true;
        }
    }
    frame->digest = el_changes_digest(frame->digest, el_changes_line_crc(sent, width, stream->segment));
}

#if EL_WITH_INTERLACED
/* Of an interlaced frame, lines up to `end` that it leaves as they are: what was sent of them last. */
static void keep_lines(el_stream *stream, uint32_t end)
{
    const uint32_t width = stream->config.width;
    const uint32_t segments = (width - 1) / stream->segment + 1;
    el_stream_frame *const frame = &stream->frame;

    for (; frame->next_line < end; frame->next_line++) {
        const uint32_t *const sent = stream->crcs + frame->next_line * segments;
        frame->digest = el_changes_digest(frame->digest, el_changes_line_crc(sent, width, stream->segment));
    }
}

/* Lines with gaps: each goes in a packet of its own, since what is above it is not at hand. */
static void take_field(el_stream *stream, const el_band *band)
{
    stream->frame.mixed = true;
    for (uint32_t line = 0; line < band->lines && stream->frame.sending; line++) {
        const uint32_t y = band->y + line * (1U + el_band_gap(band));
        keep_lines(stream, y);
        take_line(stream, band->pixels + (size_t)line * band->width, NULL, y);
        stream->frame.next_line = (uint16_t)(y + 1U);
        el_stream_end_bands(stream);
    }
}
#endif

static void take_lines(el_stream *stream, const el_band *band)
{
    const uint16_t *above = stream->last_line;

    for (uint32_t line = 0; line < band->lines && stream->frame.sending; line++) {
        const uint16_t *pixels = band->pixels + (size_t)line * band->width;
        take_line(stream, pixels, above, (uint32_t)band->y + line);
        above = pixels;
    }
    if (stream->frame.sending) {
        el_stream_release_lines(stream);
    }
    if ((stream->codecs & EL_STREAM_SPLIT) != 0 && above != stream->last_line) {
        memcpy(stream->last_line, above, 2 * (size_t)band->width);
    }
}

static void rows(void *context, el_band *band, unsigned slot)
{
    el_stream *stream = context;

    if (stream->frame.sending) {
        const uint32_t begin_us = el_stream_now_us(stream);
        const uint32_t begin_cycles = now_cycles(stream);
#if EL_WITH_INTERLACED
        if (band->gap != 0) {
            take_field(stream, band);
        } else
#endif
        {
            take_lines(stream, band);
        }
        stream->frame.encode_us += el_stream_now_us(stream) - begin_us;
        stream->frame.encode_cycles += now_cycles(stream) - begin_cycles;
    } else if (stream->rate.changing) { /* the host waits for it, and a frame may take long */
        el_stream_poll(stream);
    }
    el_band_release(band, slot);
}

/* A frame that is not sent needs no lines: the next one that is has its lines compared with what was sent. */
static bool unchanged(void *context, uint16_t y, uint16_t lines)
{
    el_stream *stream = context;
    (void)y;
    (void)lines;
    if (stream->rate.changing) {
        el_stream_poll(stream);
    }
    return !stream->frame.sending;
}

/* --- End ---------------------------------------------------------------------------------------------------------- */

/* Lines that START or KEY asked for and that are still to be sent. */
static bool is_owing(const el_stream *stream)
{
    for (uint32_t y = 0; y < stream->config.height; y += 8) {
        if (stream->lines_due[y / 8] != 0) {
            return true;
        }
    }
    return false;
}

static void send_frame_end(el_stream *stream, const el_stats *stats)
{
    el_packet_writer *writer = &stream->writer;
    const el_stream_frame *frame = &stream->frame;
    const uint32_t cycles = now_cycles(stream) - frame->begin_cycles - frame->encode_cycles;

    el_packet_begin(writer, EL_PACKET_FRAME_END);
    el_packet_put_u16(writer, frame->number);
    el_packet_put_u16(writer, frame->bands);
    el_packet_put_u32(writer, frame->begin_us);
    el_packet_put_u32(writer, el_stream_now_us(stream) - frame->begin_us - frame->encode_us);
    el_packet_put_u32(writer, frame->encode_us);
    el_packet_put_u32(writer, frame->wire_bytes);
    el_packet_put_u16(writer, stream->dropped);
    el_packet_put_u8(writer, frame->input);
    el_packet_put_u8(writer, (uint8_t)((frame->mixed ? FLAG_MIXED : 0) | (is_owing(stream) ? FLAG_OWING : 0)));
    el_packet_put_u32(writer, frame->digest);
    el_packet_put_u8(writer, EL_STATS_COUNT);
    el_packet_put(writer, stats, sizeof *stats);
    el_packet_put_u32(writer, cycles);
    if (el_packet_end(writer) > 0 && frame->sending) {
        if (stream->rolling) {
            el_stream_push(stream);
        } else {
            el_stream_flush(stream);
        }
    }
}

/* Sends what is left of the frame. False when it is not sent after all. */
static bool finish(el_stream *stream, const el_stats *stats)
{
    el_stream_frame *frame = &stream->frame;

    if (frame->sending) {
        const uint32_t begin_us = el_stream_now_us(stream);
        const uint32_t begin_cycles = now_cycles(stream);
#if EL_WITH_INTERLACED
        if (frame->next_line > 0) {
            keep_lines(stream, stream->config.height);
        }
#endif
        el_stream_end_bands(stream);
        frame->encode_us += el_stream_now_us(stream) - begin_us;
        frame->encode_cycles += now_cycles(stream) - begin_cycles;
    }
    if (frame->sending && !(frame->full && frame->bands == 0)) {
        send_frame_end(stream, stats);
        return frame->sending;
    }
    return false;
}

/* What the next frame has to know of this one, which was sent. */
static void account(el_stream *stream)
{
    const el_stream_frame *frame = &stream->frame;

    stream->dropped = 0;
    stream->heard_us = el_stream_now_us(stream);
    if (!stream->config.one_way) {
        stream->credits--;
    }
    /* A frame that is a little late does not delay the next one; after a pause the rhythm starts afresh. */
    const bool late = frame->begin_us - stream->frame_us >= 2 * stream->period_us;
    stream->frame_us = late ? frame->begin_us : stream->frame_us + stream->period_us;
    /* One in turn whose neighbour was not is refreshed once more. */
    for (uint32_t turns = frame->refreshed; (turns & 1U) != 0; turns >>= 1) {
        stream->refresh = (uint16_t)((stream->refresh + 1U) % stream->config.height);
    }
    stream->cursor = frame->full ? frame->stop : 0;
}

static void end(void *context, const el_stats *stats)
{
    el_stream *stream = context;

    if (finish(stream, stats)) {
        account(stream);
    } else if (stream->dropped < UINT16_MAX) {
        stream->dropped++;
    }
    stream->frame.sending = false;
    stream->frame.number++;
    el_stream_poll(stream);
}

/* The renderer waits for another sink's band: a chance for the link. */
static void wait(void *context)
{
    el_stream *stream = context;
    el_stream_poll(stream);
}

el_sink el_stream_sink(el_stream *stream)
{
    return (el_sink)
    {
        .context = stream, .begin = begin, .rows = rows, .unchanged = EL_WITH_REUSE ? unchanged : NULL, .end = end,
#if EL_WITH_INTERLACED
        .takes_gaps = !stream->config.one_way, /* one way, every frame has all lines */
#endif
            .wait = wait
    };
}
