/* The board as a whole: clocks, watchdog, interrupt vectors. */
#include "lm3s6965.h"

#include "cortex_m/cycles.h"
#include "cortex_m/start.h"
#include "cortex_m/systick.h"
#include "registers.h"

enum { PLL_HZ = 50000000, INTERNAL_HZ = 12000000, WATCHDOG_S = 4 };

/* Another one after each start: RAM keeps what it holds over a reset, and holds anything after power-up. */
__attribute__((section(".noinit"))) static uint32_t starts;

/* The others are never enabled. */
__attribute__((section(".vectors.irq"), used)) static const el_vector irq_vectors[] = {
    [IRQ_UART0] = el_lm3s6965_uart0_entry,
    [IRQ_SSI0] = el_lm3s6965_ssi0_entry,
};

/* 50 MHz: the PLL's 200 MHz from the 8 MHz crystal, divided by 4, in the order of the data sheet's section
 * "Initialization and Configuration" of System Control. Returns the clock: where the PLL does not lock, that of the
 * internal oscillator, +-30%, with which the display works and the UART does not. */
static uint32_t start_clock(void)
{
    enum { LOCK_POLLS = 100000 }; /* it takes 0.5 ms; these are 25 ms and more */
    uint32_t rcc = (SYSCTL_RCC | RCC_BYPASS) & ~RCC_USE_DIVIDER;
    SYSCTL_RCC = rcc;
    rcc &= ~(RCC_MAIN_OSCILLATOR_OFF | RCC_CRYSTAL_MASK | RCC_SOURCE_MASK | RCC_PLL_OFF | RCC_DIVIDER_MASK);
    rcc |= RCC_CRYSTAL_8MHZ | RCC_SOURCE_MAIN;
    SYSCTL_RCC = rcc;
    rcc |= RCC_DIVIDE_BY_4 | RCC_USE_DIVIDER;
    SYSCTL_RCC = rcc;
    for (uint32_t polls = 0; polls < LOCK_POLLS; polls++) {
        if ((SYSCTL_RIS & RIS_PLL_LOCKED) != 0) {
            SYSCTL_RCC = rcc & ~RCC_BYPASS;
            return PLL_HZ;
        }
    }
    SYSCTL_RCC = (rcc & ~RCC_USE_DIVIDER) | RCC_SOURCE_INTERNAL;
    return INTERNAL_HZ;
}

static void start_watchdog(uint32_t clock_hz)
{
    WATCHDOG_LOAD = clock_hz * WATCHDOG_S; /* it bites when it has run down twice */
    WATCHDOG_CONTROL = WATCHDOG_CONTROL_RESET | WATCHDOG_CONTROL_START;
}

const el_board *el_board_start(void)
{
    static el_board board = {.name = "LM3S6965 evaluation board",
                             .bus = &el_lm3s6965_bus,
                             .port = &el_lm3s6965_port,
                             .baud = EL_LM3S6965_BAUD,
                             .max_baud = EL_LM3S6965_MAX_BAUD};
    const uint32_t clock_hz = start_clock();
    SYSCTL_RCGC0 |= RCGC0_WATCHDOG;
    SYSCTL_RCGC1 |= RCGC1_UART0 | RCGC1_SSI0;
    SYSCTL_RCGC2 |= RCGC2_PORT_A | RCGC2_PORT_C | RCGC2_PORT_D;
    (void)SYSCTL_RCGC2; /* a part may be touched three clocks after it got its own */
    (void)SYSCTL_RCGC2;
    el_systick_start(clock_hz);
    el_cycles_start();
    el_lm3s6965_uart_start(clock_hz);
    el_lm3s6965_display_start();
    start_watchdog(clock_hz);
    board.boot_id = ++starts;
    return &board;
}

void el_board_feed(void)
{
    WATCHDOG_CLEAR = 1; /* any value: counts from the top again */
}
