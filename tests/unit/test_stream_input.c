/* INPUT: it reaches the program whole, in any state, and the host knows which frame is the first to show it. */
#include "stream_device.h"

static fake_link wire;
static test_device dev;
static host_view host;

void setUp(void)
{
    fake_link_init(&wire);
    memset(&host, 0, sizeof host);
    device_init(&dev, &wire, 16, 20, false);
}

void tearDown(void)
{
}

/* As many frames as were sent, whole and proven. */
static uint32_t draw(void)
{
    uint32_t frames = host.frames;
    dev.pixels[0]++;
    device_draw(&dev);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames);
    return host.frames - frames;
}

static void expect_input(uint32_t inputs, uint8_t control, int32_t value)
{
    TEST_ASSERT_EQUAL_UINT32(inputs, dev.inputs);
    TEST_ASSERT_EQUAL_UINT8(control, dev.control);
    TEST_ASSERT_EQUAL_INT32(value, dev.value);
}

static void test_values_arrive_whole(void)
{
    static const struct {
        const char *hex;
        uint8_t control;
        int32_t value;
    } vectors[] = {
        {"01 03 00 00 00", EL_CONTROL_SCENE, 3},
        {"02 78 56 34 12", EL_CONTROL_FRAME, 0x12345678},
        {"FF FF FF FF FF", 255, -1},
        {"80 00 00 00 80", 128, INT32_MIN},
        {"00 FF FF FF 7F 01 98", 0, INT32_MAX}, /* a later version's, longer */
    };
    for (uint32_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
        host_packet(&wire, EL_PACKET_INPUT, vectors[i].hex);
        el_stream_poll(&dev.stream);
        expect_input(i + 1, vectors[i].control, vectors[i].value);
    }
    host_packet(&wire, EL_PACKET_INPUT, "01 00 00 00"); /* a byte too short */
    el_stream_poll(&dev.stream);
    TEST_ASSERT_EQUAL_UINT32(5, dev.inputs);
    TEST_ASSERT_EQUAL_UINT32(1, dev.stream.damaged);
}

/* Numbers: what was missed, comes twice or too early is not taken; HELLO and FRAME_END tell how far the device is. */

static uint8_t numbered(uint32_t number)
{
    const uint8_t body[6] = {EL_CONTROL_FRAME, (uint8_t)number, (uint8_t)(number >> 8), 0, 0, (uint8_t)number};
    uint8_t packet[32];
    const uint32_t before = dev.inputs;
    host_bytes(&wire, packet, make_packet(EL_PACKET_INPUT, wire.host_seq++, body, sizeof body, packet));
    el_stream_poll(&dev.stream);
    return (uint8_t)(dev.inputs - before);
}

static void test_each_number_counts_once_and_in_its_turn(void)
{
    for (uint32_t next = 1; next <= 600; next++) { /* they wrap twice */
        TEST_ASSERT_EQUAL_UINT8(0, numbered(next + 1));
        TEST_ASSERT_EQUAL_UINT8(0, numbered(next + 3));
        TEST_ASSERT_EQUAL_UINT8(1, numbered(next));
        expect_input(next, EL_CONTROL_FRAME, (int32_t)next);
        TEST_ASSERT_EQUAL_UINT8(0, numbered(next));
        TEST_ASSERT_EQUAL_UINT8(0, numbered(next - 1));
        wire.in_count = wire.in_read = 0;
    }
}

static void test_hello_and_frame_end_tell_the_last_number(void)
{
    for (uint32_t number = 1; number <= 3; number++) {
        TEST_ASSERT_EQUAL_UINT8(1, numbered(number));
    }
    host_packet(&wire, EL_PACKET_PING, "01 02");
    host_packet(&wire, EL_PACKET_START, "00 02 00 00 03 00");
    el_stream_poll(&dev.stream);
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT32(3, host.input_number);
    TEST_ASSERT_EQUAL_UINT8(3, host.frame_end[22]);
    host_packet(&wire, EL_PACKET_INPUT, "03 01 00 00 00"); /* a 1.1 host's has no number, and takes none */
    el_stream_poll(&dev.stream);
    expect_input(4, EL_CONTROL_PAUSE, 1);
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT8(3, host.frame_end[22]);
}

static void test_a_start_of_the_device_begins_with_number_0(void)
{
    TEST_ASSERT_EQUAL_UINT8(1, numbered(1));
    device_init(&dev, &wire, 16, 20, false);
    TEST_ASSERT_EQUAL_UINT8(0, numbered(2));
    TEST_ASSERT_EQUAL_UINT8(1, numbered(1));
}

static void test_a_program_without_input_says_so_and_ignores_it(void)
{
    el_stream_config config = device_config(&dev, 16, 20);
    config.input = NULL;
    TEST_ASSERT_EQUAL_INT(0, el_stream_init(&dev.stream, &config));
    host_packet(&wire, EL_PACKET_INPUT, "01 03 00 00 00");
    host_packet(&wire, EL_PACKET_START, "00 01 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_HEX32(0, host.capabilities & EL_STREAM_INPUT);
    TEST_ASSERT_EQUAL_UINT32(0, dev.inputs);
}

static void test_one_way_takes_no_input(void)
{
    device_init(&dev, &wire, 16, 20, true);
    host_packet(&wire, EL_PACKET_INPUT, "01 03 00 00 00");
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_HEX32(0, host.capabilities & EL_STREAM_INPUT);
    TEST_ASSERT_EQUAL_UINT32(0, dev.inputs);
}

/* The renderer has its scene before the sink's `begin` reads the INPUT, so that frame would show the old one. */
static void test_a_frame_that_was_chosen_before_the_input_is_not_sent(void)
{
    host_packet(&wire, EL_PACKET_INPUT, "01 03 00 00 00");
    host_packet(&wire, EL_PACKET_START, "00 02 00 00 03 00");
    TEST_ASSERT_EQUAL_UINT32(0, draw());
    expect_input(1, EL_CONTROL_SCENE, 3);
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT32(1, get_u16(host.frame_end + 20)); /* frames that were not sent */

    host_packet(&wire, EL_PACKET_INPUT, "02 09 00 00 00");
    el_stream_poll(&dev.stream); /* read between two frames: the next one shows it */
    TEST_ASSERT_EQUAL_UINT32(1, draw());
}

static void send_input(fake_link *link)
{
    link->on_wait = NULL;
    host_packet(link, EL_PACKET_INPUT, "03 01 00 00 00 01");
}

static void test_input_in_the_middle_of_a_frame_disturbs_nothing(void)
{
    host_packet(&wire, EL_PACKET_START, "00 02 00 00 03 00");
    wire.room = 40;
    wire.room_per_wait = 10;
    wire.on_wait = send_input;
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    expect_input(1, EL_CONTROL_PAUSE, 1);
    TEST_ASSERT_EQUAL_UINT8(0, host.frame_end[22]); /* taken after that frame had begun */
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT8(1, host.frame_end[22]);
    TEST_ASSERT_EQUAL_UINT32(0, host.damaged + host.gaps);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_values_arrive_whole);
    RUN_TEST(test_each_number_counts_once_and_in_its_turn);
    RUN_TEST(test_hello_and_frame_end_tell_the_last_number);
    RUN_TEST(test_a_start_of_the_device_begins_with_number_0);
    RUN_TEST(test_a_program_without_input_says_so_and_ignores_it);
    RUN_TEST(test_one_way_takes_no_input);
    RUN_TEST(test_a_frame_that_was_chosen_before_the_input_is_not_sent);
    RUN_TEST(test_input_in_the_middle_of_a_frame_disturbs_nothing);
    return UNITY_END();
}
