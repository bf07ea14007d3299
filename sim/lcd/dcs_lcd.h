/* A model of an LCD controller with MIPI DCS commands, in the first place the ILI9341: bytes in, picture out.
 *
 * It was written from the data sheet alone (ILITEK ILI9341 V1.11; "section" below means there) and shares nothing with
 * the panel drivers that it judges. It takes what the 4-wire serial interface carries (bytes, each with the level of
 * D/C), the level of the reset line, and time, because reset and sleep have waiting times. What the data sheet forbids
 * is counted as an error and put into words; the model then goes on as the chip most likely would.
 *
 * Coordinates. The glass is what a viewer sees in the module's upright position: column 0 left, row 0 at the top,
 * `columns` x `rows`, whatever MADCTL says. On the usual ILI9341 modules the chip's source 1, which shows memory
 * column 0, drives the viewer's rightmost column, and the colour filter is BGR; that is why drivers write MADCTL 48h
 * (MX, BGR) for the upright picture and 28h, 88h, E8h for each further quarter turn clockwise (Adafruit_ILI9341,
 * setRotation; the same four in Linux's fbtft). A driver that writes anything else gets what it would get in life: a
 * mirrored picture, or blue for red. */
#ifndef EL_SIM_LCD_DCS_LCD_H
#define EL_SIM_LCD_DCS_LCD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    EL_LCD_MAX_SIDE = 2040,
    EL_LCD_ERRORS_KEPT = 16,
    EL_LCD_ERROR_TEXT = 192,
};

/* What a chip and its module are. */
typedef struct el_lcd_profile {
    const char *name;
    uint16_t columns;  /* of the glass and of its memory, 1..EL_LCD_MAX_SIDE */
    uint16_t rows;     /* the same */
    uint8_t all_lines; /* NL of DISCTRL that drives all rows (section 8.3.7); 0 where the model does not check it */
    bool mirrored;     /* memory column 0 is the viewer's rightmost */
    bool bgr_filter;   /* red shows as red with MADCTL's BGR bit set */
} el_lcd_profile;

/* An ILI9341 on the usual module, 240 x 320. */
extern const el_lcd_profile EL_LCD_ILI9341;

/* A controller that does not exist, for glass of any size: the same command set and the same module wiring. */
el_lcd_profile el_lcd_dcs(uint16_t columns, uint16_t rows);

typedef enum el_lcd_fault {
    EL_LCD_NO_COMMAND,  /* data before the first command */
    EL_LCD_TOO_MANY,    /* more data than the command takes; pixels without RAMWR end here too */
    EL_LCD_TOO_FEW,     /* the next command came before the last one had its parameters */
    EL_LCD_UNKNOWN,     /* not in the model's table */
    EL_LCD_BAD_WINDOW,  /* RAMWR with a window that is reversed or leaves the memory */
    EL_LCD_BAD_VALUE,   /* a parameter that the chip does not have, or the model does not */
    EL_LCD_HALF_PIXEL,  /* a command between the bytes of a pixel */
    EL_LCD_NO_RAMWR,    /* RAMWRC without a RAMWR that it could continue */
    EL_LCD_TOO_SOON,    /* a command within a waiting time */
    EL_LCD_SHORT_RESET, /* reset pulse below 10 us */
    EL_LCD_IN_RESET,    /* bytes while the reset line is low */
    EL_LCD_FAULTS
} el_lcd_fault;

typedef struct el_lcd_error {
    el_lcd_fault fault;
    uint64_t byte;                /* bytes that the chip got before the one that is wrong */
    char text[EL_LCD_ERROR_TEXT]; /* one line without a line feed: what and where */
} el_lcd_error;

typedef struct el_lcd el_lcd;

/* A chip that has had power for a while: registers at their defaults, asleep, display off, the memory full of noise
 * that is the same each time. NULL when a side is out of range or memory is short. The caller destroys it; the profile
 * is copied, except for its name. */
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

/* What the glass shows, columns * rows pixels row by row, native-endian RGB565: white while asleep or off. */
void el_lcd_glass(const el_lcd *lcd, uint16_t *rgb565);

/* The same with the module turned by `degrees` (0, 90, 180, 270) clockwise, as a product's case holds it; rows *
 * columns pixels at 90 and 270. Upright is 0 for MADCTL 48h, 270 for 28h, 180 for 88h, 90 for E8h. Returns 0, or -1
 * at any other angle. */
int el_lcd_look(const el_lcd *lcd, unsigned degrees, uint16_t *rgb565);

/* The 18 bits of memory column and row (not of the glass), red in bits 17..12 as if sent with an RGB filter. */
uint32_t el_lcd_memory(const el_lcd *lcd, unsigned column, unsigned row);

/* Pixels that reached the memory. */
uint64_t el_lcd_pixels(const el_lcd *lcd);

uint64_t el_lcd_fault_count(const el_lcd *lcd, el_lcd_fault fault);
uint64_t el_lcd_error_count(const el_lcd *lcd);
/* Error `index` of the first EL_LCD_ERRORS_KEPT; NULL when there are not so many. It stays the model's. */
const el_lcd_error *el_lcd_error_at(const el_lcd *lcd, size_t index);

#endif
