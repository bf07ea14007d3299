/* The RP2040's microsecond timer (4.6), as el_port.micros and el_bus.delay_ms; `context` is not looked at. */
#ifndef EL_BOARDS_RP2040_TIMER_H
#define EL_BOARDS_RP2040_TIMER_H

#include <stdint.h>

/* Called once, with the watchdog's tick running and the timer out of reset. `clock_hz` is clk_sys. */
void el_pico_timer_start(uint32_t clock_hz);

uint32_t el_pico_micros(void *context);
void el_pico_delay_ms(void *context, uint32_t ms);

/* As el_port.cycles: the time in cycles of clk_sys, those of sleep too. The core has no counter of its own but SysTick,
 * whose 24 bits would take an interrupt eight times a second. */
uint32_t el_pico_cycles(void *context);

/* The handler of TIMER_IRQ_0. */
void el_pico_timer_interrupt(void);

#endif
