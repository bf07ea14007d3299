/* What a board gives a program: the wire to its display, the link to a host, and a way to speak when all is lost.
 *
 * Each folder beside this file that has a linker script implements these functions for one board, bus.h and port.h
 * among them; programs in firmware/apps use nothing else of it. Parts that several chips have are in folders of their
 * own. */
#ifndef EL_BOARDS_BOARD_H
#define EL_BOARDS_BOARD_H

#include <stddef.h>
#include <stdint.h>

#include "base/bus.h"
#include "base/port.h"

typedef struct el_board {
    const char *name;    /* as HELLO tells it */
    const el_bus *bus;   /* the display's wire; NULL where there is none */
    const el_port *port; /* the host's link; NULL where there is none */
    uint32_t baud;       /* its rate at the start, 0 where it has none */
    uint32_t max_baud;   /* its highest rate, the same */
    uint32_t boot_id;    /* another one after each start, as far as the chip can */
} el_board;

/* Starts clocks, pins, bus and port; called once, first. What it returns stays. */
const el_board *el_board_start(void);

/* Tells the hardware watchdog, where the board has started one, that the program is well. */
void el_board_feed(void);

/* Sends bytes to the host by polling, whatever state interrupts, DMA and the port are in; for fault reports. Gives up
 * when the link takes nothing for 100 ms. */
void el_board_panic_write(const uint8_t *bytes, size_t count);

/* Starts the board anew; where the chip cannot, stops here. */
_Noreturn void el_board_restart(void);

/* The program gives it: its name and version, as HELLO tells it, at most 64 bytes. Reports of failures end in it, where
 * there is one. */
extern const char el_firmware_name[];

#endif
