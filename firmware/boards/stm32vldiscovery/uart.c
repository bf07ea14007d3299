/* USART1 as a port: a ring for each direction, between the program and one interrupt.
 *
 * Only the interrupt touches the registers; `write` makes it pending by hand, so that no two sides change the control
 * register. The rings are as small as they may be: the stream has a queue of its own. */
#include "stm32vldiscovery.h"

#include "cortex_m/systick.h"
#include "registers.h"
#include "ring.h"

enum { TX_PIN = 9, RX_PIN = 10 }; /* of port A */

enum {
    TX_BYTES = 128, /* a whole HELLO: a stream that waits for a host pushes only what is taken at once */
    RX_BYTES = 128, /* the most that a host says at once: PING, START and three INPUT have 71 bytes */
    CONTROL = USART_CR1_ENABLE | USART_CR1_TX | USART_CR1_RX | USART_CR1_RX_INTERRUPT
};

static uint8_t tx_bytes[TX_BYTES];
static uint8_t rx_bytes[RX_BYTES];
static el_ring tx = {.bytes = tx_bytes, .mask = TX_BYTES - 1};
static el_ring rx = {.bytes = rx_bytes, .mask = RX_BYTES - 1};

void el_vldiscovery_usart1_entry(void)
{
    uint8_t byte;
    while ((USART_SR & (USART_SR_RX_NOT_EMPTY | USART_SR_OVERRUN)) != 0) {
        byte = (uint8_t)USART_DR;         /* reading status, then data, ends an overrun as well */
        (void)el_ring_put(&rx, &byte, 1); /* what finds no room is lost: the protocol sees that by itself */
    }
    while ((USART_SR & USART_SR_TX_EMPTY) != 0 && el_ring_take(&tx, &byte, 1) != 0) {
        USART_DR = byte;
    }
    USART_CR1 = CONTROL | (el_ring_used(&tx) != 0 ? USART_CR1_TX_INTERRUPT : 0U);
}

static int32_t write(void *context, const uint8_t *bytes, size_t count)
{
    (void)context;
    const size_t taken = el_ring_put(&tx, bytes, count);
    NVIC_PEND1 = 1U << (IRQ_USART1 - 32U);
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

const el_port el_vldiscovery_port = {.write = write, .read = read, .micros = el_systick_micros, .wait = wait};

void el_vldiscovery_uart_start(void)
{
    GPIO_SET_RESET(GPIO_A) = GPIO_SET(RX_PIN); /* pulled up: an open wire is silent */
    el_gpio_configure(GPIO_A, RX_PIN, GPIO_MODE_PULLED);
    el_gpio_configure(GPIO_A, TX_PIN, GPIO_MODE_ALTERNATE);
    USART_BRR = (EL_VLDISCOVERY_HZ + EL_VLDISCOVERY_BAUD / 2) / EL_VLDISCOVERY_BAUD; /* within 0.2% */
    USART_CR1 = CONTROL;
    NVIC_ENABLE1 = 1U << (IRQ_USART1 - 32U);
}

void el_board_panic_write(const uint8_t *bytes, size_t count)
{
    enum { BYTE_POLLS = 500000 }; /* 5 cycles each, 100 ms and more */
    for (size_t i = 0; i < count; i++) {
        uint32_t polls = 0;
        while ((USART_SR & USART_SR_TX_EMPTY) == 0) {
            if (++polls == BYTE_POLLS) {
                return;
            }
        }
        USART_DR = bytes[i];
    }
    for (uint32_t polls = 0; polls < BYTE_POLLS && (USART_SR & USART_SR_SENT) == 0; polls++) {
    }
}
