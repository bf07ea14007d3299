/* The driver of OLEDs whose controllers keep several pixels in a byte, over 4-wire SPI (a D/C line beside clock and data).
 *
 * Each band is dithered straight into the controller's format, in memory of the driver's own, and given back before
 * `rows` returns; the bus sends one half of that memory while the other is filled. There is no framebuffer: lines that
 * share their bytes with lines of the next band (a page of 8 lines, a column of pixel pairs) stay until those are there.
 * So bands may have any height, but must follow each other from the top to the bottom, as the renderer's do.
 *
 * Rotation and mirroring are done by the place that each pixel gets in memory and by the order of lines, not by the
 * controller's remapping: that depends on the module's wiring, and emulators leave it out.
 *
 * Lines of which the renderer knows that they are unchanged (el_sink.unchanged) are not dithered and not sent, where they
 * are whole units; one of EL_OLED_WHOLE_FRAMES frames is sent whole all the same, so that a display that was disturbed is
 * right again. There are no hashes as colour panels have them: a frame has at most 4 KB, and the dithering costs more.
 *
 * The controllers are models: ssd1306.h, ssd0323.h. A frame may be smaller than the glass: it is the upper left part of
 * it, and the rest is made black before the first such frame. */
#ifndef EL_PANEL_OLED_H
#define EL_PANEL_OLED_H

#include <stddef.h>
#include <stdint.h>

#include "base/bus.h"
#include "base/sink.h"
#include "base/status.h"
#include "panel/panel.h"

#ifdef __cplusplus
extern "C" {
#endif

/* These controllers take parameters as they take commands, with D/C low. */
typedef struct el_oled_command {
    uint8_t code;
    uint8_t count;
    uint8_t parameters[8];
} el_oled_command;

/* A controller and its glass. Constant tables of the controllers' headers. */
typedef struct el_oled_model {
    const el_oled_command *start_up; /* what differs from the values after reset */
    uint8_t start_up_count;
    el_oled_command along_rows;    /* after a byte the next column follows, then the next row */
    el_oled_command along_columns; /* after a byte the next row (of bytes) follows, then the next column */
    uint8_t show_positive;         /* command: as the memory has it */
    uint8_t show_negative;         /* command: inverted */
    uint8_t display_on;            /* command */
    uint8_t column_range;          /* command with two parameters, the first and the last column of bytes */
    uint8_t row_range;             /* the same for rows of bytes */
    uint8_t start_line;            /* command to which the first row that is seen is added; 0: its memory is no ring */
    uint8_t columns;               /* pixels of the glass, upright; the direction that bytes pack: whole bytes */
    uint8_t rows;
    uint8_t packed_log2;   /* pixels of a byte: 3 for 8 of 1 bit, 1 for 2 of 4 bits */
    uint8_t packs_columns; /* 1: a byte holds pixels of a column, 0: of a row */
    uint8_t first_is_high; /* 1: the upper or left pixel of a byte is in its upper bits */
    uint8_t reset_wait_ms; /* after reset, before the first command */
} el_oled_model;

typedef struct el_oled_config {
    const el_bus *bus; /* must stay; sends bytes */
    el_rotation rotation;
    uint8_t mirrored; /* 1: left and right change places, as for a display that is seen in a mirror */
    uint8_t inverted; /* 1: black is light: the controller inverts, the whole glass */
    uint8_t *memory;  /* the driver's, must stay; the controllers' headers tell how much */
    size_t memory_bytes;
} el_oled_config;

enum { EL_OLED_WHOLE_FRAMES = 32 };

/* Owned by the caller; its members are the driver's.
 *
 * A unit is what the fewest whole lines fill: 1 line, or the lines that share bytes. */
typedef struct el_oled {
    el_oled_config config;
    const el_oled_model *model;
    el_orientation lie;
    uint16_t width; /* of the frame */
    uint16_t height;
    bool fits;                /* the frame has pixels, and no more than the glass */
    uint8_t lines_log2;       /* of a unit */
    uint8_t unit_bytes;       /* in this frame */
    uint8_t first_byte;       /* the place of a unit's first byte on the glass, along the unit */
    uint8_t unit;             /* the first of this buffer, counted in the frame */
    uint8_t units;            /* in this buffer, finished */
    uint8_t capacity;         /* units that a buffer takes */
    uint8_t filling;          /* the buffer that is being filled: 0 or 1; it is not on the wire */
    uint8_t turn;             /* frames since the last one that was sent whole */
    bool whole;               /* this frame is sent whole */
    bool moved;               /* units were left out: the controller expects others than the next */
    bool begun;               /* the unit after the finished ones has a line */
    volatile bool sending[2]; /* on the wire; cleared by the bus, perhaps in an interrupt */
} el_oled;

/* Used by the controllers' init functions, which say what it does. */
el_status el_oled_init(el_oled *panel, const el_oled_model *model, const el_oled_config *config);

/* Scrolling by the controller, one byte on the wire: each line of the glass - each column, where the module is on its side -
 * is seen `by` further up (to the left), and what leaves there comes in at the other end, from now on; `by` 0 undoes it.
 * Frames are drawn as ever, into the lines that they name.
 * EL_ERROR_ARGUMENT: the controller cannot: the SSD0323 has 16 rows more than its glass, which nobody draws. EL_ERROR_SIZE:
 * `by` is not below the number of lines. Then nothing was sent. */
el_status el_oled_scroll(el_oled *panel, uint8_t by);

/* The glass as the viewer sees it, in pixels. */
uint16_t el_oled_width(const el_oled *panel);
uint16_t el_oled_height(const el_oled *panel);

/* The sink, which refers to `panel`. A frame that is larger than the glass is not shown. */
el_sink el_oled_sink(el_oled *panel);

#ifdef __cplusplus
}
#endif

#endif
