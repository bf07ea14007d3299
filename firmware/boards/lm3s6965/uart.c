/* UART0 as a port: Arm's PL011. */
#include "lm3s6965.h"

#include "arm/pl011.h"
#include "cortex_m/core.h"
#include "cortex_m/cycles.h"
#include "cortex_m/systick.h"
#include "registers.h"

enum {
    TX_BYTES = 512,
    RX_BYTES = 256,
    PANIC_POLLS = 1000000 /* of 7 cycles and more at 50 MHz: 140 ms */
};

static uint8_t tx_bytes[TX_BYTES];
static uint8_t rx_bytes[RX_BYTES];
static el_pl011 uart = {
    .registers = UART0, .panic_polls = PANIC_POLLS, .tx = EL_RING(tx_bytes), .rx = EL_RING(rx_bytes)};

void el_lm3s6965_uart0_entry(void)
{
    el_pl011_interrupt(&uart);
}

const el_port el_lm3s6965_port = {.context = &uart,
                                  .write = el_pl011_write,
                                  .read = el_pl011_read,
                                  .micros = el_systick_micros,
                                  .wait = el_systick_wait,
                                  .cycles = el_cycles,
                                  .find_baud = el_pl011_find_baud,
                                  .set_baud = el_pl011_set_baud};

void el_board_panic_write(const uint8_t *bytes, size_t count)
{
    if ((SYSCTL_RCGC1 & RCGC1_UART0) != 0) { /* a part without a clock answers with a fault */
        el_pl011_panic_write(&uart, bytes, count);
    }
}

void el_lm3s6965_uart_start(uint32_t clock_hz)
{
    const uint32_t pins = 1U << 0 | 1U << 1;
    GPIO_ALTERNATE(GPIO_A) |= pins;
    GPIO_DIGITAL(GPIO_A) |= pins;
    el_pl011_start(&uart, clock_hz, EL_LM3S6965_BAUD);
    el_core_enable_interrupt(IRQ_UART0);
}
