/* Only the interrupt touches the registers; `write` makes it pending by hand, so that no two sides
 * change the control register, and a transmitter whose own interrupt never comes (QEMU's) works, too. */
#include "stm32/usart.h"

#include "board.h"
#include "cortex_m/core.h"
#include "cortex_m/cycles.h"
#include "cortex_m/systick.h"

enum {
    SR_OVERRUN = 1 << 3,
    SR_RX_NOT_EMPTY = 1 << 5,
    SR_TX_COMPLETE = 1 << 6,
    SR_TX_EMPTY = 1 << 7,
    CR1_RECEIVE = 1 << 2,
    CR1_TRANSMIT = 1 << 3,
    CR1_RX_INTERRUPT = 1 << 5,
    CR1_TX_INTERRUPT = 1 << 7,
    CR1_ENABLE = 1 << 13,
    CONTROL = CR1_ENABLE | CR1_TRANSMIT | CR1_RECEIVE | CR1_RX_INTERRUPT
};

void el_stm32_usart1_entry(void)
{
    el_stm32_usart *usart = &el_stm32_usart1;
    el_stm32_usart_registers *registers = usart->registers;
    uint8_t byte;
    while ((registers->sr & (SR_RX_NOT_EMPTY | SR_OVERRUN)) != 0) {
        byte = (uint8_t)registers->dr;           /* reading status, then data, ends an overrun as well */
        (void)el_ring_put(&usart->rx, &byte, 1); /* what finds no room is lost: the protocol sees that by itself */
    }
    while ((registers->sr & SR_TX_EMPTY) != 0 && el_ring_take(&usart->tx, &byte, 1) != 0) {
        registers->dr = byte;
    }
    registers->cr1 = CONTROL | (el_ring_used(&usart->tx) != 0 ? CR1_TX_INTERRUPT : 0U);
}

static int32_t write(void *context, const uint8_t *bytes, size_t count)
{
    (void)context;
    const size_t taken = el_ring_put(&el_stm32_usart1.tx, bytes, count);
    if (taken != 0) { /* a full ring must not keep the processor from sleeping */
        el_core_pend_interrupt(el_stm32_usart1.interrupt);
    }
    return (int32_t)taken;
}

static int32_t read(void *context, uint8_t *bytes, size_t capacity)
{
    (void)context;
    return (int32_t)el_ring_take(&el_stm32_usart1.rx, bytes, capacity);
}

/* Of its clock; with oversampling by 16 that is the rate's divider in sixteenths, and 16 the least (RM0090, 30.3.4). */
static uint32_t clocks_per_bit(uint32_t rate)
{
    enum { LEAST = 16, MOST = 65535 };
    const uint32_t nearest = (el_stm32_usart1.clock_hz + rate / 2U) / rate;
    return nearest < LEAST ? LEAST : nearest > MOST ? MOST : nearest;
}

static uint32_t find_baud(void *context, uint32_t rate)
{
    (void)context;
    return el_stm32_usart1.clock_hz / clocks_per_bit(rate);
}

static bool set_baud(void *context, uint32_t rate)
{
    (void)context;
    el_stm32_usart_registers *registers = el_stm32_usart1.registers;
    if (el_ring_used(&el_stm32_usart1.tx) != 0 || (registers->sr & SR_TX_COMPLETE) == 0) {
        return false;
    }
    registers->brr = clocks_per_bit(rate);
    return true;
}

const el_port el_stm32_usart1_port = {.write = write,
                                      .read = read,
                                      .micros = el_systick_micros,
                                      .wait = el_systick_wait,
                                      .cycles = el_cycles,
                                      .find_baud = find_baud,
                                      .set_baud = set_baud};

void el_stm32_usart1_start(uint32_t clock_hz, uint32_t baud)
{
    el_stm32_usart_registers *registers = el_stm32_usart1.registers;
    el_stm32_usart1.clock_hz = clock_hz;
    registers->brr = clocks_per_bit(baud);
    registers->cr1 = CONTROL;
    el_core_enable_interrupt(el_stm32_usart1.interrupt);
}

/* Returns when the last bit is out, so that a restart does not cut it off. */
void el_board_panic_write(const uint8_t *bytes, size_t count)
{
    const uint32_t most = el_stm32_usart1.panic_polls;
    el_stm32_usart_registers *registers = el_stm32_usart1.registers;
    for (size_t i = 0; i < count; i++) {
        uint32_t polls = 0;
        while ((registers->sr & SR_TX_EMPTY) == 0) {
            if (++polls == most) {
                return;
            }
        }
        registers->dr = bytes[i];
    }
    for (uint32_t polls = 0; polls < most && (registers->sr & SR_TX_COMPLETE) == 0; polls++) {
    }
}
