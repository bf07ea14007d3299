/* The OLED's wire: SSI0 and the D/C line.
 *
 * Bytes of a picture go out by interrupt, half a FIFO at a time, while the next band is drawn. Commands are polled:
 * they are few. SSI0 is the clock of its own wire and nothing outside can hold it up, so every wait for it ends within
 * the time of its FIFO, and a wait for an open transfer within the time of that transfer. */
#include "lm3s6965.h"

#include <stdbool.h>

#include "cortex_m/core.h"
#include "cortex_m/systick.h"
#include "registers.h"

enum { DATA_COMMAND_PIN = 7, CARD_SELECT_PIN = 0 };

/* The transfer that `bytes` has opened; the interrupt's as long as `open` is set. */
static struct {
    const uint8_t *next;
    const uint8_t *end;
    void (*done)(void *argument);
    void *argument;
    volatile bool open;
} transfer;

/* What comes in while bytes go out says nothing, but a full FIFO of it stands in the way. */
static void drain(void)
{
    while ((SSI_STATUS & SSI_STATUS_RX_NOT_EMPTY) != 0) {
        (void)SSI_DATA;
    }
}

/* Puts in what there is room for: eight words, or at the half-full mark four at least. */
static void feed(void)
{
    drain();
    for (unsigned i = 0; i < SSI_FIFO_WORDS && transfer.next != transfer.end; i++) {
        if ((SSI_STATUS & SSI_STATUS_TX_NOT_FULL) == 0) {
            return;
        }
        SSI_DATA = *transfer.next++;
    }
    if (transfer.next == transfer.end) {
        SSI_INTERRUPTS = 0;
        transfer.open = false;
        transfer.done(transfer.argument);
    }
}

void el_lm3s6965_ssi0_entry(void)
{
    feed();
}

static void wait_until_idle(void)
{
    while ((SSI_STATUS & (SSI_STATUS_BUSY | SSI_STATUS_RX_NOT_EMPTY)) != 0) {
        drain();
    }
}

/* D/C belongs to the byte that is on the wire: it changes when there is none. */
static void set_data_command(uint32_t is_data)
{
    wait_until_idle();
    GPIO_PIN(GPIO_C, DATA_COMMAND_PIN) = is_data << DATA_COMMAND_PIN;
}

static void send(const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        while ((SSI_STATUS & SSI_STATUS_TX_NOT_FULL) == 0) {
            drain();
        }
        SSI_DATA = bytes[i];
    }
}

static void wait(void *context)
{
    (void)context;
    el_core_sleep_while(&transfer.open);
}

static void close_transfer(void)
{
    while (transfer.open) {
        wait(NULL);
    }
}

static void command(void *context, uint8_t command, const uint8_t *parameters, size_t count)
{
    (void)context;
    close_transfer();
    set_data_command(0);
    send(&command, 1);
    if (count > 0) {
        set_data_command(1);
        send(parameters, count);
    }
    wait_until_idle();
}

static void bytes(void *context, const uint8_t *bytes, size_t count, void (*done)(void *argument), void *argument)
{
    (void)context;
    close_transfer();
    set_data_command(1);
    transfer.next = bytes;
    transfer.end = bytes + count;
    transfer.done = done;
    transfer.argument = argument;
    transfer.open = true;
    feed();
    if (transfer.open) {
        SSI_INTERRUPTS = SSI_INTERRUPT_TX;
    }
}

static void reset(void *context, int level)
{
    (void)context;
    (void)level; /* the line is the processor's own */
}

const el_bus el_lm3s6965_bus = {
    .reset = reset, .command = command, .bytes = bytes, .delay_ms = el_systick_delay_ms, .wait = wait};

void el_lm3s6965_display_start(void)
{
    const uint32_t pins = 1U << 2 | 1U << 3 | 1U << 5;
    GPIO_ALTERNATE(GPIO_A) |= pins;
    GPIO_DIGITAL(GPIO_A) |= pins;
    GPIO_DIRECTION(GPIO_C) |= 1U << DATA_COMMAND_PIN;
    GPIO_DIGITAL(GPIO_C) |= 1U << DATA_COMMAND_PIN;
    GPIO_DIRECTION(GPIO_D) |= 1U << CARD_SELECT_PIN;
    GPIO_DIGITAL(GPIO_D) |= 1U << CARD_SELECT_PIN;
    GPIO_PIN(GPIO_D, CARD_SELECT_PIN) = 1U << CARD_SELECT_PIN;

    /* The SSD0323 takes a bit at each rising edge of a clock of 4 MHz at most (data sheet, "4-wire SPI timing"): the
     * clock rests high, data change at its falling edge, 50 MHz / (2 * 7) = 3.57 MHz. A frame takes 9.2 ms. */
    SSI_CONTROL1 = 0;
    SSI_PRESCALER = 2;
    SSI_CONTROL0 = SSI_CONTROL0_8_BITS | SSI_CONTROL0_IDLE_HIGH | SSI_CONTROL0_SECOND_EDGE | SSI_CONTROL0_RATE(7U);
    SSI_CONTROL1 = SSI_CONTROL1_ENABLE;
    el_core_enable_interrupt(IRQ_SSI0);
}
