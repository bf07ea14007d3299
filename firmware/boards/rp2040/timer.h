/* The RP2040's microsecond timer (4.6), as el_port.micros and el_bus.delay_ms; `context` is not looked at. */
#ifndef EL_BOARDS_RP2040_TIMER_H
#define EL_BOARDS_RP2040_TIMER_H

#include <stdint.h>

uint32_t el_pico_micros(void *context);
void el_pico_delay_ms(void *context, uint32_t ms);

#endif
