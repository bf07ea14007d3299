/* The models of SSD1306 and SSD0323: where bytes go, how they look, and each fault in words. Their commands and their
 * commands' parameters all come with D/C low. */
#include <string.h>

#include "test_lcd_send.h"

static el_lcd *lcd;
static uint16_t glass[128 * 64];

static void create(const el_lcd_profile *profile)
{
    el_lcd_destroy(lcd);
    lcd = el_lcd_create(profile);
    TEST_ASSERT_NOT_NULL(lcd);
}

void setUp(void)
{
    lcd = NULL;
}

void tearDown(void)
{
    el_lcd_destroy(lcd);
}

static void send(int dc, size_t count, const uint8_t *bytes)
{
    for (size_t i = 0; i < count; i++) {
        el_lcd_write(lcd, dc, bytes[i]);
    }
}

#define COMMANDS(...) send(0, sizeof((const uint8_t[]){__VA_ARGS__}), (const uint8_t[]){__VA_ARGS__})
#define DATA(...) send(1, sizeof((const uint8_t[]){__VA_ARGS__}), (const uint8_t[]){__VA_ARGS__})

/* The upright, horizontal, black SSD1306. */
static void start_ssd1306(void)
{
    create(&EL_LCD_SSD1306);
    COMMANDS(0x8D, 0x14, 0xA1, 0xC8, 0x20, 0x00, 0xAF);
    for (unsigned i = 0; i < 1024; i++) {
        el_lcd_write(lcd, 1, 0);
    }
}

/* The upright, horizontal, black SSD0323. */
static void start_ssd0323(void)
{
    create(&EL_LCD_SSD0323);
    COMMANDS(0xA0, 0x52, 0xA2, 0x4C, 0xA8, 0x3F, 0x15, 0, 63, 0x75, 0, 63, 0xAF);
    for (unsigned i = 0; i < 4096; i++) {
        el_lcd_write(lcd, 1, 0);
    }
}

static char grey_digit(uint16_t rgb565)
{
    return rgb565 == 0 ? '.' : "0123456789ABCDEF"[rgb565 >> 12];
}

/* Expects these rows in this corner (x, y) of the upright glass, `.` for black and the upper four bits of the rest, and
 * nothing lit anywhere else. */
static void expect_glass(unsigned x, unsigned y, size_t rows, const char *const *picture)
{
    char row[129] = {0};
    unsigned lit = 0;
    unsigned expected = 0;
    expect_no_errors(lcd);
    el_lcd_glass(lcd, glass);
    for (size_t i = 0; i < 128 * 64; i++) {
        lit += glass[i] != 0;
    }
    for (size_t r = 0; r < rows; r++) {
        const size_t width = strlen(picture[r]);
        for (size_t c = 0; c < width; c++) {
            row[c] = grey_digit(glass[(y + r) * 128 + x + c]);
            expected += picture[r][c] != '.';
        }
        row[width] = 0;
        TEST_ASSERT_EQUAL_STRING(picture[r], row);
    }
    TEST_ASSERT_EQUAL_UINT(expected, lit);
}

#define EXPECT_GLASS(x, y, ...)                                                                                        \
    expect_glass(x, y, sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *), (const char *const[]){__VA_ARGS__})

static void expect_fault(el_lcd_fault fault, const char *text)
{
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_error_count(lcd));
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, fault));
    TEST_ASSERT_EQUAL_STRING(text, el_lcd_error_at(lcd, 0)->text);
}

/* SSD1306. */

static void test_1306_a_byte_is_a_column_with_its_lowest_bit_on_top(void)
{
    start_ssd1306();
    DATA(0x01, 0x83, 0x0F);
    EXPECT_GLASS(0, 0, "FFF.", ".FF.", "..F.", "..F.", "....", "....", "....", ".F..", "....");
}

static void test_1306_horizontal_mode_goes_to_the_next_page_at_the_windows_end(void)
{
    start_ssd1306();
    COMMANDS(0x21, 126, 127, 0x22, 6, 7);
    DATA(0x01, 0x03, 0x01, 0x01, 0x80);
    EXPECT_GLASS(124, 48, "...F", "...F", "....", "....", "....", "....", "....", "..F.", "..FF");
}

static void test_1306_vertical_mode_goes_down_first(void)
{
    start_ssd1306();
    COMMANDS(0x20, 0x01, 0x21, 5, 6, 0x22, 1, 2);
    DATA(0x01, 0x03, 0x07, 0x0F);
    EXPECT_GLASS(4, 7, "....", ".FF.", "..F.", "..F.", "....", "....", "....", "....", "....", ".FF.", ".FF.", "..F.",
                 "..F.");
}

static void test_1306_page_mode_stays_in_its_page(void)
{
    start_ssd1306();
    COMMANDS(0x20, 0x02, 0xB3, 0x0E, 0x17);
    DATA(0x01, 0x01, 0x03); /* columns 126, 127, and again 126 */
    EXPECT_GLASS(124, 23, "....", "..FF", "..F.", "....");
}

static void test_1306_segment_remap_acts_on_what_is_written_after_it(void)
{
    start_ssd1306();
    DATA(0x01);
    COMMANDS(0xA0);
    EXPECT_GLASS(0, 0, "F...");
    COMMANDS(0x21, 1, 127, 0x22, 0, 7);
    DATA(0x01);
    EXPECT_GLASS(0, 0,
                 "F............................................................................................"
                 ".................................F.");
}

static void test_1306_scan_direction_start_line_and_offset_move_all_rows(void)
{
    start_ssd1306();
    DATA(0x05);
    EXPECT_GLASS(0, 0, "F.", "..", "F.");
    COMMANDS(0xC0);
    EXPECT_GLASS(0, 61, "F.", "..", "F.");
    COMMANDS(0xC8, 0x40 | 62);
    EXPECT_GLASS(0, 0, "..", "..", "F.", "..", "F.");
    COMMANDS(0x40, 0xD3, 60);
    EXPECT_GLASS(0, 0, "..", "..", "..", "..", "F.", "..", "F.");
}

static void test_1306_inversion_all_lit_and_off(void)
{
    start_ssd1306();
    COMMANDS(0xA7);
    el_lcd_glass(lcd, glass);
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, glass, 128 * 64);
    COMMANDS(0xA6, 0xA5);
    el_lcd_glass(lcd, glass);
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, glass, 128 * 64);
    COMMANDS(0xAE);
    el_lcd_glass(lcd, glass);
    TEST_ASSERT_EACH_EQUAL_HEX16(0, glass, 128 * 64);
    expect_no_errors(lcd);
}

static void test_1306_comes_out_of_reset_in_page_mode_dark_and_with_its_memory(void)
{
    start_ssd1306();
    DATA(0x01);
    el_lcd_reset(lcd, 0);
    el_lcd_advance_ns(lcd, 3000);
    el_lcd_reset(lcd, 1);
    el_lcd_advance_ns(lcd, 3000);
    COMMANDS(0xB0, 0x00, 0x10);
    EXPECT_GLASS(0, 0, ".");
    COMMANDS(0x8D, 0x14, 0xC8, 0xAF);
    EXPECT_GLASS(0, 0, "F.");
}

typedef struct bad_bytes {
    uint8_t count;
    uint8_t commands[9];
    el_lcd_fault fault;
    const char *text;
} bad_bytes;

static void expect_each(const el_lcd_profile *profile, const bad_bytes *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        create(profile);
        send(0, cases[i].count, cases[i].commands);
        expect_fault(cases[i].fault, cases[i].text);
    }
}

static void test_1306_faults_in_words(void)
{
    static const bad_bytes CASES[] = {
        {1, {0xFD}, EL_LCD_UNKNOWN, "SSD1306: byte 0: command FDh is not known to this model"},
        {2,
         {0x20, 3},
         EL_LCD_BAD_VALUE,
         "SSD1306: byte 1: 20h Set Memory Addressing Mode: the mode is 0, 1 or 2 (section 10.1.3)"},
        {5,
         {0x20, 0, 0x21, 0, 128},
         EL_LCD_BAD_WINDOW,
         "SSD1306: byte 4: 21h Set Column Address: 0..128 is out of range (section 10.1.4)"},
        {5,
         {0x20, 0, 0x22, 5, 4},
         EL_LCD_BAD_WINDOW,
         "SSD1306: byte 4: 22h Set Page Address: 5..4 is reversed (section 10.1.5)"},
        {3,
         {0x21, 0, 127},
         EL_LCD_WRONG_MODE,
         "SSD1306: byte 0: 21h Set Column Address: only in horizontal or vertical addressing mode (section 10.1.4)"},
        {3,
         {0x20, 0, 0xB3},
         EL_LCD_WRONG_MODE,
         "SSD1306: byte 2: B3h Set Page Start Address: only in page addressing mode (section 10.1.13)"},
        {1,
         {0xAF},
         EL_LCD_WRONG_MODE,
         "SSD1306: byte 0: AFh Set Display ON/OFF: the module has no supply but the charge pump, which is off "
         "(section 10.1.12)"},
        {5,
         {0x8D, 0x14, 0xAF, 0x8D, 0x14},
         EL_LCD_WRONG_MODE,
         "SSD1306: byte 4: 8Dh Charge Pump Setting: only while the display is off (section appendix 2.1)"},
        {2,
         {0x8D, 0x04},
         EL_LCD_BAD_VALUE,
         "SSD1306: byte 1: 8Dh Charge Pump Setting: the value is 10h (off) or 14h (on) (section appendix 2.1)"},
        {2,
         {0xA8, 31},
         EL_LCD_BAD_VALUE,
         "SSD1306: byte 1: A8h Set Multiplex Ratio: the module's 64 rows take 3Fh (section 10.1.11)"},
        {2,
         {0xDA, 0x02},
         EL_LCD_BAD_VALUE,
         "SSD1306: byte 1: DAh Set COM Pins Hardware Configuration: the module's wiring takes 12h (section 10.1.18)"},
        {2,
         {0xD3, 64},
         EL_LCD_BAD_VALUE,
         "SSD1306: byte 1: D3h Set Display Offset: the offset is 0 to 63 (section 10.1.15)"},
        {2,
         {0xD9, 0xF0},
         EL_LCD_BAD_VALUE,
         "SSD1306: byte 1: D9h Set Pre-charge Period: a phase of 0 clocks is invalid (section 10.1.17)"},
        {2,
         {0xDB, 0x40},
         EL_LCD_BAD_VALUE,
         "SSD1306: byte 1: DBh Set VCOMH Deselect Level: the value is 00h, 20h or 30h (section 10.1.19)"},
    };
    expect_each(&EL_LCD_SSD1306, CASES, sizeof CASES / sizeof CASES[0]);
}

/* D/C high for a parameter, as controllers of colour displays have it. */
static void test_data_instead_of_a_parameter_is_too_few(void)
{
    create(&EL_LCD_SSD1306);
    COMMANDS(0x81);
    DATA(0x7F);
    expect_fault(EL_LCD_TOO_FEW,
                 "SSD1306: byte 1: 81h Set Contrast Control had 0 parameters, it takes 1 (section 10.1.7)");
    create(&EL_LCD_SSD0323);
    COMMANDS(0x15, 0);
    el_lcd_finish(lcd);
    expect_fault(EL_LCD_TOO_FEW, "SSD0323: byte 2: 15h Set Column Address had 1 parameters, it takes 2 (section 10.1)");
}

static void test_reset_pulse_and_pause(void)
{
    for (unsigned i = 0; i < 2; i++) {
        create(i == 0 ? &EL_LCD_SSD1306 : &EL_LCD_SSD0323);
        el_lcd_reset(lcd, 0);
        el_lcd_advance_ns(lcd, 2999);
        el_lcd_reset(lcd, 1);
        TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_SHORT_RESET));
        el_lcd_advance_ns(lcd, 2999);
        COMMANDS(0xA4);
        TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_TOO_SOON));
        el_lcd_reset(lcd, 0);
        COMMANDS(0xA4);
        TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_IN_RESET));
        TEST_ASSERT_EQUAL_UINT64(3, el_lcd_error_count(lcd));
    }
}

/* SSD0323. */

static void test_0323_the_upper_half_is_the_left_pixel(void)
{
    start_ssd0323();
    DATA(0x12, 0x0F, 0x80);
    EXPECT_GLASS(0, 0, "12.F8.");
    COMMANDS(0xA0, 0x50); /* nibbles change places in what is written now */
    COMMANDS(0x15, 0, 63, 0x75, 1, 63);
    DATA(0x12, 0x0F);
    EXPECT_GLASS(0, 0, "12.F8.", "21F...");
}

static void test_0323_windows_in_both_directions(void)
{
    start_ssd0323();
    COMMANDS(0x15, 62, 63, 0x75, 62, 63);
    DATA(0x12, 0x34, 0x56, 0x78, 0xAA);
    EXPECT_GLASS(123, 61, ".....", ".AA34", ".5678");
    start_ssd0323();
    COMMANDS(0xA0, 0x56, 0x15, 0, 1, 0x75, 0, 2);
    DATA(0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77);
    EXPECT_GLASS(0, 0, "7744.", "2255.", "3366.", ".....");
}

static void test_0323_columns_reversed_keep_the_order_in_a_byte(void)
{
    start_ssd0323();
    COMMANDS(0xA0, 0x53, 0x15, 0, 63, 0x75, 0, 63);
    DATA(0x12, 0x34);
    EXPECT_GLASS(124, 0, "3412");
}

/* Upside down: columns, nibbles and commons the other way, by the same offset, because the same commons are wired. */
static void test_0323_upside_down(void)
{
    start_ssd0323();
    COMMANDS(0xA0, 0x41, 0x15, 0, 63, 0x75, 0, 63);
    DATA(0x12, 0x34);
    EXPECT_GLASS(124, 63, "4321");
    TEST_ASSERT_EQUAL_INT(0, el_lcd_look(lcd, 180, glass));
    TEST_ASSERT_EQUAL_HEX16(0x1082, glass[0]); /* grey 1 */
    TEST_ASSERT_EQUAL_HEX16(0x2104, glass[1]);
}

static void test_0323_offset_and_start_line_move_rows(void)
{
    start_ssd0323();
    DATA(0x11);
    COMMANDS(0xA1, 79);
    el_lcd_glass(lcd, glass);
    TEST_ASSERT_EQUAL_HEX16(0x1082, glass[128]); /* row 0 is shown below row 79 */
    COMMANDS(0xA1, 0, 0xA2, 0x4D);
    EXPECT_GLASS(0, 0, "....", "11..");
    COMMANDS(0xA2, 0x4B); /* row 0 is at a common beyond the glass */
    EXPECT_GLASS(0, 0, ".");
}

static void test_0323_display_modes(void)
{
    start_ssd0323();
    DATA(0x1F);
    COMMANDS(0xA7);
    el_lcd_glass(lcd, glass);
    TEST_ASSERT_EQUAL_HEX16(14U << 1 << 11 | 1U << 11 | (14U << 2 | 3U) << 5 | 14U << 1 | 1U, glass[0]);
    TEST_ASSERT_EQUAL_HEX16(0x0000, glass[1]);
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, glass[2]);
    COMMANDS(0xA5);
    el_lcd_glass(lcd, glass);
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, glass, 128 * 64);
    COMMANDS(0xA6);
    EXPECT_GLASS(0, 0, ".");
    COMMANDS(0xA4);
    EXPECT_GLASS(0, 0, "1F.");
    COMMANDS(0xAE);
    EXPECT_GLASS(0, 0, ".");
}

/* A grey keeps its four bits on top of each channel. */
static void test_0323_sixteen_greys(void)
{
    start_ssd0323();
    DATA(0x01, 0x23, 0x45, 0x67, 0x89, 0xAB, 0xCD, 0xEF);
    el_lcd_glass(lcd, glass);
    for (unsigned level = 0; level < 16; level++) {
        TEST_ASSERT_EQUAL_UINT(level, glass[level] >> 12);
        TEST_ASSERT_EQUAL_UINT(level, glass[level] >> 7 & 15);
        TEST_ASSERT_EQUAL_UINT(level, glass[level] >> 1 & 15);
    }
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, glass[15]);
}

static void test_0323_faults_in_words(void)
{
    static const bad_bytes CASES[] = {
        {1, {0x20}, EL_LCD_UNKNOWN, "SSD0323: byte 0: command 20h is not known to this model"},
        {3,
         {0x15, 0, 64},
         EL_LCD_BAD_WINDOW,
         "SSD0323: byte 2: 15h Set Column Address: 0..64 is out of range (section 10.1)"},
        {3, {0x75, 1, 0}, EL_LCD_BAD_WINDOW, "SSD0323: byte 2: 75h Set Row Address: 1..0 is reversed (section 10.2)"},
        {2,
         {0x81, 128},
         EL_LCD_BAD_VALUE,
         "SSD0323: byte 1: 81h Set Contrast Current: the contrast is 0 to 127 (section 10.3)"},
        {2,
         {0xA0, 0x12},
         EL_LCD_BAD_VALUE,
         "SSD0323: byte 1: A0h Set Re-map: the module's commons are split even and odd, which bit 6 says "
         "(section 10.5)"},
        {2,
         {0xA0, 0xD2},
         EL_LCD_BAD_VALUE,
         "SSD0323: byte 1: A0h Set Re-map: bits 3, 5 and 7 must be 0 (section 10.5)"},
        {2,
         {0xA2, 80},
         EL_LCD_BAD_VALUE,
         "SSD0323: byte 1: A2h Set Display Offset: the line is 0 to 79 (section 10.7)"},
        {2,
         {0xA8, 79},
         EL_LCD_BAD_VALUE,
         "SSD0323: byte 1: A8h Set Multiplex Ratio: the module's 64 rows take 3Fh (section 10.9)"},
        {2,
         {0xB1, 0x20},
         EL_LCD_BAD_VALUE,
         "SSD0323: byte 1: B1h Set Phase Length: a phase of 0 clocks is invalid (section 10.12)"},
        {9,
         {0xB8, 1, 0x11, 0x22, 0x32, 0x43, 0x54, 0x65, 0x78},
         EL_LCD_BAD_VALUE,
         "SSD0323: byte 8: B8h Set Gray Scale Table: the table has 3 bits per level (section 10.15)"},
    };
    expect_each(&EL_LCD_SSD0323, CASES, sizeof CASES / sizeof CASES[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_1306_a_byte_is_a_column_with_its_lowest_bit_on_top);
    RUN_TEST(test_1306_horizontal_mode_goes_to_the_next_page_at_the_windows_end);
    RUN_TEST(test_1306_vertical_mode_goes_down_first);
    RUN_TEST(test_1306_page_mode_stays_in_its_page);
    RUN_TEST(test_1306_segment_remap_acts_on_what_is_written_after_it);
    RUN_TEST(test_1306_scan_direction_start_line_and_offset_move_all_rows);
    RUN_TEST(test_1306_inversion_all_lit_and_off);
    RUN_TEST(test_1306_comes_out_of_reset_in_page_mode_dark_and_with_its_memory);
    RUN_TEST(test_1306_faults_in_words);
    RUN_TEST(test_data_instead_of_a_parameter_is_too_few);
    RUN_TEST(test_reset_pulse_and_pause);
    RUN_TEST(test_0323_the_upper_half_is_the_left_pixel);
    RUN_TEST(test_0323_windows_in_both_directions);
    RUN_TEST(test_0323_columns_reversed_keep_the_order_in_a_byte);
    RUN_TEST(test_0323_upside_down);
    RUN_TEST(test_0323_offset_and_start_line_move_rows);
    RUN_TEST(test_0323_display_modes);
    RUN_TEST(test_0323_sixteen_greys);
    RUN_TEST(test_0323_faults_in_words);
    return UNITY_END();
}
