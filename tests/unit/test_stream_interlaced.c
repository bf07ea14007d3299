/* Interlaced frames through the wire: the host has the lines that were sent, and those of the frame before between them;
 * each FRAME_END says that its picture is mixed, and has its digest. */
#include "stream_device.h"

enum { WIDTH = 50, HEIGHT = 37, FRAMES = 40 };

static fake_link wire;
static test_device dev;
static host_view host;
static uint16_t shown[WIDTH * HEIGHT]; /* what the host is to have */
static uint32_t seed;

void setUp(void)
{
    fake_link_init(&wire);
    memset(&host, 0, sizeof host);
    seed = 20261122;
}

void tearDown(void)
{
}

/* The even lines of the picture, or the odd ones, in bands of so many. */
static void draw_field(unsigned first, unsigned band_lines)
{
    static const el_stats stats;
    dev.sink.begin(dev.sink.context, WIDTH, HEIGHT);
    for (unsigned y = first; y < HEIGHT; y += 2 * band_lines) {
        uint16_t pixels[WIDTH * HEIGHT];
        el_band band = {.pixels = pixels, .width = WIDTH, .y = (uint16_t)y, .gap = 1, .held = {1}};
        for (; band.lines < band_lines && y + 2U * band.lines < HEIGHT; band.lines++) {
            const unsigned at = (y + 2U * band.lines) * WIDTH;
            memcpy(pixels + band.lines * WIDTH, dev.pixels + at, 2 * WIDTH);
            memcpy(shown + at, dev.pixels + at, 2 * WIDTH);
        }
        dev.sink.rows(dev.sink.context, &band, 0);
        TEST_ASSERT_TRUE_MESSAGE(el_band_is_free(&band), "the stream keeps a band");
        memset(pixels, 0xEE, sizeof pixels);
    }
    dev.sink.end(dev.sink.context, &stats);
    device_check_guards(&dev);
}

/* Returns how many lines were sent. */
static uint32_t send_field(unsigned first, unsigned band_lines)
{
    const uint32_t frames = host.frames;
    const uint32_t lines = host.lines;
    host_packet(&wire, EL_PACKET_ACK, "00 00 01");
    wire.in_count -= wire.in_read;
    memmove(wire.in, wire.in + wire.in_read, wire.in_count);
    wire.in_read = 0;
    wire.out_count = 0;
    wire.out_read = 0;
    wire.room = FAKE_OUT_BYTES;
    draw_field(first, band_lines);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(frames + 1, host.frames);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames + host.damaged + host.gaps);
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(1, host.frame_end[23] & 1U, "not mixed");
    return host.lines - lines;
}

static void change_picture(void)
{
    const uint32_t y = random_below(&seed, HEIGHT);
    const uint32_t end = y + 1 + random_below(&seed, HEIGHT - y);
    for (uint32_t i = y * WIDTH; i < end * WIDTH; i++) {
        dev.pixels[i] = (uint16_t)random_u32(&seed);
    }
}

/* Codecs: raw, runs, both, and split streams, in the mode BLOCK. */
static void test_the_host_has_both_fields(void)
{
    static const char *const starts[] = {"00 02 00 00 01 00", "00 02 00 00 02 00", "00 02 00 00 03 00",
                                         "00 02 00 00 07 00"};
    for (unsigned i = 0; i < 4; i++) {
        setUp();
        device_init(&dev, &wire, WIDTH, HEIGHT, false);
        TEST_ASSERT_TRUE(dev.sink.takes_gaps);
        el_stream_poll(&dev.stream);
        host_packet(&wire, EL_PACKET_START, starts[i]);
        host_listen(&host, &wire);
        change_picture();
        TEST_ASSERT_EQUAL_UINT32((HEIGHT + 1) / 2, send_field(0, 4));
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(2, host.frame_end[23] & 2U, "the other lines are still due");
        TEST_ASSERT_EQUAL_UINT32(HEIGHT / 2, send_field(1, 4));
        TEST_ASSERT_EQUAL_UINT8(0, host.frame_end[23] & 2U);
        for (unsigned frame = 0; frame < FRAMES; frame++) {
            change_picture();
            (void)send_field(frame % 2, 1 + random_below(&seed, 20));
            TEST_ASSERT_EQUAL_HEX16_ARRAY(shown, host.pixels, (size_t)WIDTH * HEIGHT);
        }
        /* What stands still costs the refreshed lines alone. */
        (void)send_field(0, 3);
        (void)send_field(1, 3);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(2, send_field(0, 3));
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(2, send_field(1, 3));
        TEST_ASSERT_EQUAL_HEX16_ARRAY(dev.pixels, host.pixels, (size_t)WIDTH * HEIGHT);
    }
}

/* Nobody can ask for what is missing. */
static void test_one_way_takes_no_gaps(void)
{
    device_init(&dev, &wire, WIDTH, HEIGHT, true);
    TEST_ASSERT_FALSE(dev.sink.takes_gaps);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_host_has_both_fields);
    RUN_TEST(test_one_way_takes_no_gaps);
    return UNITY_END();
}
