/* BAND packets, built from lines that follow each other.
 *
 * Codecs 0 and 1: lines are collected in a group as long as they follow each other and fit into one packet; only their
 * tokens are kept. A group never outlives its band: after that its pixels are no longer there. Codec 2 keeps what it needs
 * of them, so its packets are the same whatever the bands are.
 *
 * How long a line is, is known when it is encoded. So in mode ROLL a line is added first, and where the packet is longer
 * then than what the link takes, the packet goes without it. */
#include <string.h>

#include "stream/parts.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "pixels go to the wire as they lie in memory");
_Static_assert((int)EL_STREAM_RESERVE_BYTES - 2 - (int)EL_STREAM_RESERVE_BYTES / 254 >=
                   (int)EL_STREAM_FRAME_END_BYTES + (int)EL_PACKET_OVERHEAD_BYTES,
               "FRAME_END fits into what is kept for it");

enum { MAX_GROUP_LINES = 255, CODEC_RAW = 0, CODEC_RUNS = 1, CODEC_SPLIT = 2, LAGS = 8, JOINED = 16 };

/* The packet's first lines: how many, and their tokens and literals. */
typedef struct extent {
    uint32_t lines;
    uint32_t tokens;
    uint32_t literals;
} extent;

static void begin_band(el_stream *stream, uint32_t lines, uint32_t codec, uint32_t tokens)
{
    el_packet_writer *writer = &stream->writer;

    el_packet_begin(writer, EL_PACKET_BAND);
    el_packet_put_u16(writer, stream->frame.number);
    el_packet_put_u16(writer, stream->band_y);
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

static extent split_extent(const el_stream *stream)
{
    const el_split *split = &stream->split;
    return (extent){split->lines, split->token_count, split->literal_count};
}

static uint32_t lag_bytes(const el_split *split, uint32_t lines)
{
    return split->lagging ? (lines + 7) / 8 : 0;
}

static size_t split_bytes(const el_stream *stream)
{
    const el_split *split = &stream->split;
    return lag_bytes(split, split->lines) + split->token_count + 2 * (size_t)split->literal_count;
}

/* What is behind these lines is forgotten. */
static void send_split(el_stream *stream, extent part)
{
    el_packet_writer *writer = &stream->writer;
    el_split *split = &stream->split;
    uint32_t flags = (split->lagging ? (uint32_t)LAGS : 0U) | (split->joined ? (uint32_t)JOINED : 0U);
    uint32_t lags = lag_bytes(split, part.lines);

    begin_band(stream, part.lines, CODEC_SPLIT | flags, part.tokens);
    if (lags > 0 && part.lines % 8 != 0) {
        split->lags[lags - 1] = (uint8_t)(split->lags[lags - 1] & ((1U << part.lines % 8) - 1U));
    }
    el_packet_put(writer, split->lags, lags);
    el_packet_put(writer, split->tokens, part.tokens);
    el_packet_put(writer, split->literals + (split->literal_count - part.literals), 2 * (size_t)part.literals);
    end_band(stream);
    el_split_begin(split);
}

/* False where the packet has no room for the line; an empty one has. */
static bool append_to_split(el_stream *stream, const el_stream_line *line)
{
    el_split *split = &stream->split;
    const uint16_t *above = line->above;

    if (split->lines > 0) {
        uint32_t gap = line->y - stream->band_y - split->lines;
        if (gap > EL_SPLIT_MAX_GAP || el_split_is_full(split)) {
            return false;
        }
        el_split_add_gap(split, gap);
    } else {
        stream->band_y = (uint16_t)line->y;
        above = stream->frame.alone ? NULL : above;
    }
    el_split_add(split, line->pixels, above, line->changed);
    return true;
}

static void forget_split(el_stream *stream)
{
    el_split_begin(&stream->split);
}

#else

static bool uses_split(const el_stream *stream)
{
    (void)stream;
    return false;
}

static extent split_extent(const el_stream *stream)
{
    (void)stream;
    return (extent){0};
}

static size_t split_bytes(const el_stream *stream)
{
    (void)stream;
    return 0;
}

static void send_split(el_stream *stream, extent part)
{
    (void)stream;
    (void)part;
}

static bool append_to_split(el_stream *stream, const el_stream_line *line)
{
    (void)stream;
    (void)line;
    return false;
}

static void forget_split(el_stream *stream)
{
    (void)stream;
}

#endif

/* --- Codecs 0 and 1 ----------------------------------------------------------------------------------------------- */

static bool is_raw(const el_stream *stream, extent part)
{
    uint32_t pixels = part.lines * stream->config.width;
    return stream->codecs == EL_STREAM_RAW ||
           ((stream->codecs & EL_STREAM_RAW) != 0 && part.tokens + 2 * part.literals >= 2 * pixels);
}

static extent group_extent(const el_stream *stream)
{
    const el_stream_group *group = &stream->group;
    return (extent){group->lines, group->tokens, group->literals};
}

static size_t group_bytes(const el_stream *stream)
{
    const extent all = group_extent(stream);
    return is_raw(stream, all) ? 2 * (size_t)all.lines * stream->config.width : all.tokens + 2 * (size_t)all.literals;
}

static void send_group(el_stream *stream, extent part)
{
    el_packet_writer *writer = &stream->writer;
    const uint16_t *from = stream->group.pixels;
    const bool raw = is_raw(stream, part);

    begin_band(stream, part.lines, raw ? CODEC_RAW : CODEC_RUNS, raw ? 0 : part.tokens);
    if (raw) {
        el_packet_put(writer, from, 2 * (size_t)part.lines * stream->config.width);
    } else {
        el_packet_put(writer, stream->tokens, part.tokens);
        for (uint32_t i = 0; i < part.tokens; i++) {
            el_packet_put(writer, from, 2 * (size_t)el_runs_literals(stream->tokens[i]));
            from += el_runs_pixels(stream->tokens[i]);
        }
    }
    end_band(stream);
    stream->group.lines = 0;
}

/* As append_to_split. */
static bool append_to_group(el_stream *stream, const el_stream_line *line)
{
    el_stream_group *group = &stream->group;
    uint32_t width = stream->config.width;
    size_t budget = EL_STREAM_RUNS_PACKET_BYTES(width) - EL_PACKET_OVERHEAD_BYTES - EL_STREAM_BAND_HEADER_BYTES;
    int32_t tokens = 0;
    uint32_t literals = width;

    if (group->lines == 0) {
        *group = (el_stream_group){.pixels = line->pixels};
        stream->band_y = (uint16_t)line->y;
    } else if (group->lines == MAX_GROUP_LINES || line->y != stream->band_y + group->lines) {
        return false;
    }
    budget -= group->tokens + 2 * (size_t)group->literals;
    if (stream->codecs == EL_STREAM_RAW) {
        tokens = 2 * (size_t)width <= budget ? 0 : EL_RUNS_TOO_LONG;
    } else {
        tokens = el_runs_encode(line->pixels, width, budget, stream->tokens + group->tokens, &literals);
    }
    if (tokens < 0) {
        return false;
    }
    group->lines++;
    group->tokens += (uint32_t)tokens;
    group->literals += literals;
    return true;
}

/* --- Either ------------------------------------------------------------------------------------------------------- */

static extent extent_of(const el_stream *stream)
{
    return uses_split(stream) ? split_extent(stream) : group_extent(stream);
}

static void send(el_stream *stream, extent part)
{
    if (part.lines == 0) {
        return;
    }
    if (uses_split(stream)) {
        send_split(stream, part);
    } else {
        send_group(stream, part);
    }
}

static bool append(el_stream *stream, const el_stream_line *line)
{
    return uses_split(stream) ? append_to_split(stream, line) : append_to_group(stream, line);
}

/* What is being built goes into the link at once. */
static bool goes(el_stream *stream)
{
    const size_t body = EL_STREAM_BAND_HEADER_BYTES + (uses_split(stream) ? split_bytes(stream) : group_bytes(stream));
    return el_stream_fits(stream, body) || (el_stream_push(stream) && el_stream_fits(stream, body));
}

void el_stream_begin_bands(el_stream *stream)
{
    stream->group.lines = 0;
    forget_split(stream);
}

void el_stream_end_bands(el_stream *stream)
{
    send(stream, extent_of(stream));
}

void el_stream_release_lines(el_stream *stream)
{
    if (!uses_split(stream)) {
        el_stream_end_bands(stream);
    }
}

bool el_stream_add_line(el_stream *stream, const el_stream_line *line)
{
    extent before = extent_of(stream);

    if (!append(stream, line)) {
        send(stream, before);
        before.lines = 0;
        (void)append(stream, line);
    }
    if (!stream->rolling || goes(stream)) {
        return true;
    }
    if (before.lines > 0) {
        send(stream, before);
        (void)append(stream, line);
        if (goes(stream)) {
            return true;
        }
    }
    el_stream_begin_bands(stream);
    return false;
}
