/* The processor's cycles, counted by the core itself, where it can: Cortex-M3 and larger, whose maker left it in. */
#ifndef EL_BOARDS_CORTEX_M_CYCLES_H
#define EL_BOARDS_CORTEX_M_CYCLES_H

#include <stdint.h>

/* Starts the counter. */
void el_cycles_start(void);

/* As el_port.cycles; `context` is not looked at. Stands still while the core sleeps, and for ever where there is no
 * counter, as in QEMU. */
uint32_t el_cycles(void *context);

#endif
