/* base/bus.h over the LCD model: immediate and deferred transfers, and the clock. */
#include "lcd_bus.h"

#include <stdio.h>
#include <string.h>

#include "test_lcd_send.h"

static el_lcd *lcd;
static el_lcd_bus state;
static el_bus bus;
static unsigned done_calls;

static void create(size_t chunk, uint32_t sck_hz)
{
    const el_lcd_profile profile = el_lcd_dcs(3, 4);
    lcd = el_lcd_create(&profile);
    TEST_ASSERT_NOT_NULL(lcd);
    el_lcd_bus_init(&state, &(el_lcd_bus_config){.lcd = lcd, .sck_hz = sck_hz, .chunk = chunk});
    bus = el_lcd_bus_functions(&state);
    done_calls = 0;
}

static void command(uint8_t code, size_t count, const uint8_t *parameters)
{
    bus.command(bus.context, code, parameters, count);
}

/* As a driver does: reset, wake, 16 bits, upright, window, RAMWR. */
static void start(void)
{
    bus.reset(bus.context, 0);
    bus.delay_ms(bus.context, 1);
    bus.reset(bus.context, 1);
    bus.delay_ms(bus.context, 5);
    command(0x11, 0, NULL);
    bus.delay_ms(bus.context, 5);
    command(0x29, 0, NULL);
    command(0x3A, 1, (const uint8_t[]){0x55});
    command(0x36, 1, (const uint8_t[]){0x48});
    command(0x2A, 4, (const uint8_t[]){0, 0, 0, 2});
    command(0x2B, 4, (const uint8_t[]){0, 0, 0, 3});
    command(0x2C, 0, NULL);
}

static void to_words(uint16_t *words, const char *letters)
{
    while (*letters != 0) {
        *words++ = letter_colour(*letters++);
    }
}

static void count_done(void *argument)
{
    (*(unsigned *)argument)++;
}

void setUp(void)
{
}

void tearDown(void)
{
    expect_no_errors(lcd);
    el_lcd_destroy(lcd);
}

static void test_immediate_is_done_before_it_returns(void)
{
    uint16_t words[12];
    create(0, 40000000);
    start();
    to_words(words, "abcdefghijkl");
    bus.pixels(bus.context, words, 12, count_done, &done_calls);
    TEST_ASSERT_EQUAL_UINT(1, done_calls);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
    bus.wait(bus.context);
    TEST_ASSERT_EQUAL_UINT(1, done_calls);
}

static void test_deferred_sends_in_chunks_when_waited_for(void)
{
    uint16_t words[12];
    create(5, 40000000);
    start();
    to_words(words, "abcdefghijkl");
    bus.pixels(bus.context, words, 12, count_done, &done_calls);
    TEST_ASSERT_EQUAL_UINT64(0, el_lcd_pixels(lcd));
    bus.wait(bus.context);
    TEST_ASSERT_EQUAL_UINT64(5, el_lcd_pixels(lcd));
    bus.wait(bus.context);
    TEST_ASSERT_EQUAL_UINT64(10, el_lcd_pixels(lcd));
    TEST_ASSERT_EQUAL_UINT(0, done_calls);
    bus.wait(bus.context);
    TEST_ASSERT_EQUAL_UINT(1, done_calls);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
}

/* The same picture, high byte first. */
static void to_bytes(uint8_t *bytes, const char *letters)
{
    for (; *letters != 0; letters++) {
        *bytes++ = (uint8_t)(letter_colour(*letters) >> 8);
        *bytes++ = (uint8_t)letter_colour(*letters);
    }
}

static void test_bytes_are_sent_as_they_lie_at_once_or_in_chunks(void)
{
    for (size_t chunk = 0; chunk < 12; chunk += 11) {
        uint8_t bytes[24];
        create(chunk, 40000000);
        start();
        to_bytes(bytes, "abcdefghijkl");
        bus.bytes(bus.context, bytes, 24, count_done, &done_calls);
        TEST_ASSERT_EQUAL_UINT(chunk == 0 ? 1 : 0, done_calls);
        bus.wait(bus.context);
        TEST_ASSERT_EQUAL_UINT64(chunk == 0 ? 24 : 11, state.traffic.pixel_bytes);
        el_lcd_bus_drain(&state);
        TEST_ASSERT_EQUAL_UINT(1, done_calls);
        EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
        if (chunk == 0) {
            el_lcd_destroy(lcd);
        }
    }
}

static void test_bytes_wait_for_words_and_words_for_bytes(void)
{
    uint8_t bytes[6];
    uint16_t words[6];
    create(2, 40000000);
    start();
    to_bytes(bytes, "def");
    to_words(words, "abcghi");
    bus.pixels(bus.context, words, 3, count_done, &done_calls);
    bus.bytes(bus.context, bytes, 6, count_done, &done_calls);
    TEST_ASSERT_EQUAL_UINT(1, done_calls);
    bus.pixels(bus.context, words + 3, 3, count_done, &done_calls);
    TEST_ASSERT_EQUAL_UINT(2, done_calls);
    to_words(words, "jkl");
    bus.pixels(bus.context, words, 3, count_done, &done_calls);
    el_lcd_bus_drain(&state);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
    TEST_ASSERT_EQUAL_UINT64(24, state.traffic.pixel_bytes);
    TEST_ASSERT_EQUAL_UINT64(4, state.traffic.transfers);
}

static void test_a_bus_of_bytes_has_no_words(void)
{
    create(0, 40000000);
    TEST_ASSERT_NOT_NULL(bus.pixels);
    el_lcd_bus_init(&state, &(el_lcd_bus_config){.lcd = lcd, .sck_hz = 1, .bytes_only = true});
    bus = el_lcd_bus_functions(&state);
    TEST_ASSERT_NULL(bus.pixels);
    TEST_ASSERT_NOT_NULL(bus.bytes);
}

/* What a tap hears, as text: C00 is a command byte, D12 data, R0 the reset line, and + time since the last of them. */
static char heard[128];

static void hear(const char *format, unsigned value)
{
    const size_t used = strlen(heard);
    (void)snprintf(heard + used, sizeof heard - used, format, value);
}

static void hear_byte(void *context, int dc, uint8_t byte)
{
    (void)context;
    hear(dc != 0 ? "D%02X " : "C%02X ", byte);
}

static void hear_reset(void *context, int level)
{
    (void)context;
    hear("R%u ", (unsigned)level);
}

static void hear_time(void *context, uint64_t ns)
{
    (void)context;
    hear("+%u ", (unsigned)ns);
}

static void test_a_tap_hears_all_that_the_display_gets(void)
{
    const uint16_t word = 0x1234;
    create(0, 8000000);
    heard[0] = 0;
    const el_lcd_tap tap = {.byte = hear_byte, .reset = hear_reset, .time = hear_time};
    el_lcd_bus_init(&state, &(el_lcd_bus_config){.lcd = lcd, .sck_hz = 8000000, .tap = tap});
    bus = el_lcd_bus_functions(&state);
    bus.reset(bus.context, 0);
    bus.delay_ms(bus.context, 1);
    bus.reset(bus.context, 1);
    bus.delay_ms(bus.context, 5);
    command(0x3A, 1, (const uint8_t[]){0x55});
    command(0x2C, 0, NULL);
    bus.pixels(bus.context, &word, 1, count_done, &done_calls);
    TEST_ASSERT_EQUAL_STRING("R0 +1000000 R1 +5000000 +1000 C3A +1000 D55 +1000 C2C D12 D34 +2000 ", heard);
}

static void test_drawing_over_a_band_in_flight_shows(void)
{
    uint16_t words[12];
    create(6, 40000000);
    start();
    to_words(words, "abcdefghijkl");
    bus.pixels(bus.context, words, 12, count_done, &done_calls);
    bus.wait(bus.context);
    to_words(words, "ABCDEFGHIJKL");
    bus.wait(bus.context);
    EXPECT_LOOK(lcd, 0, "abc", "def", "GHI", "JKL");
}

static void test_a_second_transfer_completes_the_first(void)
{
    uint16_t words[12];
    create(1, 40000000);
    start();
    to_words(words, "abcdefghijkl");
    bus.pixels(bus.context, words, 6, count_done, &done_calls);
    bus.pixels(bus.context, words + 6, 6, count_done, &done_calls);
    TEST_ASSERT_EQUAL_UINT(1, done_calls);
    TEST_ASSERT_EQUAL_UINT64(6, el_lcd_pixels(lcd));
    el_lcd_bus_drain(&state);
    TEST_ASSERT_EQUAL_UINT(2, done_calls);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
}

static void test_a_command_completes_the_transfer_before_it(void)
{
    uint16_t words[12];
    create(1, 40000000);
    start();
    to_words(words, "abcdefghijkl");
    bus.pixels(bus.context, words, 12, count_done, &done_calls);
    command(0x21, 0, NULL);
    TEST_ASSERT_EQUAL_UINT(1, done_calls);
    command(0x20, 0, NULL);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
}

static void test_no_words_are_done_too(void)
{
    create(4, 40000000);
    start();
    bus.pixels(bus.context, NULL, 0, count_done, &done_calls);
    TEST_ASSERT_EQUAL_UINT(0, done_calls);
    bus.wait(bus.context);
    TEST_ASSERT_EQUAL_UINT(1, done_calls);
}

static uint16_t second_words[6];

static void send_second(void *argument)
{
    bus.pixels(bus.context, second_words, 6, count_done, argument);
}

static void test_done_may_start_the_next_transfer(void)
{
    for (size_t chunk = 0; chunk < 3; chunk++) {
        uint16_t words[6];
        create(chunk, 40000000);
        start();
        to_words(words, "abcdef");
        to_words(second_words, "ghijkl");
        bus.pixels(bus.context, words, 6, send_second, &done_calls);
        el_lcd_bus_drain(&state);
        TEST_ASSERT_EQUAL_UINT(1, done_calls);
        EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
        if (chunk < 2) {
            el_lcd_destroy(lcd);
        }
    }
}

static void test_traffic_is_counted_by_kind(void)
{
    uint16_t words[12];
    create(0, 40000000);
    start();
    to_words(words, "abcdefghijkl");
    bus.pixels(bus.context, words, 12, count_done, &done_calls);
    TEST_ASSERT_EQUAL_UINT64(1 + 1 + 2 + 2 + 5 + 5 + 1, state.traffic.command_bytes);
    TEST_ASSERT_EQUAL_UINT64(24, state.traffic.pixel_bytes);
    TEST_ASSERT_EQUAL_UINT64(1, state.traffic.transfers);
    TEST_ASSERT_EQUAL_UINT64(11000000 + (17 + 24) * 200, state.traffic.now_ns);
}

/* 62.4 MHz: a byte takes 128.2 ns, and 39 bytes exactly 5 us. */
static void test_the_clock_does_not_drift(void)
{
    create(0, 62400000);
    for (unsigned i = 0; i < 39; i++) {
        command(0x00, 0, NULL);
    }
    TEST_ASSERT_EQUAL_UINT64(5000, state.traffic.now_ns);
}

static void test_a_slow_wire_is_a_waiting_time_too(void)
{
    create(0, 1000); /* 8 ms per byte: DISPON ends more than 5 ms after SLPOUT */
    command(0x11, 0, NULL);
    command(0x29, 0, NULL);
    TEST_ASSERT_EQUAL_UINT64(16000000, state.traffic.now_ns);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_immediate_is_done_before_it_returns);
    RUN_TEST(test_deferred_sends_in_chunks_when_waited_for);
    RUN_TEST(test_bytes_are_sent_as_they_lie_at_once_or_in_chunks);
    RUN_TEST(test_bytes_wait_for_words_and_words_for_bytes);
    RUN_TEST(test_a_bus_of_bytes_has_no_words);
    RUN_TEST(test_a_tap_hears_all_that_the_display_gets);
    RUN_TEST(test_drawing_over_a_band_in_flight_shows);
    RUN_TEST(test_a_second_transfer_completes_the_first);
    RUN_TEST(test_a_command_completes_the_transfer_before_it);
    RUN_TEST(test_no_words_are_done_too);
    RUN_TEST(test_done_may_start_the_next_transfer);
    RUN_TEST(test_traffic_is_counted_by_kind);
    RUN_TEST(test_the_clock_does_not_drift);
    RUN_TEST(test_a_slow_wire_is_a_waiting_time_too);
    return UNITY_END();
}
