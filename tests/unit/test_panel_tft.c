/* The colour displays' driver on a bus that writes down what it is told: the exact bytes of each start, of the window of
 * each rotation on each module, and each band sent once, in the right byte order, and given back once. */
#include <string.h>

#include "panel/ili9341.h"
#include "panel/st7735.h"
#include "panel/st7789.h"
#include "test_panel_bus.h"

enum { WIDTH = 320, LINES = 2 };

static el_tft panel;
static uint16_t pixels[2][WIDTH * LINES];

void setUp(void)
{
    panel_bus_start();
    memset(&panel, 0xA5, sizeof panel);
}

void tearDown(void)
{
}

static el_sink start(const el_tft_model *model, el_rotation rotation)
{
    const el_tft_config config = {.bus = &panel_bus_functions, .model = model, .rotation = rotation};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_init(&panel, &config));
    panel_bus_forget();
    return el_tft_sink(&panel);
}

/* --- Start -------------------------------------------------------------------------------------------------------- */

#define ILI9341_START "R0 d1 R1 d120 C0:23 C1:10 C5:3E,28 C7:86 B1:00,18 B6:08,82,27 3A:55 "
#define ST7789_START "R0 d1 R1 d120 3A:55 "
#define ST7735_START "R0 d1 R1 d120 3A:05 "

static void expect_start(el_tft_config config, const char *start, const char *access_and_inversion)
{
    char expected[256];
    snprintf(expected, sizeof expected, "%s%s 11 d120 29 ", start, access_and_inversion);
    memset(&panel, 0xA5, sizeof panel);
    config.bus = &panel_bus_functions;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_init(&panel, &config));
    panel_bus_expect(expected);
}

/* MADCTL, 8.2.29: MY 80, MX 40, MV 20, BGR 08. */
static void test_ili9341_start(void)
{
    const el_tft_model *const model = &el_ili9341;
    const char *const start = ILI9341_START;
    expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_0}, start, "36:48 20");
    expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_90}, start, "36:28 20");
    expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_180}, start, "36:88 20");
    expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_270}, start, "36:E8 20");
    expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_0, .mirrored = 1}, start, "36:08 20");
    expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_90, .mirrored = 1}, start, "36:A8 20");
    expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_180, .mirrored = 1}, start, "36:C8 20");
    expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_270, .mirrored = 1}, start, "36:68 20");
    expect_start((el_tft_config){.model = model, .inverted = 1}, start, "36:48 21");
    expect_start((el_tft_config){.model = model, .rgb_order = 1}, start, "36:40 20");
}

/* MADCTL, 9.1.28; the glass is IPS, so 21h is its positive. RAMCTRL, 9.2.1: ENDIAN 08. */
static void test_st7789_start(void)
{
    const el_tft_model *const models[] = {&el_st7789, &el_st7789_240x240};
    const char *const start = ST7789_START;
    for (size_t i = 0; i < 2; i++) {
        const el_tft_model *const model = models[i];
        expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_0}, start, "36:00 21");
        expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_90}, start, "36:60 21");
        expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_180}, start, "36:C0 21");
        expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_270}, start, "36:A0 21");
        expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_270, .mirrored = 1}, start, "36:20 21");
        expect_start((el_tft_config){.model = model, .rgb_order = 1, .inverted = 1}, start, "36:08 20");
        expect_start((el_tft_config){.model = model, .byte_order = EL_LOW_BYTE_FIRST}, start, "B0:00,F8 36:00 21");
    }
}

/* MADCTL, 10.1.26; COLMOD, 10.1.29: 5 is 16 bits per pixel. */
static void test_st7735_start(void)
{
    const el_tft_model *const models[] = {&el_st7735, &el_st7735_128x160_memory};
    const char *const start = ST7735_START;
    for (size_t i = 0; i < 2; i++) {
        const el_tft_model *const model = models[i];
        expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_0}, start, "36:C8 20");
        expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_90}, start, "36:A8 20");
        expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_180}, start, "36:08 20");
        expect_start((el_tft_config){.model = model, .rotation = EL_ROTATION_270}, start, "36:68 20");
        expect_start((el_tft_config){.model = model, .rgb_order = 1}, start, "36:C0 20");
    }
}

static void expect_argument_error(const el_tft_config *config)
{
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_tft_init(&panel, config));
    panel_bus_expect("");
}

static void test_what_cannot_be_is_refused_before_anything_is_sent(void)
{
    const el_bus *const bus = &panel_bus_functions;
    const el_tft_model *const model = &el_ili9341;
    el_bus deaf = *bus;
    deaf.pixels = NULL;
    deaf.bytes = NULL;
    expect_argument_error(NULL);
    expect_argument_error(&(el_tft_config){.model = model});
    expect_argument_error(&(el_tft_config){.bus = bus});
    expect_argument_error(&(el_tft_config){.bus = &deaf, .model = model});
    expect_argument_error(&(el_tft_config){.bus = bus, .model = model, .rotation = (el_rotation)4});
    expect_argument_error(&(el_tft_config){.bus = bus, .model = model, .byte_order = (el_byte_order)2});
    expect_argument_error(&(el_tft_config){.bus = bus, .model = model, .byte_order = EL_LOW_BYTE_FIRST});
    expect_argument_error(&(el_tft_config){.bus = bus, .model = &el_st7735, .byte_order = EL_LOW_BYTE_FIRST});
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_tft_init(NULL, &(el_tft_config){.bus = bus, .model = model}));

    el_bus incomplete = *bus;
    incomplete.reset = NULL;
    expect_argument_error(&(el_tft_config){.bus = &incomplete, .model = model});
    incomplete = *bus;
    incomplete.command = NULL;
    expect_argument_error(&(el_tft_config){.bus = &incomplete, .model = model});
    incomplete = *bus;
    incomplete.delay_ms = NULL;
    expect_argument_error(&(el_tft_config){.bus = &incomplete, .model = model});
}

/* --- Windows ------------------------------------------------------------------------------------------------------ */

/* A frame of the whole glass, of which only the first band is handed over. */
static void expect_window(const el_tft_model *model, el_rotation rotation, uint8_t mirrored, const char *window)
{
    const el_tft_config config = {
        .bus = &panel_bus_functions, .model = model, .rotation = rotation, .mirrored = mirrored};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_init(&panel, &config));
    panel_bus_forget();
    const el_sink sink = el_tft_sink(&panel);
    const uint16_t width = el_tft_width(&panel);
    char expected[64];
    snprintf(expected, sizeof expected, "%s 2C p%u ", window, (unsigned)width);
    el_band band;
    sink.begin(sink.context, width, el_tft_height(&panel));
    panel_bus_lend(&sink, &band, pixels[0], width, 0, 1, 0);
    panel_bus_expect(expected);
}

static void test_windows_of_modules_as_large_as_the_memory(void)
{
    const el_tft_model *const models[] = {&el_ili9341, &el_st7789};
    for (size_t i = 0; i < 2; i++) {
        for (uint8_t mirrored = 0; mirrored < 2; mirrored++) {
            expect_window(models[i], EL_ROTATION_0, mirrored, "2A:00,00,00,EF 2B:00,00,01,3F");
            expect_window(models[i], EL_ROTATION_90, mirrored, "2A:00,00,01,3F 2B:00,00,00,EF");
            expect_window(models[i], EL_ROTATION_180, mirrored, "2A:00,00,00,EF 2B:00,00,01,3F");
            expect_window(models[i], EL_ROTATION_270, mirrored, "2A:00,00,01,3F 2B:00,00,00,EF");
        }
    }
}

/* The glass has rows 0..239 of 320: where rows count from the other end, they are 80..319 (50h..13Fh). */
static void test_windows_of_the_square_st7789(void)
{
    const el_tft_model *const model = &el_st7789_240x240;
    expect_window(model, EL_ROTATION_0, 0, "2A:00,00,00,EF 2B:00,00,00,EF");
    expect_window(model, EL_ROTATION_90, 0, "2A:00,00,00,EF 2B:00,00,00,EF");
    expect_window(model, EL_ROTATION_180, 0, "2A:00,00,00,EF 2B:00,50,01,3F");
    expect_window(model, EL_ROTATION_270, 0, "2A:00,50,01,3F 2B:00,00,00,EF");
    expect_window(model, EL_ROTATION_0, 1, "2A:00,00,00,EF 2B:00,00,00,EF");
    expect_window(model, EL_ROTATION_90, 1, "2A:00,50,01,3F 2B:00,00,00,EF");
    expect_window(model, EL_ROTATION_180, 1, "2A:00,00,00,EF 2B:00,50,01,3F");
    expect_window(model, EL_ROTATION_270, 1, "2A:00,00,00,EF 2B:00,00,00,EF");
}

/* In the middle of 132x162: columns 2..129, rows 1..160. */
static void test_windows_of_the_st7735(void)
{
    for (uint8_t mirrored = 0; mirrored < 2; mirrored++) {
        expect_window(&el_st7735, EL_ROTATION_0, mirrored, "2A:00,02,00,81 2B:00,01,00,A0");
        expect_window(&el_st7735, EL_ROTATION_90, mirrored, "2A:00,01,00,A0 2B:00,02,00,81");
        expect_window(&el_st7735, EL_ROTATION_180, mirrored, "2A:00,02,00,81 2B:00,01,00,A0");
        expect_window(&el_st7735, EL_ROTATION_270, mirrored, "2A:00,01,00,A0 2B:00,02,00,81");
        expect_window(&el_st7735_128x160_memory, EL_ROTATION_0, mirrored, "2A:00,00,00,7F 2B:00,00,00,9F");
        expect_window(&el_st7735_128x160_memory, EL_ROTATION_270, mirrored, "2A:00,00,00,9F 2B:00,00,00,7F");
    }
}

/* Glass that is not in the middle of the memory on either axis. */
static void test_windows_of_glass_anywhere_in_the_memory(void)
{
    el_tft_model model = el_st7789;
    model.first_column = 3; /* 20 columns from 3 of 240: from the other end 217 = D9h */
    model.columns = 20;
    model.first_row = 5; /* 30 rows from 5 of 320: from the other end 285 = 11Dh */
    model.rows = 30;
    expect_window(&model, EL_ROTATION_0, 0, "2A:00,03,00,16 2B:00,05,00,22");
    expect_window(&model, EL_ROTATION_90, 0, "2A:00,05,00,22 2B:00,D9,00,EC");
    expect_window(&model, EL_ROTATION_180, 0, "2A:00,D9,00,EC 2B:01,1D,01,3A");
    expect_window(&model, EL_ROTATION_270, 0, "2A:01,1D,01,3A 2B:00,03,00,16");
    expect_window(&model, EL_ROTATION_0, 1, "2A:00,D9,00,EC 2B:00,05,00,22");
    expect_window(&model, EL_ROTATION_90, 1, "2A:01,1D,01,3A 2B:00,D9,00,EC");
}

/* --- Frames ------------------------------------------------------------------------------------------------------- */

/* A whole frame in bands of 2 lines, the last one shorter. */
static void send_frame(const el_sink *sink, uint16_t width, uint16_t height)
{
    el_band bands[2];
    sink->begin(sink->context, width, height);
    for (unsigned i = 0; i * LINES < height; i++) {
        const unsigned y = i * LINES;
        panel_bus_lend(sink, &bands[i % 2], pixels[i % 2], width, (uint16_t)y,
                       (uint16_t)(height - y < LINES ? height - y : LINES), i % 3);
        TEST_ASSERT_EQUAL_UINT8(0, bands[i % 2].held[i % 3]);
    }
    sink->end(sink->context, &(el_stats){0});
}

static void test_one_window_per_frame(void)
{
    el_tft_model model = el_ili9341;
    model.rows = 320;
    model.columns = 5;
    const el_sink sink = start(&model, EL_ROTATION_90);
    for (int frame = 0; frame < 2; frame++) {
        send_frame(&sink, 320, 5);
        panel_bus_expect("2A:00,00,01,3F 2B:00,00,00,04 2C p640 p640 p320 ");
    }
}

/* In pieces of 64 pixels, once, before the first frame that leaves some of the glass free. */
static void test_what_a_smaller_frame_leaves_free_is_made_black_once(void)
{
    el_tft_model model = el_ili9341;
    model.rows = 9;
    model.columns = 30; /* 270 pixels: 4 * 64 + 14 */
    const el_sink sink = start(&model, EL_ROTATION_0);
    const char *const black = "2A:00,D2,00,EF 2B:00,00,00,08 2C p64 p64 p64 p64 p14 ";
    const char *const frame = "2A:00,D2,00,EE 2B:00,00,00,01 2C p58 ";
    char both[128];
    snprintf(both, sizeof both, "%s%s", black, frame);
    send_frame(&sink, 29, 2);
    panel_bus_expect(both);
    send_frame(&sink, 29, 2);
    panel_bus_expect(frame);
    send_frame(&sink, 30, 9);
    panel_bus_expect("2A:00,D2,00,EF 2B:00,00,00,08 2C p60 p60 p60 p60 p30 ");
    send_frame(&sink, 29, 2);
    panel_bus_expect(both);
}

static void test_a_frame_larger_than_the_glass_is_given_back_and_not_sent(void)
{
    const el_sink sink = start(&el_st7789_240x240, EL_ROTATION_0);
    send_frame(&sink, 241, 3);
    send_frame(&sink, 3, 241);
    panel_bus_expect("");
}

/* Lines that are left out cost the rows of a window; the lines after it continue there. */
static void test_a_gap_sets_rows_where_it_ends(void)
{
    const el_sink sink = start(&el_ili9341, EL_ROTATION_90);
    el_band bands[2];
    sink.begin(sink.context, WIDTH, 240);
    panel_bus_lend(&sink, &bands[0], pixels[0], WIDTH, 0, 2, 0);
    panel_bus_lend(&sink, &bands[1], pixels[1], WIDTH, 100, 2, 0);
    panel_bus_lend(&sink, &bands[0], pixels[0], WIDTH, 102, 2, 0);
    panel_bus_expect("2A:00,00,01,3F 2B:00,00,00,EF 2C p640 2B:00,64,00,EF 2C p640 p640 ");
}

/* Each band goes back when its own transfer is done, to its own slot, and no other. */
static void test_deferred_transfers_release_their_own_band(void)
{
    const el_sink sink = start(&el_ili9341, EL_ROTATION_90);
    el_band bands[2];
    panel_bus.defers = true;
    sink.begin(sink.context, WIDTH, 240);
    for (uint16_t round = 0; round < 5; round++) {
        panel_bus_lend(&sink, &bands[0], pixels[0], WIDTH, (uint16_t)(round * 4), 2, 1);
        TEST_ASSERT_EQUAL_UINT8(1, bands[0].held[1]);
        panel_bus_lend(&sink, &bands[1], pixels[1], WIDTH, (uint16_t)(round * 4 + 2), 2, 2);
        bands[0].held[0] = 1; /* another sink's */
        TEST_ASSERT_EQUAL_UINT8(0, bands[0].held[1]);
        TEST_ASSERT_EQUAL_UINT8(1, bands[0].held[0]);
        TEST_ASSERT_EQUAL_UINT8(1, bands[1].held[2]);
        sink.wait(sink.context);
        TEST_ASSERT_EQUAL_UINT8(0, bands[1].held[2]);
    }
}

static void test_a_bus_without_wait(void)
{
    el_bus quiet = panel_bus_functions;
    quiet.wait = NULL;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_init(&panel, &(el_tft_config){.bus = &quiet, .model = &el_ili9341}));
    panel_bus_forget();
    const el_sink sink = el_tft_sink(&panel);
    sink.wait(sink.context);
    panel_bus_expect("");
}

/* --- Bytes -------------------------------------------------------------------------------------------------------- */

static void expect_transfer(const el_bus *bus, el_byte_order order, const char *transfer)
{
    const el_tft_config config = {.bus = bus, .model = &el_st7789, .byte_order = order};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_init(&panel, &config));
    const el_sink sink = el_tft_sink(&panel);
    el_band band;
    sink.begin(sink.context, 1, 320); /* one pixel a line, so that it can be read */
    panel_bus_lend(&sink, &band, pixels[0], 1, 0, 1, 0);
    panel_bus_forget();
    panel_bus.shows = true;
    pixels[0][0] = 0xABCD;
    panel_bus_lend(&sink, &band, pixels[0], 1, 1, 1, 0);
    panel_bus.shows = false;
    panel_bus_expect(transfer);
}

/* Words go high byte first, bytes as they lie in memory; this machine has the low one first. */
static void test_byte_order_for_each_kind_of_bus(void)
{
    el_bus words = panel_bus_functions;
    el_bus bytes = panel_bus_functions;
    words.bytes = NULL;
    bytes.pixels = NULL;
    expect_transfer(&panel_bus_functions, EL_HIGH_BYTE_FIRST, "p1[ABCD] ");
    expect_transfer(&panel_bus_functions, EL_LOW_BYTE_FIRST, "b2[CD,AB] ");
    expect_transfer(&words, EL_HIGH_BYTE_FIRST, "p1[ABCD] ");
    expect_transfer(&words, EL_LOW_BYTE_FIRST, "p1[CDAB] ");
    expect_transfer(&bytes, EL_HIGH_BYTE_FIRST, "b2[AB,CD] ");
    expect_transfer(&bytes, EL_LOW_BYTE_FIRST, "b2[CD,AB] ");
}

/* --- What the display shows already -------------------------------------------------------------------------------- */

#if EL_WITH_REUSE

enum { GLASS_WIDTH = 320, GLASS_HEIGHT = 24 };

static uint16_t picture[GLASS_HEIGHT][GLASS_WIDTH];
static uint32_t shown[EL_TFT_SHOWN_BYTES(GLASS_WIDTH, GLASS_HEIGHT) / 4];

/* A display of 320x24 that shows `picture`, its lines 20 to 23 being those that the frame after has in turn: 0 to 3. */
static el_sink start_sparing(void)
{
    static el_tft_model model;
    model = el_ili9341;
    model.memory_rows = model.rows = GLASS_WIDTH;
    model.memory_columns = model.columns = GLASS_HEIGHT;
    const el_tft_config config = {.bus = &panel_bus_functions,
                                  .model = &model,
                                  .rotation = EL_ROTATION_90,
                                  .shown = shown,
                                  .shown_bytes = sizeof shown};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_tft_init(&panel, &config));
    memset(picture, 0x5A, sizeof picture);
    return el_tft_sink(&panel);
}

/* In bands of 8 lines; those of `left_out`'s bits are offered as unchanged. */
static void show(const el_sink *sink, unsigned left_out)
{
    static uint16_t band_pixels[8 * GLASS_WIDTH];
    el_band band;
    sink->begin(sink->context, GLASS_WIDTH, GLASS_HEIGHT);
    for (uint16_t y = 0; y < GLASS_HEIGHT; y = (uint16_t)(y + 8)) {
        if ((left_out >> y / 8 & 1U) != 0 && sink->unchanged(sink->context, y, 8)) {
            continue;
        }
        memcpy(band_pixels, picture[y], sizeof band_pixels);
        panel_bus_lend(sink, &band, band_pixels, GLASS_WIDTH, y, 8, 0);
        TEST_ASSERT_EQUAL_UINT8(0, band.held[0]);
    }
    sink->end(sink->context, &(el_stats){0});
}

#define WHOLE "2A:00,00,01,3F 2B:00,00,00,17 2C p2560 p2560 p2560 "

/* Frame by frame four lines in turn; here six frames are once around. */
static void test_what_is_shown_is_not_sent_but_four_lines_in_turn(void)
{
    const el_sink sink = start_sparing();
    panel_bus_forget();
    show(&sink, 0);
    panel_bus_expect(WHOLE);
    TEST_ASSERT_EQUAL_UINT32(0, panel.pixels_kept);
    static const char *const turns[] = {"08", "0C", "10", "14", "00", "04"};
    for (unsigned frame = 0; frame < 12; frame++) {
        char expected[64];
        snprintf(expected, sizeof expected, "2A:00,00,01,3F 2B:00,%s,00,17 2C p1280 ", turns[frame % 6]);
        show(&sink, frame % 2 == 0 ? 0 : 7);
        panel_bus_expect(expected);
        TEST_ASSERT_EQUAL_UINT32(GLASS_WIDTH * (GLASS_HEIGHT - 4), panel.pixels_kept);
    }
}

/* A rectangle of segments in each band; the next one goes on in the same columns without a command. The lines in turn,
 * 8 to 11, are whole. */
static void test_rectangles_of_what_has_changed_are_sent(void)
{
    const el_sink sink = start_sparing();
    show(&sink, 0);
    panel_bus_forget();
    picture[1][40] = 1;
    picture[3][70] = 2;
    picture[16][33] = 3;
    picture[23][319] = 4;
    show(&sink, 0);
    panel_bus_expect("2A:00,20,00,5F 2B:00,01,00,17 2C p192 "
                     "2A:00,00,01,3F 2B:00,08,00,17 2C p1280 "
                     "2A:00,20,01,3F 2B:00,10,00,17 2C p2304 ");
    TEST_ASSERT_EQUAL_UINT32(GLASS_WIDTH * GLASS_HEIGHT - 192 - 1280 - 2304, panel.pixels_kept);
    show(&sink, 0); /* lines 12 to 15 */
    panel_bus_forget();
    picture[0][0] = picture[7][31] = 5;
    picture[8][0] = picture[10][31] = 6;
    show(&sink, 0);
    panel_bus_expect("2A:00,00,00,1F 2B:00,00,00,17 2C p256 p96 "
                     "2A:00,00,01,3F 2B:00,10,00,17 2C p1280 ");
}

/* The picture of a changed segment is what goes out, packed. */
static void test_the_pixels_that_are_sent_are_those_that_changed(void)
{
    const el_sink sink = start_sparing();
    show(&sink, 0);
    show(&sink, 0); /* 8 to 11 */
    panel_bus_forget();
    picture[2][64] = 0x1111;
    picture[3][95] = 0x2222;
    panel_bus.shows = true;
    show(&sink, 6);
    panel_bus.shows = false;
    char expected[64 * 5 + 64] = "2A:00,40,00,5F 2B:00,02,00,17 2C p64[";
    for (unsigned i = 0; i < 64; i++) {
        strcat(expected, i == 0 ? "1111" : i == 63 ? ",2222" : ",5A5A");
    }
    strcat(expected, "] ");
    TEST_ASSERT_EQUAL_STRING_LEN(expected, panel_bus.journal, strlen(expected));
}

/* A picture that stands still costs nothing, except that it is sent whole from time to time. */
static void test_a_still_picture_is_sent_whole_from_time_to_time(void)
{
    const el_sink sink = start_sparing();
    show(&sink, 0);
    panel_bus_forget();
    unsigned whole = 0;
    for (unsigned frame = 0; frame < 3 * EL_TFT_STILL_FRAMES; frame++) {
        sink.begin(sink.context, GLASS_WIDTH, GLASS_HEIGHT);
        if (sink.unchanged(sink.context, 0, GLASS_HEIGHT)) {
            TEST_ASSERT_EQUAL_UINT32(GLASS_WIDTH * GLASS_HEIGHT, panel.pixels_kept);
            sink.end(sink.context, &(el_stats){0});
            panel_bus_expect("");
            continue;
        }
        whole++;
        for (uint16_t y = 0; y < GLASS_HEIGHT; y = (uint16_t)(y + 8)) {
            el_band band;
            TEST_ASSERT_FALSE(sink.unchanged(sink.context, y, 8));
            panel_bus_lend(&sink, &band, picture[y], GLASS_WIDTH, y, 8, 0);
        }
        panel_bus_expect(WHOLE);
    }
    TEST_ASSERT_EQUAL_UINT(3, whole);
}

static void test_a_display_that_may_show_anything_gets_all(void)
{
    const el_sink sink = start_sparing();
    show(&sink, 0);
    show(&sink, 0);
    panel_bus_forget();
    el_tft_forget(&panel);
    show(&sink, 7);
    panel_bus_expect(WHOLE);
    show(&sink, 7);
    TEST_ASSERT_EQUAL_UINT32(GLASS_WIDTH * (GLASS_HEIGHT - 4), panel.pixels_kept);
    panel_bus_forget();
    sink.begin(sink.context, GLASS_WIDTH, GLASS_HEIGHT - 1); /* made black, then sent whole */
    panel_bus_forget();
    TEST_ASSERT_FALSE(sink.unchanged(sink.context, 0, 8));
    show(&sink, 7);
    panel_bus_expect(WHOLE);
}

/* Without memory for hashes bands go out whole, but not those of which the renderer says that they are unchanged. */
static void test_without_hashes_what_is_unchanged_is_not_sent(void)
{
    el_sink sink = start_sparing();
    panel.config.shown = NULL;
    show(&sink, 7);
    panel_bus_forget();
    show(&sink, 5); /* in turn: 8 to 11 */
    panel_bus_expect("2A:00,00,01,3F 2B:00,08,00,17 2C p2560 ");
    show(&sink, 0);
    panel_bus_expect(WHOLE);
}

static void test_too_little_memory_for_hashes_is_refused(void)
{
    const el_tft_config config = {
        .bus = &panel_bus_functions, .model = &el_st7735, .shown = shown, .shown_bytes = 4 * 4 * 160 - 1};
    panel_bus_forget();
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MEMORY, el_tft_init(&panel, &config));
    panel_bus_expect("");
}

#else

static void test_hashes_are_refused_where_they_are_left_out(void)
{
    static uint32_t shown[EL_TFT_SHOWN_BYTES(128, 160) / 4];
    const el_tft_config config = {
        .bus = &panel_bus_functions, .model = &el_st7735, .shown = shown, .shown_bytes = sizeof shown};
    panel_bus_forget();
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_tft_init(&panel, &config));
    panel_bus_expect("");
}

#endif

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ili9341_start);
    RUN_TEST(test_st7789_start);
    RUN_TEST(test_st7735_start);
    RUN_TEST(test_what_cannot_be_is_refused_before_anything_is_sent);
    RUN_TEST(test_windows_of_modules_as_large_as_the_memory);
    RUN_TEST(test_windows_of_the_square_st7789);
    RUN_TEST(test_windows_of_the_st7735);
    RUN_TEST(test_windows_of_glass_anywhere_in_the_memory);
    RUN_TEST(test_one_window_per_frame);
    RUN_TEST(test_what_a_smaller_frame_leaves_free_is_made_black_once);
    RUN_TEST(test_a_frame_larger_than_the_glass_is_given_back_and_not_sent);
    RUN_TEST(test_a_gap_sets_rows_where_it_ends);
    RUN_TEST(test_deferred_transfers_release_their_own_band);
    RUN_TEST(test_a_bus_without_wait);
    RUN_TEST(test_byte_order_for_each_kind_of_bus);
#if EL_WITH_REUSE
    RUN_TEST(test_what_is_shown_is_not_sent_but_four_lines_in_turn);
    RUN_TEST(test_rectangles_of_what_has_changed_are_sent);
    RUN_TEST(test_the_pixels_that_are_sent_are_those_that_changed);
    RUN_TEST(test_a_still_picture_is_sent_whole_from_time_to_time);
    RUN_TEST(test_a_display_that_may_show_anything_gets_all);
    RUN_TEST(test_without_hashes_what_is_unchanged_is_not_sent);
    RUN_TEST(test_too_little_memory_for_hashes_is_refused);
#else
    RUN_TEST(test_hashes_are_refused_where_they_are_left_out);
#endif
    return UNITY_END();
}
