/* The Stellaris LM3S6965 evaluation board (EK-LM3S6965 revision A) with its OSRAM OLED: 128x64, SSD0323, 4-bit grey.
 *
 * Between the files of this folder: board.c starts clocks and parts, display.c is the bus, uart.c the port. Pins:
 *
 *     PA0, PA1         UART0, on the board's USB as a serial port: 115,200 baud, 8 bits, no parity
 *     PA2, PA3, PA5    SSI0: SCLK, chip select and data of the OLED
 *     PC7              D/C of the OLED: 0 is a command
 *     PD0              chip select of the memory card on the same wires: kept high
 *
 * The OLED is reset together with the processor. */
#ifndef EL_BOARDS_LM3S6965_H
#define EL_BOARDS_LM3S6965_H

#include "board.h"

void el_lm3s6965_display_start(void);
extern const el_bus el_lm3s6965_bus;
void el_lm3s6965_ssi0_entry(void);

/* At the start; and what 50 MHz serve with ease. */
enum { EL_LM3S6965_BAUD = 115200, EL_LM3S6965_MAX_BAUD = 921600 };

void el_lm3s6965_uart_start(uint32_t clock_hz);
extern const el_port el_lm3s6965_port;
void el_lm3s6965_uart0_entry(void);

#endif
