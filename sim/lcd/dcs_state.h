/* The registers of controllers with MIPI DCS commands (ILI9341, ST7789, ST7735), private to sim/lcd: dcs_execute.c obeys,
 * dcs_view.c makes the picture, and the file named after each chip has what is its own. */
#ifndef EL_SIM_LCD_DCS_STATE_H
#define EL_SIM_LCD_DCS_STATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lcd.h"

/* Commands that mean the same in all of these chips. Sections of each are in the chips' tables. */
enum {
    EL_DCS_NOP = 0x00,
    EL_DCS_SWRESET = 0x01,
    EL_DCS_SLPIN = 0x10,
    EL_DCS_SLPOUT = 0x11,
    EL_DCS_NORON = 0x13,
    EL_DCS_INVOFF = 0x20,
    EL_DCS_INVON = 0x21,
    EL_DCS_GAMSET = 0x26,
    EL_DCS_DISPOFF = 0x28,
    EL_DCS_DISPON = 0x29,
    EL_DCS_CASET = 0x2A,
    EL_DCS_PASET = 0x2B,
    EL_DCS_RAMWR = 0x2C,
    EL_DCS_VSCRDEF = 0x33,
    EL_DCS_TEOFF = 0x34,
    EL_DCS_TEON = 0x35,
    EL_DCS_MADCTL = 0x36,
    EL_DCS_VSCRSADD = 0x37,
    EL_DCS_IDMOFF = 0x38,
    EL_DCS_IDMON = 0x39,
    EL_DCS_COLMOD = 0x3A,
    EL_DCS_RAMWRC = 0x3C,
    EL_DCS_WRDISBV = 0x51,
    EL_DCS_WRCTRLD = 0x53,
};

/* MADCTL: ILI9341 section 8.2.29 (p. 127), ST7789V 9.1.28, ST7735 10.1.26. MH (04h) is the order of the refresh within
 * a line, which no picture shows. */
enum {
    EL_MADCTL_MY = 0x80,
    EL_MADCTL_MX = 0x40,
    EL_MADCTL_MV = 0x20,
    EL_MADCTL_ML = 0x10,
    EL_MADCTL_BGR = 0x08,
};

/* What these chips differ in. */
typedef struct el_dcs_chip {
    uint64_t reset_settle_ns;     /* after a hardware reset, before the next command */
    uint64_t swreset_settle_ns;   /* after SWRESET, the same */
    uint64_t sleep_settle_ns;     /* after SLPIN and SLPOUT, the same */
    uint64_t sleep_change_ns;     /* before the next change between sleep and awake */
    void (*execute)(el_lcd *lcd); /* obeys the commands that only this chip has */
} el_dcs_chip;

typedef struct el_lcd_range {
    uint16_t start;
    uint16_t end; /* inclusive, as CASET and PASET have it */
} el_lcd_range;

typedef struct el_dcs {
    bool awake;
    bool on;
    bool inverted;
    bool idle;
    bool scrolling;
    bool wrap; /* at the window's end the address goes back to its start */
    bool gates_reversed;
    bool sources_reversed;
    bool values_reversed; /* the opposite of ILI9341's REV, which is set by default */
    bool low_byte_first;  /* of a 16-bit pixel */
    uint8_t madctl;
    uint8_t pixel_bytes; /* 2 or 3, from COLMOD */
    el_lcd_range columns;
    el_lcd_range pages;
    uint16_t top_fixed; /* lines */
    uint16_t scroll_area;
    uint16_t scroll_start;

    uint8_t pixel[3];
    uint8_t pixel_count; /* bytes of an unfinished pixel */

    /* The address counter; ILI9341 section 9.3. */
    bool writable; /* a RAMWR came since the window or MADCTL last changed, and the window was not reversed */
    bool full;     /* the window's last pixel was written, and nothing wraps */
    uint16_t column;
    uint16_t page;
} el_dcs;

struct el_lcd_family;
extern const struct el_lcd_family EL_DCS_FAMILY;

/* dcs_view.c, for the family. */
bool el_dcs_is_lit(const el_lcd *lcd);
uint16_t el_dcs_glass_pixel(const el_lcd *lcd, unsigned x, unsigned y);

#endif
