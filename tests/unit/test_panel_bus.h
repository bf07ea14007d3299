/* A bus that writes down what it is told, as text that a test can compare whole:
 *
 *   R0 R1        the reset line
 *   d120         a delay in ms
 *   36:48        a command and its parameters
 *   p640         so many 16-bit words; with `panel_bus.shows` 640[F800,...]
 *   b640         so many bytes; the same
 *   w            wait was called
 *
 * Transfers are done at once, or (`defers`) one per wait, at the latest when the next command or transfer needs the wire.
 * A transfer whose memory changes on the way fails the test. */
#ifndef TEST_PANEL_BUS_H
#define TEST_PANEL_BUS_H

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/bus.h"
#include "base/sink.h"
#include "unity.h"

enum { PANEL_BUS_JOURNAL = 65536, PANEL_BUS_BYTES = 1 << 15 };

static struct {
    bool defers;
    bool shows;
    char journal[PANEL_BUS_JOURNAL];
    size_t used;
    const uint8_t *memory; /* of the open transfer; NULL: none is open */
    size_t bytes;
    uint8_t copy[PANEL_BUS_BYTES];
    void (*done)(void *argument);
    void *argument;
} panel_bus;

static inline void panel_bus_note(const char *format, unsigned value)
{
    const int length =
        snprintf(panel_bus.journal + panel_bus.used, sizeof panel_bus.journal - panel_bus.used, format, value);
    panel_bus.used += (size_t)length;
    TEST_ASSERT_LESS_THAN_UINT(sizeof panel_bus.journal, panel_bus.used);
}

static inline void panel_bus_forget(void)
{
    panel_bus.used = 0;
    panel_bus.journal[0] = 0;
}

static inline void panel_bus_expect(const char *journal)
{
    TEST_ASSERT_EQUAL_STRING(journal, panel_bus.journal);
    panel_bus_forget();
}

static inline void panel_bus_complete(void)
{
    if (panel_bus.memory != NULL) {
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(panel_bus.copy, panel_bus.memory, panel_bus.bytes,
                                         "memory changed while it was on the wire");
        panel_bus.memory = NULL;
        panel_bus.done(panel_bus.argument);
    }
}

static inline void panel_bus_reset(void *context, int level)
{
    (void)context;
    panel_bus_note("R%u ", (unsigned)level);
}

static inline void panel_bus_command(void *context, uint8_t command, const uint8_t *parameters, size_t count)
{
    (void)context;
    panel_bus_complete();
    panel_bus_note("%02X", command);
    for (size_t i = 0; i < count; i++) {
        panel_bus_note(i == 0 ? ":%02X" : ",%02X", parameters[i]);
    }
    panel_bus_note(" ", 0);
}

static inline void panel_bus_transfer(const void *memory, size_t bytes, void (*done)(void *argument), void *argument)
{
    TEST_ASSERT_NOT_NULL(memory);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(PANEL_BUS_BYTES, bytes);
    panel_bus.memory = memory;
    panel_bus.bytes = bytes;
    panel_bus.done = done;
    panel_bus.argument = argument;
    memcpy(panel_bus.copy, memory, bytes);
    if (!panel_bus.defers) {
        panel_bus_complete();
    }
}

static inline void panel_bus_pixels(void *context, const uint16_t *words, size_t count, void (*done)(void *argument),
                                    void *argument)
{
    (void)context;
    panel_bus_complete();
    panel_bus_note("p%u", (unsigned)count);
    for (size_t i = 0; i < count && panel_bus.shows; i++) {
        panel_bus_note(i == 0 ? "[%04X" : ",%04X", words[i]);
    }
    panel_bus_note(panel_bus.shows ? "] " : " ", 0);
    panel_bus_transfer(words, 2 * count, done, argument);
}

static inline void panel_bus_send_bytes(void *context, const uint8_t *bytes, size_t count, void (*done)(void *argument),
                                        void *argument)
{
    (void)context;
    panel_bus_complete();
    panel_bus_note("b%u", (unsigned)count);
    for (size_t i = 0; i < count && panel_bus.shows; i++) {
        panel_bus_note(i == 0 ? "[%02X" : ",%02X", bytes[i]);
    }
    panel_bus_note(panel_bus.shows ? "] " : " ", 0);
    panel_bus_transfer(bytes, count, done, argument);
}

static inline void panel_bus_delay(void *context, uint32_t ms)
{
    (void)context;
    panel_bus_note("d%u ", ms);
}

static inline void panel_bus_wait(void *context)
{
    (void)context;
    panel_bus_note("w ", 0);
    panel_bus_complete();
}

static const el_bus panel_bus_functions = {
    .reset = panel_bus_reset,
    .command = panel_bus_command,
    .pixels = panel_bus_pixels,
    .bytes = panel_bus_send_bytes,
    .delay_ms = panel_bus_delay,
    .wait = panel_bus_wait,
};

static inline void panel_bus_start(void)
{
    panel_bus_forget();
    panel_bus.defers = false;
    panel_bus.shows = false;
    panel_bus.memory = NULL;
}

/* Hands a band of `lines` lines at `y` to the sink, as the renderer does. */
static inline void panel_bus_lend(const el_sink *sink, el_band *band, uint16_t *pixels, uint16_t width, uint16_t y,
                                  uint16_t lines, unsigned slot)
{
    *band = (el_band){.pixels = pixels, .width = width, .y = y, .lines = lines};
    band->held[slot] = 1;
    sink->rows(sink->context, band, slot);
}

#endif
