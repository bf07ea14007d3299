/* The driver of colour displays that speak MIPI DCS over 4-wire SPI (a D/C line beside clock and data), RGB565.
 *
 * The controllers of this family differ in a few tables, which are their models: ili9341.h, st7789.h, st7735.h. What they
 * share is here: the walk through their memory (memory access control), windows, and bands that follow each other
 * without commands, sent by the bus while the next band is drawn.
 *
 * What the display shows already need not be sent again. Bands of which the renderer knows it (el_sink.unchanged) cost
 * nothing; with memory for hashes (el_tft_config.shown) of each other band only the smallest rectangle goes out that holds
 * what has changed in it. A display that was disturbed, by a spike on a wire say, is right again after a while all the
 * same: EL_TFT_REFRESH_LINES of each frame are sent in turn as if they had changed, and one of EL_TFT_STILL_FRAMES frames
 * of a picture that does not change at all is sent whole.
 *
 * Give `el_tft_sink` to the renderer. A frame may be smaller than the glass: it is the upper left part of it, and the rest
 * is made black before the first such frame. */
#ifndef EL_PANEL_TFT_H
#define EL_PANEL_TFT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/bus.h"
#include "base/sink.h"
#include "base/status.h"
#include "panel/panel.h"
#include "panel/shown.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct el_tft_command {
    uint8_t code;
    uint8_t count;
    uint8_t parameters[4];
} el_tft_command;

/* A controller, and the glass that modules with it usually have. Constant tables of the controllers' headers. */
typedef struct el_tft_model {
    const el_tft_command *start_up; /* what differs from the values after reset */
    uint8_t start_up_count;
    uint8_t access;                       /* memory access control of the upright module: EL_TFT_ACCESS_... */
    uint8_t inverted;                     /* 1: the glass needs display inversion for true colours (IPS glass) */
    uint8_t scrolls;                      /* 1: it has el_tft_scroll's commands */
    const el_tft_command *low_byte_first; /* makes the controller take that byte order; NULL: it cannot */
    uint16_t memory_columns;              /* the controller's memory, ... */
    uint16_t memory_rows;
    uint16_t first_column; /* ... and the part of it that is behind the glass */
    uint16_t first_row;
    uint16_t columns;
    uint16_t rows;
} el_tft_model;

/* Bits of memory access control, 36h; the same in all of these controllers. */
enum {
    EL_TFT_ACCESS_MY = 0x80,  /* rows from the last to the first */
    EL_TFT_ACCESS_MX = 0x40,  /* columns from the last to the first */
    EL_TFT_ACCESS_MV = 0x20,  /* a line of the picture is a column of the memory */
    EL_TFT_ACCESS_BGR = 0x08, /* the glass has blue where the controller expects red */
    EL_TFT_16_BIT = 0x55      /* pixel format, 3Ah: 16 bits per pixel on both interfaces */
};

enum {
    EL_TFT_REFRESH_LINES = 4, /* 1 to 2 s for 240 lines at 60 to 30 frames a second, for 1/60 of the wire */
    EL_TFT_STILL_FRAMES = 64
};

/* Memory for el_tft_config.shown: a frame of width x height pixels as the viewer sees it. */
#define EL_TFT_SHOWN_BYTES(width, height) EL_SHOWN_BYTES(width, height)

typedef struct el_tft_config {
    const el_bus *bus;         /* must stay; `pixels` or `bytes` may be NULL, not both */
    const el_tft_model *model; /* must stay */
    el_rotation rotation;
    uint8_t mirrored;  /* 1: left and right change places, as for a display that is seen in a mirror */
    uint8_t rgb_order; /* 1: red and blue change places: for glass whose order is not the model's */
    uint8_t inverted;  /* 1: inversion is the opposite of the model's: for glass that shows the model as a negative */
    /* EL_LOW_BYTE_FIRST only where the model says that the controller can. It saves the swap that a bus without 16-bit
     * words needs. */
    el_byte_order byte_order;
    /* What the display shows (shown.h), so that only what changes is sent; NULL: bands are sent whole. EL_TFT_SHOWN_BYTES
     * of the glass, the driver's as long as the sink is used. */
    uint32_t *shown;
    size_t shown_bytes;
} el_tft_config;

/* Owned by the caller; its members are the driver's. */
typedef struct el_tft {
    el_tft_config config;
    uint16_t width; /* of the frame */
    uint16_t height;
    uint16_t first_x; /* where the glass begins in the controller's addresses, as rotated */
    uint16_t first_y;
    uint16_t next_line; /* the line that the controller expects ... */
    uint16_t left;      /* ... in these columns of the frame */
    uint16_t right;
    uint16_t refresh;     /* the first of the lines that are sent in any case */
    uint32_t pixels_kept; /* of this frame, or of the last one: not sent, because the display shows them */
    el_orientation lie;
    uint8_t still; /* frames on end that were as the one before */
    bool stale;    /* the next frame is sent whole */
    bool whole;    /* so is this one */
    bool fits;     /* the frame has no more pixels than the glass */
    bool words;    /* pixels go as 16-bit words, not as bytes */
    bool swap;     /* ... after their bytes have changed places */
    uint8_t next_loan;
    struct el_tft_loan {
        el_band *band;
        unsigned slot;
    } loans[2]; /* the bands on their way; the renderer has two */
} el_tft;

/* Resets and initialises the controller; takes about 250 ms. `config` is copied.
 * EL_ERROR_ARGUMENT: no bus, no model, a bus that can send neither words nor bytes, a rotation or byte order that does
 * not exist, a byte order that the controller cannot take, or `shown` without EL_WITH_REUSE. EL_ERROR_MEMORY: `shown` is
 * too small. Then nothing was sent. */
el_status el_tft_init(el_tft *panel, const el_tft_config *config);

/* Says that the display may show anything: something else was sent to it, or it had no power. The next frame is sent
 * whole. So is the first one after el_tft_init. */
void el_tft_forget(el_tft *panel);

/* Scrolling by the controller: 10 bytes on the wire in place of a picture. Of lines [first, end) of the glass - of its
 * columns, where the module is on its side - each is seen `by` further up (to the left), and what leaves there comes in at
 * the other end, from now on; `by` 0 undoes it. Frames are drawn as ever, into the lines that they name: line y is what is
 * seen at first + (y - first - by) mod (end - first). So a text that scrolls, or a plot, draws what comes in alone, in a
 * ring of lines, and with el_tft_config.shown only that is sent.
 * EL_ERROR_ARGUMENT: the controller cannot (ST7735). EL_ERROR_SIZE: no lines, or more than the glass has, or by is not
 * below their number. Then nothing was sent. Not while the renderer is in a frame of this sink: it may tear. */
el_status el_tft_scroll(el_tft *panel, uint16_t first, uint16_t end, uint16_t by);

/* The glass as the viewer sees it, in pixels. */
uint16_t el_tft_width(const el_tft *panel);
uint16_t el_tft_height(const el_tft *panel);

/* The sink, which refers to `panel`. A frame that is larger than the glass is not shown.
 *
 * Where the bus has no 16-bit words and the controller wants the high byte first, the driver swaps the bytes of the
 * band in place; with el_tft_config.shown it moves the rectangle that it sends together. Then this must be the last of
 * the renderer's sinks, and the others must be done with a band's pixels when their `rows` returns, as the stream is. */
el_sink el_tft_sink(el_tft *panel);

#ifdef __cplusplus
}
#endif

#endif
