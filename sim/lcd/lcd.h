/* Models of display controllers: bytes in, picture out.
 *
 * Each was written from the chip's data sheet and its module's wiring alone, and shares nothing with the panel drivers
 * that it judges. A model takes what the 4-wire serial interface carries (bytes, each with the level of D/C), the level
 * of the reset line, and time, because reset and sleep have waiting times. What the data sheet forbids is counted as an
 * error and put into words; the model then goes on as the chip most likely would.
 *
 * Coordinates. The glass is what a viewer sees in the module's upright position, its flat cable at the bottom: column 0
 * left, row 0 at the top, `columns` x `rows`, whatever the registers say. How a module wires the chip to its glass is
 * written beside each profile (the files that are named after the chips), with the register values that make the
 * picture upright. A driver that writes anything else gets what it would get in life: a mirrored picture, or blue for
 * red. */
#ifndef EL_SIM_LCD_LCD_H
#define EL_SIM_LCD_LCD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    EL_LCD_MAX_SIDE = 2040,
    EL_LCD_ERRORS_KEPT = 16,
    EL_LCD_ERROR_TEXT = 192,
};

/* A chip's command set and waiting times; private to this folder. */
typedef struct el_lcd_chip el_lcd_chip;

/* A chip and the module that it sits in. */
typedef struct el_lcd_profile {
    const char *panel; /* as command lines name it */
    const char *name;  /* as errors name it */
    const el_lcd_chip *chip;
    uint16_t columns; /* of the glass, 1..EL_LCD_MAX_SIDE */
    uint16_t rows;
    uint16_t memory_columns; /* of the chip's memory, in pixels, at least those of the glass */
    uint16_t memory_rows;
    uint16_t first_column; /* the memory's part that the glass shows */
    uint16_t first_row;
    bool mirrored;   /* the first of these columns is the viewer's rightmost */
    bool flipped;    /* the first of these rows is the viewer's lowest */
    bool bgr_filter; /* red shows as red with MADCTL's BGR bit set */
    bool inverting;  /* colours are right with inversion on (IPS glass) */
    uint16_t blank;  /* what the glass shows while the chip drives nothing, RGB565 */
} el_lcd_profile;

extern const el_lcd_profile EL_LCD_ILI9341;        /* 240 x 320 */
extern const el_lcd_profile EL_LCD_ST7789;         /* 240 x 320 */
extern const el_lcd_profile EL_LCD_ST7789_240X240; /* the same chip behind square glass */
extern const el_lcd_profile EL_LCD_ST7735;         /* 128 x 160 of a memory of 132 x 162 */
extern const el_lcd_profile EL_LCD_SSD1306;        /* 128 x 64, black and white */
extern const el_lcd_profile EL_LCD_SSD0323;        /* 128 x 64, 16 greys */

/* A controller that does not exist, for glass of any size: the ILI9341's commands and module wiring. */
el_lcd_profile el_lcd_dcs(uint16_t columns, uint16_t rows);

/* The profiles above, in their order; NULL after the last one. */
const el_lcd_profile *el_lcd_profile_at(size_t index);
/* The one whose `panel` is this name, or NULL. */
const el_lcd_profile *el_lcd_profile_find(const char *panel);

typedef enum el_lcd_fault {
    EL_LCD_NO_COMMAND,  /* data before the first command */
    EL_LCD_TOO_MANY,    /* more data than the command takes; pixels without RAMWR end here too */
    EL_LCD_TOO_FEW,     /* something else came before the last command had its parameters */
    EL_LCD_UNKNOWN,     /* not in the model's table */
    EL_LCD_BAD_WINDOW,  /* a window that is reversed or leaves the memory */
    EL_LCD_BAD_VALUE,   /* a parameter that the chip does not have, or the module, or the model */
    EL_LCD_HALF_PIXEL,  /* a command between the bytes of a pixel */
    EL_LCD_NO_RAMWR,    /* RAMWRC without a RAMWR that it could continue */
    EL_LCD_TOO_SOON,    /* a command within a waiting time */
    EL_LCD_SHORT_RESET, /* a reset pulse that is too short */
    EL_LCD_IN_RESET,    /* bytes while the reset line is low */
    EL_LCD_WRONG_MODE,  /* a command that the chip takes in another mode only */
    EL_LCD_FAULTS
} el_lcd_fault;

typedef struct el_lcd_error {
    el_lcd_fault fault;
    uint64_t byte;                /* bytes that the chip got before the one that is wrong */
    char text[EL_LCD_ERROR_TEXT]; /* one line without a line feed: what and where */
} el_lcd_error;

typedef struct el_lcd el_lcd;

/* A chip that has had power for a while: registers at their defaults, display off, the memory full of noise that is the
 * same each time. NULL when a side is out of range or memory is short. The caller destroys it; the profile is copied,
 * except for its names. */
el_lcd *el_lcd_create(const el_lcd_profile *profile);
void el_lcd_destroy(el_lcd *lcd);

/* The reset line's level; it is high at first. */
void el_lcd_reset(el_lcd *lcd, int level);

/* One byte; `dc` 0 is a command, anything else data. */
void el_lcd_write(el_lcd *lcd, int dc, uint8_t byte);

/* Lets time pass. */
void el_lcd_advance_ns(el_lcd *lcd, uint64_t ns);

/* Says that no more bytes come: half a pixel or missing parameters are errors now. */
void el_lcd_finish(el_lcd *lcd);

/* What the glass shows, columns * rows pixels row by row, native-endian RGB565; profile.blank while the chip sleeps or
 * its display is off. A grey of 4 bits has them as the upper bits of each channel, repeated below. */
void el_lcd_glass(const el_lcd *lcd, uint16_t *rgb565);

/* The same with the module turned by `degrees` (0, 90, 180, 270) clockwise, as a product's case holds it; rows *
 * columns pixels at 90 and 270. Returns 0, or -1 at any other angle. */
int el_lcd_look(const el_lcd *lcd, unsigned degrees, uint16_t *rgb565);

/* The contents of memory column and row (not of the glass): 18 bits, red in bits 17..12 as if sent with an RGB filter;
 * 1 or 4 bits where the chip has no more. */
uint32_t el_lcd_memory(const el_lcd *lcd, unsigned column, unsigned row);

/* Pixels that reached the memory. */
uint64_t el_lcd_pixels(const el_lcd *lcd);

uint64_t el_lcd_fault_count(const el_lcd *lcd, el_lcd_fault fault);
uint64_t el_lcd_error_count(const el_lcd *lcd);
/* Error `index` of the first EL_LCD_ERRORS_KEPT; NULL when there are not so many. It stays the model's. */
const el_lcd_error *el_lcd_error_at(const el_lcd *lcd, size_t index);

#endif
