/* The ST7735R behind 128 x 160 pixels, in the module that is known by the green tab of its protective film.
 *
 * Sources: Sitronix, "ST7735", V1.7 and V2.1, whose sections are in the table; the number of parameters of PWCTR1 and
 * VMCTR1 is the ST7735R's (V0.2, and Adafruit_ST7735's Rcmd1), which is what the modules have. No command here but those
 * of dcs_execute.c changes a pixel's place: the model checks the others' parameter counts only.
 *
 * The module: the glass shows columns 2 to 129 and rows 1 to 160 of the memory; memory column 0 is on the viewer's right
 * and row 0 at the bottom, the colour filter is BGR, so MADCTL is C8h for the upright picture and A8h, 08h, 68h for each
 * further quarter turn clockwise of the picture (Adafruit_ST7735, setRotation; Linux's fb_st7735r). */
#include "lcd_state.h"

static const el_lcd_command COMMANDS[] = {
    {EL_DCS_NOP, EL_DCS_NOP, 0, 0, "NOP", "10.1.1"},
    {EL_DCS_SWRESET, EL_DCS_SWRESET, 0, 0, "SWRESET", "10.1.2"},
    {EL_DCS_SLPIN, EL_DCS_SLPIN, 0, 0, "SLPIN", "10.1.10"},
    {EL_DCS_SLPOUT, EL_DCS_SLPOUT, 0, 0, "SLPOUT", "10.1.11"},
    {EL_DCS_NORON, EL_DCS_NORON, 0, 0, "NORON", "10.1.13"},
    {EL_DCS_INVOFF, EL_DCS_INVOFF, 0, 0, "INVOFF", "10.1.14"},
    {EL_DCS_INVON, EL_DCS_INVON, 0, 0, "INVON", "10.1.15"},
    {EL_DCS_GAMSET, EL_DCS_GAMSET, 1, 1, "GAMSET", "10.1.16"},
    {EL_DCS_DISPOFF, EL_DCS_DISPOFF, 0, 0, "DISPOFF", "10.1.17"},
    {EL_DCS_DISPON, EL_DCS_DISPON, 0, 0, "DISPON", "10.1.18"},
    {EL_DCS_CASET, EL_DCS_CASET, 4, 4, "CASET", "10.1.19"},
    {EL_DCS_PASET, EL_DCS_PASET, 4, 4, "RASET", "10.1.20"},
    {EL_DCS_RAMWR, EL_DCS_RAMWR, 0, 0, "RAMWR", "10.1.21"},
    {EL_DCS_TEOFF, EL_DCS_TEOFF, 0, 0, "TEOFF", "10.1.24"},
    {EL_DCS_TEON, EL_DCS_TEON, 1, 1, "TEON", "10.1.25"},
    {EL_DCS_MADCTL, EL_DCS_MADCTL, 1, 1, "MADCTL", "10.1.26"},
    {EL_DCS_IDMOFF, EL_DCS_IDMOFF, 0, 0, "IDMOFF", "10.1.27"},
    {EL_DCS_IDMON, EL_DCS_IDMON, 0, 0, "IDMON", "10.1.28"},
    {EL_DCS_COLMOD, EL_DCS_COLMOD, 1, 1, "COLMOD", "10.1.29"},
    {0xB1, 0xB1, 3, 3, "FRMCTR1", "10.2.1"},
    {0xB2, 0xB2, 3, 3, "FRMCTR2", "10.2.2"},
    {0xB3, 0xB3, 6, 6, "FRMCTR3", "10.2.3"},
    {0xB4, 0xB4, 1, 1, "INVCTR", "10.2.4"},
    {0xB6, 0xB6, 2, 2, "DISSET5", "10.2.5"},
    {0xC0, 0xC0, 3, 3, "PWCTR1", "10.2.6"},
    {0xC1, 0xC1, 1, 1, "PWCTR2", "10.2.7"},
    {0xC2, 0xC2, 2, 2, "PWCTR3", "10.2.8"},
    {0xC3, 0xC3, 2, 2, "PWCTR4", "10.2.9"},
    {0xC4, 0xC4, 2, 2, "PWCTR5", "10.2.10"},
    {0xC5, 0xC5, 1, 1, "VMCTR1", "10.2.11"},
    {0xC7, 0xC7, 1, 1, "VMOFCTR", "10.2.12"},
    {0xFC, 0xFC, 2, 2, "PWCTR6", "10.2.15"},
    {0xE0, 0xE0, 16, 16, "GMCTRP1", "10.2.19"},
    {0xE1, 0xE1, 16, 16, "GMCTRN1", "10.2.20"},
};

static void execute(el_lcd *lcd)
{
    (void)lcd;
}

/* Sections 10.1.2, 10.1.10 and 10.1.11: "it is necessary to wait 120msec before sending next command", longer than other
 * controllers of this family. */
static const el_dcs_chip TIMES = {
    .reset_settle_ns = 5 * EL_LCD_MS_NS, /* section 9.16 */
    .swreset_settle_ns = 120 * EL_LCD_MS_NS,
    .sleep_settle_ns = 120 * EL_LCD_MS_NS,
    .sleep_change_ns = 120 * EL_LCD_MS_NS,
    .execute = execute,
};

static const el_lcd_chip CHIP = {
    .family = &EL_DCS_FAMILY,
    .commands = COMMANDS,
    .command_count = sizeof COMMANDS / sizeof COMMANDS[0],
    .reset_pulse_ns = 10000, /* section 9.16, tRESW */
    .reset_ignored_ns = 5000,
    .reset_section = "9.16",
    .dcs = &TIMES,
};

const el_lcd_profile EL_LCD_ST7735 = {
    .panel = "st7735",
    .name = "ST7735",
    .chip = &CHIP,
    .columns = 128,
    .rows = 160,
    .memory_columns = 132,
    .memory_rows = 162,
    .first_column = 2,
    .first_row = 1,
    .mirrored = true,
    .flipped = true,
    .bgr_filter = true,
    .blank = 0xFFFF, /* normally white */
};
