/* The host's link: UART0, 8 bits, no parity, one stop bit. */
#ifndef EL_BOARDS_RP2040_LINK_H
#define EL_BOARDS_RP2040_LINK_H

#include <stdint.h>

#include "base/port.h"

/* At the start; and the most that common adapters have. */
enum { EL_PICO_BAUD = 115200, EL_PICO_MAX_BAUD = 3000000 };

/* Called once, with clk_peri at `clock_hz` and UART0, timer, pins and pads out of reset. */
const el_port *el_pico_link_start(uint32_t clock_hz);

/* The handler of UART0_IRQ. */
void el_pico_link_interrupt(void);

#endif
