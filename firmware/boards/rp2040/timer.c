/* Time, and sleep until alarm 0 while a display wants to be waited for: a quarter of a second after each start. */
#include "rp2040/timer.h"

#include <stdbool.h>

#include "cortex_m/core.h"
#include "rp2040/registers.h"

static volatile bool waiting;
static uint32_t cycles_per_us;

uint32_t el_pico_micros(void *context)
{
    (void)context;
    return EL_TIMER->timerawl;
}

uint32_t el_pico_cycles(void *context)
{
    return el_pico_micros(context) * cycles_per_us;
}

void el_pico_timer_interrupt(void)
{
    EL_TIMER->intr = 1U << 0;
    waiting = false;
}

/* The alarm rings when the clock is equal to it, so that one which is past when it is set would ring in an hour. That
 * takes a handler that runs for a millisecond; here none does. */
void el_pico_delay_ms(void *context, uint32_t ms)
{
    waiting = true;
    EL_TIMER->alarm[0] = el_pico_micros(context) + (ms + 1U) * 1000U; /* one more: the first one has begun already */
    while (waiting) {
        el_core_sleep_while(&waiting);
    }
}

void el_pico_timer_start(uint32_t clock_hz)
{
    cycles_per_us = clock_hz / 1000000U;
    EL_TIMER->inte = 1U << 0;
    el_core_enable_interrupt(EL_IRQ_TIMER_0);
}
