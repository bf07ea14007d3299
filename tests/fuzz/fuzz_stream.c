/* A session at the end of a link that does what it likes: bytes of the host, whole packets and noise, in pieces; a port
 * that takes a few bytes, none, or is gone; a clock that jumps; frames in between. Nothing may block for ever, and while
 * the link takes bytes, all that the device sends are packets with a right CRC. */
#include <stdio.h>
#include <stdlib.h>

#include "plain_crc32.h"
#include "stream/sink.h"
#include "take.h"

enum { MAX_LINK_BYTES = 1 << 20, MAX_HOST_BYTES = 96, SIDE = 40, MAX_OPERATIONS = 64 };

typedef struct link {
    uint8_t to_device[MAX_HOST_BYTES];
    size_t queued;
    uint32_t clock_us;
    uint32_t tick_us; /* the clock's step at each look and each wait */
    uint8_t room;     /* bytes that a write takes at most; 0: none */
    uint8_t chunk;    /* bytes that a read brings at most */
    bool gone;
    bool stalled;       /* may have used up the stream's patience, or is gone: what is on the line may be broken off */
    uint8_t line[2048]; /* since the last 00 */
    size_t line_bytes;
    unsigned calls;
} link;

/* COBS, then type, seq, body and CRC. */
static void expect_packet(const uint8_t *line, size_t count)
{
    uint8_t packet[2048];
    size_t size = 0;
    for (size_t at = 0; at < count;) {
        const size_t code = line[at++];
        FUZZ_EXPECT(at + code - 1 <= count);
        memcpy(packet + size, line + at, code - 1);
        size += code - 1;
        at += code - 1;
        if (code < 255 && at < count) {
            packet[size++] = 0;
        }
    }
    FUZZ_EXPECT(size >= EL_PACKET_OVERHEAD_BYTES);
    const uint32_t crc = plain_crc32(packet, size - 4);
    for (unsigned i = 0; i < 4; i++) {
        FUZZ_EXPECT(packet[size - 4 + i] == (uint8_t)(crc >> (8 * i)));
    }
}

static int32_t link_write(void *context, const uint8_t *bytes, size_t count)
{
    link *const l = context;
    FUZZ_EXPECT(l->calls++ < 10000000);
    if (l->gone) {
        return -1;
    }
    const size_t taken = count < l->room ? count : l->room;
    for (size_t i = 0; i < taken; i++) {
        if (bytes[i] != 0) {
            FUZZ_EXPECT(l->line_bytes < sizeof l->line);
            l->line[l->line_bytes++] = bytes[i];
        } else {
            if (!l->stalled && l->line_bytes > 0) {
                expect_packet(l->line, l->line_bytes);
            }
            l->line_bytes = 0;
        }
    }
    return (int32_t)taken;
}

static int32_t link_read(void *context, uint8_t *bytes, size_t capacity)
{
    link *const l = context;
    if (l->gone) {
        return -1;
    }
    size_t count = l->queued < capacity ? l->queued : capacity;
    count = count < l->chunk ? count : l->chunk;
    memcpy(bytes, l->to_device, count);
    memmove(l->to_device, l->to_device + count, l->queued - count);
    l->queued -= count;
    return (int32_t)count;
}

static uint32_t link_micros(void *context)
{
    link *const l = context;
    return l->clock_us += l->tick_us;
}

static void link_wait(void *context)
{
    link *const l = context;
    l->clock_us += 1000;
}

static void take_input(void *context, uint8_t control, int32_t value)
{
    link *const l = context;
    l->clock_us += (uint32_t)value & control; /* both are there to be read */
}

static void from_host(link *l, const uint8_t *bytes, size_t count)
{
    const size_t room = sizeof l->to_device - l->queued;
    const size_t taken = count < room ? count : room;
    memcpy(l->to_device + l->queued, bytes, taken);
    l->queued += taken;
}

/* A packet of the host as it should be, of at most 24 bytes: one COBS block per 00. */
static void packet_from_host(link *l, input *in)
{
    uint8_t packet[32];
    const size_t body = take_u8(in) % 20;
    packet[0] = take_u8(in) % 12;
    packet[1] = take_u8(in);
    take_bytes(in, packet + 2, body);
    const uint32_t crc = plain_crc32(packet, body + 2);
    for (unsigned i = 0; i < 4; i++) {
        packet[body + 2 + i] = (uint8_t)(crc >> (8 * i));
    }
    uint8_t wire[40];
    size_t code_at = 0;
    size_t size = 1;
    for (size_t i = 0; i < body + 6; i++) {
        if (packet[i] == 0) {
            wire[code_at] = (uint8_t)(size - code_at);
            code_at = size++;
        } else {
            wire[size++] = packet[i];
        }
    }
    wire[code_at] = (uint8_t)(size - code_at);
    wire[size++] = 0;
    from_host(l, wire, size);
}

static void draw_frame(input *in, const el_sink *sink, uint16_t width, uint16_t height)
{
    uint16_t pixels[SIDE * SIDE];
    const uint8_t kind = take_u8(in);
    const uint16_t lines = (uint16_t)(1 + take_u8(in) % height);
    const uint16_t colour = take_u16(in);
    for (unsigned i = 0; i < SIDE * SIDE; i++) {
        pixels[i] = (kind & 1) != 0 ? (uint16_t)(i * colour) : colour;
    }
    take_bytes(in, pixels, kind >> 1);
    sink->begin(sink->context, width, height);
    for (uint16_t y = 0; y < height; y = (uint16_t)(y + lines)) {
        el_band band = {.pixels = pixels + y * width,
                        .depth = pixels,
                        .width = width,
                        .y = y,
                        .lines = y + lines > height ? (uint16_t)(height - y) : lines,
                        .held = {1}};
        sink->rows(sink->context, &band, 0);
        FUZZ_EXPECT(el_band_is_free(&band));
    }
    const el_stats stats = {.passes = 1};
    sink->end(sink->context, &stats);
}

static void operate(input *in, link *l, el_stream *stream, const el_sink *sink)
{
    uint8_t noise[32];
    const uint8_t operation = take_u8(in);
    switch (operation % 8) {
    case 0:
        packet_from_host(l, in);
        break;
    case 1:
        take_bytes(in, noise, sizeof noise);
        from_host(l, noise, operation / 8);
        break;
    case 2:
        l->room = take_u8(in);
        l->stalled = l->stalled || l->room == 0;
        break;
    case 3:
        l->clock_us += take_u32(in);
        l->tick_us = take_u16(in);
        l->stalled = l->stalled || l->tick_us > EL_STREAM_BYTE_US; /* a tick may bring a single byte */
        break;
    case 4:
        draw_frame(in, sink, stream->config.width, stream->config.height);
        break;
    case 5: {
        const char text[] = "a line for the log, with \303\244 in it, that is cut in the middle of a character";
        const int32_t sent = el_stream_log(stream, text, operation / 8 * 3U % sizeof text);
        FUZZ_EXPECT(sent >= 0 || sent == EL_STREAM_LINK_GONE);
        break;
    }
    case 6:
        l->gone = operation > 250;
        l->stalled = l->stalled || l->gone;
        l->chunk = take_u8(in);
        break;
    default: {
        const int answer = el_stream_poll(stream);
        FUZZ_EXPECT(answer == 0 || answer == EL_STREAM_LINK_GONE);
        break;
    }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    input in = {bytes, count};
    link l = {.room = 255, .chunk = 255, .tick_us = 1 + take_u8(&in)};
    const el_port port = {
        .context = &l, .write = link_write, .read = link_read, .micros = link_micros, .wait = link_wait};
    const uint16_t width = (uint16_t)(1 + take_u8(&in) % SIDE);
    const uint16_t height = (uint16_t)(1 + take_u8(&in) % SIDE);
    const size_t memory_bytes = EL_STREAM_MEMORY_BYTES(width, height);
    uint8_t *const memory = malloc(memory_bytes + 3);
    FUZZ_EXPECT(memory != NULL);
    const el_stream_config config = {.port = &port,
                                     .width = width,
                                     .height = height,
                                     .target = "fuzz",
                                     .firmware = "any",
                                     .one_way = take_u8(&in) % 8 == 0,
                                     .input = take_input,
                                     .input_context = &l,
                                     .memory = memory + take_u8(&in) % 4,
                                     .memory_bytes = memory_bytes};
    el_stream stream;
    FUZZ_EXPECT(el_stream_init(&stream, &config) == 0);
    const el_sink sink = el_stream_sink(&stream);
    for (unsigned i = 0; i < MAX_OPERATIONS && in.left > 0; i++) {
        operate(&in, &l, &stream, &sink);
    }
    (void)el_stream_flush(&stream);
    free(memory);
    return 0;
}
