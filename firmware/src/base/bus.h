/* The wire to a display controller: SPI words, and the D/C line that tells commands from data.
 *
 * A board implements these functions; panel drivers call nothing else. D/C and the word size change only when the bus
 * is idle: that is the implementation's duty, so that no panel driver can get it wrong. */
#ifndef EL_BASE_BUS_H
#define EL_BASE_BUS_H

#include <stddef.h>
#include <stdint.h>

typedef struct el_bus {
    void *context;
    /* Drives the controller's reset line: 0 holds it in reset. */
    void (*reset)(void *context, int level);
    /* Sends one command byte with D/C low, then `count` parameter bytes with D/C high. Returns when all is sent; the
     * bytes of `parameters` are the caller's again then. */
    void (*command)(void *context, uint8_t command, const uint8_t *parameters, size_t count);
    /* Sends `count` 16-bit words with D/C high, most significant byte first, and returns at once or when they are sent.
     * `words` must not change until `done(argument)` was called, exactly once, possibly from an interrupt, possibly
     * before this function returns. At most one transfer is open: a second call, of bytes too, waits for the first.
     * NULL where the bus has no 16-bit words: panel drivers then send bytes. */
    void (*pixels)(void *context, const uint16_t *words, size_t count, void (*done)(void *argument), void *argument);
    /* The same for bytes, in the order in which they lie in memory. */
    void (*bytes)(void *context, const uint8_t *bytes, size_t count, void (*done)(void *argument), void *argument);
    /* Returns after at least this many milliseconds. */
    void (*delay_ms)(void *context, uint32_t ms);
    /* Called while somebody waits for `done`: sleep until an interrupt, or drive the transfer. May be NULL. */
    void (*wait)(void *context);
} el_bus;

#endif
