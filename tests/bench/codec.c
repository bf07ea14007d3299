/* The stream's codec 2 on the sequences of codec_sequences.h, beside its first design.
 *
 * First the encoder alone, every line sent, nothing skipped; what is measured is el_split_add and no more. One line per
 * frame, `bytes` being the packets' before COBS:
 *
 *     SEQUENCE FRAME crc CRC-OF-THE-PACKETS bytes BYTES packets N ns NANOSECONDS
 *
 * Then, where there is memory enough, what the first design makes of the same frames, and whole sessions: the file
 * SEQUENCE.MODE is what a device puts on the wire.
 *
 *     SEQUENCE first crc 00000000 split BYTES lines BYTES segments BYTES */
#include <string.h>

#include "base/crc32.h"
#include "codec_first.h"
#include "codec_sequences.h"
#include "platform.h"
#include "stream/sink.h"

enum { FEW_FRAMES = 16 /* on the target, one in so many */, WIRE_CAPACITY = 16 * 1024 * 1024 };

/* --- The encoder alone -------------------------------------------------------------------------------------------- */

typedef struct encoder {
    el_split split;
    uint8_t buffer[EL_SPLIT_BUFFER_BYTES(CODEC_WIDTH)];
    uint16_t last_line[CODEC_WIDTH];
    uint64_t bytes;
    uint64_t packets;
    uint32_t crc;
} encoder;

static void end_packet(encoder *e)
{
    const el_split *const split = &e->split;
    const size_t lags = split->lagging ? (split->lines + 7U) / 8 : 0;
    if (split->lines > 0) {
        e->packets++;
        e->bytes += EL_PACKET_OVERHEAD_BYTES + EL_STREAM_BAND_HEADER_BYTES + lags + split->token_count +
                    2 * (size_t)split->literal_count;
        e->crc = el_crc32(e->crc, split->lags, lags);
        e->crc = el_crc32(e->crc, split->tokens, split->token_count);
        e->crc = el_crc32(e->crc, split->literals, 2 * (size_t)split->literal_count);
    }
    el_split_begin(&e->split);
}

static void encoder_begin(void *context, uint16_t width, uint16_t height)
{
    encoder *const e = context;
    (void)height;
    el_split_init(&e->split, e->buffer, width);
}

static void encoder_rows(void *context, el_band *band, unsigned slot)
{
    encoder *const e = context;
    const uint16_t *above = band->y > 0 ? e->last_line : NULL;
    for (uint32_t line = 0; line < band->lines; line++) {
        const uint16_t *const pixels = band->pixels + (size_t)line * band->width;
        if (el_split_is_full(&e->split)) {
            end_packet(e);
        }
        bench_start();
        el_split_add(&e->split, pixels, above, UINT32_MAX);
        bench_stop();
        above = pixels;
    }
    memcpy(e->last_line, above, sizeof e->last_line);
    el_band_release(band, slot);
}

static void encoder_end(void *context, const el_stats *stats)
{
    (void)stats;
    end_packet(context);
}

static void print_item(const char *name, uint64_t value)
{
    bench_print(name);
    bench_print_u64(value);
}

static bool measure(size_t sequence, uint32_t frame)
{
    static encoder e;
    uint64_t best_ns = UINT64_MAX;
    for (unsigned i = 0; i < bench_repeats && i < 3; i++) {
        const el_sink sink = {.context = &e, .begin = encoder_begin, .rows = encoder_rows, .end = encoder_end};
        e.bytes = 0;
        e.packets = 0;
        e.crc = 0;
        bench_next();
        if (!codec_sequence_play(sequence, frame, &sink)) {
            return false;
        }
        best_ns = bench_elapsed_ns() < best_ns ? bench_elapsed_ns() : best_ns;
    }
    bench_print(codec_sequence_name(sequence));
    print_item(" ", frame);
    bench_print(" crc ");
    bench_print_hex(e.crc);
    print_item(" bytes ", e.bytes);
    print_item(" packets ", e.packets);
    print_item(" ns ", best_ns);
    bench_print("\n");
    return true;
}

/* --- The first design --------------------------------------------------------------------------------------------- */

enum { PIXELS = CODEC_WIDTH * CODEC_HEIGHT };

static void keep_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
}

static void keep_rows(void *context, el_band *band, unsigned slot)
{
    uint16_t *const frame = context;
    memcpy(frame + (size_t)band->y * band->width, band->pixels, sizeof frame[0] * band->lines * band->width);
    el_band_release(band, slot);
}

static void keep_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

/* `frames` has room for two. */
static bool measure_first(size_t sequence, uint16_t *frames)
{
    uint64_t whole = 0;
    uint64_t lines = 0;
    uint64_t segments = 0;
    for (uint32_t i = 0; i < CODEC_FRAMES; i++) {
        uint16_t *const frame = frames + i % 2 * PIXELS;
        const uint16_t *const known = i > 0 ? frames + (i + 1) % 2 * PIXELS : NULL;
        const el_sink sink = {.context = frame, .begin = keep_begin, .rows = keep_rows, .end = keep_end};
        if (!codec_sequence_play(sequence, i, &sink)) {
            return false;
        }
        whole += codec_first_bytes(frame, NULL, CODEC_WIDTH, 0);
        lines += codec_first_bytes(frame, known, CODEC_WIDTH, 2 * i);
        segments += codec_first_bytes(frame, known, EL_SPLIT_SEGMENT_PIXELS, 2 * i);
    }
    bench_print(codec_sequence_name(sequence));
    print_item(" first crc 00000000 split ", whole / CODEC_FRAMES);
    print_item(" lines ", lines / CODEC_FRAMES);
    print_item(" segments ", segments / CODEC_FRAMES);
    bench_print("\n");
    return true;
}

/* --- Sessions ----------------------------------------------------------------------------------------------------- */

typedef struct mode {
    const char *name;
    uint16_t codecs;
    bool segments;
} mode;

static const mode modes[] = {
    {"segments", EL_STREAM_SPLIT, true}, {"lines", EL_STREAM_SPLIT, false}, {"runs", EL_STREAM_RUNS, false}};

/* A link that takes everything and brings one START. */
typedef struct capture {
    uint8_t *bytes;
    size_t count;
    const uint8_t *start;
    size_t start_left;
} capture;

static int32_t capture_write(void *context, const uint8_t *bytes, size_t count)
{
    capture *const c = context;
    if (c->count + count > WIRE_CAPACITY) {
        return -1;
    }
    memcpy(c->bytes + c->count, bytes, count);
    c->count += count;
    return (int32_t)count;
}

static int32_t capture_read(void *context, uint8_t *bytes, size_t capacity)
{
    capture *const c = context;
    const size_t count = c->start_left < capacity ? c->start_left : capacity;
    memcpy(bytes, c->start, count);
    c->start += count;
    c->start_left -= count;
    return (int32_t)count;
}

static uint32_t capture_micros(void *context)
{
    (void)context;
    return 0;
}

static bool run_session(size_t sequence, const mode *how, capture *link)
{
    static uint8_t memory[EL_STREAM_MEMORY_BYTES(CODEC_WIDTH, CODEC_HEIGHT) +
                          EL_STREAM_SEGMENT_MEMORY_BYTES(CODEC_WIDTH, CODEC_HEIGHT)];
    static el_stream stream;
    uint8_t start[EL_COBS_ENCODER_MIN_BYTES];
    el_packet_writer host;
    el_packet_writer_init(&host, start, sizeof start, NULL, NULL);
    el_packet_begin(&host, EL_PACKET_START);
    el_packet_put_u8(&host, 0);
    el_packet_put_u8(&host, CODEC_FRAMES);
    el_packet_put_u16(&host, 0);
    el_packet_put_u16(&host, how->codecs);
    el_packet_end(&host);
    link->start = el_cobs_final(&host.wire, &link->start_left);
    link->count = 0;

    const el_port port = {.context = link, .write = capture_write, .read = capture_read, .micros = capture_micros};
    const el_stream_config config = {.port = &port,
                                     .width = CODEC_WIDTH,
                                     .height = CODEC_HEIGHT,
                                     .target = "bench",
                                     .firmware = "codec",
                                     .segments = how->segments,
                                     .memory = memory,
                                     .memory_bytes = sizeof memory};
    if (el_stream_init(&stream, &config) != 0) {
        return false;
    }
    const el_sink sink = el_stream_sink(&stream);
    for (uint32_t frame = 0; frame < CODEC_FRAMES; frame++) {
        if (!codec_sequence_play(sequence, frame, &sink)) {
            return false;
        }
    }
    return el_stream_flush(&stream);
}

int bench_main(void)
{
    uint8_t *const wire = bench_scratch(WIRE_CAPACITY);
    const uint32_t step = wire != NULL ? 1 : FEW_FRAMES;
    bool good = true;

    /* What a pair of markers costs by itself. */
    bench_next();
    bench_start();
    bench_stop();
    bench_print("empty 0 crc 00000000 bytes 0 packets 0 ns 0\n");

    for (size_t i = 0; i < CODEC_SEQUENCES; i++) {
        for (uint32_t frame = 0; frame < CODEC_FRAMES; frame += step) {
            good = measure(i, frame) && good;
        }
        good = (wire == NULL || measure_first(i, (uint16_t *)(void *)wire)) && good;
        for (size_t k = 0; wire != NULL && k < sizeof modes / sizeof modes[0]; k++) {
            capture link = {.bytes = wire};
            good = run_session(i, &modes[k], &link) && good;
            bench_keep(codec_sequence_name(i), modes[k].name, wire, link.count);
        }
    }
    return good ? 0 : 1;
}
