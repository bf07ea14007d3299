/* Data watchpoint and trace unit: Armv7-M Architecture Reference Manual, C1.8; DEMCR: C1.6.5. */
#include "cycles.h"

static volatile uint32_t *const demcr = (volatile uint32_t *)0xE000EDFC;
static volatile uint32_t *const dwt_ctrl = (volatile uint32_t *)0xE0001000;
static volatile uint32_t *const dwt_cyccnt = (volatile uint32_t *)0xE0001004;

enum { DEMCR_TRACE_ENABLE = 1 << 24, DWT_CTRL_COUNT_CYCLES = 1 << 0 };

void el_cycles_start(void)
{
    *demcr |= DEMCR_TRACE_ENABLE;
    *dwt_ctrl |= DWT_CTRL_COUNT_CYCLES;
}

uint32_t el_cycles(void *context)
{
    (void)context;
    return *dwt_cyccnt;
}
