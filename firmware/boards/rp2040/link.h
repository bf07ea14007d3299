/* The host's link: UART0 at 115,200 baud, 8 bits, no parity, one stop bit. */
#ifndef EL_BOARDS_RP2040_LINK_H
#define EL_BOARDS_RP2040_LINK_H

#include <stdint.h>

#include "base/port.h"

enum { EL_PICO_BAUD = 115200 };

/* Called once, with clk_peri at `clock_hz` and UART0, timer, pins and pads out of reset. */
const el_port *el_pico_link_start(uint32_t clock_hz);

/* The handler of UART0_IRQ. */
void el_pico_link_interrupt(void);

#endif
