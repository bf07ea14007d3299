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
        {"00 FF FF FF 7F 99 98", 0, INT32_MAX}, /* a later version's, longer */
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
    host_packet(link, EL_PACKET_INPUT, "03 01 00 00 00");
}

static void test_input_in_the_middle_of_a_frame_disturbs_nothing(void)
{
    host_packet(&wire, EL_PACKET_START, "00 02 00 00 03 00");
    wire.room = 40;
    wire.room_per_wait = 10;
    wire.on_wait = send_input;
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    expect_input(1, EL_CONTROL_PAUSE, 1);
    TEST_ASSERT_EQUAL_UINT32(1, draw());
    TEST_ASSERT_EQUAL_UINT32(0, host.damaged + host.gaps);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_values_arrive_whole);
    RUN_TEST(test_a_program_without_input_says_so_and_ignores_it);
    RUN_TEST(test_one_way_takes_no_input);
    RUN_TEST(test_a_frame_that_was_chosen_before_the_input_is_not_sent);
    RUN_TEST(test_input_in_the_middle_of_a_frame_disturbs_nothing);
    return UNITY_END();
}
