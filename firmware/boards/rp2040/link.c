/* The host's link: Arm's PL011 at the pins of pins.h. */
#include "rp2040/link.h"

#include "arm/pl011.h"
#include "board.h"
#include "cortex_m/core.h"
#include "rp2040/pins.h"
#include "rp2040/registers.h"
#include "rp2040/timer.h"

enum {
    TX_RING_BYTES = 1024, /* 89 ms of the wire: what is encoded while a few bands are drawn */
    RX_RING_BYTES = 256,  /* four of a host's largest packets */
    PANIC_POLLS = 2000000 /* of 7 cycles and more at 125 MHz: 112 ms or more */
};

static uint8_t tx_bytes[TX_RING_BYTES];
static uint8_t rx_bytes[RX_RING_BYTES];
static el_pl011 uart = {
    .registers = EL_UART0, .panic_polls = PANIC_POLLS, .tx = EL_RING(tx_bytes), .rx = EL_RING(rx_bytes)};

void el_pico_link_interrupt(void)
{
    el_pl011_interrupt(&uart);
}

void el_board_panic_write(const uint8_t *bytes, size_t count)
{
    el_pl011_panic_write(&uart, bytes, count);
}

const el_port *el_pico_link_start(uint32_t clock_hz)
{
    static const el_port port = {.context = &uart,
                                 .write = el_pl011_write,
                                 .read = el_pl011_read,
                                 .micros = el_pico_micros,
                                 .cycles = el_pico_cycles,
                                 .find_baud = el_pl011_find_baud,
                                 .set_baud = el_pl011_set_baud};
    el_pl011_start(&uart, clock_hz, EL_PICO_BAUD);
    /* An input that nobody drives must read as an idle line. */
    *EL_PAD(EL_PIN_UART_RX) = EL_PAD_INPUT | EL_PAD_4_MA | EL_PAD_PULL_UP | EL_PAD_SCHMITT;
    *EL_GPIO_CTRL(EL_PIN_UART_TX) = EL_FUNCTION_UART;
    *EL_GPIO_CTRL(EL_PIN_UART_RX) = EL_FUNCTION_UART;
    el_core_enable_interrupt(EL_IRQ_UART0);
    return &port;
}
