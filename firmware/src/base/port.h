/* A byte link to a host (UART, USB serial, pty, TCP) and a clock. A board implements it; the stream calls it. */
#ifndef EL_BASE_PORT_H
#define EL_BASE_PORT_H

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
} el_port;

#endif
