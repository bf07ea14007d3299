/* USART1 as a port, at the pins of the boot loader in the chip's ROM. */
#include "stm32/usart.h"

#include "registers.h"
#include "stm32f405.h"

enum { PIN_TX = 9, PIN_RX = 10, FUNCTION_USART1 = 7 }; /* of port A; DS8626, table 9 */

enum {
    TX_BYTES = 2048,      /* two of the stream's largest packets */
    RX_BYTES = 256,       /* three of the host's */
    PANIC_POLLS = 4000000 /* of 5 cycles and more at 168 MHz: 119 ms */
};

static uint8_t tx_bytes[TX_BYTES];
static uint8_t rx_bytes[RX_BYTES];
el_stm32_usart el_stm32_usart1 = {.registers = USART1,
                                  .interrupt = IRQ_USART1,
                                  .panic_polls = PANIC_POLLS,
                                  .tx = EL_RING(tx_bytes),
                                  .rx = EL_RING(rx_bytes)};

void el_stm32f405_usart_start(uint32_t clock_hz)
{
    GPIOA_AFRH |= FUNCTION_USART1 << 4 * (PIN_TX - 8) | FUNCTION_USART1 << 4 * (PIN_RX - 8);
    GPIOA_PUPDR |= GPIO_PULL_UP << 2 * PIN_RX; /* silence where no cable is */
    GPIOA_MODER |= GPIO_ALTERNATE << 2 * PIN_TX | GPIO_ALTERNATE << 2 * PIN_RX;
    el_stm32_usart1_start(clock_hz, EL_STM32F405_BAUD);
}
