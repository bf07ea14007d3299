/* Registers: Armv7-M Architecture Reference Manual, B3.3 (Armv6-M: B3.3 too). */
#include "systick.h"

#include "start.h"

typedef struct systick_registers {
    volatile uint32_t control; /* SYST_CSR */
    volatile uint32_t reload;  /* SYST_RVR, 24 bits */
    volatile uint32_t current; /* SYST_CVR: counts down to 0, then from reload again */
} systick_registers;

static systick_registers *const systick = (systick_registers *)0xE000E010;

enum { CONTROL_ENABLE = 1U << 0, CONTROL_INTERRUPT = 1U << 1, CONTROL_PROCESSOR_CLOCK = 1U << 2 };

static volatile uint32_t milliseconds; /* modulo 2^32 */
static uint32_t ticks_per_us;
static uint32_t last_us; /* what el_systick_micros said last */

void el_systick_entry(void)
{
    milliseconds = milliseconds + 1U;
}

void el_systick_start(uint32_t clock_hz)
{
    ticks_per_us = clock_hz / 1000000U;
    systick->reload = ticks_per_us * 1000U - 1U;
    systick->current = 0; /* any value written clears it */
    systick->control = CONTROL_ENABLE | CONTROL_INTERRUPT | CONTROL_PROCESSOR_CLOCK;
}

uint32_t el_systick_micros(void *context)
{
    (void)context;
    uint32_t whole_ms;
    uint32_t ticks;
    do {
        whole_ms = milliseconds;
        ticks = systick->reload - systick->current;
    } while (whole_ms != milliseconds);
    /* Where the interrupt is late (in an emulator by some microseconds) the counter is in its next millisecond and the
     * count is not: time stands still then, but never runs back. More than that millisecond is no lateness, but half an
     * hour in which nobody asked. */
    const uint32_t now_us = whole_ms * 1000U + ticks / ticks_per_us;
    if (last_us - now_us > 1000U) {
        last_us = now_us;
    }
    return last_us;
}

void el_systick_wait(void *context)
{
    (void)context;
    __asm__ volatile("wfi");
}

void el_systick_delay_ms(void *context, uint32_t ms)
{
    const uint32_t begin = milliseconds;
    while (milliseconds - begin <= ms) { /* one more, because the first one has begun already */
        el_systick_wait(context);
    }
}
