/* The wire byte by byte: each packet type as hexadecimal vectors (made with Python's zlib and the package cobs), and the
 * reader on each vector whole, byte by byte, with other bytes around it, and damaged. */
#include "stream/packet.h"

#include "stream_device.h"

_Static_assert(EL_STREAM_MEMORY_BYTES(320, 240) == (EL_STREAM_WITH_SPLIT ? 3325 : 1334), "the figures in session.h");
_Static_assert(EL_STREAM_RUNS_PACKET_BYTES(320) == 1024 && EL_STREAM_RUNS_PACKET_BYTES(502) == 1024,
               "short lines share a packet");
_Static_assert(EL_STREAM_RUNS_PACKET_BYTES(504) == 14 + 2 * 504 + 4, "a long line has one of its own");
_Static_assert(sizeof(el_stream) - EL_STREAM_WIRE_BYTES <= 560 + EL_STREAM_WITH_SPLIT * 360, "a session is small");
_Static_assert(EL_STREAM_ROLL_WIRE_BYTES(320) <= 860, "the queue's usual size lets 320 pixels roll");

static fake_link wire;
static test_device dev;

void setUp(void)
{
    fake_link_init(&wire);
}

void tearDown(void)
{
}

/* What the device has sent since the last time is exactly this. */
static void expect_sent(const char *hex)
{
    uint8_t expected[1024];
    size_t count = from_hex(hex, expected);
    TEST_ASSERT_EQUAL_UINT32(count, wire.out_count - wire.out_read);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, wire.out + wire.out_read, count);
    wire.out_read = wire.out_count;
}

#define HELLO_3X3                                                                                                      \
    "02 01 08 45 44 47 4C 01 02 03 02 03 02 01 01 01 05 1C 04 07 0F 01 04 40 42 0F 0E 04 03 02 01 03 70 63 31 "        \
    "04 66 77 20 32 04 05 FE 3F 01 02 3F 01 03 C2 01 05 1D B2 A4 15 00"
#define BAND_RUNS "03 03 01 01 01 01 04 03 01 04 04 81 02 80 01 03 F8 01 02 02 02 03 01 01 07 34 12 3D E1 53 02 00 "
#define FRAME_END_0                                                                                                    \
    "03 04 02 01 02 01 01 06 F0 FF FF F4 01 01 01 01 01 01 02 20 01 01 01 01 02 07 07 B1 11 0E A3 19 64 01 01 "        \
    "02 65 01 01 02 66 01 01 02 67 01 01 02 68 01 01 02 69 01 01 02 6A 01 01 02 6B 01 01 02 6C 01 01 02 6D 01 "        \
    "01 02 6E 01 01 02 6F 01 01 02 70 01 01 02 71 01 01 02 72 01 01 02 73 01 01 02 74 01 01 02 75 01 01 02 76 "        \
    "01 01 02 77 01 01 02 78 01 01 02 79 01 01 02 7A 01 01 02 7B 01 01 02 7C 01 01 03 24 F4 01 05 21 61 D1 17 "        \
    "00"
#define BAND_RAW "04 03 03 01 01 01 02 03 01 01 01 02 F8 02 F8 03 F8 01 02 02 02 03 01 01 01 01 07 34 12 BF 69 F4 49 00"

/* The first packet has a 00 in front of it. */
static void test_hello(void)
{
    device_init(&dev, &wire, 3, 3, false);
    el_stream_poll(&dev.stream);
    expect_sent("00 " HELLO_3X3);
}

static void test_log(void)
{
    device_init(&dev, &wire, 3, 3, false);
    el_stream_poll(&dev.stream);
    wire.out_read = wire.out_count;
    TEST_ASSERT_EQUAL_INT32(5, el_stream_log(&dev.stream, "gr\xC3\xBCn", 5));
    expect_sent("0C 09 01 67 72 C3 BC 6E B0 0F 1F 58 00");
}

/* The fourth packet: HELLO, and two LOG. */
static void test_baud(void)
{
    device_init(&dev, &wire, 3, 3, false);
    el_stream_poll(&dev.stream);
    for (int i = 0; i < 2; i++) {
        el_stream_log(&dev.stream, "x", 1);
    }
    host_packet(&wire, EL_PACKET_SET_BAUD, "00 10 0E 00");
    wire.out_read = wire.out_count;
    el_stream_poll(&dev.stream);
    expect_sent("03 0C 03 03 10 0E 05 F6 95 05 03 00");
}

/* A frame of 3 x 3 pixels with both codecs, then one raw. The renderer takes 500 us, the stream no time. */
static void test_band_and_frame_end(void)
{
    static const uint16_t picture[9] = {0xF800, 0xF800, 0xF800, 1, 2, 3, 0, 0, 0x1234};

    device_init(&dev, &wire, 3, 3, false);
    memcpy(dev.pixels, picture, sizeof picture);
    el_stream_poll(&dev.stream);
    wire.out_read = wire.out_count;
    host_packet(&wire, EL_PACKET_START, "00 01 00 00 03 00");
    dev.stream.input_number = 7;
    el_stats stats;
    for (uint32_t i = 0; i < EL_STATS_COUNT; i++) {
        ((uint32_t *)&stats)[i] = 100 + i;
    }
    el_band band = {.pixels = dev.pixels, .width = 3, .lines = 3};
    dev.sink.begin(dev.sink.context, 3, 3);
    dev.sink.rows(dev.sink.context, &band, 0);
    wire.clock_us += 500;
    dev.sink.end(dev.sink.context, &stats);
    expect_sent(BAND_RUNS FRAME_END_0);

    host_packet(&wire, EL_PACKET_START, "00 01 00 00 01 00");
    dev.sink.begin(dev.sink.context, 3, 3);
    dev.sink.rows(dev.sink.context, &band, 0);
    expect_sent(BAND_RAW);
}

typedef struct vector {
    const char *name;
    const char *wire;
    uint8_t type;
    const char *body;
} vector;

static const vector from_host[] = {
    {"START", "03 02 05 03 02 1E 02 03 05 BC D7 14 94 00", EL_PACKET_START, "00 02 1E 00 03 00"},
    {"ACK", "04 05 05 07 06 01 4C AE 54 4B 00", EL_PACKET_ACK, "07 00 01"},
    {"KEY", "03 06 05 01 02 F0 05 73 2C C7 BB 00", EL_PACKET_KEY, "00 00 F0 00"},
    {"PING", "07 07 05 B7 70 F2 7E 00", EL_PACKET_PING, ""},
    {"PING of 1.2", "09 07 05 01 02 23 75 4D 4D 00", EL_PACKET_PING, "01 02"},
    {"STOP", "07 08 05 78 6C 6A F9 00", EL_PACKET_STOP, ""},
    {"INPUT", "04 0A 05 05 09 C0 FF FF C8 AE 10 59 38 00", EL_PACKET_INPUT, "05 00 C0 FF FF C8"},
    {"SET_BAUD", "03 0B 05 03 10 0E 05 EE 50 40 91 00", EL_PACKET_SET_BAUD, "00 10 0E 00"},
};

enum { VECTORS = sizeof from_host / sizeof from_host[0] };

static void check_packet(const vector *expected, const el_packet *packet)
{
    uint8_t body[64];
    size_t count = from_hex(expected->body, body);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(expected->type, packet->type, expected->name);
    TEST_ASSERT_EQUAL_HEX8(5, packet->seq);
    TEST_ASSERT_EQUAL_UINT32(count, packet->body_bytes);
    if (count > 0) {
        TEST_ASSERT_EQUAL_HEX8_ARRAY(body, packet->body, count);
    }
}

/* Feeds `count` bytes; returns the number of packets, damage in `*damaged`. */
static int feed(el_packet_reader *reader, const uint8_t *bytes, size_t count, el_packet *packet, int *damaged)
{
    int packets = 0;
    for (size_t i = 0; i < count; i++) {
        int result = el_packet_feed(reader, bytes[i], packet);
        packets += result == EL_PACKET_COMPLETE;
        *damaged += result == EL_PACKET_DAMAGED;
    }
    return packets;
}

static void test_reader_takes_each_vector(void)
{
    for (size_t i = 0; i < VECTORS; i++) {
        static const char *const before[] = {"", "00", "00 00 00", "48 65 6C 6C 6F 00", "07 08 05 00"};
        static const int damage[] = {0, 0, 0, 1, 1};
        for (size_t k = 0; k < sizeof before / sizeof before[0]; k++) {
            el_packet_reader reader = {.count = 0};
            el_packet packet;
            uint8_t bytes[128];
            int damaged = 0;
            size_t lead = from_hex(before[k], bytes);
            size_t count = lead + from_hex(from_host[i].wire, bytes + lead);
            TEST_ASSERT_EQUAL_INT(0, feed(&reader, bytes, count - 1, &packet, &damaged));
            TEST_ASSERT_EQUAL_INT(EL_PACKET_COMPLETE, el_packet_feed(&reader, 0, &packet));
            TEST_ASSERT_EQUAL_INT(damage[k], damaged);
            check_packet(&from_host[i], &packet);
            TEST_ASSERT_EQUAL_INT(EL_PACKET_NONE, el_packet_feed(&reader, 0, &packet)); /* an empty chunk */
        }
    }
}

/* Every bit of every vector: no flip is taken for a packet, and the next packet is read. */
static void test_reader_refuses_every_flipped_bit(void)
{
    for (size_t i = 0; i < VECTORS; i++) {
        uint8_t good[64];
        size_t count = from_hex(from_host[i].wire, good);
        for (size_t bit = 0; bit < 8 * (count - 1); bit++) {
            el_packet_reader reader = {.count = 0};
            el_packet packet;
            uint8_t bad[64];
            int damaged = 0;
            memcpy(bad, good, count);
            bad[bit / 8] = (uint8_t)(bad[bit / 8] ^ 1U << bit % 8);
            TEST_ASSERT_EQUAL_INT(0, feed(&reader, bad, count, &packet, &damaged));
            TEST_ASSERT_GREATER_THAN_INT(0, damaged);
            TEST_ASSERT_EQUAL_INT(1, feed(&reader, good, count, &packet, &damaged));
            check_packet(&from_host[i], &packet);
        }
    }
}

/* The reader's bound: the largest packet passes, one byte more is damage, and so is an endless chunk. */
static void test_reader_bounds_a_packet(void)
{
    for (size_t body_bytes = 50; body_bytes < 70; body_bytes++) {
        el_packet_reader reader = {.count = 0};
        el_packet packet;
        uint8_t body[128] = {0};
        uint8_t bytes[256];
        int damaged = 0;
        memset(body, 0x55, sizeof body);
        size_t count = make_packet(EL_PACKET_PING, 5, body, body_bytes, bytes);
        bool fits = body_bytes + EL_PACKET_OVERHEAD_BYTES <= EL_PACKET_HOST_BYTES;
        TEST_ASSERT_EQUAL_INT(fits, feed(&reader, bytes, count, &packet, &damaged));
        TEST_ASSERT_EQUAL_INT(!fits, damaged);
    }
    el_packet_reader reader = {.count = 0};
    el_packet packet;
    for (int i = 0; i < 100000; i++) {
        TEST_ASSERT_EQUAL_INT(EL_PACKET_NONE, el_packet_feed(&reader, 0x55, &packet));
    }
    TEST_ASSERT_EQUAL_INT(EL_PACKET_DAMAGED, el_packet_feed(&reader, 0, &packet));
}

/* --- The writer by itself, through a queue that is drained a few bytes at a time ------------------------------- */

typedef struct drainer {
    el_packet_writer writer;
    uint8_t queue[EL_COBS_ENCODER_MIN_BYTES];
    uint8_t out[8192];
    size_t count;
    int drains_left; /* until the link fails */
} drainer;

static bool drain(void *context)
{
    drainer *to = context;
    size_t count;
    const uint8_t *bytes = el_cobs_final(&to->writer.wire, &count);
    if (to->drains_left-- == 0) {
        el_packet_tear(&to->writer);
        return false;
    }
    memcpy(to->out + to->count, bytes, count);
    to->count += count;
    el_cobs_take(&to->writer.wire, count);
    return true;
}

static drainer *new_drainer(int drains_left)
{
    static drainer to;
    memset(&to, 0, sizeof to);
    to.drains_left = drains_left;
    el_packet_writer_init(&to.writer, to.queue, sizeof to.queue, drain, &to);
    return &to;
}

static void test_writer_streams_packets_of_any_size(void)
{
    uint32_t seed = 3;
    for (int round = 0; round < 500; round++) {
        drainer *to = new_drainer(-1);
        uint8_t body[3000];
        uint8_t expected[4000] = {0};
        size_t count = random_below(&seed, sizeof body);
        uint32_t values = 1U << random_below(&seed, 9);
        for (size_t i = 0; i < count; i++) {
            body[i] = (uint8_t)random_below(&seed, values);
        }
        el_packet_begin(&to->writer, EL_PACKET_LOG);
        for (size_t at = 0; at < count;) {
            size_t piece = 1 + random_below(&seed, (uint32_t)(count - at));
            el_packet_put(&to->writer, body + at, piece);
            at += piece;
        }
        size_t size = make_packet(EL_PACKET_LOG, 0, body, count, expected + 1);
        TEST_ASSERT_EQUAL_INT32((int32_t)size, el_packet_end(&to->writer));
        TEST_ASSERT_TRUE(drain(to));
        TEST_ASSERT_EQUAL_UINT32(size + 1, to->count);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, to->out, size + 1);
    }
}

/* A packet whose link fails on the way is lost, its number is used up, and the next one begins with a 00. */
static void test_writer_loses_a_packet_whole(void)
{
    for (int drains = 0; drains < 4; drains++) {
        drainer *to = new_drainer(drains);
        uint8_t body[1200];
        uint8_t expected[64] = {0};
        memset(body, 0x55, sizeof body);
        el_packet_begin(&to->writer, EL_PACKET_LOG);
        el_packet_put(&to->writer, body, sizeof body);
        TEST_ASSERT_EQUAL_INT32(EL_PACKET_LOST, el_packet_end(&to->writer));

        to->drains_left = -1;
        to->count = 0;
        el_packet_begin(&to->writer, EL_PACKET_LOG);
        TEST_ASSERT_EQUAL_INT32(1 + 6 + 1, el_packet_end(&to->writer));
        TEST_ASSERT_TRUE(drain(to));
        size_t size = make_packet(EL_PACKET_LOG, 1, body, 0, expected + 1);
        TEST_ASSERT_EQUAL_UINT32(size + 1, to->count);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, to->out, size + 1);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_hello);
    RUN_TEST(test_log);
    RUN_TEST(test_baud);
    RUN_TEST(test_band_and_frame_end);
    RUN_TEST(test_reader_takes_each_vector);
    RUN_TEST(test_reader_refuses_every_flipped_bit);
    RUN_TEST(test_reader_bounds_a_packet);
    RUN_TEST(test_writer_streams_packets_of_any_size);
    RUN_TEST(test_writer_loses_a_packet_whole);
    return UNITY_END();
}
