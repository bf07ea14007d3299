/* Pixels go by DMA while the program draws on; commands, which are few and short, by the processor.
 *
 * The wire has three states that may change only when it is idle, or the display would take a word for something else:
 * chip select, D/C, and the word size. All of them change in one place, `set_wire`, which waits first. Chip select
 * rises and falls before each command, so that a display that lost count of its bits finds the next command again, and
 * around each change of the word size, for which the SPI is disabled: what its clock line does then no display shall
 * count.
 *
 * SPI mode 3, clock high when idle: the displays take it as well as mode 0, and in mode 0 the PL022 holds the clock for
 * a bit's time or more between two words (4.4.3.10 to 4.4.3.13), which mode 3 does not. */
#include "rp2040/display.h"

#include <stdbool.h>

#include "cortex_m/core.h"
#include "rp2040/pins.h"
#include "rp2040/registers.h"
#include "rp2040/timer.h"

enum { MODE_3 = EL_SPI_CR0_SPO | EL_SPI_CR0_SPH };
enum { CPSDVSR = 2 }; /* 125 MHz / 2, the PL022's fastest (4.4.4, SSPCPSR) */

enum {
    DMA_CONTROL = EL_DMA_DREQ_SPI0_TX | EL_DMA_CHAIN_TO_ITSELF | EL_DMA_INCR_READ | EL_DMA_HIGH_PRIORITY | EL_DMA_ENABLE
};

/* The transfer under way. `busy` is set by the program and cleared by the interrupt, which alone reads the rest then.
 * */
static struct {
    volatile bool busy;
    void (*done)(void *argument);
    void *argument;
} transfer;

static struct {
    uint32_t word_size; /* EL_SPI_CR0_..._BITS */
    int dc;             /* its level, or -1: the display is not selected */
} wire;

static void set_pin(unsigned pin, int level)
{
    if (level != 0) {
        EL_SIO->gpio_out_set = 1U << pin;
    } else {
        EL_SIO->gpio_out_clr = 1U << pin;
    }
}

static void wait(void *context)
{
    (void)context;
    el_core_sleep_while(&transfer.busy);
}

/* Needs no bound: the DMA ends by itself, since nothing can hold up an SPI master, and so do the last eight words, in
 * 2 us. */
static void wait_until_idle(void)
{
    while (transfer.busy) {
        wait(NULL);
    }
    while ((EL_SPI0->sr & EL_SPI_SR_BSY) != 0) {
    }
}

/* With the display not selected. The PL022 takes another size only while it is disabled (4.4.3). */
static void set_word_size(uint32_t word_size)
{
    EL_SPI0->cr1 = 0;
    EL_SPI0->cr0 = MODE_3 | word_size;
    EL_SPI0->cr1 = EL_SPI_CR1_SSE;
    wire.word_size = word_size;
}

/* Word size and D/C of what comes next, which the display is selected for. */
static void set_wire(uint32_t word_size, int dc)
{
    if (word_size == wire.word_size && dc == wire.dc) {
        return;
    }
    wait_until_idle();
    if (word_size != wire.word_size) {
        set_pin(EL_PIN_CS, 1);
        set_word_size(word_size);
    }
    set_pin(EL_PIN_DC, dc);
    set_pin(EL_PIN_CS, 0);
    wire.dc = dc;
}

static void send_byte(uint8_t byte)
{
    while ((EL_SPI0->sr & EL_SPI_SR_TNF) == 0) { /* one word's time at most */
    }
    EL_SPI0->dr = byte;
}

static void command(void *context, uint8_t code, const uint8_t *parameters, size_t count)
{
    (void)context;
    wait_until_idle();
    set_pin(EL_PIN_CS, 1);
    wire.dc = -1; /* so that it is selected again, whatever came before */
    set_wire(EL_SPI_CR0_8_BITS, 0);
    send_byte(code);
    if (count > 0) {
        set_wire(EL_SPI_CR0_8_BITS, 1);
    }
    for (size_t i = 0; i < count; i++) {
        send_byte(parameters[i]);
    }
    wait_until_idle();
}

/* Words follow those of the transfer before without a gap: only its DMA has to be over, not the wire idle. */
static void start(const void *from, size_t count, uint32_t dma_size, void (*done)(void *argument), void *argument)
{
    transfer.done = done;
    transfer.argument = argument;
    transfer.busy = true;
    __asm__ volatile("dmb" ::: "memory"); /* the buffer's last pixels are stored before the DMA looks for them */
    EL_DMA_0->read_addr = (uint32_t)(uintptr_t)from;
    EL_DMA_0->trans_count = (uint32_t)count;
    EL_DMA_0->ctrl_trig = DMA_CONTROL | dma_size;
}

static void pixels(void *context, const uint16_t *words, size_t count, void (*done)(void *argument), void *argument)
{
    while (transfer.busy) {
        wait(context);
    }
    set_wire(EL_SPI_CR0_16_BITS, 1);
    start(words, count, EL_DMA_HALFWORDS, done, argument);
}

static void bytes(void *context, const uint8_t *from, size_t count, void (*done)(void *argument), void *argument)
{
    while (transfer.busy) {
        wait(context);
    }
    set_wire(EL_SPI_CR0_8_BITS, 1);
    start(from, count, EL_DMA_BYTES, done, argument);
}

/* All words are in the SPI's queue: the buffer is free, though the wire is not idle for another 2 us. */
void el_pico_display_interrupt(void)
{
    *EL_DMA_INTS0 = 1U << 0;
    transfer.busy = false;
    transfer.done(transfer.argument);
}

static void reset(void *context, int level)
{
    (void)context;
    wait_until_idle();
    set_pin(EL_PIN_RESET, level);
}

static void make_output(unsigned pin, int level)
{
    set_pin(pin, level);
    EL_SIO->gpio_oe_set = 1U << pin;
    *EL_GPIO_CTRL(pin) = EL_FUNCTION_SIO;
}

const el_bus *el_pico_display_start(void)
{
    static const el_bus bus = {.reset = reset,
                               .command = command,
                               .pixels = pixels,
                               .bytes = bytes,
                               .delay_ms = el_pico_delay_ms,
                               .wait = wait};
    make_output(EL_PIN_CS, 1);
    make_output(EL_PIN_DC, 1);
    make_output(EL_PIN_RESET, 1);
    make_output(EL_PIN_BACKLIGHT, 1);

    EL_SPI0->cpsr = CPSDVSR;
    EL_SPI0->dmacr = EL_SPI_DMACR_TXDMAE;
    set_word_size(EL_SPI_CR0_8_BITS);
    wire.dc = -1;
    /* Edges of 62.5 MHz need more than the 4 mA that a pad has after reset (2.19.4). The clock idles high before its
     * pin shows it. */
    *EL_PAD(EL_PIN_SCK) = EL_PAD_8_MA | EL_PAD_FAST | EL_PAD_INPUT;
    *EL_PAD(EL_PIN_TX) = EL_PAD_8_MA | EL_PAD_FAST | EL_PAD_INPUT;
    *EL_GPIO_CTRL(EL_PIN_SCK) = EL_FUNCTION_SPI;
    *EL_GPIO_CTRL(EL_PIN_TX) = EL_FUNCTION_SPI;

    EL_DMA_0->write_addr = (uint32_t)(uintptr_t)&EL_SPI0->dr;
    *EL_DMA_INTE0 = 1U << 0;
    el_core_enable_interrupt(EL_IRQ_DMA_0);
    return &bus;
}
