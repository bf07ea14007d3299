/* USART1 as a port. The rings are as small as they may be: the stream has a queue of its own. */
#include "stm32vldiscovery.h"

#include "registers.h"
#include "stm32/usart.h"

enum { TX_PIN = 9, RX_PIN = 10 }; /* of port A */

enum {
    TX_BYTES = 128,      /* a whole HELLO: a stream that waits for a host pushes only what is taken at once */
    RX_BYTES = 128,      /* the most that a host says at once: PING, START and four INPUT have 80 bytes */
    PANIC_POLLS = 500000 /* of 5 cycles and more at 24 MHz: 104 ms */
};

static uint8_t tx_bytes[TX_BYTES];
static uint8_t rx_bytes[RX_BYTES];
el_stm32_usart el_stm32_usart1 = {.registers = USART1,
                                  .interrupt = IRQ_USART1,
                                  .panic_polls = PANIC_POLLS,
                                  .tx = EL_RING(tx_bytes),
                                  .rx = EL_RING(rx_bytes)};

void el_vldiscovery_uart_start(void)
{
    GPIO_SET_RESET(GPIO_A) = GPIO_SET(RX_PIN); /* pulled up: an open wire is silent */
    el_gpio_configure(GPIO_A, RX_PIN, GPIO_MODE_PULLED);
    el_gpio_configure(GPIO_A, TX_PIN, GPIO_MODE_ALTERNATE);
    el_stm32_usart1_start(EL_VLDISCOVERY_HZ, EL_VLDISCOVERY_BAUD);
}
