/* The USART of STM32F1 to F4 as two rings between the program and its interrupt, so that neither side waits for the
 * other (RM0041 and RM0090, chapters "Universal synchronous asynchronous receiver transmitter"). Pins and clocks are
 * the board's. */
#ifndef EL_BOARDS_STM32_USART_H
#define EL_BOARDS_STM32_USART_H

#include <stdint.h>

#include "base/port.h"
#include "ring.h"

typedef struct el_stm32_usart_registers {
    volatile uint32_t sr, dr, brr, cr1;
} el_stm32_usart_registers;

typedef struct el_stm32_usart {
    el_stm32_usart_registers *registers;
    uint32_t clock_hz;    /* of its bus; el_stm32_usart1_start notes it */
    unsigned interrupt;   /* its number */
    uint32_t panic_polls; /* of 5 cycles and more, for 100 ms; a byte at 115,200 baud takes 87 us */
    el_ring tx;           /* by EL_RING */
    el_ring rx;
} el_stm32_usart;

/* The one that is the board's link, which the board gives. */
extern el_stm32_usart el_stm32_usart1;

/* 8 bits, no parity, one stop bit; a whole number of clocks per bit, 16 at least: within 0.2% where there are 250 or
 * more. */
void el_stm32_usart1_start(uint32_t clock_hz, uint32_t baud);

extern const el_port el_stm32_usart1_port;

/* The handler of its interrupt. */
void el_stm32_usart1_entry(void);

#endif
