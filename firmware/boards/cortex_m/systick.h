/* Time from the core's own timer, for boards without a better one: every Cortex-M has it, and so has every emulator. */
#ifndef EL_BOARDS_CORTEX_M_SYSTICK_H
#define EL_BOARDS_CORTEX_M_SYSTICK_H

#include <stdint.h>

/* Starts the timer, with an interrupt each millisecond. `clock_hz` is the processor's, whole megahertz up to 999. */
void el_systick_start(uint32_t clock_hz);

/* As el_port.micros and el_bus.delay_ms; `context` is not looked at. Not in interrupts, nor with interrupts off: a
 * millisecond that is not counted yet would be missing. */
uint32_t el_systick_micros(void *context);
void el_systick_delay_ms(void *context, uint32_t ms);

/* As el_port.wait: sleeps until an interrupt, the timer's own at the latest. */
void el_systick_wait(void *context);

#endif
