/* The ILI9341 driver on a bus that writes down what it is told: the exact bytes of the start, one window per frame, bands
 * without commands, and each band given back once. */
#include "panel/ili9341.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

enum { LOG_BYTES = 4096, WIDTH = 320, LINES = 2 };

/* What the bus was told, as text: "R0" reset low, "d120" a delay in ms, "36:48" a command and its parameters, "p640"
 * pixels. */
static char journal[LOG_BYTES];
static bool defers;
static struct {
    void (*done)(void *argument);
    void *argument;
} open_transfers[2];
static unsigned open_count;

static void note(const char *format, unsigned value)
{
    const size_t used = strlen(journal);
    snprintf(journal + used, sizeof journal - used, format, value);
}

static void bus_reset(void *context, int level)
{
    (void)context;
    note("R%u ", (unsigned)level);
}

static void bus_command(void *context, uint8_t command, const uint8_t *parameters, size_t count)
{
    (void)context;
    note("%02X", command);
    for (size_t i = 0; i < count; i++) {
        note(i == 0 ? ":%02X" : ",%02X", parameters[i]);
    }
    note(" ", 0);
}

static void complete_oldest(void)
{
    open_transfers[0].done(open_transfers[0].argument);
    open_transfers[0] = open_transfers[1];
    open_count--;
}

static void bus_pixels(void *context, const uint16_t *words, size_t count, void (*done)(void *argument), void *argument)
{
    (void)context;
    TEST_ASSERT_NOT_NULL(words);
    note("p%u ", (unsigned)count);
    if (!defers) {
        done(argument);
        return;
    }
    TEST_ASSERT_LESS_THAN_UINT(2, open_count);
    open_transfers[open_count].done = done;
    open_transfers[open_count].argument = argument;
    open_count++;
}

static void bus_delay(void *context, uint32_t ms)
{
    (void)context;
    note("d%u ", ms);
}

static void bus_wait(void *context)
{
    (void)context;
    note("w ", 0);
    if (open_count > 0) {
        complete_oldest();
    }
}

static const el_bus bus = {
    .reset = bus_reset, .command = bus_command, .pixels = bus_pixels, .delay_ms = bus_delay, .wait = bus_wait};
static el_ili9341 panel;
static uint16_t pixels[2][WIDTH * LINES];

void setUp(void)
{
    journal[0] = 0;
    defers = false;
    open_count = 0;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT(0, open_count);
}

static el_sink start(el_rotation rotation)
{
    el_ili9341_init(&panel, &(el_ili9341_config){.bus = &bus, .rotation = rotation});
    journal[0] = 0;
    return el_ili9341_sink(&panel);
}

static el_band band_at(unsigned buffer, uint16_t y, uint16_t lines, unsigned slot)
{
    el_band band = {.pixels = pixels[buffer], .width = WIDTH, .y = y, .lines = lines};
    band.held[slot] = 1;
    return band;
}

/* --- Start -------------------------------------------------------------------------------------------------------- */

/* Data sheet V1.11: power 8.3.14 to 8.3.17, frame rate 8.3.2, display function 8.3.7, 16 bits per pixel 8.2.33, memory
 * access 8.2.29, sleep out and its 120 ms 8.2.12, display on 8.2.19; reset 15.4. */
static void expect_start(const el_ili9341_config *config, const char *access_and_inversion)
{
    char expected[LOG_BYTES];
    snprintf(expected, sizeof expected,
             "R0 d1 R1 d120 C0:23 C1:10 C5:3E,28 C7:86 B1:00,18 B6:08,82,27 3A:55 %s 11 d120 29 ",
             access_and_inversion);
    journal[0] = 0;
    memset(&panel, 0xA5, sizeof panel);
    el_ili9341_init(&panel, config);
    TEST_ASSERT_EQUAL_STRING(expected, journal);
}

/* MADCTL, 8.2.29: MY 80, MX 40, MV 20, BGR 08. */
static void test_start_of_each_rotation(void)
{
    expect_start(&(el_ili9341_config){.bus = &bus, .rotation = EL_ROTATION_0}, "36:48 20");
    expect_start(&(el_ili9341_config){.bus = &bus, .rotation = EL_ROTATION_90}, "36:28 20");
    expect_start(&(el_ili9341_config){.bus = &bus, .rotation = EL_ROTATION_180}, "36:88 20");
    expect_start(&(el_ili9341_config){.bus = &bus, .rotation = EL_ROTATION_270}, "36:E8 20");
}

static void test_start_of_other_glass(void)
{
    expect_start(&(el_ili9341_config){.bus = &bus, .inverted = 1}, "36:48 21");
    expect_start(&(el_ili9341_config){.bus = &bus, .rgb_order = 1}, "36:40 20");
    expect_start(&(el_ili9341_config){.bus = &bus, .rotation = EL_ROTATION_90, .rgb_order = 1}, "36:20 20");
}

/* --- Frames ------------------------------------------------------------------------------------------------------- */

/* A frame of 320 x 5 in bands of 2, 2 and 1 lines. */
static void send_frame(const el_sink *sink)
{
    static const uint16_t lines[3] = {2, 2, 1};
    sink->begin(sink->context, WIDTH, 5);
    for (uint16_t i = 0; i < 3; i++) {
        el_band band = band_at(i % 2, (uint16_t)(i * LINES), lines[i], i);
        sink->rows(sink->context, &band, i);
        TEST_ASSERT_EQUAL_UINT8(0, band.held[i]);
    }
    sink->end(sink->context, &(el_stats){0});
}

/* Columns 0 to 319, lines 0 to 4, once per frame. */
static void test_one_window_per_frame(void)
{
    const el_sink sink = start(EL_ROTATION_90);
    send_frame(&sink);
    TEST_ASSERT_EQUAL_STRING("2A:00,00,01,3F 2B:00,00,00,04 2C p640 p640 p320 ", journal);
    send_frame(&sink);
    TEST_ASSERT_EQUAL_STRING("2A:00,00,01,3F 2B:00,00,00,04 2C p640 p640 p320 "
                             "2A:00,00,01,3F 2B:00,00,00,04 2C p640 p640 p320 ",
                             journal);
}

static void test_a_frame_of_one_band(void)
{
    const el_sink sink = start(EL_ROTATION_0);
    for (unsigned i = 0; i < 2; i++) {
        el_band band = band_at(0, 0, LINES, 0);
        journal[0] = 0;
        sink.begin(sink.context, WIDTH, LINES);
        sink.rows(sink.context, &band, 0);
        sink.end(sink.context, &(el_stats){0});
        TEST_ASSERT_EQUAL_STRING("2A:00,00,01,3F 2B:00,00,00,01 2C p640 ", journal);
    }
}

/* Lines that are left out cost a window; the lines after it continue there. */
static void test_a_gap_sets_a_window_where_it_ends(void)
{
    const el_sink sink = start(EL_ROTATION_90);
    el_band first = band_at(0, 0, 2, 0);
    el_band second = band_at(1, 100, 2, 0);
    el_band third = band_at(0, 102, 2, 0);
    sink.begin(sink.context, WIDTH, 240);
    sink.rows(sink.context, &first, 0);
    sink.rows(sink.context, &second, 0);
    sink.rows(sink.context, &third, 0);
    TEST_ASSERT_EQUAL_STRING("2A:00,00,01,3F 2B:00,00,00,EF 2C p640 "
                             "2A:00,00,01,3F 2B:00,64,00,EF 2C p640 p640 ",
                             journal);
}

/* Two bands are on their way at once: each goes back when its own transfer is done, to its own slot, and no other. */
static void test_deferred_transfers_release_their_own_band(void)
{
    const el_sink sink = start(EL_ROTATION_90);
    defers = true;
    sink.begin(sink.context, WIDTH, 240);
    for (uint16_t round = 0; round < 5; round++) {
        el_band first = band_at(0, (uint16_t)(round * 4), 2, 1);
        el_band second = band_at(1, (uint16_t)(round * 4 + 2), 2, 2);
        first.held[0] = 1; /* another sink's */
        sink.rows(sink.context, &first, 1);
        sink.rows(sink.context, &second, 2);
        TEST_ASSERT_EQUAL_UINT8(1, first.held[1]);
        TEST_ASSERT_EQUAL_UINT8(1, second.held[2]);
        sink.wait(sink.context);
        TEST_ASSERT_EQUAL_UINT8(0, first.held[1]);
        TEST_ASSERT_EQUAL_UINT8(1, first.held[0]);
        TEST_ASSERT_EQUAL_UINT8(1, second.held[2]);
        sink.wait(sink.context);
        TEST_ASSERT_EQUAL_UINT8(0, second.held[2]);
    }
}

static void test_a_bus_without_wait(void)
{
    el_bus quiet = bus;
    quiet.wait = NULL;
    el_ili9341_init(&panel, &(el_ili9341_config){.bus = &quiet});
    const el_sink sink = el_ili9341_sink(&panel);
    journal[0] = 0;
    if (sink.wait != NULL) {
        sink.wait(sink.context);
    }
    TEST_ASSERT_EQUAL_STRING("", journal);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_start_of_each_rotation);
    RUN_TEST(test_start_of_other_glass);
    RUN_TEST(test_one_window_per_frame);
    RUN_TEST(test_a_frame_of_one_band);
    RUN_TEST(test_a_gap_sets_a_window_where_it_ends);
    RUN_TEST(test_deferred_transfers_release_their_own_band);
    RUN_TEST(test_a_bus_without_wait);
    return UNITY_END();
}
