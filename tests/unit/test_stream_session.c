/* The session: who may be sent what, and a link that is full, slow, silent, noisy or gone. */
#include "stream_device.h"

enum { SECOND_US = 1000000, WIDTH = 32, FRAME_BYTES = 1400 /* on the wire, a little less */ };

static fake_link wire;
static test_device dev;
static host_view host;

void setUp(void)
{
    fake_link_init(&wire);
    memset(&host, 0, sizeof host);
    device_init(&dev, &wire, WIDTH, 20, false);
}

void tearDown(void)
{
}

static void listen_and_poll(void)
{
    el_stream_poll(&dev.stream);
    host_listen(&host, &wire);
}

static void start(const char *body_hex)
{
    host_packet(&wire, EL_PACKET_START, body_hex);
    listen_and_poll();
}

/* Draws a frame of noise; returns 1 when the host has got it, whole and proven. */
static uint32_t draw(void)
{
    static uint32_t seed = 5;
    uint32_t frames = host.frames;
    for (uint32_t i = 0; i < WIDTH * 20; i++) {
        dev.pixels[i] = (uint16_t)random_u32(&seed);
    }
    device_draw(&dev);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames);
    return host.frames - frames;
}

/* --- Opening --------------------------------------------------------------------------------------------------- */

static int init_error(el_stream_config config)
{
    static el_stream stream;
    return el_stream_init(&stream, &config);
}

static void test_init_checks_its_configuration(void)
{
    static const char long_name[] = "12345678901234567890123456789012345678901234567890123456789012345";
    el_stream_config good = device_config(&dev, WIDTH, 20);
    el_stream_config bad = good;
    el_port port = dev.port;

    TEST_ASSERT_EQUAL_INT(0, init_error(good));
    bad.width = 0;
    TEST_ASSERT_EQUAL_INT(EL_STREAM_BAD_SIZE, init_error(bad));
    bad.width = 2041;
    TEST_ASSERT_EQUAL_INT(EL_STREAM_BAD_SIZE, init_error(bad));
    bad = good;
    bad.height = 2041;
    TEST_ASSERT_EQUAL_INT(EL_STREAM_BAD_SIZE, init_error(bad));
    bad = good;
    bad.memory_bytes--;
    TEST_ASSERT_EQUAL_INT(EL_STREAM_BAD_MEMORY, init_error(bad));
    bad = good;
    bad.memory = NULL;
    TEST_ASSERT_EQUAL_INT(EL_STREAM_BAD_MEMORY, init_error(bad));
    bad = good;
    bad.port = NULL;
    TEST_ASSERT_EQUAL_INT(EL_STREAM_BAD_PORT, init_error(bad));
    bad.port = &port;
    port.read = NULL;
    TEST_ASSERT_EQUAL_INT(EL_STREAM_BAD_PORT, init_error(bad));
    bad.one_way = true;
    TEST_ASSERT_EQUAL_INT(0, init_error(bad));
    bad = good;
    bad.target = long_name;
    TEST_ASSERT_EQUAL_INT(EL_STREAM_BAD_NAME, init_error(bad));
    bad.target = long_name + 1;
    TEST_ASSERT_EQUAL_INT(0, init_error(bad));
    bad.firmware = NULL;
    TEST_ASSERT_EQUAL_INT(EL_STREAM_BAD_NAME, init_error(bad));
}

/* --- Waiting for a host ---------------------------------------------------------------------------------------- */

static void test_hello_at_once_and_every_second(void)
{
    for (int ms = 0; ms <= 10000; ms++, wire.clock_us += 1000) {
        listen_and_poll();
        TEST_ASSERT_EQUAL_UINT32(1U + (uint32_t)ms / 1000, host.hellos);
    }
    TEST_ASSERT_EQUAL_UINT32(WIDTH, host.width);
    TEST_ASSERT_EQUAL_UINT32(20, host.height);
    TEST_ASSERT_EQUAL_HEX32(EL_STREAM_RAW | EL_STREAM_RUNS | EL_STREAM_SPLIT | EL_STREAM_PARTIAL | EL_STREAM_INPUT |
                                EL_STREAM_ROLL | EL_STREAM_SET_BAUD,
                            host.capabilities);
}

static void test_ping_is_answered_in_any_state(void)
{
    listen_and_poll();
    host_packet(&wire, EL_PACKET_PING, "");
    listen_and_poll();
    TEST_ASSERT_EQUAL_UINT32(2, host.hellos);
    start("00 09 00 00 03 00");
    host_packet(&wire, EL_PACKET_PING, "");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT32(3, host.hellos);
    TEST_ASSERT_EQUAL_UINT32(0, host.gaps);
}

static void test_nothing_but_hello_before_start(void)
{
    TEST_ASSERT_FALSE(el_stream_ready(&dev.stream));
    host_packet(&wire, EL_PACKET_ACK, "00 00 05");
    host_packet(&wire, EL_PACKET_KEY, "00 00 14 00");
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, draw());
    }
    TEST_ASSERT_EQUAL_UINT32(1, host.hellos);
    TEST_ASSERT_EQUAL_UINT32(0, host.lines);
}

/* Nobody takes a byte for an hour: polls do not wait, and HELLO is whole when somebody comes. */
static void test_waiting_with_a_full_port_never_blocks(void)
{
    wire.room = 7;
    for (int i = 0; i < 3600; i++, wire.clock_us += SECOND_US) {
        draw();
        TEST_ASSERT_EQUAL_UINT32(0, wire.waits);
    }
    wire.room = FAKE_OUT_BYTES;
    start("00 01 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_GREATER_THAN_UINT32(0, host.hellos);
    TEST_ASSERT_EQUAL_UINT32(0, host.damaged);
    TEST_ASSERT_EQUAL_UINT32(0, host.gaps);
}

static void test_start_that_cannot_be_met_is_refused_aloud(void)
{
    start("02 02 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, host.logs);
    TEST_ASSERT_EQUAL_STRING("START refused: this device knows modes 0 (BLOCK) and 1 (ROLL) only", host.log);
    start("00 02 00 00 08 00");
    TEST_ASSERT_EQUAL_UINT32(2, host.logs);
    TEST_ASSERT_EQUAL_STRING("START refused: it names no codec that this device sends", host.log);
    TEST_ASSERT_EQUAL_UINT32(0, draw());
    TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
}

/* --- Versions -------------------------------------------------------------------------------------------------- */

static void expect_refusals(uint32_t logs, const char *log)
{
    listen_and_poll();
    TEST_ASSERT_EQUAL_UINT32(logs, host.logs);
    TEST_ASSERT_EQUAL_STRING(log, host.log);
    TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
}

/* A host of another major version is told so, and gets HELLO, which tells it. */
static void test_a_host_of_another_version_is_named_and_not_listened_to(void)
{
    static const struct {
        const char *ping;
        const char *log;
    } hosts[] = {
        {"00 09", "this device has version 1 of the wire and takes nothing from a host of version 0"},
        {"02 00", "this device has version 1 of the wire and takes nothing from a host of version 2"},
        {"0A", "this device has version 1 of the wire and takes nothing from a host of version 10"},
        {"FF FF 01", "this device has version 1 of the wire and takes nothing from a host of version 255"},
    };
    listen_and_poll();
    for (uint32_t i = 0; i < sizeof hosts / sizeof hosts[0]; i++) {
        host_packet(&wire, EL_PACKET_PING, hosts[i].ping);
        expect_refusals(i + 1, hosts[i].log);
        TEST_ASSERT_EQUAL_UINT32(2 + i, host.hellos);
        host_packet(&wire, EL_PACKET_INPUT, "01 03 00 00 00 01");
        host_packet(&wire, EL_PACKET_START, "00 05 00 00 03 00");
        host_packet(&wire, EL_PACKET_SET_BAUD, "00 C2 01 00");
        TEST_ASSERT_EQUAL_UINT32(0, draw());
        TEST_ASSERT_EQUAL_UINT32(0, dev.inputs + host.bauds);
    }
    host_packet(&wire, EL_PACKET_PING, "01 09"); /* another host, of a later minor version */
    start("00 05 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
}

static void test_a_host_of_another_version_ends_the_stream(void)
{
    start("00 05 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    host_packet(&wire, EL_PACKET_PING, "02 00");
    expect_refusals(1, "this device has version 1 of the wire and takes nothing from a host of version 2");
    TEST_ASSERT_EQUAL_UINT32(0, draw());
    host_packet(&wire, EL_PACKET_PING, ""); /* a 1.1 host */
    start("00 05 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
}

/* --- Credits and rates ----------------------------------------------------------------------------------------- */

static void test_credits_are_frames(void)
{
    start("00 02 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_TRUE(el_stream_ready(&dev.stream));
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_FALSE(el_stream_ready(&dev.stream));
    TEST_ASSERT_EQUAL_UINT32(0, draw());
    TEST_ASSERT_EQUAL_UINT32(0, draw());
    host_packet(&wire, EL_PACKET_ACK, "01 00 01");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT32(4, get_u16(host.frame_end));      /* every frame is counted, */
    TEST_ASSERT_EQUAL_UINT32(2, get_u16(host.frame_end + 20)); /* and those that were not sent */
    TEST_ASSERT_EQUAL_UINT32(0, draw());
}

static void test_credits_stop_at_255(void)
{
    start("00 FF 00 00 03 00");
    host_packet(&wire, EL_PACKET_ACK, "00 00 FF");
    for (int i = 0; i < 255; i++) {
        TEST_ASSERT_EQUAL_UINT32(1, draw());
    }
    TEST_ASSERT_EQUAL_UINT32(0, draw());
}

static void test_no_credits_and_silence_for_a_second_end_the_session(void)
{
    start("00 01 00 00 03 00");
    wire.clock_us += 5 * SECOND_US; /* silence with credits ends nothing */
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    wire.clock_us += SECOND_US - 1;
    listen_and_poll();
    TEST_ASSERT_EQUAL_INT(EL_STREAM_RUNNING, dev.stream.state);
    host_packet(&wire, 0x7F, ""); /* any packet is a sign of life, one of a later version too */
    listen_and_poll();
    wire.clock_us += SECOND_US - 1;
    listen_and_poll();
    TEST_ASSERT_EQUAL_INT(EL_STREAM_RUNNING, dev.stream.state);
    wire.clock_us += 1;
    listen_and_poll();
    TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
    uint32_t hellos = host.hellos;
    wire.clock_us += SECOND_US;
    listen_and_poll();
    TEST_ASSERT_EQUAL_UINT32(hellos + 1, host.hellos);
    host_packet(&wire, EL_PACKET_ACK, "00 00 01"); /* too late */
    TEST_ASSERT_EQUAL_UINT32(0, draw());
}

/* 20 frames/s are asked for, the renderer makes 125: the stream takes one each 50 ms, and late ones do not add up. */
static void test_start_names_the_rate(void)
{
    uint32_t sent = 0;
    start("00 FF 14 00 03 00");
    for (int i = 0; i < 1250; i++, wire.clock_us += 8000) {
        sent += draw();
    }
    TEST_ASSERT_EQUAL_UINT32(200, sent);
    TEST_ASSERT_EQUAL_UINT32(1, host.hellos); /* none while a session runs */

    wire.clock_us = 1000; /* the first frame after START is due at once, whatever the clock says */
    start("00 01 01 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
}

static void test_stop_ends_the_session_and_start_begins_anew(void)
{
    start("00 05 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    host_packet(&wire, EL_PACKET_STOP, "");
    TEST_ASSERT_EQUAL_UINT32(0, draw());
    TEST_ASSERT_EQUAL_UINT32(0, draw());
    start("00 01 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT32(3, get_u16(host.frame_end));
    TEST_ASSERT_EQUAL_UINT32(0, get_u16(host.frame_end + 20)); /* of this session */
    TEST_ASSERT_EQUAL_UINT32(0, draw());                       /* the four old credits are void */
}

/* --- A host that speaks while a packet is on its way ----------------------------------------------------------- */

static const char *interruption_hex;
static uint8_t interruption_type;

static void interrupt_once(fake_link *link)
{
    if (interruption_hex != NULL) {
        host_packet(link, interruption_type, interruption_hex);
        interruption_hex = NULL;
    }
}

static void draw_interrupted(uint8_t type, const char *hex)
{
    interruption_type = type;
    interruption_hex = hex;
    wire.on_wait = interrupt_once;
    wire.room = 20; /* with the queue it is full in the second of three bands */
    wire.room_per_wait = 50;
    draw();
    wire.room = FAKE_OUT_BYTES;
    TEST_ASSERT_NULL(interruption_hex);
    listen_and_poll();
    TEST_ASSERT_EQUAL_UINT32(0, host.damaged);
    TEST_ASSERT_EQUAL_UINT32(0, host.gaps);
}

static void test_start_in_the_middle_of_a_frame_abandons_it(void)
{
    start("00 05 00 00 03 00");
    draw_interrupted(EL_PACKET_START, "00 02 00 00 01 00");
    TEST_ASSERT_EQUAL_UINT32(0, host.frames);
    TEST_ASSERT_LESS_THAN_UINT32(20, host.lines);
    uint32_t lines = host.lines;
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT32(lines + 20, host.lines);
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT32(0, draw());
}

/* The same within one band of several packets: the lines that were not sent stay due. */
static void test_start_in_the_middle_of_a_band_abandons_the_frame(void)
{
    device_init(&dev, &wire, 64, 20, false);
    dev.band_lines = 20;
    for (uint32_t i = 0; i < 64 * 20; i++) {
        dev.pixels[i] = (uint16_t)i;
    }
    start("00 05 00 00 03 00");
    interruption_type = EL_PACKET_START;
    interruption_hex = "00 02 00 00 03 00";
    wire.on_wait = interrupt_once;
    wire.room = 100;
    wire.room_per_wait = 50;
    device_draw(&dev);
    wire.room = FAKE_OUT_BYTES;
    listen_and_poll();
    TEST_ASSERT_EQUAL_UINT32(0, host.frames);
    TEST_ASSERT_EQUAL_UINT32(7, host.lines); /* the packet on its way, and no other */
    device_draw(&dev);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(1, host.frames);
    TEST_ASSERT_EQUAL_UINT32(7 + 20, host.lines);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames + host.damaged + host.gaps);
}

static void test_stop_in_the_middle_of_a_frame_abandons_it(void)
{
    start("00 05 00 00 03 00");
    draw_interrupted(EL_PACKET_STOP, "");
    TEST_ASSERT_EQUAL_UINT32(0, host.frames);
    TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
}

static void test_ping_in_the_middle_of_a_packet_is_answered_after_it(void)
{
    start("00 05 00 00 03 00");
    draw_interrupted(EL_PACKET_PING, "");
    TEST_ASSERT_EQUAL_UINT32(1, host.frames);
    TEST_ASSERT_EQUAL_UINT32(2, host.hellos);
}

/* KEY for lines that have just been sent: the next frame has them. */
static void test_key_in_the_middle_of_a_frame_is_kept(void)
{
    start("00 05 00 00 03 00");
    draw_interrupted(EL_PACKET_KEY, "00 00 02 00");
    TEST_ASSERT_EQUAL_UINT32(1, host.frames);
    uint32_t lines = host.lines;
    device_draw(&dev); /* the same picture */
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(2, host.frames);
    TEST_ASSERT_EQUAL_UINT32(lines + 2 + EL_STREAM_REFRESH_LINES, host.lines);
}

/* --- Bad links ------------------------------------------------------------------------------------------------- */

static void test_a_slow_link_delays_and_loses_nothing(void)
{
    start("00 FF 00 00 03 00");
    wire.room = 0;
    wire.room_per_wait = 1;
    wire.wait_us = EL_STREAM_BYTE_US;
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_UINT32(1, draw());
        /* The clock moves while it waits for the link alone, which is no time of rendering, nor are those cycles. */
        TEST_ASSERT_EQUAL_UINT32(0, get_u32(host.frame_end + 8));
        TEST_ASSERT_GREATER_THAN_UINT32(0, get_u32(host.frame_end + 12));
        TEST_ASSERT_EQUAL_UINT32(0, get_u32(host.frame_end + host.frame_end_bytes - 4));
    }
    TEST_ASSERT_EQUAL_UINT32(0, host.gaps);
}

/* The host takes nothing for a second in the middle of a frame, at every place of it. */
static void test_a_full_link_ends_the_session_after_a_second(void)
{
    for (size_t room = 0; room < FRAME_BYTES; room += 7) {
        setUp();
        start("00 05 00 00 03 00");
        wire.room = room;
        uint32_t before_us = wire.clock_us;
        TEST_ASSERT_EQUAL_UINT32(0, draw());
        TEST_ASSERT_EQUAL_UINT32(1000, wire.waits);
        TEST_ASSERT_EQUAL_UINT32(SECOND_US, wire.clock_us - before_us);
        TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
        TEST_ASSERT_EQUAL_UINT32(0, draw());
        TEST_ASSERT_EQUAL_UINT32(1000, wire.waits);

        wire.room = FAKE_OUT_BYTES; /* it is back: the torn packet is damage or nothing, all else is good */
        wire.clock_us += SECOND_US;
        listen_and_poll();
        TEST_ASSERT_EQUAL_UINT32(2, host.hellos);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(1, host.damaged);
        start("00 05 00 00 03 00");
        TEST_ASSERT_EQUAL_UINT32(1, draw());
    }
}

/* At every place of a frame the port says that the link is gone: it is not called again. */
static size_t room_until_gone;

static void go_away(fake_link *link)
{
    link->gone = true;
}

static void test_a_gone_link_is_left_alone(void)
{
    for (room_until_gone = 0; room_until_gone < FRAME_BYTES; room_until_gone += 11) {
        setUp();
        start("00 05 00 00 03 00");
        wire.room = room_until_gone;
        wire.on_wait = go_away;
        TEST_ASSERT_EQUAL_UINT32(0, draw());
        TEST_ASSERT_EQUAL_INT(EL_STREAM_GONE, dev.stream.state);
        TEST_ASSERT_EQUAL_INT(1, wire.calls_after_gone);
        TEST_ASSERT_EQUAL_UINT32(0, draw());
        TEST_ASSERT_FALSE(el_stream_ready(&dev.stream));
        TEST_ASSERT_EQUAL_INT(EL_STREAM_LINK_GONE, el_stream_poll(&dev.stream));
        TEST_ASSERT_EQUAL_INT32(EL_STREAM_LINK_GONE, el_stream_log(&dev.stream, "x", 1));
        TEST_ASSERT_FALSE(el_stream_flush(&dev.stream));
        TEST_ASSERT_EQUAL_INT(1, wire.calls_after_gone);
    }
}

static void test_damaged_input_is_counted_and_forgotten(void)
{
    uint8_t packet[64];
    start("00 01 00 00 03 00");
    size_t count = make_packet(EL_PACKET_ACK, 9, (const uint8_t *)"\0\0\5", 3, packet);
    packet[4] ^= 1;
    host_bytes(&wire, packet, count);
    host_packet(&wire, EL_PACKET_START, "00 01 00 00 03"); /* a byte too short */
    host_packet(&wire, EL_PACKET_ACK, "00 00");
    host_packet(&wire, EL_PACKET_KEY, "00 00 01");
    host_bytes(&wire, (const uint8_t *)"\0\0\0some text", 13); /* the terminator is a 00 too */
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT32(0, draw());
    TEST_ASSERT_EQUAL_UINT32(5, dev.stream.damaged);
}

static void test_gaps_in_the_hosts_seq_are_counted(void)
{
    wire.host_seq = 200;
    start("00 01 00 00 03 00"); /* a host may begin anywhere */
    wire.host_seq = 10;
    host_packet(&wire, EL_PACKET_ACK, "00 00 01");
    listen_and_poll();
    TEST_ASSERT_EQUAL_UINT32(256 - 201 + 10, dev.stream.missed);
    host_packet(&wire, EL_PACKET_ACK, "00 00 01 77 77"); /* a later version's, longer */
    listen_and_poll();
    TEST_ASSERT_EQUAL_UINT32(256 - 201 + 10, dev.stream.missed);
    TEST_ASSERT_EQUAL_UINT8(3, dev.stream.credits);
}

static void test_key_is_cut_at_the_height(void)
{
    start("00 FF 00 00 03 00");
    draw();
    host_packet(&wire, EL_PACKET_KEY, "12 00 FF FF"); /* lines 18 and 19 */
    host_packet(&wire, EL_PACKET_KEY, "FF FF FF FF"); /* none */
    uint32_t lines = host.lines;
    device_draw(&dev);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(lines + 2 + EL_STREAM_REFRESH_LINES, host.lines);
}

/* Bytes of no meaning without end: polls return, nothing is taken for a packet. */
static void test_a_flood_of_noise(void)
{
    static uint8_t noise[FAKE_IN_BYTES];
    uint32_t seed = 11;
    for (size_t i = 0; i < sizeof noise; i++) {
        noise[i] = (uint8_t)random_below(&seed, 40);
    }
    host_bytes(&wire, noise, sizeof noise);
    for (int i = 0; wire.in_read < wire.in_count; i++) {
        size_t before = wire.in_read;
        listen_and_poll();
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(256, wire.in_read - before);
    }
    TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
    TEST_ASSERT_GREATER_THAN_UINT32(100, dev.stream.damaged);
}

/* --- LOG ------------------------------------------------------------------------------------------------------- */

static void test_log_is_cut_at_a_character(void)
{
    char text[EL_STREAM_MAX_LOG_BYTES + 8];
    memset(text, 'x', sizeof text);
    memcpy(text + EL_STREAM_MAX_LOG_BYTES - 2, "\xE2\x82\xAC", 3); /* a euro sign, the limit inside it */
    TEST_ASSERT_EQUAL_INT32(EL_STREAM_MAX_LOG_BYTES - 2, el_stream_log(&dev.stream, text, sizeof text));
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_MAX_LOG_BYTES - 2, strlen(host.log));
}

static void test_log_without_a_host_never_waits(void)
{
    wire.room = 0;
    int32_t sent = 0;
    for (int i = 0; i < 100; i++) {
        sent += el_stream_log(&dev.stream, "0123456789", 10);
    }
    TEST_ASSERT_GREATER_THAN_INT32(0, sent);
    TEST_ASSERT_LESS_THAN_INT32(1000, sent);
    TEST_ASSERT_EQUAL_UINT32(0, wire.waits);
}

static void test_log_to_a_host_waits(void)
{
    start("00 01 00 00 03 00");
    wire.room = 0;
    wire.room_per_wait = 10;
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL_INT32(10, el_stream_log(&dev.stream, "0123456789", 10));
    }
    TEST_ASSERT_TRUE(el_stream_flush(&dev.stream));
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(100, host.logs);
}

static void test_a_renderer_of_another_size_is_told_off(void)
{
    start("00 01 00 00 03 00");
    dev.height = 19;
    TEST_ASSERT_EQUAL_UINT32(0, draw());
    TEST_ASSERT_EQUAL_STRING("the renderer's frames are not of the size that this stream has", host.log);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_init_checks_its_configuration);
    RUN_TEST(test_hello_at_once_and_every_second);
    RUN_TEST(test_ping_is_answered_in_any_state);
    RUN_TEST(test_nothing_but_hello_before_start);
    RUN_TEST(test_waiting_with_a_full_port_never_blocks);
    RUN_TEST(test_start_that_cannot_be_met_is_refused_aloud);
    RUN_TEST(test_a_host_of_another_version_is_named_and_not_listened_to);
    RUN_TEST(test_a_host_of_another_version_ends_the_stream);
    RUN_TEST(test_credits_are_frames);
    RUN_TEST(test_credits_stop_at_255);
    RUN_TEST(test_no_credits_and_silence_for_a_second_end_the_session);
    RUN_TEST(test_start_names_the_rate);
    RUN_TEST(test_stop_ends_the_session_and_start_begins_anew);
    RUN_TEST(test_start_in_the_middle_of_a_frame_abandons_it);
    RUN_TEST(test_start_in_the_middle_of_a_band_abandons_the_frame);
    RUN_TEST(test_stop_in_the_middle_of_a_frame_abandons_it);
    RUN_TEST(test_ping_in_the_middle_of_a_packet_is_answered_after_it);
    RUN_TEST(test_key_in_the_middle_of_a_frame_is_kept);
    RUN_TEST(test_a_slow_link_delays_and_loses_nothing);
    RUN_TEST(test_a_full_link_ends_the_session_after_a_second);
    RUN_TEST(test_a_gone_link_is_left_alone);
    RUN_TEST(test_damaged_input_is_counted_and_forgotten);
    RUN_TEST(test_gaps_in_the_hosts_seq_are_counted);
    RUN_TEST(test_key_is_cut_at_the_height);
    RUN_TEST(test_a_flood_of_noise);
    RUN_TEST(test_log_is_cut_at_a_character);
    RUN_TEST(test_log_without_a_host_never_waits);
    RUN_TEST(test_log_to_a_host_waits);
    RUN_TEST(test_a_renderer_of_another_size_is_told_off);
    return UNITY_END();
}
