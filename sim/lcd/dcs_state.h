/* The model's registers, private to sim/lcd: dcs_lcd.c receives bytes into them, dcs_execute.c obeys, dcs_view.c makes
 * the picture. */
#ifndef EL_SIM_LCD_DCS_STATE_H
#define EL_SIM_LCD_DCS_STATE_H

#include "dcs_commands.h"
#include "dcs_lcd.h"

/* Section 8.2.29, p. 127. MH (04h) is the order of the refresh within a line, which no picture shows. */
enum {
    EL_MADCTL_MY = 0x80,
    EL_MADCTL_MX = 0x40,
    EL_MADCTL_MV = 0x20,
    EL_MADCTL_ML = 0x10,
    EL_MADCTL_BGR = 0x08,
};

/* Second parameter of DISCTRL, section 8.3.7, p. 164. */
enum {
    EL_DISCTRL_REV = 0x80, /* 1: normally white liquid crystal, which the modules have */
    EL_DISCTRL_GS = 0x40,  /* 1: gates from the last to the first */
    EL_DISCTRL_SS = 0x20,  /* 1: sources from the last to the first */
    EL_DISCTRL_SM = 0x10,  /* 1: interlaced gates */
};

/* A waiting time: `until_ns` is its end, `after` what began it. */
typedef struct el_lcd_wait {
    uint64_t until_ns;
    const char *after;
} el_lcd_wait;

typedef struct el_lcd_range {
    uint16_t start;
    uint16_t end; /* inclusive, as CASET and PASET have it */
} el_lcd_range;

struct el_lcd {
    el_lcd_profile profile;
    uint32_t *memory; /* 18 bits per pixel: red, green, blue, 6 each */

    /* Registers. */
    bool awake;
    bool on;
    bool inverted;
    bool idle;
    bool scrolling;
    bool wrap; /* WEMODE of IFCTL */
    uint8_t madctl;
    uint8_t disctrl;
    uint8_t pixel_bytes; /* 2 or 3, from COLMOD */
    el_lcd_range columns;
    el_lcd_range pages;
    uint16_t top_fixed; /* lines */
    uint16_t scroll_area;
    uint16_t scroll_start;

    /* The command that is being received. */
    const el_dcs_command *command; /* NULL before the first one and after an unknown one */
    bool excess_reported;          /* one error per command, however much data follows */
    uint8_t parameters[EL_DCS_MAX_PARAMETERS];
    uint8_t parameter_count;
    uint8_t pixel[3];
    uint8_t pixel_count; /* bytes of an unfinished pixel */

    /* The address counter, section 9.3. */
    bool writable; /* a RAMWR came since the window or MADCTL last changed, and the window was not reversed */
    bool full;     /* the window's last pixel was written, and WEMODE says to ignore the rest */
    uint16_t column;
    uint16_t page;
    uint64_t pixels;

    /* Reset and time. */
    bool reset_low;
    uint64_t reset_low_since_ns;
    uint64_t now_ns;
    el_lcd_wait any;       /* before any command */
    el_lcd_wait sleep_out; /* before SLPOUT */
    el_lcd_wait sleep_in;  /* before SLPIN, and before SWRESET */

    uint64_t bytes;
    uint64_t faults[EL_LCD_FAULTS];
    uint64_t errors;
    el_lcd_error kept[EL_LCD_ERRORS_KEPT];
};

/* dcs_lcd.c: counts an error at the byte that is being received, and keeps its text if it is one of the first. */
__attribute__((format(printf, 3, 4))) void el_lcd_report(el_lcd *lcd, el_lcd_fault fault, const char *format, ...);

/* dcs_execute.c. The registers after a hardware reset. */
void el_lcd_default_registers(el_lcd *lcd);
/* Starts the waiting times of a reset; before the registers change, because being awake prolongs them. */
void el_lcd_wait_after_reset(el_lcd *lcd, const char *what);
/* Obeys the command that is being received, all of its parameters being there. */
void el_lcd_execute(el_lcd *lcd);
/* Takes one byte of RAMWR or RAMWRC. */
void el_lcd_pixel_byte(el_lcd *lcd, uint8_t byte);

#endif
