/* Arm's UART PL011 (Arm DDI 0183, chapter 3), as two rings between the program and its interrupt, so that neither side
 * waits for the other. RP2040 and Stellaris have it; pins, clocks and the NVIC are the board's. */
#ifndef EL_BOARDS_ARM_PL011_H
#define EL_BOARDS_ARM_PL011_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ring.h"

typedef struct el_pl011_registers {
    volatile uint32_t dr, rsr, unused_08[4], fr, unused_1c, ilpr, ibrd, fbrd, lcr_h, cr, ifls, imsc, ris, mis, icr;
} el_pl011_registers;

/* The board gives one, set up but for what el_pl011_start writes. */
typedef struct el_pl011 {
    el_pl011_registers *registers;
    uint32_t clock_hz;    /* the UART's, 536 MHz at most; el_pl011_start notes it */
    uint32_t panic_polls; /* of 7 cycles and more, for 100 ms; a byte at 115,200 baud takes 87 us */
    el_ring tx;           /* by EL_RING */
    el_ring rx;
} el_pl011;

/* 8 bits, no parity, one stop bit. The interrupt at the NVIC is the caller's to enable. */
void el_pl011_start(el_pl011 *uart, uint32_t clock_hz, uint32_t baud);

/* To be called by its interrupt. */
void el_pl011_interrupt(el_pl011 *uart);

/* As el_port.write and el_port.read; `uart` is the port's context. */
int32_t el_pl011_write(void *uart, const uint8_t *bytes, size_t count);
int32_t el_pl011_read(void *uart, uint8_t *bytes, size_t capacity);

/* As el_port.find_baud and el_port.set_baud. */
uint32_t el_pl011_find_baud(void *uart, uint32_t rate);
bool el_pl011_set_baud(void *uart, uint32_t rate);

/* As el_board_panic_write. Returns when the last bit is out, so that a restart does not cut it off. */
void el_pl011_panic_write(const el_pl011 *uart, const uint8_t *bytes, size_t count);

#endif
