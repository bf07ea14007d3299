/* The ST7789V and the IPS modules that it is sold in.
 *
 * Source: Sitronix, "ST7789V Datasheet", version 1.3, as far as drivers quote it: its own text was not at hand for every
 * command. The parameter counts of the commands that LovyanGFX and Linux's fb_st7789v send are as they send them; the
 * waiting times of 7.4.5 and LCMCTRL's bits are as drivers give them; the rest is unconfirmed.
 * Commands without a case here or in dcs_execute.c change no pixel: the model checks their parameter counts only.
 *
 * The modules: memory column 0 and row 0 are at the viewer's upper left, the colour filter is RGB, so MADCTL is 00h for
 * the upright picture and 60h, C0h, A0h for each further quarter turn clockwise of the picture; the glass is IPS,
 * normally black, and colours are right with INVON (Linux's fb_st7789v and TFT_eSPI send it). The square glass shows
 * memory rows 0 to 239: where MY counts rows from the other end, the window begins at 80 (TFT_eSPI, ST7789_Rotation). */
#include "lcd_state.h"

enum { RAMCTRL = 0xB0, LCMCTRL = 0xC0, GATECTRL = 0xE4 };

static const el_lcd_command COMMANDS[] = {
    {EL_DCS_NOP, EL_DCS_NOP, 0, 0, "NOP", "9.1.1"},
    {EL_DCS_SWRESET, EL_DCS_SWRESET, 0, 0, "SWRESET", "9.1.2"},
    {EL_DCS_SLPIN, EL_DCS_SLPIN, 0, 0, "SLPIN", "9.1.11"},
    {EL_DCS_SLPOUT, EL_DCS_SLPOUT, 0, 0, "SLPOUT", "9.1.12"},
    {EL_DCS_NORON, EL_DCS_NORON, 0, 0, "NORON", "9.1.14"},
    {EL_DCS_INVOFF, EL_DCS_INVOFF, 0, 0, "INVOFF", "9.1.15"},
    {EL_DCS_INVON, EL_DCS_INVON, 0, 0, "INVON", "9.1.16"},
    {EL_DCS_GAMSET, EL_DCS_GAMSET, 1, 1, "GAMSET", "9.1.17"},
    {EL_DCS_DISPOFF, EL_DCS_DISPOFF, 0, 0, "DISPOFF", "9.1.18"},
    {EL_DCS_DISPON, EL_DCS_DISPON, 0, 0, "DISPON", "9.1.19"},
    {EL_DCS_CASET, EL_DCS_CASET, 4, 4, "CASET", "9.1.20"},
    {EL_DCS_PASET, EL_DCS_PASET, 4, 4, "RASET", "9.1.21"},
    {EL_DCS_RAMWR, EL_DCS_RAMWR, 0, 0, "RAMWR", "9.1.22"},
    {EL_DCS_VSCRDEF, EL_DCS_VSCRDEF, 6, 6, "VSCRDEF", "9.1.25"},
    {EL_DCS_TEOFF, EL_DCS_TEOFF, 0, 0, "TEOFF", "9.1.26"},
    {EL_DCS_TEON, EL_DCS_TEON, 1, 1, "TEON", "9.1.27"},
    {EL_DCS_MADCTL, EL_DCS_MADCTL, 1, 1, "MADCTL", "9.1.28"},
    {EL_DCS_VSCRSADD, EL_DCS_VSCRSADD, 2, 2, "VSCSAD", "9.1.29"},
    {EL_DCS_IDMOFF, EL_DCS_IDMOFF, 0, 0, "IDMOFF", "9.1.30"},
    {EL_DCS_IDMON, EL_DCS_IDMON, 0, 0, "IDMON", "9.1.31"},
    {EL_DCS_COLMOD, EL_DCS_COLMOD, 1, 1, "COLMOD", "9.1.32"},
    {EL_DCS_RAMWRC, EL_DCS_RAMWRC, 0, 0, "WRMEMC", "9.1.33"},
    {EL_DCS_WRDISBV, EL_DCS_WRDISBV, 1, 1, "WRDISBV", "9.1.37"},
    {EL_DCS_WRCTRLD, EL_DCS_WRCTRLD, 1, 1, "WRCTRLD", "9.1.39"},
    {RAMCTRL, RAMCTRL, 2, 2, "RAMCTRL", "9.2.1"},
    {0xB2, 0xB2, 5, 5, "PORCTRL", "9.2.3"},
    {0xB3, 0xB3, 3, 3, "FRCTRL1", "9.2.4"},
    {0xB7, 0xB7, 1, 1, "GCTRL", "9.2.6"},
    {0xBB, 0xBB, 1, 1, "VCOMS", "9.2.9"},
    {LCMCTRL, LCMCTRL, 1, 1, "LCMCTRL", "9.2.12"},
    {0xC2, 0xC2, 2, 2, "VDVVRHEN", "9.2.14"},
    {0xC3, 0xC3, 1, 1, "VRHS", "9.2.15"},
    {0xC4, 0xC4, 1, 1, "VDVS", "9.2.16"},
    {0xC5, 0xC5, 1, 1, "VCMOFSET", "9.2.17"},
    {0xC6, 0xC6, 1, 1, "FRCTRL2", "9.2.18"},
    {0xD0, 0xD0, 2, 2, "PWCTRL1", "9.2.23"},
    {0xE0, 0xE0, 14, 14, "PVGAMCTRL", "9.2.24"},
    {0xE1, 0xE1, 14, 14, "NVGAMCTRL", "9.2.25"},
    {GATECTRL, GATECTRL, 3, 3, "GATECTRL", "9.2.28"},
};

/* The data sheet allows little-endian (ENDIAN) on 8- and 9-bit interfaces only; chips take it on the serial one too, and
 * ESP-IDF's esp_lcd_panel_st7789 uses it there. */
static void set_memory_control(el_lcd *lcd)
{
    enum { RM_AND_DM = 0x13, ENDIAN = 0x08 };
    if ((lcd->parameters[0] & RM_AND_DM) != 0) {
        el_lcd_report_command(lcd, EL_LCD_BAD_VALUE, "the RGB interface does not go with the serial one");
    }
    lcd->chip.dcs.low_byte_first = (lcd->parameters[1] & ENDIAN) != 0;
}

/* The default is what the modules above were described with; other values mirror them. */
static void set_lcm_control(el_lcd *lcd)
{
    enum { DEFAULT = 0x2C };
    if (lcd->parameters[0] != DEFAULT) {
        el_lcd_report_command(lcd, EL_LCD_BAD_VALUE, "only the default 2Ch is in this model");
    }
}

static void set_gates(el_lcd *lcd)
{
    enum { ALL_LINES = 0x27, GS = 0x01 }; /* 8 * (27h + 1) = 320 */
    if (lcd->parameters[0] != ALL_LINES || lcd->parameters[1] != 0) {
        el_lcd_report_command(lcd, EL_LCD_BAD_VALUE, "NL and SCN do not drive all lines of the memory");
    }
    lcd->chip.dcs.gates_reversed = (lcd->parameters[2] & GS) != 0;
}

static void execute(el_lcd *lcd)
{
    switch (lcd->code) {
    case RAMCTRL:
        set_memory_control(lcd);
        break;
    case LCMCTRL:
        set_lcm_control(lcd);
        break;
    case GATECTRL:
        set_gates(lcd);
        break;
    default:
        break;
    }
}

/* Sections 9.1.2, 9.1.11, 9.1.12 and 7.4.5. */
static const el_dcs_chip TIMES = {
    .reset_settle_ns = 5 * EL_LCD_MS_NS,
    .swreset_settle_ns = 5 * EL_LCD_MS_NS,
    .sleep_settle_ns = 5 * EL_LCD_MS_NS,
    .sleep_change_ns = 120 * EL_LCD_MS_NS,
    .execute = execute,
};

static const el_lcd_chip CHIP = {
    .family = &EL_DCS_FAMILY,
    .commands = COMMANDS,
    .command_count = sizeof COMMANDS / sizeof COMMANDS[0],
    .reset_pulse_ns = 10000, /* section 7.4.5, TRW */
    .reset_ignored_ns = 5000,
    .reset_section = "7.4.5",
    .dcs = &TIMES,
};

const el_lcd_profile EL_LCD_ST7789 = {
    .panel = "st7789",
    .name = "ST7789",
    .chip = &CHIP,
    .columns = 240,
    .rows = 320,
    .memory_columns = 240,
    .memory_rows = 320,
    .inverting = true,
    .blank = 0x0000,
};

const el_lcd_profile EL_LCD_ST7789_240X240 = {
    .panel = "st7789-240x240",
    .name = "ST7789",
    .chip = &CHIP,
    .columns = 240,
    .rows = 240,
    .memory_columns = 240,
    .memory_rows = 320,
    .inverting = true,
    .blank = 0x0000,
};
