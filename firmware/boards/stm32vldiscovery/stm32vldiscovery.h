/* The STM32 VL Discovery board (STM32F100RB: Cortex-M3, 24 MHz, 8 KB of RAM) with an SSD1306 OLED module at its header.
 *
 * Between the files of this folder: board.c starts clocks and parts, display.c is the bus, uart.c the port. Wires:
 *
 *     OLED module          board
 *     CLK (D0)             PA5     SPI1 SCK
 *     MOSI (D1)            PA7     SPI1 MOSI
 *     CS                   PA4
 *     DC                   PA3
 *     RES                  PA2
 *     VCC, GND             3V, GND
 *
 *     serial adapter, 3.3 V, 115,200 baud, 8 bits, no parity
 *     RX                   PA9     USART1 TX
 *     TX                   PA10    USART1 RX
 *     GND                  GND */
#ifndef EL_BOARDS_STM32VLDISCOVERY_H
#define EL_BOARDS_STM32VLDISCOVERY_H

#include "board.h"

/* The link's rate at the start, and the highest: an interrupt for each byte, 520 cycles apart. */
enum { EL_VLDISCOVERY_HZ = 24000000, EL_VLDISCOVERY_BAUD = 115200, EL_VLDISCOVERY_MAX_BAUD = 460800 };

void el_vldiscovery_display_start(void);
extern const el_bus el_vldiscovery_bus;

void el_vldiscovery_uart_start(void);

#endif
