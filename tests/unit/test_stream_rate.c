/* The link's rate: asked for, answered, changed when the last bit is out, and back at the first one when nobody is heard. */
#include <stdio.h>

#include "stream_device.h"

enum { SECOND_US = 1000000, FIRST = 115200, HIGH = 921600 };

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

/* Twice: an answer goes out in the first, what follows from that in the second. */
static void poll(void)
{
    el_stream_poll(&dev.stream);
    el_stream_poll(&dev.stream);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(0, host.damaged + host.gaps);
}

/* Polls each millisecond for `us`. */
static void pass(uint32_t us)
{
    for (uint32_t at = 0; at < us; at += 1000) {
        wire.clock_us += 1000;
        poll();
    }
}

static void ask(uint32_t rate)
{
    char hex[12];
    (void)snprintf(hex, sizeof hex, "%02X %02X %02X %02X", (unsigned)(rate & 255), (unsigned)(rate >> 8 & 255),
                   (unsigned)(rate >> 16 & 255), (unsigned)(rate >> 24));
    host_packet(&wire, EL_PACKET_SET_BAUD, hex);
    poll();
}

static void expect_rates(uint32_t answers, uint32_t answered, uint32_t now)
{
    TEST_ASSERT_EQUAL_UINT32(answers, host.bauds);
    TEST_ASSERT_EQUAL_UINT32(answered, host.baud);
    TEST_ASSERT_EQUAL_UINT32(now, wire.baud);
    TEST_ASSERT_EQUAL_UINT32(now, dev.stream.rate.now);
}

static void change_to_high(void)
{
    ask(HIGH);
    pass(10000);
    expect_rates(1, HIGH, HIGH);
    host_packet(&wire, EL_PACKET_PING, "01 02");
    poll();
    TEST_ASSERT_EQUAL_UINT32(HIGH, host.rate);
}

static void test_hello_names_the_rates(void)
{
    poll();
    TEST_ASSERT_EQUAL_HEX32(EL_STREAM_SET_BAUD, host.capabilities & EL_STREAM_SET_BAUD);
    TEST_ASSERT_EQUAL_UINT32(FIRST, host.rate);
}

static void test_the_rate_changes_when_the_last_bit_is_out(void)
{
    poll();
    wire.bits_on_way = true;
    ask(HIGH);
    expect_rates(1, HIGH, FIRST);
    const size_t sent = wire.out_count;
    host_packet(&wire, EL_PACKET_PING, "01 02"); /* nothing is sent while bits of the answer are on their way */
    pass(20000);
    TEST_ASSERT_EQUAL_INT32(0, el_stream_log(&dev.stream, "x", 1));
    TEST_ASSERT_EQUAL_UINT32(sent, wire.out_count);
    wire.bits_on_way = false;
    poll();
    expect_rates(1, HIGH, HIGH);
    poll();
    TEST_ASSERT_EQUAL_UINT32(HIGH, host.rate); /* the answer to PING */
}

static void test_the_answer_leaves_the_queue_first(void)
{
    poll();
    wire.room = 3;
    ask(HIGH);
    pass(20000);
    expect_rates(0, 0, FIRST);
    wire.room = FAKE_OUT_BYTES;
    poll();
    expect_rates(1, HIGH, HIGH);
}

static void test_a_stream_ends_before_the_rate_changes(void)
{
    host_packet(&wire, EL_PACKET_START, "00 05 00 00 03 00");
    device_draw(&dev);
    ask(HIGH);
    TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
    expect_rates(1, HIGH, HIGH);
    host_packet(&wire, EL_PACKET_START, "00 05 00 00 03 00");
    device_draw(&dev);
    host_listen(&host, &wire);
    TEST_ASSERT_EQUAL_UINT32(2, host.frames);
}

/* The answer is the rate that stays where the link has none within 1 / 40 of the one asked for, or it is above the highest. */
static void test_a_rate_that_the_link_cannot_have(void)
{
    static const struct {
        uint32_t asked;
        bool has; /* 16 MHz over a whole number */
    } rates[] = {{0, false},       {1, true},      {115200, true},  {921600, true},   {1000000, true},
                 {1000001, false}, {960000, true}, {970000, false}, {4000000, false}, {UINT32_MAX, false}};
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        setUp();
        poll();
        ask(rates[i].asked);
        const uint32_t rate = rates[i].has ? rates[i].asked : (uint32_t)FIRST;
        expect_rates(1, rate, rate);
    }
}

static void test_without_a_packet_at_the_new_rate_it_goes_back(void)
{
    poll();
    ask(HIGH);
    expect_rates(1, HIGH, HIGH);
    uint32_t hellos = host.hellos;
    host_bytes(&wire, (const uint8_t *)"\x83\xE0\x07\x00noise", 10);
    pass(SECOND_US - 1000);
    expect_rates(1, HIGH, HIGH);
    TEST_ASSERT_EQUAL_UINT32(hellos, host.hellos);
    pass(1000);
    expect_rates(1, HIGH, FIRST);
    poll();
    TEST_ASSERT_EQUAL_UINT32(hellos + 1, host.hellos);
    TEST_ASSERT_EQUAL_UINT32(FIRST, host.rate);
    pass(10 * SECOND_US); /* and stays there */
    expect_rates(1, HIGH, FIRST);
}

static void test_without_a_host_for_3_seconds_it_goes_back(void)
{
    change_to_high();
    pass(3 * SECOND_US - 1000);
    expect_rates(1, HIGH, HIGH);
    host_packet(&wire, EL_PACKET_PING, "01 02");
    poll();
    pass(3 * SECOND_US - 1000);
    expect_rates(1, HIGH, HIGH);
    pass(2000);
    expect_rates(1, HIGH, FIRST);
    TEST_ASSERT_EQUAL_UINT32(FIRST, host.rate);
}

/* A stream needs no packets of the host while it has credits; without, the session ends after a second, and the rate two
 * seconds later. */
static void test_a_running_stream_keeps_its_rate(void)
{
    change_to_high();
    host_packet(&wire, EL_PACKET_START, "00 01 00 00 03 00");
    poll();
    pass(20 * SECOND_US);
    expect_rates(1, HIGH, HIGH);
    device_draw(&dev);
    TEST_ASSERT_EQUAL_INT(EL_STREAM_RUNNING, dev.stream.state);
    pass(3 * SECOND_US - 1000);
    TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
    expect_rates(1, HIGH, HIGH);
    pass(2000);
    expect_rates(1, HIGH, FIRST);
}

static void test_the_first_rate_can_be_asked_for(void)
{
    change_to_high();
    ask(FIRST);
    expect_rates(2, FIRST, FIRST);
    pass(10 * SECOND_US);
    expect_rates(2, FIRST, FIRST);
}

static void test_the_way_back_waits_for_the_last_bit_too(void)
{
    change_to_high();
    pass(SECOND_US);
    wire.bits_on_way = true; /* of a HELLO */
    pass(3 * SECOND_US);
    expect_rates(1, HIGH, HIGH);
    wire.bits_on_way = false;
    poll();
    expect_rates(1, HIGH, FIRST);
}

static void test_a_link_without_rates(void)
{
    dev.port.set_baud = NULL;
    poll();
    TEST_ASSERT_EQUAL_HEX32(0, host.capabilities & EL_STREAM_SET_BAUD);
    ask(HIGH);
    expect_rates(1, FIRST, FIRST);
}

/* Counters of microseconds wrap at any moment of it. */
static void test_the_clock_may_wrap_in_between(void)
{
    for (uint32_t before_us = 0; before_us < 4 * SECOND_US; before_us += 125000) {
        setUp();
        wire.clock_us = 0U - before_us;
        device_init(&dev, &wire, 16, 20, false);
        change_to_high();
        pass(3 * SECOND_US - 1000);
        expect_rates(1, HIGH, HIGH);
        pass(2000);
        expect_rates(1, HIGH, FIRST);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_hello_names_the_rates);
    RUN_TEST(test_the_rate_changes_when_the_last_bit_is_out);
    RUN_TEST(test_the_answer_leaves_the_queue_first);
    RUN_TEST(test_a_stream_ends_before_the_rate_changes);
    RUN_TEST(test_a_rate_that_the_link_cannot_have);
    RUN_TEST(test_without_a_packet_at_the_new_rate_it_goes_back);
    RUN_TEST(test_without_a_host_for_3_seconds_it_goes_back);
    RUN_TEST(test_a_running_stream_keeps_its_rate);
    RUN_TEST(test_the_first_rate_can_be_asked_for);
    RUN_TEST(test_the_way_back_waits_for_the_last_bit_too);
    RUN_TEST(test_a_link_without_rates);
    RUN_TEST(test_the_clock_may_wrap_in_between);
    return UNITY_END();
}
