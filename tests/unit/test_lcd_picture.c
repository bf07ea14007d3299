/* The LCD model: where pixels go and how they look. Glass of 3 x 4 pixels, so that each picture can be read. */
#include "test_lcd_send.h"

static el_lcd *lcd;

void setUp(void)
{
    const el_lcd_profile profile = el_lcd_dcs(3, 4);
    lcd = el_lcd_create(&profile);
    TEST_ASSERT_NOT_NULL(lcd);
    switch_on(lcd);
}

void tearDown(void)
{
    expect_no_errors(lcd);
    el_lcd_destroy(lcd);
}

/* Twelve letters in the order in which they are sent, through a window over everything. */
static void fill(uint8_t madctl)
{
    SEND(lcd, 0x36, madctl);
    if ((madctl & 0x20) != 0) {
        send_window(lcd, 0, 3, 0, 2);
    } else {
        send_window(lcd, 0, 2, 0, 3);
    }
    send_command(lcd, 0x2C);
    send_letters(lcd, "abcdefghijkl");
}

/* Section 9.3, each row of the table: MV exchanges, MX mirrors memory columns, MY memory rows; the module mirrors. */
static void test_each_madctl_on_the_upright_glass(void)
{
    fill(0x08);
    EXPECT_LOOK(lcd, 0, "cba", "fed", "ihg", "lkj");
    fill(0x48);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
    fill(0x88);
    EXPECT_LOOK(lcd, 0, "lkj", "ihg", "fed", "cba");
    fill(0xC8);
    EXPECT_LOOK(lcd, 0, "jkl", "ghi", "def", "abc");
    fill(0x28);
    EXPECT_LOOK(lcd, 0, "iea", "jfb", "kgc", "lhd");
    fill(0x68);
    EXPECT_LOOK(lcd, 0, "aei", "bfj", "cgk", "dhl");
    fill(0xA8);
    EXPECT_LOOK(lcd, 0, "lhd", "kgc", "jfb", "iea");
    fill(0xE8);
    EXPECT_LOOK(lcd, 0, "dhl", "cgk", "bfj", "aei");
}

static void test_the_four_usual_madctl_are_upright_when_the_module_is_turned(void)
{
    fill(0x48);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
    fill(0x28);
    EXPECT_LOOK(lcd, 270, "abcd", "efgh", "ijkl");
    fill(0x88);
    EXPECT_LOOK(lcd, 180, "abc", "def", "ghi", "jkl");
    fill(0xE8);
    EXPECT_LOOK(lcd, 90, "abcd", "efgh", "ijkl");
}

static void test_a_mirrored_landscape_stays_mirrored_however_the_module_is_turned(void)
{
    fill(0x68);
    EXPECT_LOOK(lcd, 90, "dcba", "hgfe", "lkji");
    EXPECT_LOOK(lcd, 270, "ijkl", "efgh", "abcd");
}

static void test_other_angles_are_refused(void)
{
    uint16_t pixels[12];
    TEST_ASSERT_EQUAL_INT(-1, el_lcd_look(lcd, 45, pixels));
    TEST_ASSERT_EQUAL_INT(-1, el_lcd_look(lcd, 360, pixels));
}

/* MX, MY and MV act when pixels are written; the colour order acts when they are shown. */
static void test_madctl_does_not_move_what_is_in_the_memory(void)
{
    fill(0x48);
    SEND(lcd, 0x36, 0xA8);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
}

static void test_a_window_is_filled_column_first_and_wraps_at_its_end(void)
{
    fill(0x48);
    send_window(lcd, 1, 2, 1, 2);
    send_command(lcd, 0x2C);
    send_letters(lcd, "ABCD");
    EXPECT_LOOK(lcd, 0, "abc", "dAB", "gCD", "jkl");
    send_letters(lcd, "EF");
    EXPECT_LOOK(lcd, 0, "abc", "dEF", "gCD", "jkl");
}

static void test_pixels_beyond_the_window_are_dropped_without_wemode(void)
{
    fill(0x48);
    SEND(lcd, 0xF6, 0x00, 0x00, 0x00);
    send_window(lcd, 1, 2, 1, 2);
    send_command(lcd, 0x2C);
    send_letters(lcd, "ABCDEF");
    EXPECT_LOOK(lcd, 0, "abc", "dAB", "gCD", "jkl");
}

static void test_ramwr_starts_again_and_ramwrc_goes_on(void)
{
    fill(0x48);
    send_window(lcd, 0, 1, 0, 1);
    send_command(lcd, 0x2C);
    send_letters(lcd, "A");
    send_command(lcd, 0x00);
    send_command(lcd, 0x3C);
    send_letters(lcd, "BC");
    EXPECT_LOOK(lcd, 0, "ABc", "Cef", "ghi", "jkl");
    send_command(lcd, 0x2C);
    send_letters(lcd, "Z");
    EXPECT_LOOK(lcd, 0, "ZBc", "Cef", "ghi", "jkl");
}

static void test_the_window_is_counted_in_exchanged_coordinates(void)
{
    fill(0x28);
    send_window(lcd, 2, 3, 0, 1);
    send_command(lcd, 0x2C);
    send_letters(lcd, "ABCD");
    EXPECT_LOOK(lcd, 270, "abAB", "efCD", "ijkl");
}

/* One pixel at memory column 0, row 0. */
static void put_pixel(size_t count, const uint8_t *bytes)
{
    SEND(lcd, 0x36, 0x08);
    send_window(lcd, 0, 0, 0, 0);
    send_bytes(lcd, 0x2C, bytes, count);
}

static uint16_t top_right(void)
{
    uint16_t pixels[12];
    el_lcd_glass(lcd, pixels);
    return pixels[2];
}

static void test_sixteen_bits_become_eighteen_by_copying_the_highest_bit(void)
{
    put_pixel(2, (const uint8_t[]){0x84, 0x10}); /* red 10000, green 100000, blue 10000 */
    TEST_ASSERT_EQUAL_HEX32(0x21 << 12 | 0x20 << 6 | 0x21, el_lcd_memory(lcd, 0, 0));
    put_pixel(2, (const uint8_t[]){0x78, 0x0F}); /* red 01111, green 0, blue 01111 */
    TEST_ASSERT_EQUAL_HEX32(0x1E << 12 | 0x1E, el_lcd_memory(lcd, 0, 0));
}

static void test_eighteen_bits_are_the_upper_six_of_three_bytes(void)
{
    SEND(lcd, 0x3A, 0x66);
    put_pixel(3, (const uint8_t[]){0x07, 0xFF, 0x84});
    TEST_ASSERT_EQUAL_HEX32(0x01 << 12 | 0x3F << 6 | 0x21, el_lcd_memory(lcd, 0, 0));
    TEST_ASSERT_EQUAL_HEX16(0 << 11 | 0x3F << 5 | 0x10, top_right());
}

static void test_every_rgb565_comes_back_as_it_was_sent(void)
{
    for (unsigned colour = 0; colour < 65536; colour++) {
        put_pixel(2, (const uint8_t[]){(uint8_t)(colour >> 8), (uint8_t)colour});
        TEST_ASSERT_EQUAL_HEX16(colour, top_right());
    }
}

static void test_red_is_red_with_the_bgr_bit_only(void)
{
    put_pixel(2, (const uint8_t[]){0xF8, 0x00});
    TEST_ASSERT_EQUAL_HEX16(0xF800, top_right());
    SEND(lcd, 0x36, 0x00);
    TEST_ASSERT_EQUAL_HEX16(0x001F, top_right());
}

static void test_inversion_and_idle_mode(void)
{
    put_pixel(2, (const uint8_t[]){0x84, 0x0F}); /* highest bits 1, 1, 0 */
    send_command(lcd, 0x21);
    TEST_ASSERT_EQUAL_HEX16(0x840F ^ 0xFFFF, top_right());
    send_command(lcd, 0x20);
    send_command(lcd, 0x39);
    TEST_ASSERT_EQUAL_HEX16(0xFFE0, top_right());
    send_command(lcd, 0x38);
    TEST_ASSERT_EQUAL_HEX16(0x840F, top_right());
    SEND(lcd, 0xB6, 0x0A, 0x02, 0x27);
    TEST_ASSERT_EQUAL_HEX16(0x840F ^ 0xFFFF, top_right());
}

static void test_the_glass_is_white_unless_awake_and_on(void)
{
    fill(0x48);
    send_command(lcd, 0x28);
    EXPECT_LOOK(lcd, 0, "...", "...", "...", "...");
    send_command(lcd, 0x29);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
    send_command(lcd, 0x10);
    EXPECT_LOOK(lcd, 0, "...", "...", "...", "...");
}

static void test_pixels_can_be_written_asleep(void)
{
    send_command(lcd, 0x10);
    el_lcd_advance_ns(lcd, 120000000);
    fill(0x48);
    send_command(lcd, 0x11);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
}

static void test_scrolling_moves_the_lines_between_the_fixed_ones(void)
{
    fill(0x48);
    SEND(lcd, 0x33, 0, 1, 0, 3, 0, 0);
    SEND(lcd, 0x37, 0, 2);
    EXPECT_LOOK(lcd, 0, "abc", "ghi", "jkl", "def");
    send_command(lcd, 0x13);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
}

static void test_scrolling_counts_from_the_bottom_with_ml(void)
{
    fill(0x58);
    EXPECT_LOOK(lcd, 0, "abc", "def", "ghi", "jkl");
    SEND(lcd, 0x33, 0, 1, 0, 3, 0, 0);
    SEND(lcd, 0x37, 0, 2);
    EXPECT_LOOK(lcd, 0, "ghi", "abc", "def", "jkl");
}

static void test_reversed_gates_and_sources_turn_the_picture(void)
{
    fill(0x48);
    SEND(lcd, 0xB6, 0x0A, 0xA2, 0x27);
    EXPECT_LOOK(lcd, 0, "cba", "fed", "ihg", "lkj");
    SEND(lcd, 0xB6, 0x0A, 0xC2, 0x27, 0x04);
    EXPECT_LOOK(lcd, 0, "jkl", "ghi", "def", "abc");
}

static void test_defaults_after_power_on(void)
{
    el_lcd_destroy(lcd);
    lcd = el_lcd_create(&EL_LCD_ILI9341);
    TEST_ASSERT_NOT_NULL(lcd);
    send_command(lcd, 0x2C);
    for (unsigned i = 0; i < 240 * 320; i++) { /* 18 bits per pixel, window over everything */
        el_lcd_write(lcd, 1, (uint8_t)(i / 240 << 2 & 0xFF));
        el_lcd_write(lcd, 1, (uint8_t)(i % 240 << 2 & 0xFF));
        el_lcd_write(lcd, 1, 0);
    }
    TEST_ASSERT_EQUAL_UINT64(240 * 320, el_lcd_pixels(lcd));
    TEST_ASSERT_EQUAL_HEX32((319U & 0x3F) << 12 | (239U & 0x3F) << 6, el_lcd_memory(lcd, 239, 319));
    TEST_ASSERT_EQUAL_HEX32(1U << 12, el_lcd_memory(lcd, 0, 1));
}

/* Sections 8.2.29 and 8.2.33: "no change". A driver that trusts SWRESET for these fails here. */
static void test_swreset_keeps_madctl_pixel_format_and_memory(void)
{
    fill(0x28);
    send_window(lcd, 1, 1, 1, 1);
    send_command(lcd, 0x01);
    el_lcd_advance_ns(lcd, 120000000);
    send_command(lcd, 0x2C); /* window over everything, in exchanged coordinates */
    send_letters(lcd, "ABCDE");
    send_command(lcd, 0x11);
    el_lcd_advance_ns(lcd, 5000000);
    send_command(lcd, 0x29);
    EXPECT_LOOK(lcd, 270, "ABCD", "Efgh", "ijkl");
}

static void test_hardware_reset_sets_madctl_and_pixel_format_but_keeps_the_memory(void)
{
    fill(0x48);
    el_lcd_reset(lcd, 0);
    el_lcd_advance_ns(lcd, 10000);
    el_lcd_reset(lcd, 1);
    EXPECT_LOOK(lcd, 0, "...", "...", "...", "...");
    el_lcd_advance_ns(lcd, 120000000);
    send_command(lcd, 0x11);
    el_lcd_advance_ns(lcd, 5000000);
    send_command(lcd, 0x29);
    SEND(lcd, 0x2C, 0xB0, 0x40, 0x00); /* as it comes out of reset: 18 bits, first to memory column 0, row 0 */
    TEST_ASSERT_EQUAL_HEX32(0x2C << 12 | 0x10 << 6, el_lcd_memory(lcd, 0, 0));
    SEND(lcd, 0x36, 0x08);
    EXPECT_LOOK(lcd, 0, "abZ", "def", "ghi", "jkl");
}

static void test_unwritten_memory_is_the_same_noise_each_time(void)
{
    const el_lcd_profile profile = el_lcd_dcs(3, 4);
    el_lcd *other = el_lcd_create(&profile);
    TEST_ASSERT_NOT_NULL(other);
    switch_on(other);
    uint16_t first[12];
    uint16_t second[12];
    unsigned different = 0;
    el_lcd_glass(lcd, first);
    el_lcd_glass(other, second);
    el_lcd_destroy(other);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(first, second, 12);
    for (unsigned i = 1; i < 12; i++) {
        different += first[i] != first[0];
    }
    TEST_ASSERT_GREATER_THAN_UINT(8, different);
}

static void test_sizes_outside_the_range_are_refused(void)
{
    const el_lcd_profile wide = el_lcd_dcs(2041, 1);
    const el_lcd_profile flat = el_lcd_dcs(1, 0);
    const el_lcd_profile largest = el_lcd_dcs(2040, 2040);
    TEST_ASSERT_NULL(el_lcd_create(&wide));
    TEST_ASSERT_NULL(el_lcd_create(&flat));
    el_lcd *large = el_lcd_create(&largest);
    TEST_ASSERT_NOT_NULL(large);
    el_lcd_destroy(large);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_madctl_on_the_upright_glass);
    RUN_TEST(test_the_four_usual_madctl_are_upright_when_the_module_is_turned);
    RUN_TEST(test_a_mirrored_landscape_stays_mirrored_however_the_module_is_turned);
    RUN_TEST(test_other_angles_are_refused);
    RUN_TEST(test_madctl_does_not_move_what_is_in_the_memory);
    RUN_TEST(test_a_window_is_filled_column_first_and_wraps_at_its_end);
    RUN_TEST(test_pixels_beyond_the_window_are_dropped_without_wemode);
    RUN_TEST(test_ramwr_starts_again_and_ramwrc_goes_on);
    RUN_TEST(test_the_window_is_counted_in_exchanged_coordinates);
    RUN_TEST(test_sixteen_bits_become_eighteen_by_copying_the_highest_bit);
    RUN_TEST(test_eighteen_bits_are_the_upper_six_of_three_bytes);
    RUN_TEST(test_every_rgb565_comes_back_as_it_was_sent);
    RUN_TEST(test_red_is_red_with_the_bgr_bit_only);
    RUN_TEST(test_inversion_and_idle_mode);
    RUN_TEST(test_the_glass_is_white_unless_awake_and_on);
    RUN_TEST(test_pixels_can_be_written_asleep);
    RUN_TEST(test_scrolling_moves_the_lines_between_the_fixed_ones);
    RUN_TEST(test_scrolling_counts_from_the_bottom_with_ml);
    RUN_TEST(test_reversed_gates_and_sources_turn_the_picture);
    RUN_TEST(test_defaults_after_power_on);
    RUN_TEST(test_swreset_keeps_madctl_pixel_format_and_memory);
    RUN_TEST(test_hardware_reset_sets_madctl_and_pixel_format_but_keeps_the_memory);
    RUN_TEST(test_unwritten_memory_is_the_same_noise_each_time);
    RUN_TEST(test_sizes_outside_the_range_are_refused);
    return UNITY_END();
}
