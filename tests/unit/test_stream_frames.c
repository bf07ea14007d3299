/* Pictures through the wire: what the host assembles is the picture, and no more is sent than has to be. */
#include "stream_device.h"

static fake_link wire;
static test_device dev;
static host_view host;
static uint32_t seed;

void setUp(void)
{
    fake_link_init(&wire);
    memset(&host, 0, sizeof host);
    seed = 20261121;
}

void tearDown(void)
{
}

static void open_device(uint16_t width, uint16_t height, uint16_t band_lines, const char *start_hex)
{
    device_init(&dev, &wire, width, height, false);
    dev.band_lines = band_lines;
    el_stream_poll(&dev.stream);
    host_packet(&wire, EL_PACKET_START, start_hex);
    host_listen(&host, &wire);
}

/* Draws a frame that is to be sent, checks the host's picture, returns how many lines were sent. */
static uint32_t draw(void)
{
    uint32_t frames = host.frames;
    uint32_t lines = host.lines;
    host_packet(&wire, EL_PACKET_ACK, "00 00 01");
    wire.in_count -= wire.in_read; /* what was read makes room */
    memmove(wire.in, wire.in + wire.in_read, wire.in_count);
    wire.in_read = 0;
    wire.out_count = 0;
    wire.out_read = 0;
    wire.room = FAKE_OUT_BYTES;
    device_draw(&dev);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(frames + 1, host.frames);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames + host.damaged + host.gaps);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(EL_STREAM_PACKET_BYTES(dev.width), host.largest_packet);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(dev.pixels, host.pixels, (size_t)dev.width * dev.height);
    return host.lines - lines;
}

/* Rectangles of one colour, of few colours, and noise over what was there. */
static void scribble(void)
{
    uint32_t kind = random_below(&seed, 4);
    uint32_t x0 = random_below(&seed, dev.width);
    uint32_t y0 = random_below(&seed, dev.height);
    uint32_t x1 = x0 + 1 + random_below(&seed, dev.width - x0);
    uint32_t y1 = y0 + 1 + random_below(&seed, dev.height - y0);
    uint16_t colour = (uint16_t)random_u32(&seed);
    for (uint32_t y = y0; y < y1; y++) {
        for (uint32_t x = x0; x < x1; x++) {
            uint32_t noise = random_u32(&seed);
            dev.pixels[y * dev.width + x] = kind < 2 ? colour : (uint16_t)(kind == 2 ? noise & 3 : noise);
        }
    }
}

static void test_seeded_pictures_of_all_shapes(void)
{
    static const uint16_t sizes[] = {1, 2, 3, 16, 31, 64, 127, 128};
    static const char *const starts[] = {"00 02 00 00 01 00", "00 02 00 00 02 00", "00 02 00 00 03 00"};

    for (int round = 0; round < 60; round++) {
        uint16_t width = sizes[random_below(&seed, 8)];
        uint16_t height = sizes[random_below(&seed, 8)];
        open_device(width, height, (uint16_t)(1 + random_below(&seed, height)), starts[round % 3]);
        host.has_both_codecs = round % 3 == 2;
        for (int frame = 0; frame < 12; frame++) {
            scribble();
            wire.most = 1 + random_below(&seed, 700);
            draw();
        }
        uint32_t next_seed = random_u32(&seed);
        setUp();
        seed = next_seed;
    }
}

static void test_a_host_gets_only_codecs_that_it_has(void)
{
    open_device(64, 64, 8, "00 02 00 00 01 00");
    draw();
    TEST_ASSERT_EQUAL_UINT32(0, host.run_bands);
    TEST_ASSERT_GREATER_THAN_UINT32(0, host.raw_bands);
    host_packet(&wire, EL_PACKET_START, "00 02 00 00 02 00");
    host.raw_bands = 0;
    for (size_t i = 0; i < 64; i++) {
        dev.pixels[i] = (uint16_t)i;
    }
    draw();
    TEST_ASSERT_EQUAL_UINT32(0, host.raw_bands);
    TEST_ASSERT_GREATER_THAN_UINT32(0, host.run_bands);
}

/* With both codecs the smaller one: raw for a line without a run, runs for one with a single run of three. */
static void test_the_smaller_codec(void)
{
    open_device(32, 1, 1, "00 02 00 00 03 00");
    for (size_t i = 0; i < 32; i++) {
        dev.pixels[i] = (uint16_t)i;
    }
    draw();
    TEST_ASSERT_EQUAL_UINT32(1, host.raw_bands);
    dev.pixels[10] = dev.pixels[11] = dev.pixels[12];
    draw();
    TEST_ASSERT_EQUAL_UINT32(1, host.raw_bands);
    TEST_ASSERT_EQUAL_UINT32(1, host.run_bands);
}

static void test_the_first_frame_has_all_lines_and_later_ones_what_changed(void)
{
    open_device(64, 100, 8, "00 02 00 00 03 00");
    scribble();
    TEST_ASSERT_EQUAL_UINT32(100, draw());
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_REFRESH_LINES, draw());
    dev.pixels[50 * 64 + 63] ^= 1;
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_REFRESH_LINES + 1, draw());
    host_packet(&wire, EL_PACKET_KEY, "46 00 05 00"); /* lines 70..74 */
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_REFRESH_LINES + 5, draw());
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_REFRESH_LINES, draw());
    host_packet(&wire, EL_PACKET_START, "00 02 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(100, draw());
}

/* A host's picture that is wrong in a way that no CRC shows is right again after height / EL_STREAM_REFRESH_LINES. */
static void test_every_line_is_refreshed(void)
{
    open_device(16, 100, 8, "00 02 00 00 03 00");
    draw();
    bool sent[100] = {false};
    for (int frame = 0; frame < 100 / EL_STREAM_REFRESH_LINES; frame++) {
        memset(host.pixels, 0x55, sizeof host.pixels);
        host_packet(&wire, EL_PACKET_ACK, "00 00 01");
        device_draw(&dev);
        host_listen(&host, &wire); /* a bad frame, of course */
        for (int y = 0; y < 100; y++) {
            sent[y] = sent[y] || host.pixels[16 * y] != 0x5555;
        }
    }
    for (int y = 0; y < 100; y++) {
        TEST_ASSERT_TRUE(sent[y]);
    }
}

/* Lines that were changed and changed back while the host had no credits are as it knows them. */
static void test_frames_that_are_not_sent_change_nothing(void)
{
    open_device(16, 100, 8, "00 00 00 00 03 00");
    draw();
    uint16_t before[100];
    for (size_t y = 0; y < 100; y++) {
        before[y] = dev.pixels[16 * y];
        dev.pixels[16 * y] ^= 0x0F0F;
    }
    device_draw(&dev);
    for (size_t y = 0; y < 100; y++) {
        dev.pixels[16 * y] = before[y];
    }
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_REFRESH_LINES, draw());
    TEST_ASSERT_EQUAL_UINT32(1, get_u16(host.frame_end + 20));
}

#if EL_WITH_REUSE

/* Lines that have not changed are left to the stream while it sends nothing; a frame that it sends it sees whole, and what
 * was changed meanwhile arrives. */
static void test_what_is_unchanged_is_left_out_of_frames_that_are_not_sent(void)
{
    const el_stats stats = {0};
    open_device(16, 100, 8, "00 00 00 00 03 00");
    draw();
    for (size_t i = 0; i < 16 * 30; i++) {
        dev.pixels[i] ^= 0x0F0F;
    }
    device_draw(&dev); /* no credits: it sees the change and does not send it */
    for (unsigned frame = 0; frame < 3; frame++) {
        dev.sink.begin(dev.sink.context, 16, 100);
        TEST_ASSERT_TRUE(dev.sink.unchanged(dev.sink.context, 0, 100));
        dev.sink.end(dev.sink.context, &stats);
    }
    host_packet(&wire, EL_PACKET_ACK, "00 00 01");
    dev.sink.begin(dev.sink.context, 16, 100);
    TEST_ASSERT_FALSE(dev.sink.unchanged(dev.sink.context, 0, 100));
    TEST_ASSERT_FALSE(dev.sink.unchanged(dev.sink.context, 8, 8));
    dev.sink.end(dev.sink.context, &stats);
}

#endif

/* Equal lines share packets up to the largest: 100 flat lines of one band are one packet, noise fills each. */
static void test_lines_share_packets(void)
{
    open_device(64, 100, 100, "00 02 00 00 03 00");
    draw();
    TEST_ASSERT_EQUAL_UINT32(1, host.raw_bands + host.run_bands);
    for (size_t i = 0; i < 64 * 100; i++) {
        dev.pixels[i] = (uint16_t)random_u32(&seed);
    }
    draw();
    TEST_ASSERT_EQUAL_UINT32(1 + (100 + 6) / 7, host.raw_bands + host.run_bands); /* 7 lines of 128 bytes in 1010 */
}

/* One way: HELLO, then all lines of every frame, without a word from the host. */
static void test_one_way(void)
{
    device_init(&dev, &wire, 32, 32, true);
    TEST_ASSERT_TRUE(el_stream_ready(&dev.stream));
    host_packet(&wire, EL_PACKET_STOP, ""); /* not heard */
    for (uint32_t frame = 0; frame < 40; frame++) {
        device_draw(&dev);
        host_listen(&host, &wire);
        TEST_ASSERT_EQUAL_UINT32(32 * (frame + 1), host.lines);
        wire.clock_us += 100000;
    }
    TEST_ASSERT_EQUAL_UINT32(40, host.frames);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames + host.damaged + host.gaps);
    TEST_ASSERT_EQUAL_UINT32(4, host.hellos);
    TEST_ASSERT_EQUAL_HEX32(EL_STREAM_RAW | EL_STREAM_RUNS, host.capabilities);

    wire.room = 10; /* nobody reads for a while: one frame is torn, the next is whole */
    device_draw(&dev);
    TEST_ASSERT_EQUAL_UINT32(1000, wire.waits);
    wire.room = FAKE_OUT_BYTES;
    device_draw(&dev);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(41, host.frames);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames);
    TEST_ASSERT_EQUAL_UINT32(1, get_u16(host.frame_end + 20));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_seeded_pictures_of_all_shapes);
    RUN_TEST(test_a_host_gets_only_codecs_that_it_has);
    RUN_TEST(test_the_smaller_codec);
    RUN_TEST(test_the_first_frame_has_all_lines_and_later_ones_what_changed);
    RUN_TEST(test_every_line_is_refreshed);
    RUN_TEST(test_frames_that_are_not_sent_change_nothing);
#if EL_WITH_REUSE
    RUN_TEST(test_what_is_unchanged_is_left_out_of_frames_that_are_not_sent);
#endif
    RUN_TEST(test_lines_share_packets);
    RUN_TEST(test_one_way);
    return UNITY_END();
}
