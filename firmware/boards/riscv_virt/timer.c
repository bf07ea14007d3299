/* The machine's 64-bit timer as the clock, as the tick that ends every WFI, and as the watchdog, for the machine has no
 * other: it cannot free a processor whose interrupts are off, but it can say where the program hangs. */
#include "board.h"
#include "registers.h"
#include "riscv_virt.h"

enum {
    TICK_PERIOD = MTIME_HZ / 1000,
    WATCHDOG_TICKS = 4000 /* a frame takes 10 to 60 ms, but a busy computer gives QEMU little of its time */
};

static volatile uint32_t ticks_since_fed;

void el_board_feed(void)
{
    ticks_since_fed = 0;
}

static uint64_t now(void)
{
    uint32_t high;
    uint32_t low;
    do {
        high = MTIME_HIGH;
        low = MTIME_LOW;
    } while (high != MTIME_HIGH); /* the low word has wrapped in between */
    return (uint64_t)high << 32 | low;
}

uint32_t el_virt_micros(void)
{
    return (uint32_t)(now() / (MTIME_HZ / 1000000U));
}

/* A tick that comes late delays those after it: nobody counts them as time. */
void el_virt_tick_start(void)
{
    const uint64_t next = now() + TICK_PERIOD;
    MTIMECMP_HIGH = UINT32_MAX; /* so that no value in between is in the past (priv 3.2.1) */
    MTIMECMP_LOW = (uint32_t)next;
    MTIMECMP_HIGH = (uint32_t)(next >> 32);
}

bool el_virt_tick(void)
{
    el_virt_tick_start();
    ticks_since_fed++;
    return ticks_since_fed <= WATCHDOG_TICKS;
}
