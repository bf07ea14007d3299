/* The OLEDs' driver on a bus that writes down what it is told: the exact bytes of start, windows and bands for each
 * rotation; and, put back together by a reader of the bytes that shares nothing with the driver, the dithered picture as
 * the viewer sees it, for every rotation, mirroring, size, band height and amount of memory. */
#include <stdlib.h>
#include <string.h>

#include "base/dither.h"
#include "panel/ssd0323.h"
#include "panel/ssd1306.h"
#include "seeded.h"
#include "test_panel_bus.h"

enum { COLUMNS = 128, ROWS = 64, MAX_PIXELS = COLUMNS * ROWS };

static el_oled panel;
static uint8_t memory[4096];

void setUp(void)
{
    panel_bus_start();
    memset(&panel, 0xA5, sizeof panel);
    memset(memory, 0xA5, sizeof memory);
}

void tearDown(void)
{
}

typedef struct chip {
    const char *name;
    el_status (*init)(el_oled *, const el_oled_config *);
    el_sink (*sink)(el_oled *);
    unsigned levels;
    uint8_t column_range;
    uint8_t row_range;
    unsigned column_bytes; /* of the whole memory behind the glass */
    unsigned row_bytes;
} chip;

static const chip ssd1306 = {"SSD1306", el_ssd1306_init, el_ssd1306_sink, 1, 0x21, 0x22, 128, 8};
static const chip ssd0323 = {"SSD0323", el_ssd0323_init, el_ssd0323_sink, 15, 0x15, 0x75, 64, 64};

static el_sink start(const chip *is, el_oled_config config, size_t memory_bytes)
{
    config.bus = config.bus != NULL ? config.bus : &panel_bus_functions;
    config.memory = memory;
    config.memory_bytes = memory_bytes;
    TEST_ASSERT_EQUAL_INT(EL_OK, is->init(&panel, &config));
    return is->sink(&panel);
}

/* --- Start -------------------------------------------------------------------------------------------------------- */

#define SSD0323_START                                                                                                  \
    "R0 d1 R1 d1 81 32 85 A2 4C A8 3F B1 22 B2 46 B3 F1 BF 0D BE 02 BC 10 B8 01 11 22 32 43 54 65 76 AD 03 "

static void expect_start(const chip *is, el_oled_config config, const char *start_up)
{
    start(is, config, sizeof memory);
    panel_bus_expect(start_up);
}

/* Memory addressing mode, 10.1.3: 0 horizontal, 1 vertical. Inverse display, 10.1.10. */
static void test_ssd1306_start(void)
{
    expect_start(&ssd1306, (el_oled_config){.rotation = EL_ROTATION_0}, "R0 d1 R1 d1 8D 14 A1 C8 20 00 A6 AF ");
    expect_start(&ssd1306, (el_oled_config){.rotation = EL_ROTATION_90}, "R0 d1 R1 d1 8D 14 A1 C8 20 01 A6 AF ");
    expect_start(&ssd1306, (el_oled_config){.rotation = EL_ROTATION_180}, "R0 d1 R1 d1 8D 14 A1 C8 20 00 A6 AF ");
    expect_start(&ssd1306, (el_oled_config){.rotation = EL_ROTATION_270}, "R0 d1 R1 d1 8D 14 A1 C8 20 01 A6 AF ");
    expect_start(&ssd1306, (el_oled_config){.inverted = 1}, "R0 d1 R1 d1 8D 14 A1 C8 20 00 A7 AF ");
}

/* Remap: 40 split, 10 COMs, 04 vertical increment, 02 nibbles. */
static void test_ssd0323_start(void)
{
    expect_start(&ssd0323, (el_oled_config){.rotation = EL_ROTATION_0}, SSD0323_START "A0 52 A4 AF ");
    expect_start(&ssd0323, (el_oled_config){.rotation = EL_ROTATION_90}, SSD0323_START "A0 56 A4 AF ");
    expect_start(&ssd0323, (el_oled_config){.rotation = EL_ROTATION_180}, SSD0323_START "A0 52 A4 AF ");
    expect_start(&ssd0323, (el_oled_config){.rotation = EL_ROTATION_270}, SSD0323_START "A0 56 A4 AF ");
    expect_start(&ssd0323, (el_oled_config){.inverted = 1}, SSD0323_START "A0 52 A7 AF ");
}

static void expect_error(const chip *is, el_status status, const el_oled_config *config)
{
    TEST_ASSERT_EQUAL_INT(status, is->init(&panel, config));
    panel_bus_expect("");
}

static void test_what_cannot_be_is_refused_before_anything_is_sent(void)
{
    const chip *const chips[] = {&ssd1306, &ssd0323};
    const el_oled_config good = {.bus = &panel_bus_functions, .memory = memory, .memory_bytes = sizeof memory};
    for (size_t i = 0; i < 2; i++) {
        const chip *const is = chips[i];
        TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, is->init(NULL, &good));
        expect_error(is, EL_ERROR_ARGUMENT, NULL);
        el_oled_config bad = good;
        bad.bus = NULL;
        expect_error(is, EL_ERROR_ARGUMENT, &bad);
        bad = good;
        bad.memory = NULL;
        expect_error(is, EL_ERROR_ARGUMENT, &bad);
        bad = good;
        bad.rotation = (el_rotation)4;
        expect_error(is, EL_ERROR_ARGUMENT, &bad);
        for (int missing = 0; missing < 4; missing++) {
            el_bus incomplete = panel_bus_functions;
            incomplete.reset = missing == 0 ? NULL : incomplete.reset;
            incomplete.command = missing == 1 ? NULL : incomplete.command;
            incomplete.bytes = missing == 2 ? NULL : incomplete.bytes;
            incomplete.delay_ms = missing == 3 ? NULL : incomplete.delay_ms;
            bad = good;
            bad.bus = &incomplete;
            expect_error(is, EL_ERROR_ARGUMENT, &bad);
        }
    }
}

/* The least memory is two units: pages, lines, or columns of pixel pairs. */
static void test_too_little_memory_is_refused(void)
{
    static const struct {
        const chip *is;
        el_rotation rotation;
        size_t least;
    } cases[] = {
        {&ssd1306, EL_ROTATION_0, 256},   {&ssd1306, EL_ROTATION_90, 16},   {&ssd1306, EL_ROTATION_180, 256},
        {&ssd1306, EL_ROTATION_270, 16},  {&ssd0323, EL_ROTATION_0, 128},   {&ssd0323, EL_ROTATION_90, 128},
        {&ssd0323, EL_ROTATION_180, 128}, {&ssd0323, EL_ROTATION_270, 128},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        start(cases[i].is, (el_oled_config){.rotation = cases[i].rotation}, cases[i].least);
        panel_bus_forget();
        expect_error(cases[i].is, EL_ERROR_MEMORY,
                     &(el_oled_config){.bus = &panel_bus_functions,
                                       .rotation = cases[i].rotation,
                                       .memory = memory,
                                       .memory_bytes = cases[i].least - 1});
    }
}

static void test_memory_for_a_band(void)
{
    TEST_ASSERT_EQUAL_UINT(256, EL_SSD1306_MEMORY_BYTES(1));
    TEST_ASSERT_EQUAL_UINT(256, EL_SSD1306_MEMORY_BYTES(8));
    TEST_ASSERT_EQUAL_UINT(512, EL_SSD1306_MEMORY_BYTES(3)); /* 7 lines before and 3: 2 pages */
    TEST_ASSERT_EQUAL_UINT(512, EL_SSD1306_MEMORY_BYTES(16));
    TEST_ASSERT_EQUAL_UINT(2048, EL_SSD1306_MEMORY_BYTES(64));
    TEST_ASSERT_EQUAL_UINT(1024, EL_SSD0323_MEMORY_BYTES(8));
}

/* --- Exact bytes --------------------------------------------------------------------------------------------------- */

static uint16_t picture[MAX_PIXELS];

static void send_frame(const el_sink *sink, uint16_t width, uint16_t height, uint16_t band_lines)
{
    static uint16_t lent[2][MAX_PIXELS];
    el_band bands[2];
    sink->begin(sink->context, width, height);
    for (unsigned y = 0, i = 0; y < height; y += band_lines, i ^= 1U) {
        const unsigned lines = height - y < band_lines ? height - y : band_lines;
        memcpy(lent[i], picture + (size_t)y * width, sizeof(uint16_t) * lines * width);
        panel_bus_lend(sink, &bands[i], lent[i], width, (uint16_t)y, (uint16_t)lines, i);
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(0, bands[i].held[i], "the band was not given back at once");
        memset(lent[i], 0x5A, sizeof(uint16_t) * lines * width); /* and is drawn anew */
    }
    sink->end(sink->context, &(el_stats){0});
}

/* White where the text has a #; as large as the text, whose lines end with a slash. */
static void draw(const char *text, uint16_t *width, uint16_t *height)
{
    const size_t line = strcspn(text, "/");
    size_t pixels = 0;
    for (; *text != 0; text++) {
        if (*text != '/') {
            picture[pixels++] = *text == '#' ? 0xFFFF : 0;
        }
    }
    *width = (uint16_t)line;
    *height = (uint16_t)(pixels / line);
}

/* What a frame sends after an equal one, so without the glass being made black. */
static void expect_frame(const chip *is, el_rotation rotation, const char *text, uint16_t band_lines, const char *bytes)
{
    uint16_t width;
    uint16_t height;
    const el_sink sink = start(is, (el_oled_config){.rotation = rotation}, sizeof memory);
    draw(text, &width, &height);
    send_frame(&sink, width, height, band_lines);
    panel_bus_forget();
    panel_bus.shows = true;
    send_frame(&sink, width, height, band_lines);
    panel_bus.shows = false;
    panel_bus_expect(bytes);
}

static const char *const mark = "##./"
                                "#../"
                                "#../"
                                ".../"
                                ".../"
                                ".../"
                                ".../"
                                ".../"
                                ".#./"
                                "..#/";

/* Pages of 8 lines, the top one is bit 0; the second page has 2 lines. Upside down the frame ends at column 127 and page
 * 7, and its first line is bit 7. */
static void test_ssd1306_upright_and_upside_down(void)
{
    expect_frame(&ssd1306, EL_ROTATION_0, mark, 8, "21 00 02 22 00 01 b3[07,01,00] b3[00,01,02] ");
    expect_frame(&ssd1306, EL_ROTATION_0, mark, 3, "21 00 02 22 00 01 b3[07,01,00] b3[00,01,02] ");
    expect_frame(&ssd1306, EL_ROTATION_0, mark, 10, "21 00 02 22 00 01 b6[07,01,00,00,01,02] ");
    expect_frame(&ssd1306, EL_ROTATION_180, mark, 8, "21 7D 7F 22 07 07 b3[00,80,E0] 22 06 06 b3[40,80,00] ");
    expect_frame(&ssd1306, EL_ROTATION_180, mark, 10, "21 7D 7F 22 06 07 b6[40,80,00,00,80,E0] ");
}

/* Sideways a line is a column of the glass, of one page here. */
static void test_ssd1306_sideways(void)
{
    expect_frame(&ssd1306, EL_ROTATION_270, "##./#../", 1, "22 07 07 21 00 01 b1[C0] b1[80] ");
    expect_frame(&ssd1306, EL_ROTATION_90, "##./#../", 1, "22 00 00 21 7F 7F b1[03] 21 7E 7E b1[01] ");
    expect_frame(&ssd1306, EL_ROTATION_90, "##./#../", 2, "22 00 00 21 7E 7F b2[01,03] ");
    expect_frame(&ssd1306, EL_ROTATION_90, "#.......#/", 1, "22 00 01 21 7F 7F b2[01,01] ");
}

/* The left pixel is the upper half. */
static void test_ssd0323_upright_and_upside_down(void)
{
    expect_frame(&ssd0323, EL_ROTATION_0, "##./#.#/", 1, "15 00 01 75 00 01 b2[FF,00] b2[F0,F0] ");
    expect_frame(&ssd0323, EL_ROTATION_0, "##./#.#/", 2, "15 00 01 75 00 01 b4[FF,00,F0,F0] ");
    expect_frame(&ssd0323, EL_ROTATION_180, "##./#.#/", 1, "15 3E 3F 75 3F 3F b2[00,FF] 75 3E 3E b2[0F,0F] ");
    expect_frame(&ssd0323, EL_ROTATION_180, "##./#.#/", 2, "15 3E 3F 75 3E 3F b4[0F,0F,00,FF] ");
}

/* Sideways two lines share a column of bytes. */
static void test_ssd0323_sideways(void)
{
    expect_frame(&ssd0323, EL_ROTATION_270, "##./#.#/##./", 1, "75 3D 3F 15 00 01 b3[0F,F0,FF] b3[00,F0,F0] ");
    expect_frame(&ssd0323, EL_ROTATION_90, "##./#.#/##./", 1, "75 00 02 15 3F 3F b3[FF,0F,F0] 15 3E 3E b3[0F,0F,00] ");
    expect_frame(&ssd0323, EL_ROTATION_90, "##./#.#/##./", 3, "75 00 02 15 3E 3F b6[0F,0F,00,FF,0F,F0] ");
}

static void test_a_frame_larger_than_the_glass_is_given_back_and_not_sent(void)
{
    const el_sink sink = start(&ssd1306, (el_oled_config){.rotation = EL_ROTATION_0}, 256);
    TEST_ASSERT_EQUAL_UINT16(128, el_oled_width(&panel));
    TEST_ASSERT_EQUAL_UINT16(64, el_oled_height(&panel));
    panel_bus_forget();
    send_frame(&sink, 129, 8, 8);
    send_frame(&sink, 64, 65, 8);
    panel_bus_expect("");
}

static void test_what_a_smaller_frame_leaves_free_is_made_black_once(void)
{
    const el_sink sink = start(&ssd1306, (el_oled_config){.rotation = EL_ROTATION_0}, 1000);
    panel_bus_forget();
    send_frame(&sink, 128, 64, 64);
    panel_bus_expect("21 00 7F 22 00 07 b384 b384 b256 "); /* 3 pages fit half of 1000 bytes */
    send_frame(&sink, 128, 63, 63);
    panel_bus_expect("21 00 7F 22 00 07 b500 b500 b24 21 00 7F 22 00 07 b384 b384 b256 ");
    send_frame(&sink, 128, 63, 63);
    panel_bus_expect("21 00 7F 22 00 07 b384 b384 b256 ");
}

/* --- Any picture ---------------------------------------------------------------------------------------------------- */

/* A chip that takes the driver's bytes, at the time that `late` says: 0 at once; 1 when the wire is needed, or somebody
 * waits; else after so many waits. */
static struct {
    const chip *is;
    uint8_t ram[64 * 64]; /* row by row of bytes */
    bool vertical;
    uint8_t range[2][2]; /* of columns, of rows */
    unsigned at[2];
    uint8_t code; /* of the command whose parameters are due */
    unsigned due;
    unsigned taken;
    unsigned late;
    unsigned waits;
    const uint8_t *bytes;
    size_t count;
    size_t left; /* on the wire */
    uint8_t copy[sizeof memory];
    void (*done)(void *);
    void *argument;
} glass;

static void glass_byte(uint8_t byte)
{
    const unsigned first = glass.vertical ? 1 : 0;
    TEST_ASSERT_LESS_THAN_UINT(glass.is->column_bytes, glass.at[0]);
    TEST_ASSERT_LESS_THAN_UINT(glass.is->row_bytes, glass.at[1]);
    glass.ram[glass.at[1] * glass.is->column_bytes + glass.at[0]] = byte;
    for (unsigned i = 0; i < 2; i++) {
        const unsigned axis = first ^ i;
        if (glass.at[axis] != glass.range[axis][1]) {
            glass.at[axis]++;
            return;
        }
        glass.at[axis] = glass.range[axis][0];
    }
}

/* The bytes leave, which does not give their memory back. */
static void glass_take(void)
{
    for (; glass.left > 0; glass.left--) {
        glass_byte(glass.bytes[glass.count - glass.left]);
    }
}

static void glass_complete(void)
{
    if (glass.bytes != NULL) {
        glass_take();
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(glass.copy, glass.bytes, glass.count,
                                         "memory changed before it was given back");
        glass.bytes = NULL;
        glass.done(glass.argument);
    }
}

static void glass_command(void *context, uint8_t byte, const uint8_t *parameters, size_t count)
{
    (void)context;
    (void)parameters;
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, count, "parameters have D/C low");
    glass_take(); /* D/C changes when the wire is idle; the interrupt that calls `done` may come later */
    if (glass.due == 0) {
        glass.code = byte;
        glass.taken = 0;
        const bool is_range = byte == glass.is->column_range || byte == glass.is->row_range;
        const bool is_mode = byte == (glass.is == &ssd1306 ? 0x20 : 0xA0);
        glass.due = is_range ? 2 : is_mode ? 1 : 0;
        return;
    }
    glass.due--;
    if (glass.code == 0x20) {
        glass.vertical = byte == 1;
    } else if (glass.code == 0xA0) {
        glass.vertical = (byte & 4) != 0;
    } else {
        const unsigned axis = glass.code == glass.is->row_range;
        glass.range[axis][glass.taken++] = byte;
        glass.at[axis] = glass.range[axis][0];
    }
}

static void glass_transfer(void *context, const uint8_t *bytes, size_t count, void (*done)(void *), void *argument)
{
    (void)context;
    glass_complete();
    glass.bytes = bytes;
    glass.count = count;
    glass.left = count;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(sizeof glass.copy, count);
    memcpy(glass.copy, bytes, count);
    glass.done = done;
    glass.argument = argument;
    glass.waits = 0;
    if (glass.late == 0) {
        glass_complete();
    }
}

static void glass_wait(void *context)
{
    (void)context;
    if (++glass.waits >= glass.late) {
        glass_complete();
    }
}

static unsigned level_on_glass(unsigned column, unsigned row)
{
    if (glass.is == &ssd1306) {
        return ((unsigned)glass.ram[row / 8 * 128 + column] >> row % 8) & 1U;
    }
    return ((unsigned)glass.ram[row * 64 + column / 2] >> (column % 2 == 0 ? 4 : 0)) & 15U;
}

/* As the viewer sees it. */
static unsigned level_seen(el_rotation rotation, bool mirrored, unsigned x, unsigned y)
{
    const unsigned width = rotation == EL_ROTATION_90 || rotation == EL_ROTATION_270 ? ROWS : COLUMNS;
    const unsigned seen = mirrored ? width - 1 - x : x;
    switch (rotation) {
    case EL_ROTATION_90:
        return level_on_glass(COLUMNS - 1 - y, seen);
    case EL_ROTATION_180:
        return level_on_glass(COLUMNS - 1 - seen, ROWS - 1 - y);
    case EL_ROTATION_270:
        return level_on_glass(y, ROWS - 1 - seen);
    default:
        return level_on_glass(seen, y);
    }
}

/* Of a line that base/dither.h made. */
static unsigned level_of(const uint8_t *line, unsigned x)
{
    return glass.is == &ssd1306 ? ((unsigned)line[x / 8] >> (7 - x % 8)) & 1U
                                : ((unsigned)line[x / 2] >> (x % 2 == 0 ? 4 : 0)) & 15U;
}

static void expect_picture(el_rotation rotation, bool mirrored, unsigned width, unsigned height, const char *name)
{
    const bool sideways = rotation == EL_ROTATION_90 || rotation == EL_ROTATION_270;
    const unsigned glass_width = sideways ? ROWS : COLUMNS;
    for (unsigned y = 0; y < MAX_PIXELS / glass_width; y++) {
        uint8_t line[COLUMNS] = {0};
        if (y < height && glass.is == &ssd1306) {
            el_dither_mono(line, picture + (size_t)y * width, width, y);
        } else if (y < height) {
            el_dither_grey4(line, picture + (size_t)y * width, width, y);
        }
        for (unsigned x = 0; x < glass_width; x++) {
            const unsigned expected = x < width ? level_of(line, x) : 0;
            if (expected != level_seen(rotation, mirrored, x, y)) {
                char message[160];
                snprintf(message, sizeof message, "%s at %d degrees, mirrored %d, %u x %u: pixel %u, %u", name,
                         90 * (int)rotation, mirrored, width, height, x, y);
                TEST_ASSERT_EQUAL_UINT_MESSAGE(expected, level_seen(rotation, mirrored, x, y), message);
            }
        }
    }
}

static void try_any(const chip *is, seeded *s, el_rotation rotation, bool mirrored)
{
    static const el_bus bus = {.reset = panel_bus_reset,
                               .command = glass_command,
                               .bytes = glass_transfer,
                               .delay_ms = panel_bus_delay,
                               .wait = glass_wait};
    const bool sideways = rotation == EL_ROTATION_90 || rotation == EL_ROTATION_270;
    memset(&glass, 0, sizeof glass);
    for (size_t i = 0; i < sizeof glass.ram; i++) {
        glass.ram[i] = (uint8_t)any_u64(s); /* after power-on */
    }
    glass.is = is;
    glass.late = any_below(s, 4);
    const size_t memory_bytes = (size_t)any_between(s, 256, any_below(s, 2) != 0 ? 300 : 2000);
    const el_sink sink =
        start(is, (el_oled_config){.bus = &bus, .rotation = rotation, .mirrored = mirrored}, memory_bytes);
    panel_bus_forget();
    for (int frame = 0; frame < 3; frame++) {
        const bool whole = any_below(s, 4) == 0;
        const unsigned width = whole ? el_oled_width(&panel) : 1 + any_below(s, el_oled_width(&panel));
        const unsigned height = whole ? el_oled_height(&panel) : 1 + any_below(s, el_oled_height(&panel));
        TEST_ASSERT_EQUAL_UINT(sideways ? ROWS : COLUMNS, el_oled_width(&panel));
        for (size_t i = 0; i < (size_t)width * height; i++) {
            picture[i] = (uint16_t)any_u64(s);
        }
        send_frame(&sink, (uint16_t)width, (uint16_t)height, (uint16_t)any_between(s, 1, height < 20 ? height : 20));
        glass_complete();
        expect_picture(rotation, mirrored, width, height, is->name);
    }
}

static void try_all(const chip *is, uint64_t seed)
{
    seeded s = seeded_from(seed);
    for (s.round = 0; s.round < 8 * PART_OF(24); s.round++) {
        try_any(is, &s, (el_rotation)(s.round & 3U), (s.round & 4U) != 0);
    }
}

static void test_ssd1306_shows_any_picture_of_any_size_any_way_up(void)
{
    try_all(&ssd1306, 1306);
}

static void test_ssd0323_shows_any_picture_of_any_size_any_way_up(void)
{
    try_all(&ssd0323, 323);
}

/* A frame that is given up halfway leaves nothing behind in the next one. */
static void test_a_frame_after_an_unfinished_one(void)
{
    uint16_t width;
    uint16_t height;
    const el_sink sink = start(&ssd1306, (el_oled_config){.rotation = EL_ROTATION_0}, 256);
    draw(mark, &width, &height);
    send_frame(&sink, width, height, 8);
    uint16_t white[5 * 3];
    memset(white, 0xFF, sizeof white);
    el_band band;
    sink.begin(sink.context, width, height);
    panel_bus_lend(&sink, &band, white, width, 0, 5, 0);
    panel_bus_forget();
    panel_bus.shows = true;
    send_frame(&sink, width, height, 8);
    panel_bus_expect("21 00 02 22 00 01 b3[07,01,00] b3[00,01,02] ");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ssd1306_start);
    RUN_TEST(test_ssd0323_start);
    RUN_TEST(test_what_cannot_be_is_refused_before_anything_is_sent);
    RUN_TEST(test_too_little_memory_is_refused);
    RUN_TEST(test_memory_for_a_band);
    RUN_TEST(test_ssd1306_upright_and_upside_down);
    RUN_TEST(test_ssd1306_sideways);
    RUN_TEST(test_ssd0323_upright_and_upside_down);
    RUN_TEST(test_ssd0323_sideways);
    RUN_TEST(test_a_frame_larger_than_the_glass_is_given_back_and_not_sent);
    RUN_TEST(test_what_a_smaller_frame_leaves_free_is_made_black_once);
    RUN_TEST(test_ssd1306_shows_any_picture_of_any_size_any_way_up);
    RUN_TEST(test_ssd0323_shows_any_picture_of_any_size_any_way_up);
    RUN_TEST(test_a_frame_after_an_unfinished_one);
    return UNITY_END();
}
