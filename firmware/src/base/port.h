/* A byte link to a host (UART, USB serial, pty, TCP) and a clock. A board implements it; the stream calls it. */
#ifndef EL_BASE_PORT_H
#define EL_BASE_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct el_port {
    void *context;
    /* Takes up to `count` bytes and returns how many it took, 0 when it is full now; -1 when the link is gone for good.
     * Never blocks. */
    int32_t (*write)(void *context, const uint8_t *bytes, size_t count);
    /* Puts up to `capacity` received bytes into `bytes` and returns how many, 0 when there are none; -1 when the link
     * is gone for good. Never blocks. */
    int32_t (*read)(void *context, uint8_t *bytes, size_t capacity);
    /* A clock in microseconds that wraps at 2^32. */
    uint32_t (*micros)(void *context);
    /* Called while the stream waits for room or for the host: sleep a little. May be NULL. */
    void (*wait)(void *context);
    /* Cycles of the processor, free running, modulo 2^32. NULL: the board does not count them. */
    uint32_t (*cycles)(void *context);

    /* The rate of a UART, in bits per second. Both or neither: a link without a rate, or with one that stays, has NULL. */

    /* What the link would really have if it were to have `rate`, >= 1: what its divider comes to. Changes nothing. */
    uint32_t (*find_baud)(void *context, uint32_t rate);
    /* Changes to `rate`, as far as its divider goes, if the last bit of all that `write` took has left. False: it has not,
     * and nothing has changed; to be asked again. Never blocks. */
    bool (*set_baud)(void *context, uint32_t rate);
} el_port;

#endif
