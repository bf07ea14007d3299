/* The SSD1306 on the usual module of 128 x 64 pixels without a supply of its own.
 *
 * Source: Solomon Systech, "SSD1306", Rev 1.5, and its appendix "Charge Pump Regulator" (section 2.1). Sections of the
 * commands were checked against the table of contents of Rev 1.2 and 1.5.
 *
 * The module: segment 127 is at the viewer's left and common 63 at the top, so the picture is upright with A1h and C8h
 * (Adafruit_SSD1306, u8g2); commons are wired alternately to both sides (DAh 12h); the glass is fed by the charge pump.
 * A lit pixel is white here, whatever colour the glass has, and contrast does not change it. */
#include "lcd_state.h"

enum {
    COLUMNS = 128,
    ROWS = 64,
    PAGES = 8,
    LOWER_COLUMN = 0x00,
    HIGHER_COLUMN = 0x10,
    ADDRESSING_MODE = 0x20,
    COLUMN_RANGE = 0x21,
    PAGE_RANGE = 0x22,
    START_LINE = 0x40,
    CONTRAST = 0x81,
    CHARGE_PUMP = 0x8D,
    SEGMENT_REMAP = 0xA0,
    ENTIRE_ON = 0xA4,
    INVERSION = 0xA6,
    MULTIPLEX = 0xA8,
    DISPLAY_OFF = 0xAE,
    DISPLAY_ON = 0xAF,
    PAGE_START = 0xB0,
    SCAN_DIRECTION = 0xC0,
    DISPLAY_OFFSET = 0xD3,
    CLOCK = 0xD5,
    PRE_CHARGE = 0xD9,
    COM_PINS = 0xDA,
    VCOMH = 0xDB,
};

enum { HORIZONTAL, VERTICAL, PAGE_BY_PAGE };

static const el_lcd_command COMMANDS[] = {
    {LOWER_COLUMN, 0x0F, 0, 0, "Set Lower Column Start Address", "10.1.1"},
    {HIGHER_COLUMN, 0x1F, 0, 0, "Set Higher Column Start Address", "10.1.2"},
    {ADDRESSING_MODE, ADDRESSING_MODE, 1, 1, "Set Memory Addressing Mode", "10.1.3"},
    {COLUMN_RANGE, COLUMN_RANGE, 2, 2, "Set Column Address", "10.1.4"},
    {PAGE_RANGE, PAGE_RANGE, 2, 2, "Set Page Address", "10.1.5"},
    {0x2E, 0x2E, 0, 0, "Deactivate Scroll", "10.2.3"},
    {START_LINE, 0x7F, 0, 0, "Set Display Start Line", "10.1.6"},
    {CONTRAST, CONTRAST, 1, 1, "Set Contrast Control", "10.1.7"},
    {CHARGE_PUMP, CHARGE_PUMP, 1, 1, "Charge Pump Setting", "appendix 2.1"},
    {SEGMENT_REMAP, 0xA1, 0, 0, "Set Segment Re-map", "10.1.8"},
    {ENTIRE_ON, 0xA5, 0, 0, "Entire Display ON", "10.1.9"},
    {INVERSION, 0xA7, 0, 0, "Set Normal/Inverse Display", "10.1.10"},
    {MULTIPLEX, MULTIPLEX, 1, 1, "Set Multiplex Ratio", "10.1.11"},
    {DISPLAY_OFF, DISPLAY_ON, 0, 0, "Set Display ON/OFF", "10.1.12"},
    {PAGE_START, 0xB7, 0, 0, "Set Page Start Address", "10.1.13"},
    {SCAN_DIRECTION, 0xCF, 0, 0, "Set COM Output Scan Direction", "10.1.14"},
    {DISPLAY_OFFSET, DISPLAY_OFFSET, 1, 1, "Set Display Offset", "10.1.15"},
    {CLOCK, CLOCK, 1, 1, "Set Display Clock Divide Ratio", "10.1.16"},
    {PRE_CHARGE, PRE_CHARGE, 1, 1, "Set Pre-charge Period", "10.1.17"},
    {COM_PINS, COM_PINS, 1, 1, "Set COM Pins Hardware Configuration", "10.1.18"},
    {VCOMH, VCOMH, 1, 1, "Set VCOMH Deselect Level", "10.1.19"},
    {0xE3, 0xE3, 0, 0, "NOP", "10.1.20"},
};

static void reset(el_lcd *lcd)
{
    lcd->any = el_lcd_wait_from_now(lcd, 3000, "reset"); /* section 8.9.2, t2 */
    lcd->chip.ssd1306 = (el_lcd_ssd1306){
        .mode = PAGE_BY_PAGE,
        .columns.end = COLUMNS - 1,
        .pages.end = PAGES - 1,
    };
}

/* The address counter, section 10.1.3. */

static void step_address(el_lcd_ssd1306 *chip)
{
    switch (chip->mode) {
    case HORIZONTAL:
        if (el_axis_step(&chip->columns, COLUMNS)) {
            (void)el_axis_step(&chip->pages, PAGES);
        }
        break;
    case VERTICAL:
        if (el_axis_step(&chip->pages, PAGES)) {
            (void)el_axis_step(&chip->columns, COLUMNS);
        }
        break;
    default:
        chip->columns.at = chip->columns.at == COLUMNS - 1 ? chip->page_mode_start : (uint8_t)(chip->columns.at + 1);
        break;
    }
}

/* Eight pixels of a column, the lowest bit on top (section 8.7). The re-map of segments acts here, so it does not move
 * what was written before (section 10.1.8). */
static void pixel_byte(el_lcd *lcd, uint8_t byte)
{
    el_lcd_ssd1306 *const chip = &lcd->chip.ssd1306;
    const unsigned segment = chip->segments_reversed ? COLUMNS - 1U - chip->columns.at : chip->columns.at;
    for (unsigned bit = 0; bit < 8; bit++) {
        *el_lcd_cell(lcd, segment, chip->pages.at * 8U + bit) = (uint32_t)byte >> bit & 1U;
    }
    lcd->pixels += 8;
    step_address(chip);
}

/* Commands. */

static void bad_value(el_lcd *lcd, const char *what)
{
    el_lcd_report_command(lcd, EL_LCD_BAD_VALUE, what);
}

static void check(el_lcd *lcd)
{
    const uint8_t code = lcd->command->code;
    const bool pages = lcd->chip.ssd1306.mode == PAGE_BY_PAGE;
    if ((code == LOWER_COLUMN || code == HIGHER_COLUMN || code == PAGE_START) && !pages) {
        el_lcd_report_command(lcd, EL_LCD_WRONG_MODE, "only in page addressing mode");
    }
    if ((code == COLUMN_RANGE || code == PAGE_RANGE) && pages) {
        el_lcd_report_command(lcd, EL_LCD_WRONG_MODE, "only in horizontal or vertical addressing mode");
    }
}

static void set_column_nibble(el_lcd_ssd1306 *chip, uint8_t code)
{
    const unsigned low = code < HIGHER_COLUMN ? code & 0xFU : chip->page_mode_start & 0xFU;
    const unsigned high = code < HIGHER_COLUMN ? chip->page_mode_start & 0x70U : (unsigned)(code & 7) << 4;
    chip->page_mode_start = (uint8_t)(high | low);
    chip->columns.at = chip->page_mode_start;
}

static void set_charge_pump(el_lcd *lcd)
{
    enum { FIXED = 0x10, FIXED_MASK = 0x3B, ENABLE = 0x04 };
    if ((lcd->parameters[0] & FIXED_MASK) != FIXED) {
        bad_value(lcd, "the value is 10h (off) or 14h (on)");
    }
    if (lcd->chip.ssd1306.on) {
        el_lcd_report_command(lcd, EL_LCD_WRONG_MODE, "only while the display is off");
    }
    lcd->chip.ssd1306.pump = (lcd->parameters[0] & ENABLE) != 0;
}

static void set_display(el_lcd *lcd, bool on)
{
    if (on && !lcd->chip.ssd1306.pump) {
        el_lcd_report_command(lcd, EL_LCD_WRONG_MODE, "the module has no supply but the charge pump, which is off");
    }
    lcd->chip.ssd1306.on = on;
}

/* Values that move no pixel, but that the chip or the module does not have. */
static void check_value(el_lcd *lcd)
{
    const uint8_t value = lcd->parameters[0];
    switch (lcd->code) {
    case MULTIPLEX:
        if (value != ROWS - 1) {
            bad_value(lcd, "the module's 64 rows take 3Fh");
        }
        break;
    case PRE_CHARGE:
        if ((value & 0x0F) == 0 || (value & 0xF0) == 0) {
            bad_value(lcd, "a phase of 0 clocks is invalid");
        }
        break;
    case COM_PINS:
        if (value != 0x12) {
            bad_value(lcd, "the module's wiring takes 12h");
        }
        break;
    case VCOMH:
        if (value != 0x00 && value != 0x20 && value != 0x30) {
            bad_value(lcd, "the value is 00h, 20h or 30h");
        }
        break;
    default:
        break;
    }
}

static void execute(el_lcd *lcd)
{
    el_lcd_ssd1306 *const chip = &lcd->chip.ssd1306;
    switch (lcd->command->code) {
    case LOWER_COLUMN:
    case HIGHER_COLUMN:
        set_column_nibble(chip, lcd->code);
        break;
    case ADDRESSING_MODE:
        if (lcd->parameters[0] > PAGE_BY_PAGE) {
            bad_value(lcd, "the mode is 0, 1 or 2");
            break;
        }
        chip->mode = lcd->parameters[0];
        break;
    case COLUMN_RANGE:
        el_axis_set(lcd, &chip->columns, COLUMNS);
        break;
    case PAGE_RANGE:
        el_axis_set(lcd, &chip->pages, PAGES);
        break;
    case START_LINE:
        chip->start_line = lcd->code & 0x3F;
        break;
    case CHARGE_PUMP:
        set_charge_pump(lcd);
        break;
    case SEGMENT_REMAP:
        chip->segments_reversed = (lcd->code & 1) != 0;
        break;
    case ENTIRE_ON:
        chip->all_lit = (lcd->code & 1) != 0;
        break;
    case INVERSION:
        chip->inverted = (lcd->code & 1) != 0;
        break;
    case DISPLAY_OFF:
        set_display(lcd, lcd->code == DISPLAY_ON);
        break;
    case PAGE_START:
        chip->pages.at = lcd->code & 7;
        break;
    case SCAN_DIRECTION:
        chip->coms_reversed = (lcd->code & 8) != 0;
        break;
    case DISPLAY_OFFSET:
        if (lcd->parameters[0] >= ROWS) {
            bad_value(lcd, "the offset is 0 to 63");
        }
        chip->offset = lcd->parameters[0] % ROWS;
        break;
    default:
        check_value(lcd);
        break;
    }
}

/* The glass. */

static bool is_lit(const el_lcd *lcd)
{
    return lcd->chip.ssd1306.on && lcd->chip.ssd1306.pump;
}

/* Tables 10-1 and 10-2: the row that a common shows. */
static uint16_t glass_pixel(const el_lcd *lcd, unsigned x, unsigned y)
{
    const el_lcd_ssd1306 *const chip = &lcd->chip.ssd1306;
    const unsigned segment = COLUMNS - 1U - x;
    const unsigned common = ROWS - 1U - y;
    const unsigned position = chip->coms_reversed ? ROWS - 1U - common : common;
    const unsigned row = (position + chip->offset + chip->start_line) % ROWS;
    const bool lit = chip->all_lit || (el_lcd_memory(lcd, segment, row) != 0) != chip->inverted;
    return lit ? 0xFFFF : 0x0000;
}

static const el_lcd_family FAMILY = {
    .parameters_are_commands = true,
    .memory_bits = 1,
    .reset = reset,
    .check = check,
    .execute = execute,
    .pixel_byte = pixel_byte,
    .is_lit = is_lit,
    .glass_pixel = glass_pixel,
};

static const el_lcd_chip CHIP = {
    .family = &FAMILY,
    .commands = COMMANDS,
    .command_count = sizeof COMMANDS / sizeof COMMANDS[0],
    .reset_pulse_ns = 3000, /* section 8.9, t1 */
    .reset_section = "8.9",
};

const el_lcd_profile EL_LCD_SSD1306 = {
    .panel = "ssd1306",
    .name = "SSD1306",
    .chip = &CHIP,
    .columns = COLUMNS,
    .rows = ROWS,
    .memory_columns = COLUMNS,
    .memory_rows = ROWS,
    .blank = 0x0000,
};
