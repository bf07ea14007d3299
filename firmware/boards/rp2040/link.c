/* Two rings between the program and the UART's queues, moved by its interrupt, so that neither side waits for the other.
 *
 * The transmit interrupt of a PL011 comes when its queue runs low, not while it is empty (4.2.6.3): whoever puts bytes
 * into an idle ring must move the first ones by hand. `move_out` does that for both, with the interrupt off. */
#include "rp2040/link.h"

#include "board.h"
#include "ring.h"
#include "rp2040/pins.h"
#include "rp2040/registers.h"
#include "rp2040/timer.h"

enum {
    TX_RING_BYTES = 1024, /* 89 ms of the wire: what is encoded while a few bands are drawn */
    RX_RING_BYTES = 256,  /* four of a host's largest packets */
    /* clk_peri / (16 * baud) in 1/64, to nearest (4.2.7.1) */
    DIVISOR_Q6 = (EL_PICO_CLOCK_HZ * 4LL + EL_PICO_BAUD / 2) / EL_PICO_BAUD,
    PANIC_POLLS = 2000000 /* of 7 cycles and more at 125 MHz: 112 ms or more; a byte takes 87 us */
};

static uint8_t tx_bytes[TX_RING_BYTES];
static uint8_t rx_bytes[RX_RING_BYTES];
static el_ring tx = {.bytes = tx_bytes, .mask = TX_RING_BYTES - 1};
static el_ring rx = {.bytes = rx_bytes, .mask = RX_RING_BYTES - 1};

static void move_out(void)
{
    uint8_t byte;
    while ((EL_UART0->fr & EL_UART_FR_TXFF) == 0 && el_ring_take(&tx, &byte, 1) == 1) {
        EL_UART0->dr = byte;
    }
    if (el_ring_used(&tx) > 0) {
        el_set_bits(&EL_UART0->imsc, EL_UART_INT_TX);
    } else {
        el_clear_bits(&EL_UART0->imsc, EL_UART_INT_TX);
    }
}

/* Takes all that has come, which ends the interrupt. What the ring has no room for is lost; the stream notices by its
 * CRCs. Framing errors come with a byte, which is kept for the same reason. */
static void move_in(void)
{
    while ((EL_UART0->fr & EL_UART_FR_RXFE) == 0) {
        const uint8_t byte = (uint8_t)EL_UART0->dr;
        (void)el_ring_put(&rx, &byte, 1);
    }
}

void el_pico_link_interrupt(void)
{
    move_in();
    move_out();
}

static int32_t write(void *context, const uint8_t *from, size_t count)
{
    (void)context;
    const size_t took = el_ring_put(&tx, from, count);
    *EL_NVIC_ICER = 1U << EL_IRQ_UART0;
    __asm__ volatile("dsb\n isb" ::: "memory");
    move_out();
    *EL_NVIC_ISER = 1U << EL_IRQ_UART0;
    return (int32_t)took;
}

static int32_t read(void *context, uint8_t *to, size_t capacity)
{
    (void)context;
    return (int32_t)el_ring_take(&rx, to, capacity);
}

void el_board_panic_write(const uint8_t *from, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t polls = PANIC_POLLS;
        while ((EL_UART0->fr & EL_UART_FR_TXFF) != 0) {
            if (--polls == 0) {
                return;
            }
        }
        EL_UART0->dr = from[i];
    }
}

const el_port *el_pico_link_start(void)
{
    static const el_port port = {.write = write, .read = read, .micros = el_pico_micros};
    EL_UART0->ibrd = DIVISOR_Q6 / 64;
    EL_UART0->fbrd = DIVISOR_Q6 % 64;
    EL_UART0->lcr_h = EL_UART_LCR_H_8_BITS | EL_UART_LCR_H_FIFOS;
    EL_UART0->cr = EL_UART_CR_ENABLE | EL_UART_CR_TXE | EL_UART_CR_RXE;
    EL_UART0->imsc = EL_UART_INT_RX | EL_UART_INT_RX_TIMEOUT;
    /* An input that nobody drives must read as an idle line. */
    *EL_PAD(EL_PIN_UART_RX) = EL_PAD_INPUT | EL_PAD_4_MA | EL_PAD_PULL_UP | EL_PAD_SCHMITT;
    *EL_GPIO_CTRL(EL_PIN_UART_TX) = EL_FUNCTION_UART;
    *EL_GPIO_CTRL(EL_PIN_UART_RX) = EL_FUNCTION_UART;
    *EL_NVIC_ISER = 1U << EL_IRQ_UART0;
    return &port;
}
