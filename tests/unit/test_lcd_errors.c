/* The LCD model: what the data sheet forbids is found, counted and put into words. Each test provokes one fault and
 * expects it, its text, and no other. */
#include "test_lcd_send.h"

static el_lcd *lcd;

void setUp(void)
{
    lcd = el_lcd_create(&EL_LCD_ILI9341);
    TEST_ASSERT_NOT_NULL(lcd);
}

void tearDown(void)
{
    el_lcd_destroy(lcd);
}

static void expect_one(el_lcd_fault fault, uint64_t byte, const char *text)
{
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_error_count(lcd));
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, fault));
    TEST_ASSERT_EQUAL_INT(fault, el_lcd_error_at(lcd, 0)->fault);
    TEST_ASSERT_EQUAL_UINT64(byte, el_lcd_error_at(lcd, 0)->byte);
    TEST_ASSERT_EQUAL_STRING(text, el_lcd_error_at(lcd, 0)->text);
    TEST_ASSERT_NULL(el_lcd_error_at(lcd, 1));
}

static void test_data_before_any_command(void)
{
    el_lcd_write(lcd, 1, 0x5A);
    el_lcd_write(lcd, 1, 0x5B);
    expect_one(EL_LCD_NO_COMMAND, 0, "ILI9341: byte 0: data 5Ah before any command");
}

static void test_too_many_parameters(void)
{
    SEND(lcd, 0x36, 0x48, 0x11, 0x22);
    expect_one(EL_LCD_TOO_MANY, 2,
               "ILI9341: byte 2: data 11h after 36h MADCTL, which takes 1; pixels need 2Ch RAMWR first (8.2.29)");
}

static void test_pixels_without_ramwr(void)
{
    send_window(lcd, 0, 9, 0, 9);
    send_letters(lcd, "pixels");
    expect_one(EL_LCD_TOO_MANY, 10,
               "ILI9341: byte 10: data E0h after 2Bh PASET, which takes 4; pixels need 2Ch RAMWR first (8.2.21)");
}

static void test_too_few_parameters(void)
{
    SEND(lcd, 0x2A, 0, 0, 0);
    expect_no_errors(lcd);
    send_command(lcd, 0x00);
    expect_one(EL_LCD_TOO_FEW, 4, "ILI9341: byte 4: 2Ah CASET had 3 parameters, it takes 4 (section 8.2.20)");
}

static void test_too_few_parameters_at_the_end(void)
{
    send_command(lcd, 0x36);
    el_lcd_finish(lcd);
    el_lcd_finish(lcd);
    expect_one(EL_LCD_TOO_FEW, 1, "ILI9341: byte 1: 36h MADCTL had 0 parameters, it takes 1 (section 8.2.29)");
}

static void test_unknown_command_with_its_parameters_is_one_error(void)
{
    SEND(lcd, 0xEF, 0x03, 0x80, 0x02);
    send_command(lcd, 0x00);
    expect_one(EL_LCD_UNKNOWN, 0, "ILI9341: byte 0: command EFh is not known to this model");
}

static void test_window_beyond_the_columns(void)
{
    send_window(lcd, 0, 240, 0, 319);
    expect_no_errors(lcd);
    send_command(lcd, 0x2C);
    expect_one(
        EL_LCD_BAD_WINDOW, 10,
        "ILI9341: byte 10: 2Ch RAMWR: window columns 0..240, pages 0..319 is out of range with MADCTL 00h (8.2.20)");
}

static void test_the_windows_limits_follow_mv(void)
{
    send_window(lcd, 0, 319, 0, 239);
    SEND(lcd, 0x36, 0x28);
    send_command(lcd, 0x2C);
    expect_no_errors(lcd);
    SEND(lcd, 0x36, 0x48);
    send_command(lcd, 0x2C);
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_BAD_WINDOW));
    send_window(lcd, 0, 239, 0, 319);
    send_command(lcd, 0x2C);
    SEND(lcd, 0x36, 0x28);
    send_command(lcd, 0x2C);
    TEST_ASSERT_EQUAL_UINT64(2, el_lcd_fault_count(lcd, EL_LCD_BAD_WINDOW));
    TEST_ASSERT_EQUAL_UINT64(2, el_lcd_error_count(lcd));
}

static void test_pixels_out_of_range_are_dropped(void)
{
    SEND(lcd, 0x3A, 0x55);
    send_window(lcd, 239, 240, 0, 0);
    send_command(lcd, 0x2C);
    send_letters(lcd, "abcd");
    TEST_ASSERT_EQUAL_UINT64(2, el_lcd_pixels(lcd));
}

static void test_reversed_window_takes_no_pixels(void)
{
    SEND(lcd, 0x3A, 0x55);
    send_window(lcd, 5, 4, 0, 9);
    send_command(lcd, 0x2C);
    send_letters(lcd, "abcd");
    TEST_ASSERT_EQUAL_UINT64(0, el_lcd_pixels(lcd));
    expect_one(EL_LCD_BAD_WINDOW, 12,
               "ILI9341: byte 12: 2Ch RAMWR: window columns 5..4, pages 0..9 is reversed with MADCTL 00h (8.2.20)");
}

static void test_half_a_pixel(void)
{
    SEND(lcd, 0x3A, 0x55);
    SEND(lcd, 0x2C, 1, 2, 3);
    send_command(lcd, 0x00);
    expect_one(EL_LCD_HALF_PIXEL, 6, "ILI9341: byte 6: 2Ch RAMWR ended after 1 of the 2 bytes of a pixel");
}

static void test_ramwrc_without_ramwr(void)
{
    SEND(lcd, 0x3C, 1, 2, 3);
    TEST_ASSERT_EQUAL_UINT64(0, el_lcd_pixels(lcd));
    expect_one(EL_LCD_NO_RAMWR, 0,
               "ILI9341: byte 0: 3Ch RAMWRC without RAMWR since reset, CASET, PASET or MADCTL (8.2.34)");
}

static void test_ramwrc_after_a_new_window(void)
{
    SEND(lcd, 0x2C, 1, 2, 3);
    send_window(lcd, 0, 9, 0, 9);
    send_command(lcd, 0x3C);
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_NO_RAMWR));
}

static void expect_bad_value(const char *text)
{
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_error_count(lcd));
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_BAD_VALUE));
    TEST_ASSERT_EQUAL_STRING(text, el_lcd_error_at(lcd, 0)->text);
    tearDown();
    setUp();
}

static void test_bad_values(void)
{
    SEND(lcd, 0x3A, 0x03);
    expect_bad_value("ILI9341: byte 1: 3Ah COLMOD: bits 2..0 must be 101 (16 bits per pixel) or 110 (18) "
                     "(section 8.2.33)");
    SEND(lcd, 0x26, 0x03);
    expect_bad_value("ILI9341: byte 1: 26h GAMSET: the curve must be 1, 2, 4 or 8 (section 8.2.17)");
    SEND(lcd, 0x33, 0, 0, 1, 0x41, 0, 0);
    expect_bad_value("ILI9341: byte 6: 33h VSCRDEF: top, scrolling and bottom lines must add up to the rows of the "
                     "glass (section 8.2.26)");
    SEND(lcd, 0x37, 1, 0x40);
    expect_bad_value("ILI9341: byte 2: 37h VSCRSADD: the line must be inside the scrolling area (section 8.2.30)");
    SEND(lcd, 0xB6, 0x0A, 0x92, 0x27);
    expect_bad_value("ILI9341: byte 3: B6h DISCTRL: interlaced gates (SM) are not in this model (section 8.3.7)");
    SEND(lcd, 0xB6, 0x0A, 0x82, 0x1D, 0x04);
    expect_bad_value("ILI9341: byte 3: B6h DISCTRL: NL does not drive all lines of the glass (section 8.3.7)");
    SEND(lcd, 0xF6, 0x01, 0x00, 0x20);
    expect_bad_value("ILI9341: byte 3: F6h IFCTL: only WEMODE is in this model, all other bits must be 0 "
                     "(section 8.3.28)");
}

/* A waiting time is tried one nanosecond too early and exactly at its end. */
static void expect_wait(uint64_t ns, uint8_t before, uint8_t after)
{
    el_lcd_advance_ns(lcd, 1000000000);
    send_command(lcd, before);
    const uint64_t errors = el_lcd_fault_count(lcd, EL_LCD_TOO_SOON);
    el_lcd_advance_ns(lcd, ns - 1);
    send_command(lcd, after);
    TEST_ASSERT_EQUAL_UINT64(errors + 1, el_lcd_fault_count(lcd, EL_LCD_TOO_SOON));
}

static void expect_enough(uint64_t ns, uint8_t before, uint8_t after)
{
    el_lcd_advance_ns(lcd, 1000000000);
    send_command(lcd, before);
    const uint64_t errors = el_lcd_fault_count(lcd, EL_LCD_TOO_SOON);
    el_lcd_advance_ns(lcd, ns);
    send_command(lcd, after);
    TEST_ASSERT_EQUAL_UINT64(errors, el_lcd_fault_count(lcd, EL_LCD_TOO_SOON));
}

static void test_five_milliseconds_after_swreset_slpin_and_slpout(void)
{
    for (unsigned i = 0; i < 3; i++) {
        const uint8_t command = (const uint8_t[]){0x01, 0x10, 0x11}[i];
        expect_wait(5000000, command, 0x00);
        expect_enough(5000000, command, 0x00);
    }
}

static void test_hundred_and_twenty_milliseconds_between_sleep_changes(void)
{
    expect_wait(120000000, 0x11, 0x10);   /* to sleep before being awake */
    expect_enough(120000000, 0x11, 0x10); /* now asleep */
    expect_wait(120000000, 0x11, 0x01);   /* software reset in the sleep-out sequence; asleep */
    expect_enough(120000000, 0x11, 0x01); /* asleep, by a reset while awake */
    expect_enough(5000000, 0x10, 0x11);   /* asleep already: nothing changes, no 120 ms; now awake */
    expect_wait(120000000, 0x10, 0x11);   /* now awake */
    expect_enough(120000000, 0x10, 0x11); /* now awake */
    expect_wait(120000000, 0x01, 0x11);   /* reset while awake; now awake */
    expect_enough(120000000, 0x01, 0x11);
    el_lcd_advance_ns(lcd, 1000000000);
    send_command(lcd, 0x10);
    el_lcd_advance_ns(lcd, 1000000000);
    expect_enough(5000000, 0x01, 0x11); /* reset while asleep */
}

static void test_too_soon_in_words(void)
{
    send_command(lcd, 0x11);
    el_lcd_advance_ns(lcd, 3000000);
    send_command(lcd, 0x29);
    expect_one(EL_LCD_TOO_SOON, 1, "ILI9341: byte 1: 29h DISPON comes 2000 us too soon after SLPOUT (section 8.2.19)");
}

static void pulse(uint64_t low_ns)
{
    el_lcd_reset(lcd, 0);
    el_lcd_advance_ns(lcd, low_ns);
    el_lcd_reset(lcd, 1);
}

static void test_reset_pulse(void)
{
    pulse(10000);
    expect_no_errors(lcd);
    pulse(9999);
    expect_one(EL_LCD_SHORT_RESET, 0, "ILI9341: byte 0: reset was low for 9999 ns, it takes 10000 (section 15.4)");
}

static void test_a_spike_does_not_reset(void)
{
    switch_on(lcd);
    pulse(4999);
    SEND(lcd, 0x2C, 1, 2); /* still 16 bits per pixel, no waiting time */
    el_lcd_finish(lcd);
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_error_count(lcd));
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_SHORT_RESET));
}

static void test_five_milliseconds_after_reset(void)
{
    pulse(10000);
    el_lcd_advance_ns(lcd, 5000000);
    send_command(lcd, 0x11); /* asleep before the reset: no 120 ms */
    el_lcd_advance_ns(lcd, 5000000);
    expect_no_errors(lcd);
    pulse(10000);
    el_lcd_advance_ns(lcd, 4999999);
    send_command(lcd, 0x00);
    expect_one(EL_LCD_TOO_SOON, 1, "ILI9341: byte 1: 00h NOP comes 1 us too soon after reset (section 8.2.1)");
}

static void test_sleep_out_120_milliseconds_after_a_reset_while_awake(void)
{
    switch_on(lcd);
    pulse(10000);
    el_lcd_advance_ns(lcd, 120000000);
    send_command(lcd, 0x11);
    el_lcd_advance_ns(lcd, 120000000);
    expect_no_errors(lcd);
    pulse(10000);
    el_lcd_advance_ns(lcd, 119999999);
    send_command(lcd, 0x11);
    TEST_ASSERT_EQUAL_UINT64(1, el_lcd_fault_count(lcd, EL_LCD_TOO_SOON));
}

static void test_bytes_in_reset_are_one_error_and_have_no_effect(void)
{
    el_lcd_reset(lcd, 0);
    SEND(lcd, 0x3A, 0x55);
    el_lcd_advance_ns(lcd, 10000);
    el_lcd_reset(lcd, 1);
    el_lcd_advance_ns(lcd, 5000000);
    SEND(lcd, 0x2C, 1, 2, 3);
    el_lcd_finish(lcd);
    expect_one(EL_LCD_IN_RESET, 0, "ILI9341: byte 0: command 3Ah while the reset line is low");
}

/* The commands of 8.2, 8.3 and 8.4 with the number of parameters that each takes. */
static const uint8_t COUNTS[][2] = {
    {0x00, 0}, {0x13, 0}, {0x20, 0}, {0x21, 0}, {0x28, 0}, {0x29, 0},  {0x2A, 4},  {0x2B, 4}, {0x33, 6}, {0x34, 0},
    {0x35, 1}, {0x36, 1}, {0x37, 2}, {0x38, 0}, {0x39, 0}, {0x3A, 1},  {0x51, 1},  {0x53, 1}, {0x26, 1}, {0xB1, 2},
    {0xB4, 1}, {0xB7, 1}, {0xC0, 1}, {0xC1, 1}, {0xC5, 2}, {0xC7, 1},  {0xCB, 5},  {0xCF, 3}, {0xE8, 3}, {0xEA, 2},
    {0xED, 4}, {0xF2, 1}, {0xF6, 3}, {0xF7, 1}, {0xB6, 4}, {0xE0, 15}, {0xE1, 15},
};

static void test_each_command_takes_its_number_of_parameters_and_no_more(void)
{
    static const uint8_t ZEROS[16] = {0};
    for (size_t i = 0; i < sizeof COUNTS / sizeof COUNTS[0]; i++) {
        const uint64_t before = el_lcd_fault_count(lcd, EL_LCD_TOO_MANY);
        send_bytes(lcd, COUNTS[i][0], ZEROS, COUNTS[i][1]);
        send_command(lcd, 0x00);
        TEST_ASSERT_EQUAL_UINT64(before, el_lcd_fault_count(lcd, EL_LCD_TOO_MANY));
        TEST_ASSERT_EQUAL_UINT64(0, el_lcd_fault_count(lcd, EL_LCD_TOO_FEW));
        send_bytes(lcd, COUNTS[i][0], ZEROS, COUNTS[i][1] + 1U);
        TEST_ASSERT_EQUAL_UINT64(before + 1, el_lcd_fault_count(lcd, EL_LCD_TOO_MANY));
    }
    TEST_ASSERT_EQUAL_UINT64(0, el_lcd_fault_count(lcd, EL_LCD_UNKNOWN));
}

static void test_the_first_errors_are_kept_and_all_are_counted(void)
{
    for (unsigned i = 0; i < 40; i++) {
        send_command(lcd, 0xFF);
    }
    TEST_ASSERT_EQUAL_UINT64(40, el_lcd_error_count(lcd));
    TEST_ASSERT_EQUAL_UINT64(15, el_lcd_error_at(lcd, 15)->byte);
    TEST_ASSERT_NULL(el_lcd_error_at(lcd, 16));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_data_before_any_command);
    RUN_TEST(test_too_many_parameters);
    RUN_TEST(test_pixels_without_ramwr);
    RUN_TEST(test_too_few_parameters);
    RUN_TEST(test_too_few_parameters_at_the_end);
    RUN_TEST(test_unknown_command_with_its_parameters_is_one_error);
    RUN_TEST(test_window_beyond_the_columns);
    RUN_TEST(test_the_windows_limits_follow_mv);
    RUN_TEST(test_pixels_out_of_range_are_dropped);
    RUN_TEST(test_reversed_window_takes_no_pixels);
    RUN_TEST(test_half_a_pixel);
    RUN_TEST(test_ramwrc_without_ramwr);
    RUN_TEST(test_ramwrc_after_a_new_window);
    RUN_TEST(test_bad_values);
    RUN_TEST(test_five_milliseconds_after_swreset_slpin_and_slpout);
    RUN_TEST(test_hundred_and_twenty_milliseconds_between_sleep_changes);
    RUN_TEST(test_too_soon_in_words);
    RUN_TEST(test_reset_pulse);
    RUN_TEST(test_a_spike_does_not_reset);
    RUN_TEST(test_five_milliseconds_after_reset);
    RUN_TEST(test_sleep_out_120_milliseconds_after_a_reset_while_awake);
    RUN_TEST(test_bytes_in_reset_are_one_error_and_have_no_effect);
    RUN_TEST(test_each_command_takes_its_number_of_parameters_and_no_more);
    RUN_TEST(test_the_first_errors_are_kept_and_all_are_counted);
    return UNITY_END();
}
