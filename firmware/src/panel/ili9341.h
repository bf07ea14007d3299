/* ILI9341: 240x320 TFT controller (ILI Technology, data sheet V1.11), 4-wire SPI, RGB565.
 *
 * A sink: give `el_ili9341_sink` to the renderer. Each frame sets the window once; bands follow each other in the
 * controller's memory without further commands, sent by the bus while the next band is drawn. A window smaller than the
 * glass is the upper left part of it. */
#ifndef EL_PANEL_ILI9341_H
#define EL_PANEL_ILI9341_H

#include <stdint.h>

#include "base/bus.h"
#include "base/sink.h"
#include "panel/panel.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_ILI9341_COLUMNS = 240, EL_ILI9341_ROWS = 320 };

typedef struct el_ili9341_config {
    const el_bus *bus;
    el_rotation rotation;
    uint8_t rgb_order; /* 0: blue-green-red glass, as nearly all modules have; 1: red-green-blue */
    uint8_t inverted;  /* 1: the module shows inverted colours (IPS glass) */
} el_ili9341_config;

/* Owned by the caller; its members are the driver's. */
typedef struct el_ili9341 {
    el_ili9341_config config;
    uint16_t next_line; /* the line that the controller expects; beyond the picture: a window is due */
    uint16_t width;
    uint16_t height;
    struct {
        el_band *band;
        unsigned slot;
    } loans[2]; /* the bands on their way; the renderer has two */
    uint8_t next_loan;
} el_ili9341;

/* Resets and initialises the controller; takes about 250 ms. `config` is copied, `config->bus` must stay. */
void el_ili9341_init(el_ili9341 *panel, const el_ili9341_config *config);

/* A sink whose frames are at most the rotated glass in size. It refers to `panel`. */
el_sink el_ili9341_sink(el_ili9341 *panel);

#ifdef __cplusplus
}
#endif

#endif
