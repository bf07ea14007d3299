/* The models of ST7789 and ST7735: what they do not share with the ILI9341, whose tests are test_lcd_picture.c and
 * test_lcd_errors.c: memory larger than the glass, module wiring, commands and waiting times of their own. */
#include "test_lcd_send.h"

static el_lcd *lcd;
static uint16_t glass[240 * 320];

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

/* A letter at the first and another at the last pixel of a window over all of the glass, black between. */
static void fill(unsigned sc, unsigned ec, unsigned sp, unsigned ep)
{
    send_window(lcd, sc, ec, sp, ep);
    send_command(lcd, 0x2C);
    send_letters(lcd, "a");
    const unsigned count = (ec - sc + 1) * (ep - sp + 1);
    for (unsigned i = 2; i < count; i++) {
        el_lcd_write(lcd, 1, 0);
        el_lcd_write(lcd, 1, 0);
    }
    send_letters(lcd, "z");
}

/* Expects `a` as the viewer's first and `z` as the last pixel at this angle. */
static void expect_corners(unsigned degrees, size_t pixels)
{
    expect_no_errors(lcd);
    TEST_ASSERT_EQUAL_INT(0, el_lcd_look(lcd, degrees, glass));
    TEST_ASSERT_EQUAL_HEX16(letter_colour('a'), glass[0]);
    TEST_ASSERT_EQUAL_HEX16(0, glass[1]);
    TEST_ASSERT_EQUAL_HEX16(letter_colour('z'), glass[pixels - 1]);
}

static void test_st7789_is_upright_without_madctl_and_true_with_inversion(void)
{
    create(&EL_LCD_ST7789);
    switch_on(lcd);
    send_command(lcd, 0x21);
    fill(0, 239, 0, 319);
    expect_corners(0, 240 * 320);
    send_command(lcd, 0x20);
    el_lcd_glass(lcd, glass);
    TEST_ASSERT_EQUAL_HEX16(0xFFFF ^ letter_colour('a'), glass[0]);
}

static void test_st7789_turned_by_the_usual_madctl(void)
{
    create(&EL_LCD_ST7789);
    switch_on(lcd);
    send_command(lcd, 0x21);
    SEND(lcd, 0x36, 0x60);
    fill(0, 319, 0, 239);
    expect_corners(270, 240 * 320);
    SEND(lcd, 0x36, 0xC0);
    fill(0, 239, 0, 319);
    expect_corners(180, 240 * 320);
    SEND(lcd, 0x36, 0xA0);
    fill(0, 319, 0, 239);
    expect_corners(90, 240 * 320);
}

static void test_square_glass_begins_at_row_80_where_my_counts_from_the_other_end(void)
{
    create(&EL_LCD_ST7789_240X240);
    switch_on(lcd);
    send_command(lcd, 0x21);
    fill(0, 239, 0, 239);
    expect_corners(0, 240 * 240);
    SEND(lcd, 0x36, 0x60);
    fill(0, 239, 0, 239);
    expect_corners(270, 240 * 240);
    SEND(lcd, 0x36, 0xC0);
    fill(0, 239, 80, 319);
    expect_corners(180, 240 * 240);
    SEND(lcd, 0x36, 0xA0);
    fill(80, 319, 0, 239);
    expect_corners(90, 240 * 240);
}

static void test_a_window_without_that_offset_shows(void)
{
    create(&EL_LCD_ST7789_240X240);
    switch_on(lcd);
    send_command(lcd, 0x21);
    SEND(lcd, 0x36, 0xC0);
    fill(0, 239, 0, 239);
    expect_no_errors(lcd); /* the memory has these rows; the picture is where nobody sees it */
    TEST_ASSERT_EQUAL_INT(0, el_lcd_look(lcd, 180, glass));
    TEST_ASSERT_TRUE(glass[0] != letter_colour('a'));
}

static void test_st7789_takes_the_low_byte_first_when_told(void)
{
    create(&EL_LCD_ST7789);
    switch_on(lcd);
    SEND(lcd, 0xB0, 0x00, 0xF8);
    send_window(lcd, 0, 0, 0, 0);
    SEND(lcd, 0x2C, 0x34, 0x12);
    TEST_ASSERT_EQUAL_HEX32(0x04 << 12 | 0x11 << 6 | 0x29, el_lcd_memory(lcd, 0, 0)); /* 00010 010001 10100 */
    expect_no_errors(lcd);
}

static void test_st7735_glass_is_the_middle_of_its_memory(void)
{
    create(&EL_LCD_ST7735);
    switch_on(lcd);
    SEND(lcd, 0x36, 0xC8);
    fill(2, 129, 1, 160);
    expect_corners(0, 128 * 160);
    SEND(lcd, 0x36, 0xA8);
    fill(1, 160, 2, 129);
    expect_corners(270, 128 * 160);
    SEND(lcd, 0x36, 0x08);
    fill(2, 129, 1, 160);
    expect_corners(180, 128 * 160);
    SEND(lcd, 0x36, 0x68);
    fill(1, 160, 2, 129);
    expect_corners(90, 128 * 160);
}

static void test_st7735_memory_ends_at_132_by_162(void)
{
    create(&EL_LCD_ST7735);
    switch_on(lcd);
    send_window(lcd, 0, 131, 0, 161);
    send_command(lcd, 0x2C);
    expect_no_errors(lcd);
    send_window(lcd, 0, 132, 0, 161);
    send_command(lcd, 0x2C);
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_BAD_WINDOW));
    SEND(lcd, 0x36, 0x20);
    send_window(lcd, 0, 131, 0, 161); /* exchanged, 162 by 132 */
    send_command(lcd, 0x2C);
    TEST_ASSERT_EQUAL_UINT64(2, el_lcd_fault_count(lcd, EL_LCD_BAD_WINDOW));
}

static void test_dark_glass_is_black_or_white_by_its_kind(void)
{
    create(&EL_LCD_ST7789);
    el_lcd_glass(lcd, glass);
    TEST_ASSERT_EACH_EQUAL_HEX16(0x0000, glass, 240 * 320);
    create(&EL_LCD_ST7735);
    el_lcd_glass(lcd, glass);
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, glass, 128 * 160);
}

static void expect_fault(el_lcd_fault fault, const char *text)
{
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_error_count(lcd));
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, fault));
    TEST_ASSERT_EQUAL_STRING(text, el_lcd_error_at(lcd, 0)->text);
}

static void test_commands_of_the_ili9341_are_unknown_here(void)
{
    create(&EL_LCD_ST7789);
    SEND(lcd, 0xCB, 0x39, 0x2C, 0x00, 0x34, 0x02);
    expect_fault(EL_LCD_UNKNOWN, "ST7789: byte 0: command CBh is not known to this model");
    create(&EL_LCD_ST7735);
    SEND(lcd, 0x33, 0, 0, 0, 160, 0, 0);
    expect_fault(EL_LCD_UNKNOWN, "ST7735: byte 0: command 33h is not known to this model");
}

static void test_parameter_counts_are_each_chips_own(void)
{
    create(&EL_LCD_ST7789);
    SEND(lcd, 0xB2, 0x0C, 0x0C, 0x00, 0x33);
    send_command(lcd, 0x00);
    expect_fault(EL_LCD_TOO_FEW, "ST7789: byte 5: B2h PORCTRL had 4 parameters, it takes 5 (section 9.2.3)");
    create(&EL_LCD_ST7735);
    SEND(lcd, 0xC0, 0xA2, 0x02);
    send_command(lcd, 0x00);
    expect_fault(EL_LCD_TOO_FEW, "ST7735: byte 3: C0h PWCTR1 had 2 parameters, it takes 3 (section 10.2.6)");
}

static void test_values_of_the_st7789_that_the_module_does_not_have(void)
{
    create(&EL_LCD_ST7789);
    SEND(lcd, 0xC0, 0x2D);
    expect_fault(EL_LCD_BAD_VALUE,
                 "ST7789: byte 1: C0h LCMCTRL: only the default 2Ch is in this model (section 9.2.12)");
    create(&EL_LCD_ST7789);
    SEND(lcd, 0xE4, 0x1D, 0x00, 0x00);
    expect_fault(EL_LCD_BAD_VALUE,
                 "ST7789: byte 3: E4h GATECTRL: NL and SCN do not drive all lines of the memory (section 9.2.28)");
    create(&EL_LCD_ST7789);
    SEND(lcd, 0xB0, 0x11, 0xF0);
    expect_fault(EL_LCD_BAD_VALUE, "ST7789: byte 2: B0h RAMCTRL: the RGB interface does not go with the serial one "
                                   "(section 9.2.1)");
}

static void test_st7735_waits_120_milliseconds_after_each_change(void)
{
    for (unsigned i = 0; i < 3; i++) {
        create(&EL_LCD_ST7735);
        send_command(lcd, (const uint8_t[]){0x01, 0x10, 0x11}[i]);
        el_lcd_advance_ns(lcd, 120000000 - 1);
        send_command(lcd, 0x00);
        TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_TOO_SOON));
        el_lcd_advance_ns(lcd, 1);
        send_command(lcd, 0x00);
        TEST_ASSERT_EQUAL_UINT64(1, el_lcd_error_count(lcd));
    }
}

static void test_st7789_waits_5_milliseconds(void)
{
    create(&EL_LCD_ST7789);
    send_command(lcd, 0x11);
    el_lcd_advance_ns(lcd, 5000000 - 1);
    send_command(lcd, 0x29);
    expect_fault(EL_LCD_TOO_SOON, "ST7789: byte 1: 29h DISPON comes 1 us too soon after SLPOUT (section 9.1.19)");
}

static void test_profiles_are_found_by_the_names_of_command_lines(void)
{
    static const char *const NAMES[] = {"ili9341", "st7789", "st7789-240x240", "st7735", "ssd1306", "ssd0323"};
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; i++) {
        TEST_ASSERT_EQUAL_STRING(NAMES[i], el_lcd_profile_at(i)->panel);
        TEST_ASSERT_EQUAL_PTR(el_lcd_profile_at(i), el_lcd_profile_find(NAMES[i]));
    }
    TEST_ASSERT_NULL(el_lcd_profile_at(sizeof NAMES / sizeof NAMES[0]));
    TEST_ASSERT_NULL(el_lcd_profile_find("ST7735"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_st7789_is_upright_without_madctl_and_true_with_inversion);
    RUN_TEST(test_st7789_turned_by_the_usual_madctl);
    RUN_TEST(test_square_glass_begins_at_row_80_where_my_counts_from_the_other_end);
    RUN_TEST(test_a_window_without_that_offset_shows);
    RUN_TEST(test_st7789_takes_the_low_byte_first_when_told);
    RUN_TEST(test_st7735_glass_is_the_middle_of_its_memory);
    RUN_TEST(test_st7735_memory_ends_at_132_by_162);
    RUN_TEST(test_dark_glass_is_black_or_white_by_its_kind);
    RUN_TEST(test_commands_of_the_ili9341_are_unknown_here);
    RUN_TEST(test_parameter_counts_are_each_chips_own);
    RUN_TEST(test_values_of_the_st7789_that_the_module_does_not_have);
    RUN_TEST(test_st7735_waits_120_milliseconds_after_each_change);
    RUN_TEST(test_st7789_waits_5_milliseconds);
    RUN_TEST(test_profiles_are_found_by_the_names_of_command_lines);
    return UNITY_END();
}
