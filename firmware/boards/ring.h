/* A queue of bytes between a program and an interrupt: one side puts, the other takes, neither locks.
 *
 * Each index has one writer, and a byte is in its place before the index says so. That suffices on one core, whose
 * interrupts see its stores in order; what has to be kept from changing the order is the compiler alone. */
#ifndef EL_BOARDS_RING_H
#define EL_BOARDS_RING_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

/* EL_RING gives an empty one. */
typedef struct el_ring {
    uint8_t *bytes;          /* mask + 1 of them */
    uint16_t mask;           /* 2^n - 1, at most 32767 */
    volatile uint16_t put;   /* bytes ever put, modulo 2^16: the putting side's */
    volatile uint16_t taken; /* the taking side's */
} el_ring;

/* Initialises an el_ring with an array of bytes. For another size than 2^n it divides by 0, which no constant may. */
#define EL_RING(array)                                                                                                 \
    {                                                                                                                  \
        .bytes = (array), .mask = (sizeof(array) - 1) / ((sizeof(array) & (sizeof(array) - 1)) == 0)                   \
    }

static inline uint16_t el_ring_used(const el_ring *ring)
{
    return (uint16_t)(ring->put - ring->taken);
}

/* Puts up to `count` bytes and returns how many there was room for. */
static inline size_t el_ring_put(el_ring *ring, const uint8_t *bytes, size_t count)
{
    const uint16_t put = ring->put;
    const size_t room = (size_t)ring->mask + 1U - el_ring_used(ring);
    const size_t fitting = count < room ? count : room;
    for (size_t i = 0; i < fitting; i++) {
        ring->bytes[(put + i) & ring->mask] = bytes[i];
    }
    atomic_signal_fence(memory_order_release);
    ring->put = (uint16_t)(put + fitting);
    return fitting;
}

/* Takes up to `capacity` bytes and returns how many there were. */
static inline size_t el_ring_take(el_ring *ring, uint8_t *bytes, size_t capacity)
{
    const uint16_t taken = ring->taken;
    const size_t used = el_ring_used(ring);
    const size_t fitting = capacity < used ? capacity : used;
    atomic_signal_fence(memory_order_acquire);
    for (size_t i = 0; i < fitting; i++) {
        bytes[i] = ring->bytes[(taken + i) & ring->mask];
    }
    atomic_signal_fence(memory_order_release);
    ring->taken = (uint16_t)(taken + fitting);
    return fitting;
}

#endif
