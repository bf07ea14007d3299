/* The time that a frame's sink functions may take: bounded by the frame's bytes whatever the link does, and nothing at all
 * while nobody takes them. The fake link's clock moves in waits alone, so it counts what the stream holds up. */
#include "stream_device.h"

static fake_link wire;
static test_device dev;
static host_view host;
static uint32_t seed;

enum { WIDTH = 64, HEIGHT = 48, LONGEST_PAUSE_US = 90000 };

static void begin(bool one_way)
{
    fake_link_init(&wire);
    memset(&host, 0, sizeof host);
    device_init(&dev, &wire, WIDTH, HEIGHT, one_way);
}

void setUp(void)
{
    seed = 3;
    begin(false);
}

void tearDown(void)
{
}

static void start(void)
{
    host_packet(&wire, EL_PACKET_START, "00 FF 00 00 03 00");
    el_stream_poll(&dev.stream);
    host_listen(&host, &wire);
}

/* Draws a frame of noise and states the bound; returns the time that it was held up. */
static uint32_t draw(void)
{
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        dev.pixels[i] = (uint16_t)random_u32(&seed);
    }
    size_t before_bytes = wire.out_count;
    uint32_t before_us = wire.clock_us;
    device_draw(&dev);
    uint32_t held_us = wire.clock_us - before_us;
    size_t bytes = wire.out_count - before_bytes;
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(EL_STREAM_PATIENCE_US + bytes * EL_STREAM_BYTE_US + wire.wait_us, held_us);
    host_listen(&host, &wire);
    return held_us;
}

/* Many frames after one that was given up: none of them waits. */
static void expect_no_more_waiting(void)
{
    uint32_t waits = wire.waits;
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, draw());
    }
    TEST_ASSERT_EQUAL_UINT32(waits, wire.waits);
    TEST_ASSERT_EQUAL_INT(EL_STREAM_WAITING, dev.stream.state);
    TEST_ASSERT_EQUAL_UINT32(1, dev.stream.stalls);
}

static void test_a_link_that_takes_nothing_costs_a_second_once(void)
{
    start();
    wire.room = 0;
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_PATIENCE_US, draw());
    expect_no_more_waiting();
}

/* A byte each 100 ms restores 2 ms of 100: the patience of a second lasts for ten of them. */
static void test_a_trickle_costs_little_more(void)
{
    start();
    wire.room = 0;
    wire.room_per_wait = 1;
    wire.wait_us = 100000;
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(1100000, draw());
    expect_no_more_waiting();
}

/* The part of a frame that went quickly earns the rest no more than the full patience. */
static void test_a_trickle_after_most_of_the_frame_costs_no_more(void)
{
    for (size_t room = 0; room < 2U * WIDTH * HEIGHT; room += 97) {
        begin(false);
        start();
        wire.room = room;
        wire.on_wait = NULL;
        wire.room_per_wait = 1;
        wire.wait_us = 100000;
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(1100000, draw());
        TEST_ASSERT_EQUAL_UINT32(0, host.frames);
        TEST_ASSERT_EQUAL_UINT32(1, dev.stream.stalls);
    }
}

static void test_the_slowest_link_that_is_kept(void)
{
    start();
    wire.room = 0;
    wire.room_per_wait = 10;
    wire.wait_us = 10 * EL_STREAM_BYTE_US;
    for (int i = 0; i < 3; i++) {
        draw();
    }
    TEST_ASSERT_EQUAL_UINT32(3, host.frames);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames + host.damaged + host.gaps + dev.stream.stalls);
}

static void test_and_one_that_is_slower(void)
{
    start();
    wire.room = 0;
    wire.room_per_wait = 8;
    wire.wait_us = 10 * EL_STREAM_BYTE_US;
    draw();
    TEST_ASSERT_EQUAL_UINT32(0, host.frames);
    expect_no_more_waiting();
}

/* Bursts and pauses of every size: the bound in draw() holds, and what the host has got is right. */
static void any_weather(fake_link *link)
{
    link->room += random_below(&seed, 8) == 0 ? random_below(&seed, 600) : random_below(&seed, 3);
    link->clock_us += random_below(&seed, LONGEST_PAUSE_US);
}

static void test_any_link_keeps_the_bound(void)
{
    uint32_t whole = 0;
    for (uint32_t i = 0; i < 60; i++) {
        begin(false);
        seed = i + 1;
        start();
        wire.room = random_below(&seed, 2000);
        wire.wait_us = 0;
        wire.on_wait = any_weather;
        uint32_t before_us = wire.clock_us;
        size_t before_bytes = wire.out_count;
        for (uint32_t k = 0; k < WIDTH * HEIGHT; k++) {
            dev.pixels[k] = (uint16_t)random_u32(&seed);
        }
        device_draw(&dev);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(EL_STREAM_PATIENCE_US + (wire.out_count - before_bytes) * EL_STREAM_BYTE_US +
                                             LONGEST_PAUSE_US,
                                         wire.clock_us - before_us);
        host_listen(&host, &wire);
        TEST_ASSERT_EQUAL_UINT32(1, host.frames + dev.stream.stalls);
        TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames);
        whole += host.frames;
    }
    TEST_ASSERT_TRUE(whole > 5 && whole < 55); /* both ends are met */
}

/* --- What arrives can hold nothing up --------------------------------------------------------------------------- */

static void send_noise(fake_link *link)
{
    uint8_t noise[300];
    link->in_count = link->in_read = 0;
    for (size_t i = 0; i < sizeof noise; i++) {
        noise[i] = (uint8_t)random_below(&seed, 40);
    }
    host_bytes(link, noise, sizeof noise);
}

static void test_noise_without_end_holds_nothing_up(void)
{
    start();
    wire.room = 0;
    wire.on_wait = send_noise;
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_PATIENCE_US, draw());
    TEST_ASSERT_GREATER_THAN_UINT32(1000, dev.stream.damaged);
    send_noise(&wire);
    expect_no_more_waiting();
}

static void send_pings(fake_link *link)
{
    link->in_count = link->in_read = 0;
    for (int i = 0; i < 30; i++) {
        host_packet(link, EL_PACKET_PING, "");
    }
}

/* A HELLO a poll is all that PINGs get, and only where it fits into the queue. */
static void test_pings_without_end_leave_the_frames_alone(void)
{
    start();
    wire.room = 0;
    wire.room_per_wait = 20;
    wire.on_wait = send_pings;
    for (uint32_t i = 0; i < 5; i++) {
        send_pings(&wire);
        draw();
        TEST_ASSERT_EQUAL_UINT32(i + 1, host.frames);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(1 + 2 * (i + 1), host.hellos);
    }
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames + host.damaged + host.gaps + dev.stream.stalls);
}

static void test_pings_without_end_on_a_link_that_takes_nothing(void)
{
    start();
    wire.room = 0;
    wire.on_wait = send_pings;
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_PATIENCE_US, draw());
    for (int i = 0; i < 100; i++) {
        send_pings(&wire);
        TEST_ASSERT_EQUAL_UINT32(0, draw());
    }
}

static void send_stop(fake_link *link)
{
    link->on_wait = NULL;
    host_packet(link, EL_PACKET_STOP, "");
}

/* The packet on its way is completed, with what is left of the frame's patience. */
static void test_a_stop_on_a_dying_link_restores_no_patience(void)
{
    start();
    wire.room = 300;
    wire.on_wait = send_stop;
    wire.room_per_wait = 1;
    wire.wait_us = 100000;
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(1100000, draw());
}

/* --- Afterwards ------------------------------------------------------------------------------------------------- */

static void test_the_host_that_comes_back_is_told(void)
{
    start();
    wire.room = 700;
    draw();
    wire.room = FAKE_OUT_BYTES;
    start();
    draw();
    TEST_ASSERT_EQUAL_UINT32(1, host.frames);
    TEST_ASSERT_EQUAL_STRING("the link stalled: what was on its way was given up", host.log);
    TEST_ASSERT_EQUAL_UINT32(1, dev.stream.stalls);
}

/* Nobody says START there: frames come again when the link has taken a whole HELLO. */
static void test_one_way_waits_once_and_comes_back(void)
{
    begin(true);
    draw();
    TEST_ASSERT_EQUAL_UINT32(1, host.frames);
    wire.room = 0;
    TEST_ASSERT_EQUAL_UINT32(EL_STREAM_PATIENCE_US, draw());
    for (size_t room = 0; room < 40; room += 13) { /* too little for a HELLO */
        wire.room = room;
        TEST_ASSERT_EQUAL_UINT32(0, draw());
    }
    TEST_ASSERT_EQUAL_UINT32(1, dev.stream.stalls);
    wire.room = FAKE_OUT_BYTES;
    draw(); /* its poll sends the HELLO */
    draw();
    TEST_ASSERT_EQUAL_UINT32(3, host.frames);
    TEST_ASSERT_EQUAL_UINT32(0, host.bad_frames);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_link_that_takes_nothing_costs_a_second_once);
    RUN_TEST(test_a_trickle_costs_little_more);
    RUN_TEST(test_a_trickle_after_most_of_the_frame_costs_no_more);
    RUN_TEST(test_the_slowest_link_that_is_kept);
    RUN_TEST(test_and_one_that_is_slower);
    RUN_TEST(test_any_link_keeps_the_bound);
    RUN_TEST(test_noise_without_end_holds_nothing_up);
    RUN_TEST(test_pings_without_end_leave_the_frames_alone);
    RUN_TEST(test_pings_without_end_on_a_link_that_takes_nothing);
    RUN_TEST(test_a_stop_on_a_dying_link_restores_no_patience);
    RUN_TEST(test_the_host_that_comes_back_is_told);
    RUN_TEST(test_one_way_waits_once_and_comes_back);
    return UNITY_END();
}
