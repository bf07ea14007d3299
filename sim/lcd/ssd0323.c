/* The SSD0323 behind the 128 x 64 pixels of 16 greys of OSRAM's Pictiva OLED, as on the LM3S6965 evaluation board.
 *
 * Sources: the SSD0323's own data sheet could not be had; sections are those of its successor with the same commands
 * (Solomon Systech, "SSD1325", Rev 2.3), and the command set and the addressing were checked against QEMU's ssd0323 and
 * u8g2's driver of such glass.
 *
 * The module: segment 0 is at the viewer's left; commons 67 (at the top) to 4 are connected, the even ones on one side
 * and the odd ones on the other; so the picture is upright with A0h 52h and A2h 4Ch (OSRAM's application note AN018, in
 * Luminary Micro's driver of the board). The grey that is shown is the one in the memory: contrast and the grey scale
 * table (B8h) do not change it here. */
#include "lcd_state.h"

enum {
    COLUMNS = 128,
    COLUMN_BYTES = 64,
    ROWS = 64,
    MEMORY_ROWS = 80, /* and commons */
    TOP_COMMON = 67,
    COLUMN_RANGE = 0x15,
    ROW_RANGE = 0x75,
    CONTRAST = 0x81,
    REMAP = 0xA0,
    START_LINE = 0xA1,
    DISPLAY_OFFSET = 0xA2,
    DISPLAY_MODE = 0xA4,
    MULTIPLEX = 0xA8,
    DISPLAY_OFF = 0xAE,
    DISPLAY_ON = 0xAF,
    PHASE_LENGTH = 0xB1,
    GREY_TABLE = 0xB8,
};

/* A0h, section 10.5. */
enum {
    REMAP_COLUMNS = 0x01,  /* bytes from the right to the left */
    REMAP_NIBBLES = 0x02,  /* the upper nibble is the left pixel */
    REMAP_VERTICAL = 0x04, /* the address counter goes down first */
    REMAP_COMS = 0x10,     /* rows from the last common to the first */
    REMAP_SPLIT = 0x40,    /* even and odd commons on different sides */
    REMAP_RESERVED = 0xA8,
};

/* The low bits of DISPLAY_MODE. */
enum { MODE_NORMAL, MODE_ALL_ON, MODE_ALL_OFF, MODE_INVERSE };

static const el_lcd_command COMMANDS[] = {
    {COLUMN_RANGE, COLUMN_RANGE, 2, 2, "Set Column Address", "10.1"},
    {ROW_RANGE, ROW_RANGE, 2, 2, "Set Row Address", "10.2"},
    {CONTRAST, CONTRAST, 1, 1, "Set Contrast Current", "10.3"},
    {0x84, 0x86, 0, 0, "Set Current Range", "10.4"},
    {REMAP, REMAP, 1, 1, "Set Re-map", "10.5"},
    {START_LINE, START_LINE, 1, 1, "Set Display Start Line", "10.6"},
    {DISPLAY_OFFSET, DISPLAY_OFFSET, 1, 1, "Set Display Offset", "10.7"},
    {DISPLAY_MODE, 0xA7, 0, 0, "Set Display Mode", "10.8"},
    {MULTIPLEX, MULTIPLEX, 1, 1, "Set Multiplex Ratio", "10.9"},
    {0xAD, 0xAD, 1, 1, "Set Master Configuration", "10.10"},
    {DISPLAY_OFF, DISPLAY_ON, 0, 0, "Set Display ON/OFF", "10.11"},
    {0xB0, 0xB0, 1, 1, "Set Pre-charge Compensation Enable", "9"},
    {PHASE_LENGTH, PHASE_LENGTH, 1, 1, "Set Phase Length", "10.12"},
    {0xB2, 0xB2, 1, 1, "Set Row Period", "10.13"},
    {0xB3, 0xB3, 1, 1, "Set Display Clock Divide Ratio", "10.14"},
    {0xB4, 0xB4, 1, 1, "Set Pre-charge Compensation Level", "9"},
    {GREY_TABLE, GREY_TABLE, 8, 8, "Set Gray Scale Table", "10.15"},
    {0xBC, 0xBC, 1, 1, "Set Pre-charge Voltage", "10.16"},
    {0xBE, 0xBE, 1, 1, "Set VCOMH", "10.17"},
    {0xBF, 0xBF, 1, 1, "Set Segment Low Voltage", "10.18"},
    {0xE3, 0xE3, 0, 0, "NOP", "10.19"},
};

static void reset(el_lcd *lcd)
{
    lcd->any = el_lcd_wait_from_now(lcd, 3000, "reset");
    lcd->chip.ssd0323 = (el_lcd_ssd0323){
        .columns.end = COLUMN_BYTES - 1,
        .rows.end = MEMORY_ROWS - 1,
        .multiplex = MEMORY_ROWS - 1,
    };
}

/* The address counter, sections 10.1 and 10.2. */

static void step_address(el_lcd_ssd0323 *chip)
{
    if ((chip->remap & REMAP_VERTICAL) != 0) {
        if (el_axis_step(&chip->rows, MEMORY_ROWS)) {
            (void)el_axis_step(&chip->columns, COLUMN_BYTES);
        }
    } else if (el_axis_step(&chip->columns, COLUMN_BYTES)) {
        (void)el_axis_step(&chip->rows, MEMORY_ROWS);
    }
}

/* The re-map of columns and nibbles acts when the memory is written; cells are in the order of the segments. */
static void pixel_byte(el_lcd *lcd, uint8_t byte)
{
    el_lcd_ssd0323 *const chip = &lcd->chip.ssd0323;
    const unsigned pair = (chip->remap & REMAP_COLUMNS) != 0 ? COLUMN_BYTES - 1U - chip->columns.at : chip->columns.at;
    const bool upper_first = (chip->remap & REMAP_NIBBLES) != 0;
    *el_lcd_cell(lcd, 2 * pair, chip->rows.at) = upper_first ? byte >> 4 : byte & 0xFU;
    *el_lcd_cell(lcd, 2 * pair + 1, chip->rows.at) = upper_first ? byte & 0xFU : byte >> 4;
    lcd->pixels += 2;
    step_address(chip);
}

/* Commands. */

static void bad_value(el_lcd *lcd, const char *what)
{
    el_lcd_report_command(lcd, EL_LCD_BAD_VALUE, what);
}

static void set_remap(el_lcd *lcd)
{
    lcd->chip.ssd0323.remap = lcd->parameters[0];
    if ((lcd->parameters[0] & REMAP_RESERVED) != 0) {
        bad_value(lcd, "bits 3, 5 and 7 must be 0");
    }
    if ((lcd->parameters[0] & REMAP_SPLIT) == 0) {
        bad_value(lcd, "the module's commons are split even and odd, which bit 6 says");
    }
}

static void set_line(el_lcd *lcd, uint8_t *line)
{
    if (lcd->parameters[0] >= MEMORY_ROWS) {
        bad_value(lcd, "the line is 0 to 79");
    }
    *line = lcd->parameters[0] % MEMORY_ROWS;
}

/* Section 10.15. */
static void check_grey_table(el_lcd *lcd)
{
    for (unsigned i = 0; i < 8; i++) {
        if ((lcd->parameters[i] & 0x88) != 0) {
            bad_value(lcd, "the table has 3 bits per level");
            return;
        }
    }
}

static void execute(el_lcd *lcd)
{
    el_lcd_ssd0323 *const chip = &lcd->chip.ssd0323;
    switch (lcd->command->code) {
    case COLUMN_RANGE:
        el_axis_set(lcd, &chip->columns, COLUMN_BYTES);
        break;
    case ROW_RANGE:
        el_axis_set(lcd, &chip->rows, MEMORY_ROWS);
        break;
    case CONTRAST:
        if (lcd->parameters[0] > 0x7F) {
            bad_value(lcd, "the contrast is 0 to 127");
        }
        break;
    case REMAP:
        set_remap(lcd);
        break;
    case START_LINE:
        set_line(lcd, &chip->start_line);
        break;
    case DISPLAY_OFFSET:
        set_line(lcd, &chip->offset);
        break;
    case DISPLAY_MODE:
        chip->display_mode = lcd->code & 3;
        break;
    case MULTIPLEX:
        chip->multiplex = lcd->parameters[0];
        if (lcd->parameters[0] != ROWS - 1) {
            bad_value(lcd, "the module's 64 rows take 3Fh");
        }
        break;
    case DISPLAY_OFF:
        chip->on = lcd->code == DISPLAY_ON;
        break;
    case PHASE_LENGTH:
        if ((lcd->parameters[0] & 0x0F) == 0 || (lcd->parameters[0] & 0xF0) == 0) {
            bad_value(lcd, "a phase of 0 clocks is invalid");
        }
        break;
    case GREY_TABLE:
        check_grey_table(lcd);
        break;
    default: /* voltages and clocks */
        break;
    }
}

/* The glass. */

static bool is_lit(const el_lcd *lcd)
{
    return lcd->chip.ssd0323.on;
}

/* 4 bits repeated to 5, 6 and 5. */
static uint16_t grey(uint32_t level)
{
    return (uint16_t)((level << 1 | level >> 3) << 11 | (level << 2 | level >> 2) << 5 | (level << 1 | level >> 3));
}

/* Sections 10.5 and 10.7: rows are scanned from common 0, or down to it from the last of those that are driven, and the
 * offset moves them all towards common 0. */
static uint16_t glass_pixel(const el_lcd *lcd, unsigned x, unsigned y)
{
    const el_lcd_ssd0323 *const chip = &lcd->chip.ssd0323;
    const unsigned scanned = (TOP_COMMON - y + chip->offset) % MEMORY_ROWS;
    if (scanned > chip->multiplex) {
        return lcd->profile.blank;
    }
    const unsigned line = (chip->remap & REMAP_COMS) != 0 ? chip->multiplex - scanned : scanned;
    const uint32_t level = el_lcd_memory(lcd, x, (line + chip->start_line) % MEMORY_ROWS);
    switch (chip->display_mode) {
    case MODE_ALL_ON:
        return grey(15);
    case MODE_ALL_OFF:
        return grey(0);
    case MODE_INVERSE:
        return grey(15 - level);
    default:
        return grey(level);
    }
}

static const el_lcd_family FAMILY = {
    .parameters_are_commands = true,
    .memory_bits = 4,
    .reset = reset,
    .execute = execute,
    .pixel_byte = pixel_byte,
    .is_lit = is_lit,
    .glass_pixel = glass_pixel,
};

static const el_lcd_chip CHIP = {
    .family = &FAMILY,
    .commands = COMMANDS,
    .command_count = sizeof COMMANDS / sizeof COMMANDS[0],
    .reset_pulse_ns = 3000, /* the SSD1306's, which is the only one of this maker that could be looked up */
    .reset_section = "8.4",
};

const el_lcd_profile EL_LCD_SSD0323 = {
    .panel = "ssd0323",
    .name = "SSD0323",
    .chip = &CHIP,
    .columns = COLUMNS,
    .rows = ROWS,
    .memory_columns = COLUMNS,
    .memory_rows = MEMORY_ROWS,
    .blank = 0x0000,
};
