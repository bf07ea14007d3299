/* USART1 as a port: a ring for each direction, between the program and one interrupt.
 *
 * Only the interrupt touches the registers; `write` makes it pending by hand, so that no two sides change the control
 * register, and a transmitter whose own interrupt never comes (QEMU's) works, too. */
#include "cortex_m/systick.h"
#include "registers.h"
#include "ring.h"
#include "stm32f405.h"

enum {
    TX_BYTES = 2048, /* two of the stream's largest packets */
    RX_BYTES = 256,  /* three of the host's */
    CONTROL = USART_CR1_ENABLE | USART_CR1_TRANSMIT | USART_CR1_RECEIVE | USART_CR1_RX_INTERRUPT
};
_Static_assert((TX_BYTES & (TX_BYTES - 1)) == 0 && (RX_BYTES & (RX_BYTES - 1)) == 0, "as el_ring wants them");

static uint8_t tx_bytes[TX_BYTES];
static uint8_t rx_bytes[RX_BYTES];
static el_ring tx = {.bytes = tx_bytes, .mask = TX_BYTES - 1};
static el_ring rx = {.bytes = rx_bytes, .mask = RX_BYTES - 1};

void el_stm32f405_usart1_entry(void)
{
    if ((USART1_SR & (USART_SR_RX_NOT_EMPTY | USART_SR_OVERRUN)) != 0) {
        const uint8_t byte = (uint8_t)USART1_DR; /* reading status, then data, ends an overrun as well */
        (void)el_ring_put(&rx, &byte, 1);        /* what finds no room is lost: the protocol sees that by itself */
    }
    uint8_t byte;
    while ((USART1_SR & USART_SR_TX_EMPTY) != 0 && el_ring_take(&tx, &byte, 1) != 0) {
        USART1_DR = byte;
    }
    USART1_CR1 = CONTROL | (el_ring_used(&tx) != 0 ? USART_CR1_TX_INTERRUPT : 0U);
}

static int32_t write(void *context, const uint8_t *bytes, size_t count)
{
    (void)context;
    const size_t taken = el_ring_put(&tx, bytes, count);
    if (taken != 0) { /* a full ring must not keep the processor from sleeping */
        NVIC_PEND1 = 1U << (IRQ_USART1 - 32U);
    }
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
    __asm__ volatile("wfi"); /* a millisecond at most: SysTick ticks */
}

const el_port el_stm32f405_port = {.write = write, .read = read, .micros = el_systick_micros, .wait = wait};

void el_stm32f405_usart_start(el_stm32f405_clocks clocks)
{
    USART1_BRR = (clocks.apb2_hz + EL_STM32F405_BAUD / 2U) / EL_STM32F405_BAUD; /* oversampling by 16 (30.3.4) */
    USART1_CR1 = CONTROL;
    NVIC_ENABLE1 = 1U << (IRQ_USART1 - 32U);
}

void el_board_panic_write(const uint8_t *bytes, size_t count)
{
    enum { BYTE_POLLS = 2000000 }; /* ten cycles each at 168 MHz, 100 ms and more */
    for (size_t i = 0; i < count; i++) {
        uint32_t polls = 0;
        while ((USART1_SR & USART_SR_TX_EMPTY) == 0) {
            if (++polls == BYTE_POLLS) {
                return;
            }
        }
        USART1_DR = bytes[i];
    }
    /* The last byte is still on its way: a restart would cut it off. */
    for (uint32_t polls = 0; polls < BYTE_POLLS && (USART1_SR & USART_SR_TX_COMPLETE) == 0; polls++) {
    }
}
