/* Mode ROLL: rendering never waits, the picture comes in pieces, and what FRAME_END says of it is true of it. The codecs
 * are 0 and 1, which the host of these tests knows; tests/link has codec 2. */
#include "stream_device.h"

enum { WIDTH = 40, HEIGHT = 30 };

static fake_link wire;
static test_device dev;
static host_view host;
static uint32_t seed;

void setUp(void)
{
    fake_link_init(&wire);
    memset(&host, 0, sizeof host);
    device_init(&dev, &wire, WIDTH, HEIGHT, false);
    seed = 77;
}

void tearDown(void)
{
}

static void start(const char *hex)
{
    host_packet(&wire, EL_PACKET_START, hex);
    el_stream_poll(&dev.stream);
    host_listen(&host, &wire);
}

static void noise(uint32_t y0, uint32_t y1)
{
    for (uint32_t i = y0 * WIDTH; i < y1 * WIDTH; i++) {
        dev.pixels[i] = (uint16_t)random_u32(&seed);
    }
}

/* A frame over a link that takes `room` bytes during it; it never waits for more. Returns 1 if it was sent. */
static uint32_t draw_and_leave(size_t room)
{
    wire.room = room;
    device_draw(&dev);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, wire.waits, "it waits");
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames + host.damaged + host.gaps);
    return dev.stream.dropped == 0;
}

static void empty_the_queue(void)
{
    const size_t most = wire.most;
    wire.most = FAKE_OUT_BYTES;
    wire.room = FAKE_OUT_BYTES;
    el_stream_poll(&dev.stream);
    host_listen(&host, &wire);
    wire.most = most;
}

/* The same with a queue that is empty when the frame begins, and again afterwards. */
static uint32_t draw(size_t room)
{
    empty_the_queue();
    const uint32_t frames = host.frames;
    const uint32_t sent = draw_and_leave(room);
    empty_the_queue();
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames + host.damaged + host.gaps);
    TEST_ASSERT_EQUAL_UINT32(sent, host.frames - frames);
    return sent;
}

static bool is_mixed(void)
{
    return (host.frame_end[23] & 1) != 0;
}

static bool is_owing(void)
{
    return (host.frame_end[23] & 2) != 0;
}

static bool shows_the_picture(void)
{
    return memcmp(host.pixels, dev.pixels, 2 * WIDTH * HEIGHT) == 0;
}

/* --- A link that is fast enough -------------------------------------------------------------------------------- */

static void test_a_fast_link_gets_whole_frames(void)
{
    start("01 FF 00 00 03 00");
    for (int i = 0; i < 50; i++) {
        noise(random_below(&seed, HEIGHT), HEIGHT);
        TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
        TEST_ASSERT_FALSE(is_mixed() || is_owing());
        TEST_ASSERT_TRUE(shows_the_picture());
        TEST_ASSERT_EQUAL_UINT32(0, get_u16(host.frame_end + 20));
    }
}

/* --- One that is not ------------------------------------------------------------------------------------------- */

/* The picture stands still: frame by frame it is built up, and from the first to the last line none is sent twice. */
static void test_the_picture_is_built_up(void)
{
    uint32_t frames = 0;
    noise(0, HEIGHT);
    start("01 FF 00 00 01 00");
    for (; frames == 0 || is_owing(); frames++) {
        const uint32_t lines = host.lines;
        TEST_ASSERT_EQUAL_UINT32(1, draw(200));
        TEST_ASSERT_GREATER_THAN_UINT32(lines, host.lines);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(HEIGHT, host.lines);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(2, frames);
    TEST_ASSERT_EQUAL_UINT32(HEIGHT, host.lines);
    TEST_ASSERT_FALSE(is_mixed());
    TEST_ASSERT_TRUE(shows_the_picture());
    TEST_ASSERT_EQUAL_UINT32(1, draw(200));
    TEST_ASSERT_EQUAL_UINT32(HEIGHT + EL_STREAM_REFRESH_LINES, host.lines);
}

/* Noise in all lines, more than the link takes: every line has its turn, and the host's picture is the digest's. */
static void test_no_line_starves(void)
{
    uint32_t age[HEIGHT] = {0};
    start("01 FF 00 00 03 00");
    for (int i = 0; i < 200; i++) {
        uint16_t before[WIDTH * HEIGHT];
        memcpy(before, host.pixels, sizeof before);
        host_packet(&wire, EL_PACKET_ACK, "00 00 01");
        noise(0, HEIGHT);
        TEST_ASSERT_EQUAL_UINT32(1, draw(500 + random_below(&seed, 400)));
        TEST_ASSERT_TRUE(is_mixed());
        TEST_ASSERT_TRUE(i < 10 || !is_owing());
        for (uint32_t y = 0; y < HEIGHT; y++) {
            const bool new = memcmp(before + y * WIDTH, host.pixels + y * WIDTH, 2 * WIDTH) != 0;
            age[y] = new ? 0 : age[y] + 1;
            TEST_ASSERT_LESS_THAN_UINT32(8, age[y]);
        }
    }
}

/* Only the lines above the cursor change: the frame that leaves them out says that it is mixed, the next one has them. */
static void test_lines_above_the_cursor_have_the_next_turn(void)
{
    start("01 FF 00 00 01 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(600));
    TEST_ASSERT_TRUE(is_mixed());
    noise(0, 1);
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES)); /* from the cursor to the end */
    TEST_ASSERT_TRUE(is_mixed());
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
    TEST_ASSERT_FALSE(is_mixed());
    TEST_ASSERT_TRUE(shows_the_picture());
}

static void test_what_changed_back_is_not_mixed(void)
{
    uint16_t before[WIDTH * HEIGHT];
    start("01 FF 00 00 01 00");
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
    memcpy(before, dev.pixels, sizeof before);
    noise(10, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(300)); /* lines 10 and some */
    TEST_ASSERT_TRUE(is_mixed());
    memcpy(dev.pixels, before, sizeof before);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
    }
    TEST_ASSERT_FALSE(is_mixed());
    TEST_ASSERT_TRUE(shows_the_picture());
}

/* A link that takes nothing: no frame, no credit, no wait; and it goes on where it stood. */
static void test_a_full_link_costs_nothing(void)
{
    start("01 03 00 00 01 00");
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw_and_leave(0)); /* into the queue, which is full then */
    TEST_ASSERT_EQUAL_UINT8(2, dev.stream.credits);
    for (int i = 0; i < 20; i++) {
        noise(0, HEIGHT);
        TEST_ASSERT_EQUAL_UINT32(0, draw_and_leave(0));
    }
    TEST_ASSERT_EQUAL_UINT8(2, dev.stream.credits);
    TEST_ASSERT_EQUAL_UINT32(0, dev.stream.stalls + host.frames);
    TEST_ASSERT_EQUAL_UINT32(1, draw_and_leave(FAKE_OUT_BYTES));
    TEST_ASSERT_EQUAL_UINT32(2, host.frames);
    TEST_ASSERT_EQUAL_UINT32(20, get_u16(host.frame_end + 20)); /* frames that were not sent */
    TEST_ASSERT_EQUAL_UINT8(1, dev.stream.credits);
}

/* Fills the queue so that it has room for a packet with `body_bytes` and not for a LOG of one byte besides, which takes its
 * byte, what every packet has and two bytes of COBS. */
static void fill_the_queue(size_t body_bytes)
{
    const size_t log_bytes = 1 + EL_PACKET_OVERHEAD_BYTES + 2;
    wire.room = 0;
    while (el_packet_fits(&dev.stream.writer, body_bytes + log_bytes)) {
        TEST_ASSERT_EQUAL_INT32(1, el_stream_log(&dev.stream, "x", 1));
    }
    TEST_ASSERT_TRUE(el_packet_fits(&dev.stream.writer, body_bytes));
}

/* With room for FRAME_END alone: a picture of which nothing new could be sent is no frame. */
static void test_a_frame_without_its_lines_is_none(void)
{
    start("01 03 00 00 01 00");
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
    fill_the_queue(EL_STREAM_FRAME_END_BYTES + 20);
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(0, draw_and_leave(0));
    TEST_ASSERT_EQUAL_UINT8(2, dev.stream.credits);
}

/* Nor is one whose end has no room, though nothing has changed from the cursor on. */
static void test_a_frame_without_its_end_is_none(void)
{
    start("01 FF 00 00 01 00");
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
    uint16_t before[WIDTH * HEIGHT];
    memcpy(before, dev.pixels, sizeof before);
    noise(10, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(300));
    TEST_ASSERT_GREATER_THAN_UINT32(10, dev.stream.cursor);
    memcpy(dev.pixels, before, sizeof before);
    fill_the_queue(EL_STREAM_FRAME_END_BYTES - 20);
    TEST_ASSERT_EQUAL_UINT32(0, draw_and_leave(0));
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
}

static void test_start_begins_at_the_top(void)
{
    start("01 FF 00 00 01 00");
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(300));
    start("01 FF 00 00 01 00");
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(300));
    TEST_ASSERT_EQUAL_HEX16_ARRAY(dev.pixels, host.pixels, WIDTH);
}

/* The queue's room is FRAME_END's, whatever else waits for a chance: HELLO for a PING in the middle of a frame comes after. */
static void test_a_ping_in_the_middle_of_a_frame_takes_no_frame_end_s_place(void)
{
    for (size_t room = 0; room < 1500; room += 50) {
        setUp();
        start("01 FF 00 00 01 00");
        noise(0, HEIGHT);
        wire.room = room;
        el_stats stats = {0};
        dev.sink.begin(dev.sink.context, WIDTH, HEIGHT);
        for (uint32_t y = 0; y < HEIGHT; y++) {
            el_band band = {.pixels = dev.pixels + y * WIDTH, .width = WIDTH, .y = (uint16_t)y, .lines = 1};
            dev.sink.rows(dev.sink.context, &band, 0);
            host_packet(&wire, EL_PACKET_PING, "01 02");
            dev.sink.wait(dev.sink.context);
        }
        TEST_ASSERT_TRUE(el_packet_fits(&dev.stream.writer, EL_STREAM_FRAME_END_BYTES));
        dev.sink.end(dev.sink.context, &stats);
        empty_the_queue();
        TEST_ASSERT_EQUAL_UINT32(1, host.frames);
        TEST_ASSERT_GREATER_THAN_UINT32(1, host.hellos);
        TEST_ASSERT_EQUAL_UINT32(0, wire.waits + host.bad_frames + host.damaged + host.gaps);
    }
}

static void test_log_never_waits(void)
{
    start("01 FF 00 00 03 00");
    wire.room = 0;
    int32_t sent = 0;
    for (int i = 0; i < 200; i++) {
        sent += el_stream_log(&dev.stream, "0123456789", 10);
    }
    TEST_ASSERT_GREATER_THAN_INT32(0, sent);
    TEST_ASSERT_LESS_THAN_INT32(2000, sent);
    TEST_ASSERT_EQUAL_UINT32(0, wire.waits);
}

/* --- KEY and refreshing ---------------------------------------------------------------------------------------- */

static void test_key_is_owed_until_it_is_met(void)
{
    start("01 FF 00 00 01 00");
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
    memset(host.pixels, 0x55, sizeof host.pixels);
    host_packet(&wire, EL_PACKET_KEY, "00 00 FF FF");
    int frames = 0;
    do {
        TEST_ASSERT_EQUAL_UINT32(1, draw(500));
        frames++;
    } while (is_owing());
    TEST_ASSERT_GREATER_THAN_INT(2, frames);
    TEST_ASSERT_TRUE(shows_the_picture());
}

/* A host's picture that is wrong in a way that no CRC shows becomes right line by line, under changes that never end. */
static void test_every_line_is_refreshed(void)
{
    start("01 FF 00 00 01 00");
    noise(0, HEIGHT);
    TEST_ASSERT_EQUAL_UINT32(1, draw(FAKE_OUT_BYTES));
    bool sent[HEIGHT] = {false};
    for (int i = 0; i < 3 * HEIGHT; i++) {
        const uint32_t busy = 10; /* lines that change all the time, more than the link takes */
        memset(host.pixels, 0x55, sizeof host.pixels);
        host_packet(&wire, EL_PACKET_ACK, "00 00 01");
        noise(busy, 2 * busy);
        wire.room = 600;
        device_draw(&dev);
        host_listen(&host, &wire); /* a bad frame, of course */
        for (uint32_t y = 0; y < HEIGHT; y++) {
            sent[y] = sent[y] || host.pixels[y * WIDTH] != 0x5555;
        }
    }
    for (uint32_t y = 0; y < HEIGHT; y++) {
        TEST_ASSERT_TRUE(sent[y]);
    }
}

/* --- Anything -------------------------------------------------------------------------------------------------- */

/* Any changes, sizes of bands, codecs and links: each FRAME_END's digest is that of the picture that the host has, unless
 * lines are owed; a frame that is not mixed is the picture. */
static void test_seeded_links_and_pictures(void)
{
    static const char *const starts[] = {"01 FF 00 00 01 00", "01 FF 00 00 02 00", "01 FF 00 00 03 00"};
    uint32_t proven = 0;
    for (int round = 0; round < 90; round++) {
        const uint32_t next_seed = seed + 1;
        setUp();
        seed = next_seed * 2654435761U | 1U;
        dev.band_lines = (uint16_t)(1 + random_below(&seed, HEIGHT));
        start(starts[round % 3]);
        for (int frame = 0; frame < 60; frame++) {
            if (random_below(&seed, 2) == 0) {
                const uint32_t y = random_below(&seed, HEIGHT);
                noise(y, y + 1 + random_below(&seed, HEIGHT - y));
            }
            if (random_below(&seed, 12) == 0) {
                host_packet(&wire, EL_PACKET_KEY, "05 00 09 00");
            }
            if (random_below(&seed, 40) == 0) {
                start(starts[round % 3]);
            }
            wire.most = 1 + random_below(&seed, 300);
            const size_t room = random_below(&seed, 3) == 0 ? 0 : random_below(&seed, 2500);
            if (random_below(&seed, 2) == 0) {
                draw_and_leave(room);
            } else if (draw(room) == 1 && !is_mixed() && !is_owing()) {
                TEST_ASSERT_TRUE(shows_the_picture());
                proven++;
            }
        }
        seed = next_seed;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(500, proven);
}

/* --- Who knows ROLL -------------------------------------------------------------------------------------------- */

/* A line's largest packet and FRAME_END go into the queue at once, at each width that the device says it can roll. */
static void test_the_queue_is_large_enough_where_it_says_so(void)
{
    static uint8_t queue[8192];
    for (int32_t width = 1; width <= EL_STREAM_MAX_SIZE; width++) {
        el_packet_writer writer;
        el_packet_writer_init(&writer, queue, (uint16_t)EL_STREAM_ROLL_WIRE_BYTES(width), NULL, NULL);
        const size_t line = (size_t)EL_STREAM_ONE_LINE_BYTES(width) - EL_PACKET_OVERHEAD_BYTES;
        TEST_ASSERT_TRUE(el_packet_fits(&writer, line + EL_STREAM_RESERVE_BYTES));
        TEST_ASSERT_GREATER_OR_EQUAL_INT32(EL_STREAM_LINE_PACKET_BYTES(width), EL_STREAM_ONE_LINE_BYTES(width));
    }
}

static void test_a_width_too_large_to_roll(void)
{
    static uint8_t memory[EL_STREAM_MEMORY_BYTES(EL_STREAM_MAX_SIZE, 1)];
    el_stream_config config = device_config(&dev, EL_STREAM_MAX_SIZE, 1);
    config.memory = memory;
    config.memory_bytes = sizeof memory;
    TEST_ASSERT_EQUAL_INT(0, el_stream_init(&dev.stream, &config));
    start("01 FF 00 00 01 00");
    TEST_ASSERT_EQUAL_HEX32(0, host.capabilities & EL_STREAM_ROLL);
    TEST_ASSERT_EQUAL_STRING("START refused: this device knows mode 0 (BLOCK) only", host.log);
    TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_fast_link_gets_whole_frames);
    RUN_TEST(test_the_picture_is_built_up);
    RUN_TEST(test_no_line_starves);
    RUN_TEST(test_lines_above_the_cursor_have_the_next_turn);
    RUN_TEST(test_what_changed_back_is_not_mixed);
    RUN_TEST(test_a_full_link_costs_nothing);
    RUN_TEST(test_a_frame_without_its_lines_is_none);
    RUN_TEST(test_a_frame_without_its_end_is_none);
    RUN_TEST(test_start_begins_at_the_top);
    RUN_TEST(test_a_ping_in_the_middle_of_a_frame_takes_no_frame_end_s_place);
    RUN_TEST(test_log_never_waits);
    RUN_TEST(test_key_is_owed_until_it_is_met);
    RUN_TEST(test_every_line_is_refreshed);
    RUN_TEST(test_seeded_links_and_pictures);
    RUN_TEST(test_the_queue_is_large_enough_where_it_says_so);
    RUN_TEST(test_a_width_too_large_to_roll);
    return UNITY_END();
}
