/* A day of frames, 30 a second, in the time that a test has: every counter of the wire wraps, most of them many times, and
 * nothing is lost, wrong, late or larger at its end. The firmware has no heap; what could grow is the queue and the memory
 * that it was given, and both are looked at. With sanitizers it is an hour, and minutes on emulated cores. */
#include "seeded.h"
#include "stream_device.h"

#ifdef __SANITIZE_ADDRESS__
#define SLOWNESS 24
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SLOWNESS 24
#endif
#endif
#ifndef SLOWNESS
#define SLOWNESS 1
#endif

enum {
    WIDTH = 6,
    HEIGHT = 4,
    FRAMES = PART_OF(PART_OF(24 * 3600 * 30 / SLOWNESS)),
    FRAME_US = 33333,
    LOOK_EVERY = 61,   /* frames; the host of these tests is slow */
    INPUT_EVERY = 30,  /* one a second */
    PING_EVERY = 1800, /* one a minute, and a LOG */
    KEY_EVERY = 977,
    ACK_EVERY = 100,
};

static fake_link wire;
static test_device dev;
static host_view host;

/* The wraps are not far: at 2^16 frames, 2^32 us and 2^32 bytes. */
void setUp(void)
{
    fake_link_init(&wire);
    memset(&host, 0, sizeof host);
    wire.clock_us = UINT32_MAX - 5000000;
    device_init(&dev, &wire, WIDTH, HEIGHT, false);
    dev.stream.frame.number = UINT16_MAX - 100;
    dev.stream.writer.seq = 250;
    dev.stream.writer.wire.moved = UINT32_MAX - 100000;
}

void tearDown(void)
{
}

static void draw(uint32_t frame)
{
    static const el_stats stats;
    el_band band = {.pixels = dev.pixels, .width = WIDTH, .lines = HEIGHT};
    dev.pixels[frame % (WIDTH * HEIGHT)] = (uint16_t)(frame * 40503U);
    dev.sink.begin(dev.sink.context, WIDTH, HEIGHT);
    dev.sink.rows(dev.sink.context, &band, 0);
    wire.clock_us += 1000;
    dev.sink.end(dev.sink.context, &stats);
}

/* Counts the packets that nobody looks at, so that a gap in seq shows at the next one that is looked at. */
static void skip_packets(void)
{
    uint32_t packets = 0;
    for (size_t at = wire.out_read; at < wire.out_count; at++) {
        packets += wire.out[at] == 0;
    }
    host.next_seq = (uint8_t)(host.next_seq + packets);
}

static void take_sent(bool look)
{
    if (look) {
        host_listen(&host, &wire);
    } else {
        skip_packets();
    }
    wire.out_count = wire.out_read = 0;
    wire.room = FAKE_OUT_BYTES;
}

static void expect_frame(uint32_t frame, uint32_t frames, uint32_t begin_us)
{
    TEST_ASSERT_EQUAL_UINT32(frames + 1, host.frames);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames + host.damaged + host.gaps);
    TEST_ASSERT_EQUAL_UINT16((uint16_t)(UINT16_MAX - 100 + frame), get_u16(host.frame_end));
    TEST_ASSERT_EQUAL_UINT32(begin_us, get_u32(host.frame_end + 4));
    TEST_ASSERT_EQUAL_UINT32(1000, get_u32(host.frame_end + 8)); /* the time of rendering */
    TEST_ASSERT_EQUAL_UINT32(0, get_u16(host.frame_end + 20));   /* frames that were not sent */
    TEST_ASSERT_EQUAL_UINT8((uint8_t)(frame / INPUT_EVERY + 1), host.frame_end[22]);
    TEST_ASSERT_EQUAL_UINT32(125 * 1000, get_u32(host.frame_end + host.frame_end_bytes - 4)); /* cycles */
}

static void say(uint8_t type, const char *hex, bool due)
{
    if (due) {
        host_packet(&wire, type, hex);
    }
}

static void test_a_day(void)
{
    host_packet(&wire, EL_PACKET_START, "00 64 1E 00 03 00"); /* 100 credits, 30 frames/s */
    el_stream_poll(&dev.stream);
    take_sent(true);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        const bool look = frame % LOOK_EVERY == 0;
        const uint32_t frames = host.frames;
        const uint32_t begin_us = wire.clock_us;
        if (frame % INPUT_EVERY == 0) {
            const uint8_t body[6] = {EL_CONTROL_STEP, 1, 0, 0, 0, (uint8_t)(frame / INPUT_EVERY + 1)};
            uint8_t packet[32];
            host_bytes(&wire, packet, make_packet(EL_PACKET_INPUT, wire.host_seq++, body, sizeof body, packet));
        }
        say(EL_PACKET_KEY, "01 00 02 00", frame % KEY_EVERY == 0);
        say(EL_PACKET_PING, "01 02", frame % PING_EVERY == 0);
        say(EL_PACKET_ACK, "00 00 64", frame % ACK_EVERY == ACK_EVERY - 1);
        if (wire.in_count > 0) {
            el_stream_poll(&dev.stream);
            TEST_ASSERT_EQUAL_UINT32(wire.in_count, wire.in_read);
            wire.in_count = wire.in_read = 0;
        }
        draw(frame);
        if (look) {
            /* The host's picture is old: between two looks it took nothing. */
            memcpy(host.pixels, dev.pixels, sizeof dev.pixels[0] * WIDTH * HEIGHT);
        }
        take_sent(look);
        if (look) {
            expect_frame(frame, frames, begin_us);
        }
        TEST_ASSERT_EQUAL_UINT32(0, dev.stream.writer.wire.used - dev.stream.writer.wire.taken);
        wire.clock_us = begin_us + FRAME_US + (frame % 3 == 0);
    }
    TEST_ASSERT_EQUAL_UINT32((FRAMES - 1) / INPUT_EVERY + 1, dev.inputs);
    TEST_ASSERT_EQUAL_UINT32(0, dev.stream.stalls + dev.stream.damaged + dev.stream.missed);
    TEST_ASSERT_EQUAL_UINT8(ACK_EVERY - FRAMES % ACK_EVERY, dev.stream.credits);
    device_check_guards(&dev);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_day);
    return UNITY_END();
}
