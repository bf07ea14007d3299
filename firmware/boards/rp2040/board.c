/* The Raspberry Pi Pico: resets, the watchdog, and the table of interrupts. The display's wire is display.c, the host's
 * link is link.c; all pins are in pins.h. */
#include "board.h"

#include "cortex_m/start.h"
#include "rp2040/clocks.h"
#include "rp2040/display.h"
#include "rp2040/link.h"
#include "rp2040/registers.h"
#include "rp2040/timer.h"

enum {
    /* 8 s, nearly the longest: the benchmark's S3 takes 2.2 s for a frame. In half microseconds, because the watchdog
     * counts twice per tick (erratum RP2040-E1). */
    WATCHDOG_HALF_US = 8 * 2000000
};
_Static_assert(WATCHDOG_HALF_US < 1 << 24, "the watchdog counts 24 bits");

static void start_watchdog(void)
{
    EL_PSM->wdsel = EL_PSM_ALL_BUT_OSCILLATORS;
    el_board_feed();
    EL_WATCHDOG->ctrl = EL_WATCHDOG_ENABLE | EL_WATCHDOG_PAUSE_IN_DEBUGGER;
}

/* Noise of the ring oscillator, which runs beside the crystal (2.17.5): each bit of the id is made of eight. Without
 * the crystal it is no noise, and a host may take this start for the one before. */
static uint32_t make_boot_id(void)
{
    uint32_t id = 0;
    for (int i = 0; i < 8 * 32; i++) {
        id = (id << 1 | id >> 31) ^ (*EL_ROSC_RANDOMBIT & 1U);
    }
    return id;
}

/* What HELLO says of a board whose clocks are not what they should be, as far as its UART is heard at all. */
static const char *name_at(uint32_t clock_hz)
{
    switch (clock_hz) {
    case EL_PICO_CLOCK_HZ:
        return "Raspberry Pi Pico";
    case EL_PICO_CRYSTAL_HZ:
        return "Raspberry Pi Pico (slow: its PLL does not lock)";
    default:
        return "Raspberry Pi Pico (slow: its crystal does not swing)";
    }
}

const el_board *el_board_start(void)
{
    static el_board board = {.baud = EL_PICO_BAUD, .max_baud = EL_PICO_MAX_BAUD};
    const uint32_t clock_hz = el_pico_clocks_start();
    el_pico_release(EL_RESET_IO_BANK0 | EL_RESET_PADS_BANK0 | EL_RESET_TIMER | EL_RESET_DMA | EL_RESET_SPI0 |
                    EL_RESET_UART0);
    el_pico_timer_start(clock_hz);
    board.name = name_at(clock_hz);
    board.bus = el_pico_display_start();
    board.port = el_pico_link_start(clock_hz);
    board.boot_id = make_boot_id();
    start_watchdog();
    return &board;
}

void el_board_feed(void)
{
    EL_WATCHDOG->load = WATCHDOG_HALF_US;
}

_Noreturn void el_board_restart(void)
{
    EL_PSM->wdsel = EL_PSM_ALL_BUT_OSCILLATORS;
    for (;;) {
        EL_WATCHDOG->ctrl = EL_WATCHDOG_TRIGGER;
    }
}

/* After the core's sixteen; start.c has those. */
__attribute__((section(".vectors.irq"), used)) static const el_vector irq_vectors[] = {
    el_pico_timer_interrupt, EL_FAULT_ENTRY_4, EL_FAULT_ENTRY_4,
    el_fault_entry,          el_fault_entry,   el_pico_display_interrupt, /* 0 to 11 */
    EL_FAULT_ENTRY_4,        EL_FAULT_ENTRY_4, el_pico_link_interrupt,    /* to 20 */
    EL_FAULT_ENTRY_4,        el_fault_entry,
};
_Static_assert(EL_IRQ_TIMER_0 == 0 && EL_IRQ_DMA_0 == 11 && EL_IRQ_UART0 == 20 &&
                   sizeof irq_vectors / sizeof irq_vectors[0] == EL_IRQ_COUNT,
               "the places in the table");
