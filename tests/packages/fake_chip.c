/* The hardware below chip.h of PORTING.md, as strict as a real one: an SPI with a queue of four words, a DMA, a UART with
 * queues of 16 bytes, and interrupts that come when they are on.
 *
 * All moves together, a step for each look at the hardware: the DMA fills the queue, one word leaves the wire. D/C is
 * sampled when a word leaves, as a display samples it, so a port that changes it too early is seen. What leaves goes into
 * a wire trace (sim/wire_trace.h) that FAKE_CHIP_TRACE names; the run ends with the third memory write, two frames after
 * the start. The UART is standard input and output; with FAKE_CHIP_UART_DEAD set it never has room. */
#include <stdio.h>
#include <stdlib.h>

#include "base/bus.h"
#include "base/port.h"
#include "chip.h"
#include "wire_record.h"

enum { SPI_QUEUE = 4, UART_QUEUE = 16, STEP_NS = 1000, TICK_STEPS = 1000, MEMORY_WRITE = 0x2C, MEMORY_WRITES = 3 };

static FILE *trace;
static uint32_t unwritten_ns;
static uint32_t steps;
static uint32_t interrupts_are_off;
static bool in_interrupt;
static unsigned served; /* interrupts */

static uint16_t spi_queue[SPI_QUEUE];
static unsigned spi_used;
static unsigned spi_bits = 8;
static int data_command;
static int deselected = 1;
static unsigned memory_writes;

static const uint8_t *dma_next;
static size_t dma_left;
static bool dma_ended;

static uint8_t uart_queue[UART_QUEUE];
static unsigned uart_used;
static int uart_received = EOF;
static bool uart_wants_room;

static void fail(const char *what)
{
    fprintf(stderr, "fake chip: %s\n", what);
    exit(1);
}

static void record(int kind, int value)
{
    if (trace == NULL) {
        return;
    }
    write_record(trace, unwritten_ns, kind, value);
    unwritten_ns = 0;
}

static void leave_wire(unsigned byte)
{
    if (deselected) {
        fail("a byte on the wire while the display is not selected");
    }
    record(data_command != 0 ? TRACE_DATA : TRACE_COMMAND, (int)byte);
    if (data_command == 0 && byte == MEMORY_WRITE && ++memory_writes == MEMORY_WRITES) {
        exit(fclose(trace) == 0 ? 0 : 1);
    }
}

static void move_spi(void)
{
    const unsigned bytes = spi_bits / 8;
    while (dma_left > 0 && spi_used < SPI_QUEUE) {
        spi_queue[spi_used++] = bytes == 2 ? *(const uint16_t *)(const void *)dma_next : *dma_next;
        dma_next += bytes;
        dma_ended = --dma_left == 0;
    }
    if (spi_used == 0) {
        return;
    }
    const uint16_t word = spi_queue[0];
    for (unsigned i = 1; i < spi_used; i++) {
        spi_queue[i - 1] = spi_queue[i];
    }
    spi_used--;
    if (bytes == 2) {
        leave_wire(word >> 8);
    }
    leave_wire(word & 255U);
}

static void move_uart(void)
{
    if (uart_used > 0 && getenv("FAKE_CHIP_UART_DEAD") == NULL) {
        putchar(uart_queue[0]);
        uart_used--;
        for (unsigned i = 0; i < uart_used; i++) {
            uart_queue[i] = uart_queue[i + 1];
        }
    }
}

static bool interrupt_pending(void)
{
    return dma_ended || uart_received != EOF || (uart_wants_room && uart_used < UART_QUEUE);
}

static void serve_interrupts(void)
{
    if (interrupts_are_off != 0 || in_interrupt || !interrupt_pending()) {
        return;
    }
    served++;
    in_interrupt = true;
    if (dma_ended) {
        dma_ended = false;
        board_dma_ended();
    }
    if (interrupt_pending()) {
        board_uart_interrupt();
    }
    in_interrupt = false;
}

static void step(void)
{
    steps++;
    unwritten_ns += STEP_NS;
    move_spi();
    move_uart();
    if (uart_received == EOF && !in_interrupt && steps % 4 == 0) {
        uart_received = getchar();
    }
    serve_interrupts();
}

void chip_start(void)
{
    const char *const path = getenv("FAKE_CHIP_TRACE");
    if (path != NULL) {
        trace = fopen(path, "wb");
        if (trace == NULL) {
            fail("cannot write the trace");
        }
        fputs("HOT1", trace);
    }
}

/* Begins close to its wrap. */
uint32_t chip_micros(void)
{
    step();
    return 0xFFFFFF00U + steps;
}

uint32_t chip_interrupts_off(void)
{
    const uint32_t before = interrupts_are_off;
    interrupts_are_off = 1;
    return before;
}

void chip_interrupts_restore(uint32_t state)
{
    interrupts_are_off = state;
    serve_interrupts();
}

void chip_sleep(void)
{
    const unsigned served_before = served;
    do {
        step();
    } while (served == served_before && !interrupt_pending() && steps % TICK_STEPS != 0);
}

void chip_pin_reset(int level)
{
    record(TRACE_RESET, level);
}

void chip_pin_dc(int level)
{
    data_command = level;
}

void chip_pin_select(int level)
{
    deselected = level;
}

bool chip_spi_has_room(void)
{
    step();
    return spi_used < SPI_QUEUE;
}

void chip_spi_put(uint8_t byte)
{
    if (spi_used == SPI_QUEUE) {
        fail("a byte for a full SPI queue");
    }
    if (dma_left > 0) {
        fail("a byte in the middle of a DMA transfer");
    }
    spi_queue[spi_used++] = byte;
}

bool chip_spi_is_busy(void)
{
    step();
    return spi_used > 0 || dma_left > 0;
}

void chip_spi_set_word(unsigned bits)
{
    if (spi_used > 0 || dma_left > 0) {
        fail("the word size changed on a busy wire");
    }
    spi_bits = bits;
}

void chip_dma_start(const void *memory, size_t words)
{
    if (dma_left > 0 || dma_ended) {
        fail("a second DMA transfer before the end of the first");
    }
    dma_next = memory;
    dma_left = words;
}

bool chip_uart_has_room(void)
{
    if (!in_interrupt) {
        step();
    }
    return uart_used < UART_QUEUE;
}

void chip_uart_put(uint8_t byte)
{
    if (uart_used == UART_QUEUE) {
        fail("a byte for a full UART queue");
    }
    uart_queue[uart_used++] = byte;
}

bool chip_uart_has_byte(void)
{
    return uart_received != EOF;
}

uint8_t chip_uart_get(void)
{
    const int byte = uart_received;
    if (byte == EOF) {
        fail("a byte of an empty UART queue");
    }
    uart_received = EOF;
    return (uint8_t)byte;
}

void chip_uart_want_room(bool on)
{
    uart_wants_room = on;
}

uint32_t chip_boot_id(void)
{
    return 1;
}

void chip_feed_watchdog(void)
{
}

_Noreturn void chip_restart(void)
{
    while (uart_used > 0) {
        move_uart();
    }
    exit(fflush(stdout) == 0 ? 0 : 1);
}
