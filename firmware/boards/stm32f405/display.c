/* The display's wire: SPI1, pixels and longer bytes by DMA2, and three pins.
 *
 * One transfer is open at a time. Its end is the DMA's: then its memory is the caller's again, while the last word or
 * two still leave the SPI. So D/C, chip select and the word size change after `wait_idle` alone, and bands that follow
 * each other change none of them. */
#include <stdbool.h>

#include "cortex_m/core.h"
#include "cortex_m/systick.h"
#include "registers.h"
#include "stm32f405.h"

/* Pins of port A (WIRING.md). */
enum { PIN_RESET = 2, PIN_DC = 3, PIN_CS = 4, PIN_SCK = 5, PIN_MOSI = 7 };

/* Mode 0, most significant bit first, half of 84 MHz: 42 MHz, the SPI's most (DS8626, 5.3.19). It sends alone, so what
 * the display might say cannot overrun a receiver that nobody reads. */
#define CONTROL (SPI_CR1_MASTER | SPI_CR1_SELECTED | SPI_CR1_TRANSMIT_ONLY | SPI_CR1_ENABLE)

/* SPI1_TX is channel 3 of stream 3 (RM0090, table 43). */
#define STREAM (DMA2_S3CR_CHANNEL(3U) | DMA2_S3CR_NEXT_ADDRESS | DMA2_S3CR_TO_PERIPHERAL | DMA2_S3CR_COMPLETE_INTERRUPT)

enum {
    WORD_POLLS = 1000,  /* a word takes 64 cycles of the core */
    STALLED_US = 100000 /* the DMA moves a word each microsecond at least */
};

typedef struct transfer {
    volatile bool open;
    const uint8_t *next; /* what the DMA has not been given yet */
    size_t words_left;   /* the same, in words */
    uint32_t dma_left;   /* words of its piece that it had not fetched when it was looked at last */
    uint32_t moved_us;   /* when that had changed */
    void (*done)(void *argument);
    void *argument;
} transfer;

static transfer current;
static uint8_t word_bytes; /* of the wire as it is set up: 1 or 2 */
static bool dma_is_dead;

static void set_pin(unsigned pin, int level)
{
    GPIOA_BSRR = 1U << (level != 0 ? pin : pin + 16U);
}

static void wait_for(uint32_t flag, uint32_t state)
{
    for (uint32_t polls = 0; polls < WORD_POLLS && (SPI1_SR & flag) != state; polls++) {
    }
}

static void wait_idle(void)
{
    /* In this order: the SPI may be idle for a moment while a word waits (RM0090, 28.3.7). */
    wait_for(SPI_SR_TX_EMPTY, SPI_SR_TX_EMPTY);
    wait_for(SPI_SR_BUSY, 0);
}

/* Makes the wire ready for words of that size. Chip select goes up for longer than the 40 ns that controllers ask for,
 * because the SPI is set up meanwhile: a display that lost count of the bits begins anew. While the SPI is off it lets
 * go of its pins, which the display does not look at then. */
static void begin_words(uint8_t bytes, int dc)
{
    const uint32_t control = CONTROL | (bytes == 2 ? SPI_CR1_16_BITS : 0U);
    wait_idle();
    set_pin(PIN_CS, 1);
    SPI1_CR1 &= ~SPI_CR1_ENABLE; /* the word size changes while it is off, and at no other time (28.5.1) */
    SPI1_CR2 = 0;
    SPI1_CR1 = control & ~SPI_CR1_ENABLE;
    SPI1_CR1 = control;
    set_pin(PIN_DC, dc);
    set_pin(PIN_CS, 0);
    word_bytes = bytes;
}

static void put_words(const uint8_t *next, size_t words)
{
    for (size_t i = 0; i < words; i++) {
        wait_for(SPI_SR_TX_EMPTY, SPI_SR_TX_EMPTY);
        SPI1_DR = word_bytes == 2 ? ((const uint16_t *)(const void *)next)[i] : next[i];
    }
}

/* --- Transfers ---------------------------------------------------------------------------------------------------- */

static void give_dma_a_piece(void)
{
    const size_t words = current.words_left < DMA_MAX_WORDS ? current.words_left : DMA_MAX_WORDS;
    const uint32_t control = STREAM | (word_bytes == 2 ? DMA2_S3CR_16_BITS : 0U);
    DMA2_S3CR = control;
    DMA2_S3PAR = (uint32_t)(uintptr_t)&SPI1_DR;
    DMA2_S3M0AR = (uint32_t)(uintptr_t)current.next;
    DMA2_S3NDTR = (uint32_t)words;
    current.next += words * word_bytes;
    current.words_left -= words;
    __asm__ volatile("dsb" ::: "memory"); /* the pixels are in memory before the DMA looks */
    DMA2_S3CR = control | DMA2_S3CR_ENABLE;
}

static void close_transfer(void)
{
    current.open = false;
    current.done(current.argument);
}

void el_stm32f405_dma2_stream3_entry(void)
{
    DMA2_LIFCR = DMA2_LIFCR_STREAM_3;
    if (current.words_left != 0) {
        give_dma_a_piece();
    } else {
        close_transfer();
    }
}

/* It stands still: no known chip does that, emulators without a DMA do. The processor sends the rest, and all that
 * follows. */
static void give_dma_up(void)
{
    el_core_disable_interrupt(IRQ_DMA2_STREAM_3);
    dma_is_dead = true;
    if (current.open) { /* its end has not come at the last moment */
        DMA2_S3CR = 0;
        SPI1_CR2 = 0;
        const uint32_t unsent = DMA2_S3NDTR;
        put_words(current.next - unsent * word_bytes, unsent + current.words_left);
        close_transfer();
    }
}

static void wait(void *context)
{
    (void)context;
    el_core_sleep_while(&current.open); /* SysTick ends it within a millisecond */

    const uint32_t now_us = el_systick_micros(NULL);
    const uint32_t dma_left = DMA2_S3NDTR;
    if (dma_left != current.dma_left) {
        current.dma_left = dma_left;
        current.moved_us = now_us;
    } else if (current.open && now_us - current.moved_us >= STALLED_US) {
        give_dma_up();
    }
}

static void finish(void)
{
    while (current.open) {
        wait(NULL);
    }
}

/* --- The bus ------------------------------------------------------------------------------------------------------ */

static void reset(void *context, int level)
{
    (void)context;
    finish();
    set_pin(PIN_RESET, level);
}

static void command(void *context, uint8_t command, const uint8_t *parameters, size_t count)
{
    (void)context;
    finish();
    begin_words(1, 0);
    put_words(&command, 1);
    wait_idle();
    set_pin(PIN_DC, 1);
    put_words(parameters, count);
    wait_idle();
}

static void send(const void *memory, size_t words, uint8_t bytes, void (*done)(void *argument), void *argument)
{
    finish();
    if (word_bytes != bytes) {
        begin_words(bytes, 1);
    }
    if (dma_is_dead || words == 0) {
        put_words(memory, words);
        done(argument);
        return;
    }
    current = (transfer){.open = true,
                         .next = memory,
                         .words_left = words,
                         .moved_us = el_systick_micros(NULL),
                         .done = done,
                         .argument = argument};
    give_dma_a_piece();
    SPI1_CR2 = SPI_CR2_TX_DMA; /* last, as 28.3.9 has it */
}

static void pixels(void *context, const uint16_t *words, size_t count, void (*done)(void *argument), void *argument)
{
    (void)context;
    send(words, count, 2, done, argument);
}

static void bytes(void *context, const uint8_t *bytes, size_t count, void (*done)(void *argument), void *argument)
{
    (void)context;
    send(bytes, count, 1, done, argument);
}

const el_bus el_stm32f405_bus = {.reset = reset,
                                 .command = command,
                                 .pixels = pixels,
                                 .bytes = bytes,
                                 .delay_ms = el_systick_delay_ms,
                                 .wait = wait};

void el_stm32f405_display_start(void)
{
    enum { FUNCTION_SPI1 = 5 }; /* DS8626, table 9 */
    const uint32_t outputs = GPIO_OUTPUT << 2 * PIN_RESET | GPIO_OUTPUT << 2 * PIN_DC | GPIO_OUTPUT << 2 * PIN_CS;
    set_pin(PIN_CS, 1);
    set_pin(PIN_RESET, 1);
    GPIOA_AFRL |= FUNCTION_SPI1 << 4 * PIN_SCK | FUNCTION_SPI1 << 4 * PIN_MOSI;
    /* At a pin's slowest an edge takes up to 100 ns: chip select would fall, and D/C change, after the first bits. */
    GPIOA_OSPEEDR |= GPIO_50_MHZ << 2 * PIN_SCK | GPIO_50_MHZ << 2 * PIN_MOSI | GPIO_50_MHZ << 2 * PIN_CS |
                     GPIO_50_MHZ << 2 * PIN_DC;
    GPIOA_PUPDR |= GPIO_PULL_DOWN << 2 * PIN_SCK; /* low while the SPI is off, as it is between words */
    GPIOA_MODER |= outputs | GPIO_ALTERNATE << 2 * PIN_SCK | GPIO_ALTERNATE << 2 * PIN_MOSI;
    begin_words(1, 1);
    el_core_enable_interrupt(IRQ_DMA2_STREAM_3);
}
