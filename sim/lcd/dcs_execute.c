/* What MIPI DCS commands do: registers, waiting times, the address counter.
 *
 * One switch, with a case for each command that can change the picture or must be waited for and that all of these chips
 * have; what only one chip has is in its own file. Sections are of the ILI9341 data sheet V1.11 where no other is named;
 * those of the other chips say the same. */
#include "lcd_state.h"

enum { DEFAULT_PIXEL_BYTES = 3 }; /* section 8.2.33: 18 bits per pixel */

/* Resets. The registers of section 8.2 that "no change" stands for on a software reset are COLMOD and MADCTL. */

static void full_window(el_lcd *lcd)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    const bool exchanged = (dcs->madctl & EL_MADCTL_MV) != 0;
    const uint16_t last_column = (uint16_t)(lcd->profile.memory_columns - 1);
    const uint16_t last_row = (uint16_t)(lcd->profile.memory_rows - 1);
    dcs->columns = (el_lcd_range){0, exchanged ? last_row : last_column};
    dcs->pages = (el_lcd_range){0, exchanged ? last_column : last_row};
}

static void software_reset(el_lcd *lcd)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    dcs->awake = false;
    dcs->on = false;
    dcs->inverted = false;
    dcs->idle = false;
    dcs->scrolling = false;
    dcs->wrap = true;
    dcs->gates_reversed = false;
    dcs->sources_reversed = false;
    dcs->values_reversed = false;
    dcs->low_byte_first = false;
    dcs->top_fixed = 0;
    dcs->scroll_area = lcd->profile.memory_rows;
    dcs->scroll_start = 0;
    dcs->writable = false;
    full_window(lcd);
}

/* Before the registers change, because being awake prolongs the waiting. */
static void wait_after_reset(el_lcd *lcd, uint64_t settle_ns, const char *what)
{
    lcd->any = el_lcd_wait_from_now(lcd, settle_ns, what);
    if (lcd->chip.dcs.awake) {
        lcd->sleep_out = el_lcd_wait_from_now(lcd, lcd->profile.chip->dcs->sleep_change_ns, what);
    }
}

static void hardware_reset(el_lcd *lcd)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    wait_after_reset(lcd, lcd->profile.chip->dcs->reset_settle_ns, "reset");
    dcs->madctl = 0;
    dcs->pixel_bytes = DEFAULT_PIXEL_BYTES;
    dcs->pixel_count = 0;
    software_reset(lcd);
}

/* The address counter, section 9.3. */

static bool is_outside(const el_lcd *lcd)
{
    const el_dcs *const dcs = &lcd->chip.dcs;
    const bool exchanged = (dcs->madctl & EL_MADCTL_MV) != 0;
    return dcs->columns.end >= (exchanged ? lcd->profile.memory_rows : lcd->profile.memory_columns) ||
           dcs->pages.end >= (exchanged ? lcd->profile.memory_columns : lcd->profile.memory_rows);
}

/* The limits depend on MADCTL, and CASET and PASET are looked at when RAMWR comes (section 8.2.20): so are errors. */
static void begin_pixels(el_lcd *lcd)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    const bool reversed = dcs->columns.start > dcs->columns.end || dcs->pages.start > dcs->pages.end;
    if (reversed || is_outside(lcd)) {
        el_lcd_report(lcd, EL_LCD_BAD_WINDOW,
                      "2Ch RAMWR: window columns %u..%u, pages %u..%u is %s with MADCTL %02Xh (%s)", dcs->columns.start,
                      dcs->columns.end, dcs->pages.start, dcs->pages.end, reversed ? "reversed" : "out of range",
                      dcs->madctl, el_lcd_section(lcd, EL_DCS_CASET));
    }
    dcs->writable = !reversed;
    dcs->full = false;
    dcs->column = dcs->columns.start;
    dcs->page = dcs->pages.start;
}

static void store_pixel(el_lcd *lcd, uint32_t rgb18)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    const bool exchanged = (dcs->madctl & EL_MADCTL_MV) != 0;
    unsigned column = exchanged ? dcs->page : dcs->column;
    unsigned row = exchanged ? dcs->column : dcs->page;
    if (column >= lcd->profile.memory_columns || row >= lcd->profile.memory_rows) {
        return; /* "data of out of range will be ignored", section 8.2.20 */
    }
    if ((dcs->madctl & EL_MADCTL_MX) != 0) {
        column = lcd->profile.memory_columns - 1U - column;
    }
    if ((dcs->madctl & EL_MADCTL_MY) != 0) {
        row = lcd->profile.memory_rows - 1U - row;
    }
    *el_lcd_cell(lcd, column, row) = rgb18;
    lcd->pixels++;
}

static void step_address(el_lcd *lcd)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    if (dcs->column != dcs->columns.end) {
        dcs->column++;
        return;
    }
    dcs->column = dcs->columns.start;
    if (dcs->page != dcs->pages.end) {
        dcs->page++;
        return;
    }
    dcs->page = dcs->pages.start;
    dcs->full = !dcs->wrap;
}

/* Section 7.6.2: 16 bits are R5 G6 B5, most significant first; 18 bits are the upper six of three bytes. With EPF 00 of
 * IFCTL (section 8.3.28) the missing lowest bit of red and blue is a copy of the highest. */
static uint32_t pixel_value(const el_lcd *lcd)
{
    const el_dcs *const dcs = &lcd->chip.dcs;
    if (dcs->pixel_bytes == 3) {
        return (uint32_t)dcs->pixel[0] >> 2 << 12 | (uint32_t)dcs->pixel[1] >> 2 << 6 | (uint32_t)dcs->pixel[2] >> 2;
    }
    const unsigned high = dcs->low_byte_first ? 1 : 0;
    const uint32_t rgb565 = (uint32_t)dcs->pixel[high] << 8 | dcs->pixel[1 - high];
    const uint32_t red = rgb565 >> 11;
    const uint32_t green = rgb565 >> 5 & 0x3F;
    const uint32_t blue = rgb565 & 0x1F;
    return (red << 1 | red >> 4) << 12 | green << 6 | (blue << 1 | blue >> 4);
}

static void pixel_byte(el_lcd *lcd, uint8_t byte)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    dcs->pixel[dcs->pixel_count++] = byte;
    if (dcs->pixel_count < dcs->pixel_bytes) {
        return;
    }
    dcs->pixel_count = 0;
    if (dcs->writable && !dcs->full) {
        store_pixel(lcd, pixel_value(lcd));
        step_address(lcd);
    }
}

/* Commands. */

static void bad_value(el_lcd *lcd, const char *what)
{
    el_lcd_report_command(lcd, EL_LCD_BAD_VALUE, what);
}

static uint16_t word(const el_lcd *lcd, unsigned index)
{
    return (uint16_t)(lcd->parameters[index] << 8 | lcd->parameters[index + 1]);
}

static void change_sleep(el_lcd *lcd, bool awake)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    const el_dcs_chip *const chip = lcd->profile.chip->dcs;
    lcd->any = el_lcd_wait_from_now(lcd, chip->sleep_settle_ns, lcd->command->name);
    if (dcs->awake != awake) {
        el_lcd_wait *const back = awake ? &lcd->sleep_in : &lcd->sleep_out;
        *back = el_lcd_wait_from_now(lcd, chip->sleep_change_ns, lcd->command->name);
    }
    dcs->awake = awake;
}

static void set_pixel_format(el_lcd *lcd, uint8_t value)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    switch (value & 0x8F) { /* bits 6..4 are for the RGB interface, which is not connected */
    case 0x05:
        dcs->pixel_bytes = 2;
        break;
    case 0x06:
        dcs->pixel_bytes = 3;
        break;
    default:
        bad_value(lcd, "bits 2..0 must be 101 (16 bits per pixel) or 110 (18)");
        break;
    }
}

static void define_scrolling(el_lcd *lcd)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    const unsigned top = word(lcd, 0);
    const unsigned area = word(lcd, 2);
    const unsigned bottom = word(lcd, 4);
    if (top + area + bottom != lcd->profile.memory_rows || area == 0) {
        bad_value(lcd, "top, scrolling and bottom lines must add up to the rows of the glass");
        return;
    }
    dcs->top_fixed = (uint16_t)top;
    dcs->scroll_area = (uint16_t)area;
    dcs->scroll_start = (uint16_t)top;
}

static void start_scrolling(el_lcd *lcd)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    const uint16_t line = word(lcd, 0);
    if (line < dcs->top_fixed || line >= dcs->top_fixed + dcs->scroll_area) {
        bad_value(lcd, "the line must be inside the scrolling area");
        return;
    }
    dcs->scroll_start = line;
    dcs->scrolling = true;
}

static void execute(el_lcd *lcd)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    switch (lcd->code) {
    case EL_DCS_SWRESET:
        wait_after_reset(lcd, lcd->profile.chip->dcs->swreset_settle_ns, "SWRESET");
        software_reset(lcd);
        break;
    case EL_DCS_SLPIN:
    case EL_DCS_SLPOUT:
        change_sleep(lcd, lcd->code == EL_DCS_SLPOUT);
        break;
    case EL_DCS_NORON: /* "Normal display mode on means Partial mode off, Scroll mode off", section 8.2.14 */
        dcs->scrolling = false;
        break;
    case EL_DCS_INVOFF:
    case EL_DCS_INVON:
        dcs->inverted = lcd->code == EL_DCS_INVON;
        break;
    case EL_DCS_DISPOFF:
    case EL_DCS_DISPON:
        dcs->on = lcd->code == EL_DCS_DISPON;
        break;
    case EL_DCS_IDMOFF:
    case EL_DCS_IDMON:
        dcs->idle = lcd->code == EL_DCS_IDMON;
        break;
    case EL_DCS_CASET:
        dcs->columns = (el_lcd_range){word(lcd, 0), word(lcd, 2)};
        dcs->writable = false;
        break;
    case EL_DCS_PASET:
        dcs->pages = (el_lcd_range){word(lcd, 0), word(lcd, 2)};
        dcs->writable = false;
        break;
    case EL_DCS_MADCTL:
        dcs->madctl = lcd->parameters[0];
        dcs->writable = false;
        break;
    case EL_DCS_RAMWR:
        begin_pixels(lcd);
        break;
    case EL_DCS_RAMWRC: /* "written to undefined addresses" otherwise, section 8.2.34 */
        if (!dcs->writable) {
            el_lcd_report(lcd, EL_LCD_NO_RAMWR, "3Ch %s without RAMWR since reset, CASET, PASET or MADCTL (%s)",
                          lcd->command->name, lcd->command->section);
        }
        break;
    case EL_DCS_COLMOD:
        set_pixel_format(lcd, lcd->parameters[0]);
        break;
    case EL_DCS_GAMSET:
        if (lcd->parameters[0] != 1 && lcd->parameters[0] != 2 && lcd->parameters[0] != 4 && lcd->parameters[0] != 8) {
            bad_value(lcd, "the curve must be 1, 2, 4 or 8");
        }
        break;
    case EL_DCS_VSCRDEF:
        define_scrolling(lcd);
        break;
    case EL_DCS_VSCRSADD:
        start_scrolling(lcd);
        break;
    default:
        lcd->profile.chip->dcs->execute(lcd);
        break;
    }
}

static void check(el_lcd *lcd)
{
    if (lcd->code == EL_DCS_SLPOUT) {
        el_lcd_check_wait(lcd, &lcd->sleep_out);
    }
    if (lcd->code == EL_DCS_SLPIN || lcd->code == EL_DCS_SWRESET) {
        el_lcd_check_wait(lcd, &lcd->sleep_in);
    }
}

static bool takes_pixels(const el_lcd_command *command)
{
    return command->code == EL_DCS_RAMWR || command->code == EL_DCS_RAMWRC;
}

static void close_command(el_lcd *lcd)
{
    el_dcs *const dcs = &lcd->chip.dcs;
    if (dcs->pixel_count != 0) {
        el_lcd_report(lcd, EL_LCD_HALF_PIXEL, "%02Xh %s ended after %u of the %u bytes of a pixel", lcd->code,
                      lcd->command->name, dcs->pixel_count, dcs->pixel_bytes);
    }
    dcs->pixel_count = 0;
}

const el_lcd_family EL_DCS_FAMILY = {
    .parameters_are_commands = false,
    .memory_bits = 18,
    .reset = hardware_reset,
    .check = check,
    .execute = execute,
    .takes_pixels = takes_pixels,
    .pixel_byte = pixel_byte,
    .close = close_command,
    .is_lit = el_dcs_is_lit,
    .glass_pixel = el_dcs_glass_pixel,
};
