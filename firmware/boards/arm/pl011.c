/* The transmit interrupt comes when the queue runs low, not while it is empty (DDI 0183, "UARTTXINTR"): whoever puts
 * bytes into an idle ring must move the first ones by hand. `el_pl011_write` does that while the interrupt is masked.
 * */
#include "arm/pl011.h"

enum {
    FR_BUSY = 1 << 3,
    FR_RXFE = 1 << 4,
    FR_TXFF = 1 << 5,
    LCR_H_FIFOS = 1 << 4,
    LCR_H_8_BITS = 3 << 5,
    CR_ENABLE = 1 << 0,
    CR_TXE = 1 << 8,
    CR_RXE = 1 << 9,
    INT_RX = 1 << 4,
    INT_TX = 1 << 5,
    INT_RX_TIMEOUT = 1 << 6
};
_Static_assert(offsetof(el_pl011_registers, fr) == 0x18 && offsetof(el_pl011_registers, icr) == 0x44,
               "DDI 0183, summary of registers");

static void move_out(el_pl011 *uart)
{
    uint8_t byte;
    while ((uart->registers->fr & FR_TXFF) == 0 && el_ring_take(&uart->tx, &byte, 1) == 1) {
        uart->registers->dr = byte;
    }
}

/* Takes all that has come. What the ring has no room for is lost; the stream notices by its CRCs. Framing errors come
 * with a byte, which is kept for the same reason. */
static void move_in(el_pl011 *uart)
{
    while ((uart->registers->fr & FR_RXFE) == 0) {
        const uint8_t byte = (uint8_t)uart->registers->dr;
        (void)el_ring_put(&uart->rx, &byte, 1);
    }
}

void el_pl011_interrupt(el_pl011 *uart)
{
    const uint32_t pending = uart->registers->mis;
    uart->registers->icr = pending;
    move_in(uart);
    if ((pending & INT_TX) != 0) {
        move_out(uart);
    }
}

int32_t el_pl011_write(void *context, const uint8_t *bytes, size_t count)
{
    el_pl011 *uart = context;
    const size_t taken = el_ring_put(&uart->tx, bytes, count);
    uart->registers->imsc = INT_RX | INT_RX_TIMEOUT; /* one side at a time takes from the ring */
    move_out(uart);
    uart->registers->imsc = INT_RX | INT_RX_TIMEOUT | INT_TX;
    return (int32_t)taken;
}

int32_t el_pl011_read(void *context, uint8_t *bytes, size_t capacity)
{
    el_pl011 *uart = context;
    return (int32_t)el_ring_take(&uart->rx, bytes, capacity);
}

/* 64ths of clock / (16 * rate), to nearest; 32 bits hold it up to 536 MHz. 1 to 65535 are what the registers take. */
static uint32_t find_divider_q6(const el_pl011 *uart, uint32_t rate)
{
    enum { LEAST_Q6 = 64, MOST_Q6 = 65535 * 64 };
    const uint32_t nearest = (8U * uart->clock_hz / rate + 1U) / 2U;
    return nearest < LEAST_Q6 ? LEAST_Q6 : nearest > MOST_Q6 ? MOST_Q6 : nearest;
}

/* The order is the manual's: off, the divider, and the write of LCR_H that puts it in force (3.3.5 to 3.3.8). */
static void set_up(el_pl011 *uart, uint32_t rate)
{
    const uint32_t divider_q6 = find_divider_q6(uart, rate);
    uart->registers->cr = 0;
    uart->registers->ibrd = divider_q6 >> 6;
    uart->registers->fbrd = divider_q6 & 63U;
    uart->registers->lcr_h = LCR_H_8_BITS | LCR_H_FIFOS;
    uart->registers->cr = CR_ENABLE | CR_TXE | CR_RXE;
}

void el_pl011_start(el_pl011 *uart, uint32_t clock_hz, uint32_t baud)
{
    uart->clock_hz = clock_hz;
    set_up(uart, baud);
    uart->registers->imsc = INT_RX | INT_RX_TIMEOUT;
}

uint32_t el_pl011_find_baud(void *context, uint32_t rate)
{
    const el_pl011 *uart = context;
    return 4U * uart->clock_hz / find_divider_q6(uart, rate);
}

bool el_pl011_set_baud(void *context, uint32_t rate)
{
    el_pl011 *uart = context;
    if (el_ring_used(&uart->tx) != 0 || (uart->registers->fr & FR_BUSY) != 0) {
        return false;
    }
    set_up(uart, rate);
    return true;
}

void el_pl011_panic_write(const el_pl011 *uart, const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t polls = 0;
        while ((uart->registers->fr & FR_TXFF) != 0) {
            if (++polls == uart->panic_polls) {
                return;
            }
        }
        uart->registers->dr = bytes[i];
    }
    for (uint32_t polls = 0; polls < uart->panic_polls && (uart->registers->fr & FR_BUSY) != 0; polls++) {
    }
}
