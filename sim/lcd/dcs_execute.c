/* What the commands do: registers, waiting times, the address counter.
 *
 * One switch, with a case for each command that can change the picture or must be waited for. All sections are of the
 * ILI9341 data sheet V1.11. */
#include "dcs_state.h"

#define MS_NS UINT64_C(1000000)
static const uint64_t SETTLE_NS = 5 * MS_NS;         /* sections 8.2.2, 8.2.11, 8.2.12, 15.4: before the next command */
static const uint64_t SLEEP_CHANGE_NS = 120 * MS_NS; /* the same: before the next change between sleep and awake */

/* Defaults after power-on and reset. */
enum {
    DEFAULT_DISCTRL = EL_DISCTRL_REV | 0x02, /* section 8.3.7: 82h */
    DEFAULT_PIXEL_BYTES = 3,                 /* section 8.2.33: 18 bits per pixel */
};

/* Resets. The registers of section 8.2 that "no change" stands for on a software reset are COLMOD and MADCTL. */

static void full_window(el_lcd *lcd)
{
    const bool exchanged = (lcd->madctl & EL_MADCTL_MV) != 0;
    const uint16_t last_column = (uint16_t)(lcd->profile.columns - 1);
    const uint16_t last_row = (uint16_t)(lcd->profile.rows - 1);
    lcd->columns = (el_lcd_range){0, exchanged ? last_row : last_column};
    lcd->pages = (el_lcd_range){0, exchanged ? last_column : last_row};
}

static void software_reset(el_lcd *lcd)
{
    lcd->awake = false;
    lcd->on = false;
    lcd->inverted = false;
    lcd->idle = false;
    lcd->scrolling = false;
    lcd->wrap = true;
    lcd->disctrl = DEFAULT_DISCTRL;
    lcd->top_fixed = 0;
    lcd->scroll_area = lcd->profile.rows;
    lcd->scroll_start = 0;
    lcd->writable = false;
    full_window(lcd);
}

void el_lcd_default_registers(el_lcd *lcd)
{
    lcd->madctl = 0;
    lcd->pixel_bytes = DEFAULT_PIXEL_BYTES;
    software_reset(lcd);
}

static el_lcd_wait wait_from_now(const el_lcd *lcd, uint64_t ns, const char *after)
{
    return (el_lcd_wait){lcd->now_ns + ns, after};
}

void el_lcd_wait_after_reset(el_lcd *lcd, const char *what)
{
    lcd->any = wait_from_now(lcd, SETTLE_NS, what);
    if (lcd->awake) {
        lcd->sleep_out = wait_from_now(lcd, SLEEP_CHANGE_NS, what);
    }
}

/* The address counter, section 9.3. */

static bool is_outside(const el_lcd *lcd)
{
    const bool exchanged = (lcd->madctl & EL_MADCTL_MV) != 0;
    return lcd->columns.end >= (exchanged ? lcd->profile.rows : lcd->profile.columns) ||
           lcd->pages.end >= (exchanged ? lcd->profile.columns : lcd->profile.rows);
}

/* The limits depend on MADCTL, and CASET and PASET are looked at when RAMWR comes (section 8.2.20): so are errors. */
static void begin_pixels(el_lcd *lcd)
{
    const bool reversed = lcd->columns.start > lcd->columns.end || lcd->pages.start > lcd->pages.end;
    if (reversed || is_outside(lcd)) {
        el_lcd_report(lcd, EL_LCD_BAD_WINDOW,
                      "2Ch RAMWR: window columns %u..%u, pages %u..%u is %s with MADCTL %02Xh (8.2.20)",
                      lcd->columns.start, lcd->columns.end, lcd->pages.start, lcd->pages.end,
                      reversed ? "reversed" : "out of range", lcd->madctl);
    }
    lcd->writable = !reversed;
    lcd->full = false;
    lcd->column = lcd->columns.start;
    lcd->page = lcd->pages.start;
}

static void store_pixel(el_lcd *lcd, uint32_t rgb18)
{
    const bool exchanged = (lcd->madctl & EL_MADCTL_MV) != 0;
    unsigned column = exchanged ? lcd->page : lcd->column;
    unsigned row = exchanged ? lcd->column : lcd->page;
    if (column >= lcd->profile.columns || row >= lcd->profile.rows) {
        return; /* "data of out of range will be ignored", section 8.2.20 */
    }
    if ((lcd->madctl & EL_MADCTL_MX) != 0) {
        column = lcd->profile.columns - 1U - column;
    }
    if ((lcd->madctl & EL_MADCTL_MY) != 0) {
        row = lcd->profile.rows - 1U - row;
    }
    lcd->memory[(size_t)row * lcd->profile.columns + column] = rgb18;
    lcd->pixels++;
}

static void step_address(el_lcd *lcd)
{
    if (lcd->column != lcd->columns.end) {
        lcd->column++;
        return;
    }
    lcd->column = lcd->columns.start;
    if (lcd->page != lcd->pages.end) {
        lcd->page++;
        return;
    }
    lcd->page = lcd->pages.start;
    lcd->full = !lcd->wrap;
}

/* Section 7.6.2: 16 bits are R5 G6 B5, most significant first; 18 bits are the upper six of three bytes. With EPF 00 of
 * IFCTL (section 8.3.28) the missing lowest bit of red and blue is a copy of the highest. */
static uint32_t pixel_value(const el_lcd *lcd)
{
    if (lcd->pixel_bytes == 3) {
        return (uint32_t)lcd->pixel[0] >> 2 << 12 | (uint32_t)lcd->pixel[1] >> 2 << 6 | (uint32_t)lcd->pixel[2] >> 2;
    }
    const uint32_t rgb565 = (uint32_t)lcd->pixel[0] << 8 | lcd->pixel[1];
    const uint32_t red = rgb565 >> 11;
    const uint32_t green = rgb565 >> 5 & 0x3F;
    const uint32_t blue = rgb565 & 0x1F;
    return (red << 1 | red >> 4) << 12 | green << 6 | (blue << 1 | blue >> 4);
}

void el_lcd_pixel_byte(el_lcd *lcd, uint8_t byte)
{
    lcd->pixel[lcd->pixel_count++] = byte;
    if (lcd->pixel_count < lcd->pixel_bytes) {
        return;
    }
    lcd->pixel_count = 0;
    if (lcd->writable && !lcd->full) {
        store_pixel(lcd, pixel_value(lcd));
        step_address(lcd);
    }
}

/* Commands. */

static void bad_value(el_lcd *lcd, const char *what)
{
    el_lcd_report(lcd, EL_LCD_BAD_VALUE, "%02Xh %s: %s (section %s)", lcd->command->code, lcd->command->name, what,
                  lcd->command->section);
}

static uint16_t word(const el_lcd *lcd, unsigned index)
{
    return (uint16_t)(lcd->parameters[index] << 8 | lcd->parameters[index + 1]);
}

static void enter_sleep(el_lcd *lcd)
{
    lcd->any = wait_from_now(lcd, SETTLE_NS, "SLPIN");
    if (lcd->awake) {
        lcd->sleep_out = wait_from_now(lcd, SLEEP_CHANGE_NS, "SLPIN");
    }
    lcd->awake = false;
}

static void leave_sleep(el_lcd *lcd)
{
    lcd->any = wait_from_now(lcd, SETTLE_NS, "SLPOUT");
    if (!lcd->awake) {
        lcd->sleep_in = wait_from_now(lcd, SLEEP_CHANGE_NS, "SLPOUT");
    }
    lcd->awake = true;
}

static void set_pixel_format(el_lcd *lcd, uint8_t value)
{
    switch (value & 0x8F) { /* bits 6..4 are for the RGB interface, which is not connected */
    case 0x05:
        lcd->pixel_bytes = 2;
        break;
    case 0x06:
        lcd->pixel_bytes = 3;
        break;
    default:
        bad_value(lcd, "bits 2..0 must be 101 (16 bits per pixel) or 110 (18)");
        break;
    }
}

static void define_scrolling(el_lcd *lcd)
{
    const unsigned top = word(lcd, 0);
    const unsigned area = word(lcd, 2);
    const unsigned bottom = word(lcd, 4);
    if (top + area + bottom != lcd->profile.rows || area == 0) {
        bad_value(lcd, "top, scrolling and bottom lines must add up to the rows of the glass");
        return;
    }
    lcd->top_fixed = (uint16_t)top;
    lcd->scroll_area = (uint16_t)area;
    lcd->scroll_start = (uint16_t)top;
}

static void start_scrolling(el_lcd *lcd)
{
    const uint16_t line = word(lcd, 0);
    if (line < lcd->top_fixed || line >= lcd->top_fixed + lcd->scroll_area) {
        bad_value(lcd, "the line must be inside the scrolling area");
        return;
    }
    lcd->scroll_start = line;
    lcd->scrolling = true;
}

static void set_display_function(el_lcd *lcd)
{
    lcd->disctrl = lcd->parameters[1];
    if ((lcd->disctrl & EL_DISCTRL_SM) != 0) {
        bad_value(lcd, "interlaced gates (SM) are not in this model");
    }
    if (lcd->profile.all_lines != 0 && lcd->parameters[2] != lcd->profile.all_lines) {
        bad_value(lcd, "NL does not drive all lines of the glass");
    }
}

/* Exclusive-or bits on MADCTL, other expansions to 18 bits, little-endian, the RGB interface: no driver for a serial
 * display uses them, so they are more likely a mistake. */
static void set_interface(el_lcd *lcd)
{
    if ((lcd->parameters[0] & 0xFE) != 0 || lcd->parameters[1] != 0 || lcd->parameters[2] != 0) {
        bad_value(lcd, "only WEMODE is in this model, all other bits must be 0");
    }
    lcd->wrap = (lcd->parameters[0] & 0x01) != 0;
}

void el_lcd_execute(el_lcd *lcd)
{
    switch (lcd->command->code) {
    case EL_DCS_SWRESET:
        el_lcd_wait_after_reset(lcd, "SWRESET");
        software_reset(lcd);
        break;
    case EL_DCS_SLPIN:
        enter_sleep(lcd);
        break;
    case EL_DCS_SLPOUT:
        leave_sleep(lcd);
        break;
    case EL_DCS_NORON: /* "Normal display mode on means Partial mode off, Scroll mode off", section 8.2.14 */
        lcd->scrolling = false;
        break;
    case EL_DCS_INVOFF:
    case EL_DCS_INVON:
        lcd->inverted = lcd->command->code == EL_DCS_INVON;
        break;
    case EL_DCS_DISPOFF:
    case EL_DCS_DISPON:
        lcd->on = lcd->command->code == EL_DCS_DISPON;
        break;
    case EL_DCS_IDMOFF:
    case EL_DCS_IDMON:
        lcd->idle = lcd->command->code == EL_DCS_IDMON;
        break;
    case EL_DCS_CASET:
        lcd->columns = (el_lcd_range){word(lcd, 0), word(lcd, 2)};
        lcd->writable = false;
        break;
    case EL_DCS_PASET:
        lcd->pages = (el_lcd_range){word(lcd, 0), word(lcd, 2)};
        lcd->writable = false;
        break;
    case EL_DCS_MADCTL:
        lcd->madctl = lcd->parameters[0];
        lcd->writable = false;
        break;
    case EL_DCS_RAMWR:
        begin_pixels(lcd);
        break;
    case EL_DCS_RAMWRC: /* "written to undefined addresses" otherwise, section 8.2.34 */
        if (!lcd->writable) {
            el_lcd_report(lcd, EL_LCD_NO_RAMWR,
                          "3Ch RAMWRC without RAMWR since reset, CASET, PASET or MADCTL (8.2.34)");
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
    case EL_ILI_DISCTRL:
        set_display_function(lcd);
        break;
    case EL_ILI_IFCTL:
        set_interface(lcd);
        break;
    default: /* voltages, gamma and timing: nothing that a pixel's place or value depends on */
        break;
    }
}
