/* UART0 as a port: a ring for each direction, emptied and filled by one interrupt.
 *
 * The UART asks for more when its FIFO runs low, not because it is empty. So `write` fills the FIFO itself, and what did
 * not fit into it follows by interrupt. */
#include "lm3s6965.h"

#include "cortex_m/systick.h"
#include "registers.h"
#include "ring.h"

enum { TX_BYTES = 512, RX_BYTES = 256 };
_Static_assert((TX_BYTES & (TX_BYTES - 1)) == 0 && (RX_BYTES & (RX_BYTES - 1)) == 0, "as el_ring wants them");

static uint8_t tx_bytes[TX_BYTES];
static uint8_t rx_bytes[RX_BYTES];
static el_ring tx = {.bytes = tx_bytes, .mask = TX_BYTES - 1};
static el_ring rx = {.bytes = rx_bytes, .mask = RX_BYTES - 1};

static void fill(void)
{
    uint8_t byte;
    while ((UART_FLAGS & UART_FLAGS_TX_FULL) == 0 && el_ring_take(&tx, &byte, 1) != 0) {
        UART_DATA = byte;
    }
}

void el_lm3s6965_uart0_entry(void)
{
    const uint32_t pending = UART_PENDING;
    UART_CLEAR = pending;
    while ((UART_FLAGS & UART_FLAGS_RX_EMPTY) == 0) {
        const uint8_t byte = (uint8_t)UART_DATA;
        (void)el_ring_put(&rx, &byte, 1); /* what finds no room is lost: the protocol sees that by itself */
    }
    if ((pending & UART_INTERRUPT_TX) != 0) {
        fill();
    }
}

static int32_t write(void *context, const uint8_t *bytes, size_t count)
{
    (void)context;
    const size_t taken = el_ring_put(&tx, bytes, count);
    UART_INTERRUPTS &= ~UART_INTERRUPT_TX; /* one side at a time takes from the ring */
    fill();
    UART_INTERRUPTS |= UART_INTERRUPT_TX;
    return (int32_t)taken;
}

static int32_t read(void *context, uint8_t *bytes, size_t capacity)
{
    (void)context;
    return (int32_t)el_ring_take(&rx, bytes, capacity);
}

static void wait(void *context)
{
    (void)context;
    __asm__ volatile("wfi");
}

const el_port el_lm3s6965_port = {.write = write, .read = read, .micros = el_systick_micros, .wait = wait};

void el_lm3s6965_uart_start(uint32_t clock_hz)
{
    const uint32_t pins = 1U << 0 | 1U << 1;
    GPIO_ALTERNATE(GPIO_A) |= pins;
    GPIO_DIGITAL(GPIO_A) |= pins;

    /* 64ths of clock / (16 * baud), to nearest. */
    const uint32_t divider_q6 = (8U * clock_hz / EL_LM3S6965_BAUD + 1U) / 2U;
    UART_CONTROL = 0;
    UART_BAUD_WHOLE = divider_q6 >> 6;
    UART_BAUD_64TH = divider_q6 & 63U;
    UART_LINE = UART_LINE_8_BITS | UART_LINE_FIFO;
    UART_CONTROL = UART_CONTROL_ENABLE | UART_CONTROL_TX | UART_CONTROL_RX;
    UART_INTERRUPTS = UART_INTERRUPT_RX | UART_INTERRUPT_RX_TIMEOUT;
    NVIC_ENABLE0 = 1U << IRQ_UART0;
}

void el_board_panic_write(const uint8_t *bytes, size_t count)
{
    enum { BYTE_POLLS = 2000000 }; /* 5 cycles each, 100 ms and more */
    for (size_t i = 0; i < count; i++) {
        uint32_t polls = 0;
        while ((UART_FLAGS & UART_FLAGS_TX_FULL) != 0) {
            if (++polls == BYTE_POLLS) {
                return;
            }
        }
        UART_DATA = bytes[i];
    }
    /* The FIFO's last bytes, 1.4 ms of them: a restart would cut them off. */
    for (uint32_t polls = 0; polls < BYTE_POLLS && (UART_FLAGS & UART_FLAGS_BUSY) != 0; polls++) {
    }
}
