/* From bands of pixels to BAND packets.
 *
 * Codecs 0 and 1: lines are collected in a group as long as they follow each other and fit into one packet; only their
 * tokens are kept. A group never outlives its band: after `rows` its pixels are no longer there. Codec 2 keeps what it
 * needs of them, so its packets are the same whatever the bands are. */
#include "stream/sink.h"

#include <string.h>

#include "base/crc32.h"
#include "stream/changes.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "pixels and CRCs go to the wire as they lie in memory");

enum { MAX_GROUP_LINES = 255, CODEC_RAW = 0, CODEC_RUNS = 1, CODEC_SPLIT = 2, LAGS = 8, JOINED = 16 };

typedef struct group {
    const uint16_t *pixels; /* of the first line; the others follow */
    uint32_t y;
    uint32_t lines;
    uint32_t tokens;
    uint32_t literals;
} group;

static uint32_t now_us(const el_stream *stream)
{
    return stream->config.port->micros(stream->config.port->context);
}

static bool take_due(el_stream *stream, uint32_t y)
{
    uint8_t bit = (uint8_t)(1U << y % 8);
    bool due = (stream->lines_due[y / 8] & bit) != 0;
    stream->lines_due[y / 8] = (uint8_t)(stream->lines_due[y / 8] & ~bit);
    return due;
}

/* The segments that the host does not have, a bit each; and the line's part of the digest. The line stops being due before
 * it is sent: a KEY that arrives meanwhile stays. */
static uint32_t find_changes(el_stream *stream, const uint16_t *pixels, uint32_t y)
{
    const uint32_t width = stream->config.width;
    const uint32_t segments = (width - 1) / stream->segment + 1;
    uint32_t line_crc;
    uint32_t changed = el_changes_find(pixels, width, stream->segment, stream->crcs + y * segments, &line_crc);

    stream->frame.digest = el_crc32(stream->frame.digest, &line_crc, sizeof line_crc);
    if (take_due(stream, y) || (changed != 0 && segments == 1)) {
        changed = UINT32_MAX;
    }
    return changed;
}

static void make_refresh_due(el_stream *stream)
{
    for (int i = 0; i < EL_STREAM_REFRESH_LINES; i++) {
        el_stream_make_due(stream, stream->refresh, stream->refresh + 1U);
        stream->refresh = (uint16_t)((stream->refresh + 1U) % stream->config.height);
    }
}

static void begin(void *context, uint16_t width, uint16_t height)
{
    el_stream *stream = context;
    el_stream_frame *frame = &stream->frame;

    stream->input_came = false;
    el_stream_poll(stream);
    uint32_t now = now_us(stream);
    *frame = (el_stream_frame){.number = frame->number, .begin_us = now};
    if (!el_stream_ready(stream) || stream->input_came) { /* this frame was chosen before the input came */
        return;
    }
    if (width != stream->config.width || height != stream->config.height) {
        stream->notice = "the renderer's frames are not of the size that this stream has";
        return;
    }
    frame->sending = true;
    frame->alone = stream->asked;
    stream->asked = false;
#if EL_STREAM_WITH_SPLIT
    el_split_begin(&stream->split); /* a frame that ended early may have left something */
#endif
    stream->patience_us = EL_STREAM_PATIENCE_US;
    if (stream->config.one_way) {
        el_stream_make_due(stream, 0, height);
    } else {
        stream->credits--;
        make_refresh_due(stream);
    }
    /* A frame that is a little late does not delay the next one; after a pause the rhythm starts afresh. */
    bool late = now - stream->frame_us >= 2 * stream->period_us;
    stream->frame_us = late ? now : stream->frame_us + stream->period_us;
}

static void begin_band(el_stream *stream, uint32_t y, uint32_t lines, uint32_t codec, uint32_t tokens)
{
    el_packet_writer *writer = &stream->writer;

    el_packet_begin(writer, EL_PACKET_BAND);
    el_packet_put_u16(writer, stream->frame.number);
    el_packet_put_u16(writer, (uint16_t)y);
    el_packet_put_u8(writer, (uint8_t)lines);
    el_packet_put_u8(writer, (uint8_t)codec);
    el_packet_put_u16(writer, (uint16_t)tokens);
}

static void end_band(el_stream *stream)
{
    int32_t wire_bytes = el_packet_end(&stream->writer);
    if (wire_bytes > 0) {
        stream->frame.bands++;
        stream->frame.wire_bytes += (uint32_t)wire_bytes;
        el_stream_push(stream);
    }
}

/* --- Codec 2 ------------------------------------------------------------------------------------------------------ */

#if EL_STREAM_WITH_SPLIT

static bool uses_split(const el_stream *stream)
{
    return (stream->codecs & EL_STREAM_SPLIT) != 0;
}

static void send_split(el_stream *stream)
{
    el_packet_writer *writer = &stream->writer;
    const el_split *split = &stream->split;
    uint32_t flags = (split->lagging ? (uint32_t)LAGS : 0U) | (split->joined ? (uint32_t)JOINED : 0U);

    if (split->lines > 0) {
        begin_band(stream, stream->split_y, split->lines, CODEC_SPLIT | flags, split->token_count);
        if (split->lagging) {
            el_packet_put(writer, split->lags, (split->lines + 7) / 8);
        }
        el_packet_put(writer, split->tokens, split->token_count);
        el_packet_put(writer, split->literals, 2 * (size_t)split->literal_count);
        end_band(stream);
        el_split_begin(&stream->split);
    }
}

/* `above` is NULL at the top of the picture. */
static void add_split_line(el_stream *stream, const uint16_t *pixels, const uint16_t *above, uint32_t y,
                           uint32_t changed)
{
    el_split *split = &stream->split;

    if (split->lines > 0) {
        uint32_t gap = y - stream->split_y - split->lines;
        if (gap > EL_SPLIT_MAX_GAP || el_split_is_full(split)) {
            send_split(stream);
        } else {
            el_split_add_gap(split, gap);
        }
    }
    if (split->lines == 0) {
        stream->split_y = (uint16_t)y;
        above = stream->frame.alone ? NULL : above;
    }
    el_split_add(split, pixels, above, changed);
}

static void send_split_lines(el_stream *stream, const el_band *band)
{
    const uint16_t *above = band->y > 0 ? stream->last_line : NULL;

    for (uint32_t line = 0; line < band->lines && stream->frame.sending; line++) {
        const uint16_t *pixels = band->pixels + (size_t)line * band->width;
        uint32_t changed = find_changes(stream, pixels, (uint32_t)band->y + line);
        if (changed != 0) {
            add_split_line(stream, pixels, above, (uint32_t)band->y + line, changed);
        }
        above = pixels;
    }
    if (above != NULL) {
        memcpy(stream->last_line, above, 2 * (size_t)band->width);
    }
}

#else

static bool uses_split(const el_stream *stream)
{
    (void)stream;
    return false;
}

static void send_split(el_stream *stream)
{
    (void)stream;
}

static void send_split_lines(el_stream *stream, const el_band *band)
{
    (void)stream;
    (void)band;
}

#endif

/* --- Codecs 0 and 1 ----------------------------------------------------------------------------------------------- */

static void send_group(el_stream *stream, group *part)
{
    el_packet_writer *writer = &stream->writer;
    uint32_t pixels = part->lines * stream->config.width;
    bool raw = stream->codecs == EL_STREAM_RAW ||
               ((stream->codecs & EL_STREAM_RAW) != 0 && part->tokens + 2 * part->literals >= 2 * pixels);

    begin_band(stream, part->y, part->lines, raw ? CODEC_RAW : CODEC_RUNS, raw ? 0 : part->tokens);
    if (raw) {
        el_packet_put(writer, part->pixels, 2 * (size_t)pixels);
    } else {
        const uint16_t *from = part->pixels;
        el_packet_put(writer, stream->tokens, part->tokens);
        for (uint32_t i = 0; i < part->tokens; i++) {
            el_packet_put(writer, from, 2 * (size_t)el_runs_literals(stream->tokens[i]));
            from += el_runs_pixels(stream->tokens[i]);
        }
    }
    part->lines = 0;
    end_band(stream);
}

/* Adds a line to the group. False when it does not fit; an empty group takes any line. */
static bool add_line(el_stream *stream, group *part, const uint16_t *pixels, uint32_t y)
{
    uint32_t width = stream->config.width;
    size_t budget = EL_STREAM_RUNS_PACKET_BYTES(width) - EL_PACKET_OVERHEAD_BYTES - EL_STREAM_BAND_HEADER_BYTES;
    int32_t tokens = 0;
    uint32_t literals = width;

    if (part->lines == 0) {
        *part = (group){.pixels = pixels, .y = y};
    } else if (part->lines == MAX_GROUP_LINES) {
        return false;
    }
    budget -= part->tokens + 2 * (size_t)part->literals;
    if (stream->codecs == EL_STREAM_RAW) {
        tokens = 2 * (size_t)width <= budget ? 0 : EL_RUNS_TOO_LONG;
    } else {
        tokens = el_runs_encode(pixels, width, budget, stream->tokens + part->tokens, &literals);
    }
    if (tokens < 0) {
        return false;
    }
    part->lines++;
    part->tokens += (uint32_t)tokens;
    part->literals += literals;
    return true;
}

static void send_group_lines(el_stream *stream, const el_band *band)
{
    group part = {.lines = 0};

    for (uint32_t line = 0; line < band->lines && stream->frame.sending; line++) {
        const uint16_t *pixels = band->pixels + (size_t)line * band->width;
        uint32_t y = (uint32_t)band->y + line;

        if (find_changes(stream, pixels, y) != 0) {
            if (!add_line(stream, &part, pixels, y)) {
                send_group(stream, &part);
                add_line(stream, &part, pixels, y);
            }
        } else if (part.lines > 0) {
            send_group(stream, &part);
        }
    }
    if (part.lines > 0 && stream->frame.sending) {
        send_group(stream, &part);
    }
}

static void rows(void *context, el_band *band, unsigned slot)
{
    el_stream *stream = context;

    if (stream->frame.sending) {
        uint32_t begin_us = now_us(stream);
        if (uses_split(stream)) {
            send_split_lines(stream, band);
        } else {
            send_group_lines(stream, band);
        }
        stream->frame.encode_us += now_us(stream) - begin_us;
    }
    el_band_release(band, slot);
}

static void send_frame_end(el_stream *stream, const el_stats *stats)
{
    el_packet_writer *writer = &stream->writer;
    const el_stream_frame *frame = &stream->frame;

    el_packet_begin(writer, EL_PACKET_FRAME_END);
    el_packet_put_u16(writer, frame->number);
    el_packet_put_u16(writer, frame->bands);
    el_packet_put_u32(writer, frame->begin_us);
    el_packet_put_u32(writer, now_us(stream) - frame->begin_us - frame->encode_us);
    el_packet_put_u32(writer, frame->encode_us);
    el_packet_put_u32(writer, frame->wire_bytes);
    el_packet_put_u16(writer, stream->dropped);
    el_packet_put_u16(writer, 0);
    el_packet_put_u32(writer, frame->digest);
    el_packet_put_u8(writer, EL_STATS_COUNT);
    el_packet_put(writer, stats, sizeof *stats);
    if (el_packet_end(writer) > 0 && frame->sending) {
        el_stream_flush(stream);
    }
}

static void end(void *context, const el_stats *stats)
{
    el_stream *stream = context;

    if (stream->frame.sending) {
        uint32_t begin_us = now_us(stream);
        send_split(stream);
        stream->frame.encode_us += now_us(stream) - begin_us;
    }
    if (stream->frame.sending) {
        send_frame_end(stream, stats);
    }
    if (stream->frame.sending) {
        stream->dropped = 0;
        stream->heard_us = now_us(stream);
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
    return (el_sink){.context = stream, .begin = begin, .rows = rows, .end = end, .wait = wait};
}
