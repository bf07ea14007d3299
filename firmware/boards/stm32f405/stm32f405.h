/* The parts of this board. board.c starts them in this order: clocks, USART, display. */
#ifndef EL_BOARDS_STM32F405_STM32F405_H
#define EL_BOARDS_STM32F405_STM32F405_H

#include <stdint.h>

#include "board.h"

/* What the clocks came to: 168 and 84 MHz, or 16 and 16 where the PLL does not start. */
typedef struct el_stm32f405_clocks {
    uint32_t core_hz;
    uint32_t apb2_hz; /* of SPI1 and USART1 */
} el_stm32f405_clocks;

el_stm32f405_clocks el_stm32f405_clocks_start(void);

/* At the start; and the highest: an interrupt for each byte, 840 cycles apart. */
enum { EL_STM32F405_BAUD = EDGELINE_BAUD, EL_STM32F405_MAX_BAUD = EDGELINE_BAUD > 2000000 ? EDGELINE_BAUD : 2000000 };

void el_stm32f405_usart_start(uint32_t clock_hz);

extern const el_bus el_stm32f405_bus;
void el_stm32f405_display_start(void);
void el_stm32f405_dma2_stream3_entry(void);

#endif
