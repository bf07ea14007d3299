/* From the driver through the wire to the glass: each panel's driver against the model of its chip, for all rotations,
 * mirrored and not, by words and by bytes, immediate and deferred. The picture is noise, so that no pixel can take
 * another's place unseen. */
#include "display.h"

#include "base/dither.h"
#include "seeded.h"
#include "unity.h"

enum { MAX_PIXELS = 240 * 320, GREYS = 16 };

static el_display display;
static uint16_t picture[MAX_PIXELS];
static uint16_t glass[MAX_PIXELS];

void setUp(void)
{
    display = (el_display){0};
}

void tearDown(void)
{
    el_display_close(&display);
}

static void open_display(const el_display_config *config)
{
    el_display_close(&display);
    TEST_ASSERT_TRUE(el_display_open(&display, config));
}

/* Sends the upper left width x height of `picture`, whose lines are as wide as the glass, as the renderer does: two
 * bands that are filled by turns, each only when it is free. */
static void send_frame(unsigned width, unsigned height, unsigned band_lines)
{
    static uint16_t pixels[2][MAX_PIXELS];
    el_band bands[2] = {{.pixels = pixels[0]}, {.pixels = pixels[1]}};
    static const el_stats no_stats;
    const el_sink *const sink = &display.sink;
    sink->begin(sink->context, (uint16_t)width, (uint16_t)height);
    for (unsigned y = 0, turn = 0; y < height; y += band_lines, turn ^= 1) {
        el_band *const band = &bands[turn];
        while (!el_band_is_free(band)) {
            sink->wait(sink->context);
        }
        band->y = (uint16_t)y;
        band->lines = (uint16_t)(height - y < band_lines ? height - y : band_lines);
        band->width = (uint16_t)width;
        for (unsigned i = 0; i < band->lines * width; i++) {
            band->pixels[i] = picture[(y + i / width) * display.width + i % width];
        }
        band->held[0] = 1;
        sink->rows(sink->context, band, 0);
    }
    sink->end(sink->context, &no_stats);
    el_lcd_bus_drain(&display.bus_state);
    TEST_ASSERT_TRUE(el_band_is_free(&bands[0]) && el_band_is_free(&bands[1]));
}

static uint16_t grey_of(uint32_t level)
{
    return (uint16_t)((level << 1 | level >> 3) << 11 | (level << 2 | level >> 2) << 5 | (level << 1 | level >> 3));
}

/* What a pixel of the picture becomes on this panel; what is inverted is so at the very end. */
static uint16_t expected_pixel(const el_display_config *config, unsigned x, unsigned y, uint16_t rgb565)
{
    const unsigned bits = el_lcd_profile_find(config->panel)->chip == EL_LCD_SSD1306.chip   ? 1
                          : el_lcd_profile_find(config->panel)->chip == EL_LCD_SSD0323.chip ? 4
                                                                                            : 16;
    uint16_t shown = rgb565;
    if (bits < 16) {
        const uint32_t levels = (1U << bits) - 1;
        const uint32_t level = el_dither(el_luma_q16(rgb565), levels, el_dither_threshold_q16(x, y));
        shown = grey_of(level * (GREYS - 1) / levels);
    } else if (config->rgb_order) {
        shown = (uint16_t)(rgb565 << 11 | (rgb565 & 0x07E0) | rgb565 >> 11);
    }
    return config->inverted ? (uint16_t)~shown : shown;
}

static void expect_frame(const el_display_config *config, unsigned width, unsigned height)
{
    const uint16_t black = expected_pixel(config, 0, 0, 0);
    TEST_ASSERT_TRUE(el_display_look(&display, glass));
    for (unsigned y = 0; y < display.height; y++) {
        for (unsigned x = 0; x < display.width; x++) {
            const uint16_t sent = picture[y * display.width + x];
            const uint16_t expected = x < width && y < height ? expected_pixel(config, x, y, sent) : black;
            const unsigned seen_x = config->mirrored ? display.width - 1U - x : x;
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(expected, glass[y * display.width + seen_x], config->panel);
        }
    }
}

static void make_noise(uint64_t seed)
{
    seeded random = seeded_from(seed);
    for (unsigned i = 0; i < MAX_PIXELS; i++) {
        picture[i] = (uint16_t)(any_u64(&random) >> 20);
    }
}

static void test_every_panel_shows_the_picture_however_it_is_mounted_and_sent(void)
{
    make_noise(1);
    const el_lcd_profile *profile;
    for (size_t i = 0; (profile = el_lcd_profile_at(i)) != NULL; i++) {
        for (unsigned way = (unsigned)i % EL_TEST_PART; way < 32; way += EL_TEST_PART) {
            const el_display_config config = {
                .panel = profile->panel,
                .band_lines = 8,
                .rotation = (el_rotation)(way % 4),
                .mirrored = (way & 4) != 0,
                .bytes_only = (way & 8) != 0,
                .chunk = (way & 16) != 0 ? 97 : 0,
            };
            open_display(&config);
            send_frame(display.width, display.height, 8);
            expect_frame(&config, display.width, display.height);
        }
    }
}

static void test_every_panel_takes_bands_of_any_height_and_smaller_frames(void)
{
    static const uint8_t heights[] = {1, 3, 7, 13, 64};
    make_noise(2);
    const el_lcd_profile *profile;
    for (size_t i = 0; (profile = el_lcd_profile_at(i)) != NULL; i++) {
        for (unsigned h = 0; h < sizeof heights; h++) {
            const el_display_config config = {
                .panel = profile->panel,
                .band_lines = heights[h],
                .rotation = (el_rotation)(h % 4),
                .chunk = 50,
            };
            open_display(&config);
            const unsigned width = display.width - 5U;
            const unsigned height = display.height - 3U;
            send_frame(width, height, heights[h]);
            expect_frame(&config, width, height);
        }
    }
}

static void test_inversion_and_colour_order_are_the_opposite_of_the_modules(void)
{
    make_noise(3);
    const el_lcd_profile *profile;
    for (size_t i = 0; (profile = el_lcd_profile_at(i)) != NULL; i++) {
        const el_display_config config = {.panel = profile->panel, .band_lines = 8, .inverted = 1, .rgb_order = 1};
        open_display(&config);
        send_frame(display.width, display.height, 8);
        expect_frame(&config, display.width, display.height);
    }
}

static void test_the_st7789_takes_either_byte_first(void)
{
    make_noise(4);
    for (unsigned i = 0; i < 4; i++) {
        const el_display_config config = {.panel = "st7789-240x240",
                                          .band_lines = 8,
                                          .byte_order = i & 1 ? EL_LOW_BYTE_FIRST : EL_HIGH_BYTE_FIRST,
                                          .bytes_only = i > 1};
        open_display(&config);
        send_frame(display.width, display.height, 8);
        expect_frame(&config, display.width, display.height);
    }
}

/* The second frame differs from the first in all pixels: what is left of the first would show. */
static void test_the_next_frame_takes_the_place_of_the_last(void)
{
    const el_lcd_profile *profile;
    for (size_t i = 0; (profile = el_lcd_profile_at(i)) != NULL; i++) {
        const el_display_config config = {.panel = profile->panel, .band_lines = 5, .chunk = 31};
        open_display(&config);
        make_noise(5);
        send_frame(display.width, display.height, 5);
        for (unsigned p = 0; p < MAX_PIXELS; p++) {
            picture[p] = (uint16_t)~picture[p];
        }
        send_frame(display.width, display.height, 5);
        expect_frame(&config, display.width, display.height);
    }
}

/* The checks above can fail: a band that is drawn over while it is on its way shows on the glass. */
static void test_a_band_drawn_over_in_flight_is_seen(void)
{
    static uint16_t pixels[240 * 8];
    static const el_stats no_stats;
    make_noise(6);
    const el_display_config config = {.panel = "ili9341", .band_lines = 8, .chunk = 100};
    open_display(&config);
    send_frame(240, 320, 8);
    el_band band = {.pixels = pixels, .width = 240, .lines = 8, .held = {1}};
    for (unsigned i = 0; i < 240 * 8; i++) {
        pixels[i] = picture[i];
    }
    const el_sink *const sink = &display.sink;
    sink->begin(sink->context, 240, 320);
    sink->rows(sink->context, &band, 0);
    sink->wait(sink->context);
    TEST_ASSERT_FALSE(el_band_is_free(&band));
    pixels[99] = (uint16_t)~pixels[99]; /* sent already */
    pixels[100] = (uint16_t)~pixels[100];
    sink->end(sink->context, &no_stats);
    TEST_ASSERT_TRUE(el_display_look(&display, glass));
    TEST_ASSERT_EQUAL_HEX16(picture[99], glass[99]);
    TEST_ASSERT_EQUAL_HEX16(~picture[100] & 0xFFFF, glass[100]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_panel_shows_the_picture_however_it_is_mounted_and_sent);
    RUN_TEST(test_every_panel_takes_bands_of_any_height_and_smaller_frames);
    RUN_TEST(test_inversion_and_colour_order_are_the_opposite_of_the_modules);
    RUN_TEST(test_the_st7789_takes_either_byte_first);
    RUN_TEST(test_the_next_frame_takes_the_place_of_the_last);
    RUN_TEST(test_a_band_drawn_over_in_flight_is_seen);
    return UNITY_END();
}
