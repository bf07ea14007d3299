/* The display's wire: SPI0 at 62.5 MHz, fed by DMA channel 0. */
#ifndef EL_BOARDS_RP2040_DISPLAY_H
#define EL_BOARDS_RP2040_DISPLAY_H

#include "base/bus.h"

/* Sets up pins, SPI and DMA, and lights the backlight. Called once, with the clocks running and SPI0, DMA, timer, pins
 * and pads out of reset. */
const el_bus *el_pico_display_start(void);

/* The handler of DMA_IRQ_0. */
void el_pico_display_interrupt(void);

#endif
