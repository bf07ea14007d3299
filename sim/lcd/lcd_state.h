/* What the models have in common, private to sim/lcd: lcd.c receives bytes by a chip's command table and keeps time and
 * errors; a family of chips obeys the commands and makes the picture. */
#ifndef EL_SIM_LCD_LCD_STATE_H
#define EL_SIM_LCD_LCD_STATE_H

#include "dcs_state.h"
#include "lcd.h"
#include "ssd0323_state.h"
#include "ssd1306_state.h"

#define EL_LCD_MS_NS UINT64_C(1000000)

enum { EL_LCD_MAX_PARAMETERS = 16 };

/* Most entries stand for one code, some for a range whose low bits are the value. */
typedef struct el_lcd_command {
    uint8_t code;
    uint8_t last; /* code of the range's end, the same as `code` for one */
    uint8_t min_parameters;
    uint8_t max_parameters;
    const char *name;    /* as the data sheet has it */
    const char *section; /* of the data sheet that the table's file names */
} el_lcd_command;

/* Chips that obey the same way. */
typedef struct el_lcd_family {
    /* Parameters come with D/C low, as commands do, and all data goes to the memory (Solomon Systech). Where it is
     * false, parameters are data, and pixels need a command first (MIPI DCS). */
    bool parameters_are_commands;
    uint8_t memory_bits; /* per pixel */
    /* Starts the waiting times of a hardware reset, and sets the registers. */
    void (*reset)(el_lcd *lcd);
    /* Looks at a command's waiting times and mode when its byte comes. May be NULL. */
    void (*check)(el_lcd *lcd);
    /* Obeys lcd->command, `code` of which is in lcd->code, all of its parameters being there. */
    void (*execute)(el_lcd *lcd);
    /* Whether the data that follows this command is pixels. NULL where parameters_are_commands. */
    bool (*takes_pixels)(const el_lcd_command *command);
    /* Takes a byte of pixels. */
    void (*pixel_byte)(el_lcd *lcd, uint8_t byte);
    /* The command that was received has ended. May be NULL. */
    void (*close)(el_lcd *lcd);
    bool (*is_lit)(const el_lcd *lcd);
    /* RGB565 at this place of the upright glass while is_lit. */
    uint16_t (*glass_pixel)(const el_lcd *lcd, unsigned x, unsigned y);
} el_lcd_family;

struct el_lcd_chip {
    const el_lcd_family *family;
    const el_lcd_command *commands;
    size_t command_count;
    uint64_t reset_pulse_ns;   /* shortest that the data sheet allows */
    uint64_t reset_ignored_ns; /* a shorter one has no effect */
    const char *reset_section;
    const el_dcs_chip *dcs; /* what DCS controllers differ in; NULL in other families */
};

/* A waiting time: `until_ns` is its end, `after` what began it. */
typedef struct el_lcd_wait {
    uint64_t until_ns;
    const char *after;
} el_lcd_wait;

struct el_lcd {
    el_lcd_profile profile;
    uint32_t *memory; /* memory_columns * memory_rows */
    uint64_t pixels;

    union {
        el_dcs dcs;
        el_lcd_ssd1306 ssd1306;
        el_lcd_ssd0323 ssd0323;
    } chip;

    /* The command that is being received. */
    const el_lcd_command *command; /* NULL before the first one and after an unknown one */
    uint8_t code;
    bool excess_reported; /* one error per command, however much data follows */
    uint8_t parameters[EL_LCD_MAX_PARAMETERS];
    uint8_t parameter_count;

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

/* Counts an error at the byte that is being received, and keeps its text if it is one of the first. */
__attribute__((format(printf, 3, 4))) void el_lcd_report(el_lcd *lcd, el_lcd_fault fault, const char *format, ...);
/* The same for a fault of the command that is being received, which the text need not name. */
void el_lcd_report_command(el_lcd *lcd, el_lcd_fault fault, const char *what);

/* The data sheet's section about another command of this chip's table. */
const char *el_lcd_section(const el_lcd *lcd, uint8_t code);

el_lcd_wait el_lcd_wait_from_now(const el_lcd *lcd, uint64_t ns, const char *after);
/* Reports the command that is being received if it comes before the end of `wait`. */
void el_lcd_check_wait(el_lcd *lcd, const el_lcd_wait *wait);

uint32_t *el_lcd_cell(el_lcd *lcd, unsigned column, unsigned row);

#endif
