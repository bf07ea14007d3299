/* Scrolling by the controller's own commands, from the driver to the glass: the emulated chip obeys them, and the viewer sees
 * the lines that the driver's header says, in each way of mounting; and a text that scrolls costs the wire one line. */
#include "display.h"

#include <string.h>

#include "seeded.h"
#include "unity.h"

enum { MAX_PIXELS = 240 * 320, BAND_LINES = 8 };

static el_display display;
static uint16_t before[MAX_PIXELS];
static uint16_t glass[MAX_PIXELS];

void setUp(void)
{
    display = (el_display){0};
}

void tearDown(void)
{
    el_display_close(&display);
}

/* Sends lines of the ring as a frame: line y is `colours[y]`, black and white by turns where a panel has no more. */
static void send_frame(const uint16_t *colours, uint64_t noise)
{
    static uint16_t pixels[320 * BAND_LINES];
    static const el_stats no_stats;
    const el_sink *const sink = &display.sink;
    el_band band = {.pixels = pixels, .width = display.width};
    seeded random = seeded_from(noise);
    sink->begin(sink->context, display.width, display.height);
    for (unsigned y = 0; y < display.height; y += BAND_LINES) {
        band.y = (uint16_t)y;
        band.lines = (uint16_t)(display.height - y < BAND_LINES ? display.height - y : BAND_LINES);
        for (unsigned i = 0; i < (unsigned)band.lines * band.width; i++) {
            const uint16_t plain = colours == NULL ? (uint16_t)(any_u64(&random) >> 20) : 0;
            band.pixels[i] = colours == NULL ? plain : colours[y + i / band.width];
        }
        band.held[0] = 1;
        sink->rows(sink->context, &band, 0);
        while (!el_band_is_free(&band)) {
            sink->wait(sink->context);
        }
    }
    sink->end(sink->context, &no_stats);
    TEST_ASSERT_TRUE(el_display_look(&display, glass));
}

/* Where a viewer finds what was at place `at` along the glass' rows. */
static unsigned moved(unsigned at, unsigned first, unsigned end, unsigned by)
{
    return at < first || at >= end ? at : first + (at - first + (end - first) - by) % (end - first);
}

/* Places are those of the driver: a mirrored module shows them from its other side. */
static void expect_moved(const el_display_config *config, unsigned first, unsigned end, unsigned by)
{
    const bool sideways = config->rotation == EL_ROTATION_90 || config->rotation == EL_ROTATION_270;
    TEST_ASSERT_TRUE(el_display_look(&display, glass));
    for (unsigned y = 0; y < display.height; y++) {
        for (unsigned x = 0; x < display.width; x++) {
            const unsigned to_x = sideways ? moved(x, first, end, by) : x;
            const unsigned to_y = sideways ? y : moved(y, first, end, by);
            const unsigned mirror = config->mirrored ? display.width - 1U : 0U;
            const unsigned from_x = mirror != 0 ? mirror - x : x;
            const unsigned seen_x = mirror != 0 ? mirror - to_x : to_x;
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(before[y * display.width + from_x], glass[to_y * display.width + seen_x],
                                            config->panel);
        }
    }
}

static void open_with_noise(const el_display_config *config)
{
    el_display_close(&display);
    TEST_ASSERT_TRUE(el_display_open(&display, config));
    send_frame(NULL, 1);
    memcpy(before, glass, sizeof before);
}

static void test_colour_panels_scroll_however_they_are_mounted(void)
{
    static const char *const panels[] = {"ili9341", "st7789", "st7789-240x240"};
    seeded s = seeded_from(2);
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned way = i % EL_TEST_PART; way < 8; way += EL_TEST_PART, s.round++) {
            const el_display_config config = {.panel = panels[i],
                                              .band_lines = BAND_LINES,
                                              .rotation = (el_rotation)(way % 4),
                                              .mirrored = way / 4 != 0};
            open_with_noise(&config);
            el_tft *const panel = &display.driver.tft;
            const unsigned rows = panel->config.model->rows;
            const unsigned first = any_below(&s, rows);
            const unsigned end = (unsigned)any_between(&s, first + 1, rows);
            const unsigned by = any_below(&s, end - first);
            TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_scroll(panel, 0, (uint16_t)rows, 17));
            expect_moved(&config, 0, rows, 17);
            const uint64_t commands = display.bus_state.traffic.command_bytes;
            TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_scroll(panel, (uint16_t)first, (uint16_t)end, (uint16_t)by));
            TEST_ASSERT_EQUAL_UINT64(10, display.bus_state.traffic.command_bytes - commands);
            expect_moved(&config, first, end, by);
            TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_scroll(panel, 0, (uint16_t)rows, 0));
            expect_moved(&config, 0, rows, 0);
        }
    }
}

static void test_the_ssd1306_scrolls_however_it_is_mounted(void)
{
    for (unsigned way = 0; way < 8; way++) {
        const el_display_config config = {
            .panel = "ssd1306", .band_lines = BAND_LINES, .rotation = (el_rotation)(way % 4), .mirrored = way / 4 != 0};
        open_with_noise(&config);
        for (uint8_t by = 64; by-- > 0;) {
            const uint64_t commands = display.bus_state.traffic.command_bytes;
            TEST_ASSERT_EQUAL_INT(EL_OK, el_oled_scroll(&display.driver.oled, by));
            TEST_ASSERT_EQUAL_UINT64(1, display.bus_state.traffic.command_bytes - commands);
            expect_moved(&config, 0, 64, by);
        }
    }
}

/* A log: a line comes in at the bottom, all others go up by one. What is drawn is a ring, of which one line is new. */
static void test_a_text_that_scrolls_costs_the_wire_one_line(void)
{
    uint16_t ring[320];
    const el_display_config config = {.panel = "ili9341", .band_lines = BAND_LINES, .sparing = true};
    TEST_ASSERT_TRUE(el_display_open(&display, &config));
    for (unsigned y = 0; y < 320; y++) {
        ring[y] = (uint16_t)(y * 101U);
    }
    send_frame(ring, 0);
    for (unsigned step = 1; step < 40; step++) {
        const unsigned fresh = step - 1;
        ring[fresh] = (uint16_t)((319U + step) * 101U);
        const uint64_t bytes = display.bus_state.traffic.pixel_bytes;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_scroll(&display.driver.tft, 0, 320, (uint16_t)step));
        send_frame(ring, 0);
        for (unsigned y = 0; y < 320; y++) {
            TEST_ASSERT_EQUAL_HEX16((uint16_t)((y + step) * 101U), glass[y * 240]);
            TEST_ASSERT_EQUAL_HEX16(glass[y * 240], glass[y * 240 + 239]);
        }
        /* The line, and those that each frame refreshes; in whole bands where they lie in one. */
        const uint64_t lines = (display.bus_state.traffic.pixel_bytes - bytes) / 480;
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(1 + BAND_LINES + EL_TFT_REFRESH_LINES, lines);
    }
}

static void test_what_cannot_scroll_is_refused_before_anything_is_sent(void)
{
    static const uint16_t bad[][3] = {{0, 0, 0}, {5, 5, 0}, {9, 8, 0}, {0, 321, 0}, {0, 320, 320}, {10, 20, 10}};
    TEST_ASSERT_TRUE(el_display_open(&display, &(el_display_config){.panel = "ili9341", .band_lines = 8}));
    uint64_t commands = display.bus_state.traffic.command_bytes;
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, el_tft_scroll(&display.driver.tft, bad[i][0], bad[i][1], bad[i][2]));
    }
    TEST_ASSERT_EQUAL_UINT64(commands, display.bus_state.traffic.command_bytes);
    el_display_close(&display);
    TEST_ASSERT_TRUE(el_display_open(&display, &(el_display_config){.panel = "st7735", .band_lines = 8}));
    commands = display.bus_state.traffic.command_bytes;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_tft_scroll(&display.driver.tft, 0, 160, 1));
    TEST_ASSERT_EQUAL_UINT64(commands, display.bus_state.traffic.command_bytes);
    el_display_close(&display);
    TEST_ASSERT_TRUE(el_display_open(&display, &(el_display_config){.panel = "ssd0323", .band_lines = 8}));
    commands = display.bus_state.traffic.command_bytes;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_oled_scroll(&display.driver.oled, 1));
    TEST_ASSERT_EQUAL_UINT64(commands, display.bus_state.traffic.command_bytes);
    el_display_close(&display);
    TEST_ASSERT_TRUE(el_display_open(&display, &(el_display_config){.panel = "ssd1306", .band_lines = 8}));
    commands = display.bus_state.traffic.command_bytes;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, el_oled_scroll(&display.driver.oled, 64));
    TEST_ASSERT_EQUAL_UINT64(commands, display.bus_state.traffic.command_bytes);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_colour_panels_scroll_however_they_are_mounted);
    RUN_TEST(test_the_ssd1306_scrolls_however_it_is_mounted);
    RUN_TEST(test_a_text_that_scrolls_costs_the_wire_one_line);
    RUN_TEST(test_what_cannot_scroll_is_refused_before_anything_is_sent);
    return UNITY_END();
}
