/* The host's link: two rings between the program and the UART's interrupt.
 *
 * The 16550 tells when its FIFO is empty, not when it has room; so it is filled to the brim each time. Its interrupt
 * comes when the FIFO becomes empty or is empty when the interrupt is switched on: the first bytes need no help. */
#include "ring.h"

#include "board.h"
#include "registers.h"
#include "riscv_virt.h"

static uint8_t tx_bytes[1024];
static uint8_t rx_bytes[256];
static el_ring tx = EL_RING(tx_bytes);
static el_ring rx = EL_RING(rx_bytes);

/* Of the UART's clock over 16 to the rate. */
static uint32_t divider_of(uint32_t rate)
{
    enum { MOST = 65535 };
    const uint32_t nearest = (UART_CLOCK_HZ / 16U + rate / 2U) / rate;
    return nearest < 1U ? 1U : nearest > MOST ? MOST : nearest;
}

/* No interrupt may come while the divider is where the data is. */
static void set_divider(uint32_t divider)
{
    UART_LINE = UART_LINE_8N1 | UART_LINE_DLAB;
    UART_DIVIDER_LOW = (uint8_t)divider;
    UART_DIVIDER_HIGH = (uint8_t)(divider >> 8);
    UART_LINE = UART_LINE_8N1;
}

void el_virt_uart_start(void)
{
    set_divider(divider_of(EL_VIRT_BAUD));
    UART_MODEM = UART_MODEM_DTR_RTS;
    UART_FIFO = UART_FIFO_ON_AND_CLEARED;
    UART_INTERRUPTS = UART_INTERRUPTS_RECEIVED;
    PLIC_PRIORITY(PLIC_SOURCE_UART) = 1;
    PLIC_THRESHOLD = 0;
    PLIC_ENABLE = 1U << PLIC_SOURCE_UART;
}

void el_virt_uart_interrupt(void)
{
    while ((UART_STATUS & UART_STATUS_RECEIVED) != 0) {
        const uint8_t byte = UART_DATA;
        (void)el_ring_put(&rx, &byte, 1); /* without room it is lost, and the CRC tells */
    }
    if ((UART_STATUS & UART_STATUS_EMPTY) != 0) {
        uint8_t bytes[UART_FIFO_BYTES];
        const size_t count = el_ring_take(&tx, bytes, sizeof bytes);
        for (size_t i = 0; i < count; i++) {
            UART_DATA = bytes[i];
        }
        if (count == 0) {
            UART_INTERRUPTS = UART_INTERRUPTS_RECEIVED;
        }
    }
}

static int32_t uart_write(void *context, const uint8_t *bytes, size_t count)
{
    (void)context;
    const size_t taken = el_ring_put(&tx, bytes, count);
    /* The bytes are in the ring before: an interrupt that finds it empty in between is followed by this one. */
    UART_INTERRUPTS = UART_INTERRUPTS_RECEIVED | UART_INTERRUPTS_EMPTY;
    return (int32_t)taken;
}

static int32_t uart_read(void *context, uint8_t *bytes, size_t capacity)
{
    (void)context;
    return (int32_t)el_ring_take(&rx, bytes, capacity);
}

static uint32_t uart_micros(void *context)
{
    (void)context;
    return el_virt_micros();
}

/* The processor's own counter (priv 3.1.10). Zicsr has to be named: that it is a name of its own is younger than some
 * compilers' idea of the processor. */
static uint32_t uart_cycles(void *context)
{
    (void)context;
    uint32_t cycles;
    __asm__ volatile(".option push\n.option arch, +zicsr\ncsrr %0, mcycle\n.option pop" : "=r"(cycles));
    return cycles;
}

/* Until any interrupt; the tick's comes within a millisecond. */
static void uart_wait(void *context)
{
    (void)context;
    __asm__ volatile("wfi" ::: "memory");
}

static uint32_t uart_find_baud(void *context, uint32_t rate)
{
    (void)context;
    return UART_CLOCK_HZ / 16U / divider_of(rate);
}

static bool uart_set_baud(void *context, uint32_t rate)
{
    (void)context;
    if (el_ring_used(&tx) != 0 || (UART_STATUS & UART_STATUS_IDLE) == 0) {
        return false;
    }
    el_virt_interrupts_off();
    set_divider(divider_of(rate));
    el_virt_interrupts_on();
    return true;
}

const el_port el_virt_uart = {.write = uart_write,
                              .read = uart_read,
                              .micros = uart_micros,
                              .wait = uart_wait,
                              .cycles = uart_cycles,
                              .find_baud = uart_find_baud,
                              .set_baud = uart_set_baud};

/* Time goes on whatever the program has done to the processor, so it can be the bound. */
static bool becomes(uint8_t status)
{
    const uint32_t begin_us = el_virt_micros();
    while ((UART_STATUS & status) == 0) {
        if (el_virt_micros() - begin_us > 100000U) {
            return false;
        }
    }
    return true;
}

void el_board_panic_write(const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!becomes(UART_STATUS_EMPTY)) {
            return;
        }
        UART_DATA = bytes[i];
    }
    (void)becomes(UART_STATUS_IDLE); /* a reset empties the FIFO */
}
