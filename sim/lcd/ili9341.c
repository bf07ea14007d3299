/* The ILI9341 on the usual module.
 *
 * Source: ILITEK, "ILI9341 a-Si TFT LCD Single Chip Driver 240RGBx320 Resolution and 262K color", V1.11; the page is in
 * the comment of each line of the table. Commands without a case here or in dcs_execute.c (voltages, gamma, timing) do
 * not change which pixel is where: the model checks their parameter counts only.
 *
 * The module: the chip's source 1, which shows memory column 0, drives the viewer's rightmost column, and the colour
 * filter is BGR; that is why drivers write MADCTL 48h (MX, BGR) for the upright picture and 28h, 88h, E8h for each
 * further quarter turn clockwise of the picture (Adafruit_ILI9341, setRotation; the same four in Linux's fbtft). */
#include "lcd_state.h"

enum { DISCTRL = 0xB6, IFCTL = 0xF6 };

static const el_lcd_command COMMANDS[] = {
    {EL_DCS_NOP, EL_DCS_NOP, 0, 0, "NOP", "8.2.1"},                 /* p. 89 */
    {EL_DCS_SWRESET, EL_DCS_SWRESET, 0, 0, "SWRESET", "8.2.2"},     /* p. 90 */
    {EL_DCS_SLPIN, EL_DCS_SLPIN, 0, 0, "SLPIN", "8.2.11"},          /* p. 100 */
    {EL_DCS_SLPOUT, EL_DCS_SLPOUT, 0, 0, "SLPOUT", "8.2.12"},       /* p. 101 */
    {EL_DCS_NORON, EL_DCS_NORON, 0, 0, "NORON", "8.2.14"},          /* p. 104 */
    {EL_DCS_INVOFF, EL_DCS_INVOFF, 0, 0, "INVOFF", "8.2.15"},       /* p. 105 */
    {EL_DCS_INVON, EL_DCS_INVON, 0, 0, "INVON", "8.2.16"},          /* p. 106 */
    {EL_DCS_GAMSET, EL_DCS_GAMSET, 1, 1, "GAMSET", "8.2.17"},       /* p. 107 */
    {EL_DCS_DISPOFF, EL_DCS_DISPOFF, 0, 0, "DISPOFF", "8.2.18"},    /* p. 108 */
    {EL_DCS_DISPON, EL_DCS_DISPON, 0, 0, "DISPON", "8.2.19"},       /* p. 109 */
    {EL_DCS_CASET, EL_DCS_CASET, 4, 4, "CASET", "8.2.20"},          /* p. 110 */
    {EL_DCS_PASET, EL_DCS_PASET, 4, 4, "PASET", "8.2.21"},          /* p. 112 */
    {EL_DCS_RAMWR, EL_DCS_RAMWR, 0, 0, "RAMWR", "8.2.22"},          /* p. 114 */
    {EL_DCS_VSCRDEF, EL_DCS_VSCRDEF, 6, 6, "VSCRDEF", "8.2.26"},    /* p. 120 */
    {EL_DCS_TEOFF, EL_DCS_TEOFF, 0, 0, "TEOFF", "8.2.27"},          /* p. 124 */
    {EL_DCS_TEON, EL_DCS_TEON, 1, 1, "TEON", "8.2.28"},             /* p. 125 */
    {EL_DCS_MADCTL, EL_DCS_MADCTL, 1, 1, "MADCTL", "8.2.29"},       /* p. 127 */
    {EL_DCS_VSCRSADD, EL_DCS_VSCRSADD, 2, 2, "VSCRSADD", "8.2.30"}, /* p. 129 */
    {EL_DCS_IDMOFF, EL_DCS_IDMOFF, 0, 0, "IDMOFF", "8.2.31"},       /* p. 131 */
    {EL_DCS_IDMON, EL_DCS_IDMON, 0, 0, "IDMON", "8.2.32"},          /* p. 132 */
    {EL_DCS_COLMOD, EL_DCS_COLMOD, 1, 1, "COLMOD", "8.2.33"},       /* p. 134 */
    {EL_DCS_RAMWRC, EL_DCS_RAMWRC, 0, 0, "RAMWRC", "8.2.34"},       /* p. 135 */
    {EL_DCS_WRDISBV, EL_DCS_WRDISBV, 1, 1, "WRDISBV", "8.2.38"},    /* p. 141 */
    {EL_DCS_WRCTRLD, EL_DCS_WRCTRLD, 1, 1, "WRCTRLD", "8.2.40"},    /* p. 143 */
    {0xB1, 0xB1, 2, 2, "FRMCTR1", "8.3.2"},                         /* p. 155 */
    {0xB4, 0xB4, 1, 1, "INVTR", "8.3.5"},                           /* p. 161 */
    {DISCTRL, DISCTRL, 3, 4, "DISCTRL", "8.3.7"},                   /* p. 164; the fourth, PCDIV, divides an
                                                                              external clock, and drivers leave it out */
    {0xB7, 0xB7, 1, 1, "ETMOD", "8.3.8"},                           /* p. 168 */
    {0xC0, 0xC0, 1, 1, "PWCTRL1", "8.3.16"},                        /* p. 178 */
    {0xC1, 0xC1, 1, 1, "PWCTRL2", "8.3.17"},                        /* p. 179 */
    {0xC5, 0xC5, 2, 2, "VMCTRL1", "8.3.18"},                        /* p. 180 */
    {0xC7, 0xC7, 1, 1, "VMCTRL2", "8.3.19"},                        /* p. 182 */
    {0xCB, 0xCB, 5, 5, "Power control A", "8.4.1"},                 /* p. 195 */
    {0xCF, 0xCF, 3, 3, "Power control B", "8.4.2"},                 /* p. 196 */
    {0xE0, 0xE0, 15, 15, "PGAMCTRL", "8.3.24"},                     /* p. 188 */
    {0xE1, 0xE1, 15, 15, "NGAMCTRL", "8.3.25"},                     /* p. 189 */
    {0xE8, 0xE8, 3, 3, "Driver timing control A", "8.4.3"},         /* p. 197 */
    {0xEA, 0xEA, 2, 2, "Driver timing control B", "8.4.5"},         /* p. 199 */
    {0xED, 0xED, 4, 4, "Power on sequence control", "8.4.6"},       /* p. 200 */
    {0xF2, 0xF2, 1, 1, "Enable 3G", "8.4.7"},                       /* p. 201 */
    {IFCTL, IFCTL, 3, 3, "IFCTL", "8.3.28"},                        /* p. 192 */
    {0xF7, 0xF7, 1, 1, "Pump ratio control", "8.4.8"},              /* p. 202 */
};

/* Second parameter of DISCTRL, section 8.3.7, p. 164. */
enum {
    DISCTRL_REV = 0x80, /* 1: normally white liquid crystal, which the modules have */
    DISCTRL_GS = 0x40,  /* 1: gates from the last to the first */
    DISCTRL_SS = 0x20,  /* 1: sources from the last to the first */
    DISCTRL_SM = 0x10,  /* 1: interlaced gates */
};

static void set_display_function(el_lcd *lcd)
{
    enum { ALL_LINES = 0x27 }; /* NL, third parameter: 8 * (27h + 1) = 320 */
    const uint8_t value = lcd->parameters[1];
    lcd->chip.dcs.values_reversed = (value & DISCTRL_REV) == 0;
    lcd->chip.dcs.gates_reversed = (value & DISCTRL_GS) != 0;
    lcd->chip.dcs.sources_reversed = (value & DISCTRL_SS) != 0;
    if ((value & DISCTRL_SM) != 0) {
        el_lcd_report_command(lcd, EL_LCD_BAD_VALUE, "interlaced gates (SM) are not in this model");
    }
    if (lcd->parameters[2] != ALL_LINES && lcd->profile.rows == EL_LCD_ILI9341.rows) {
        el_lcd_report_command(lcd, EL_LCD_BAD_VALUE, "NL does not drive all lines of the glass");
    }
}

/* Exclusive-or bits on MADCTL, other expansions to 18 bits, little-endian, the RGB interface: no driver for a serial
 * display uses them, so they are more likely a mistake. */
static void set_interface(el_lcd *lcd)
{
    if ((lcd->parameters[0] & 0xFE) != 0 || lcd->parameters[1] != 0 || lcd->parameters[2] != 0) {
        el_lcd_report_command(lcd, EL_LCD_BAD_VALUE, "only WEMODE is in this model, all other bits must be 0");
    }
    lcd->chip.dcs.wrap = (lcd->parameters[0] & 0x01) != 0;
}

static void execute(el_lcd *lcd)
{
    if (lcd->code == DISCTRL) {
        set_display_function(lcd);
    } else if (lcd->code == IFCTL) {
        set_interface(lcd);
    }
}

/* Sections 8.2.2, 8.2.11, 8.2.12 and 15.4. */
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
    .reset_pulse_ns = 10000,  /* section 15.4, tRW */
    .reset_ignored_ns = 5000, /* section 15.4, note 2: shorter pulses are rejected */
    .reset_section = "15.4",
    .dcs = &TIMES,
};

const el_lcd_profile EL_LCD_ILI9341 = {
    .panel = "ili9341",
    .name = "ILI9341",
    .chip = &CHIP,
    .columns = 240,
    .rows = 320,
    .memory_columns = 240,
    .memory_rows = 320,
    .mirrored = true,
    .bgr_filter = true,
    .blank = 0xFFFF, /* normally white: without a voltage the backlight shines through */
};

el_lcd_profile el_lcd_dcs(uint16_t columns, uint16_t rows)
{
    el_lcd_profile profile = EL_LCD_ILI9341;
    profile.panel = profile.name = "dcs";
    profile.columns = profile.memory_columns = columns;
    profile.rows = profile.memory_rows = rows;
    return profile;
}
