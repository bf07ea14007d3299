/* The Raspberry Pi Pico: clocks, resets, time, the watchdog, and the table of interrupts. The display's wire is
 * display.c, the host's link is link.c; all pins are in pins.h. */
#include "board.h"

#include "cortex_m/start.h"
#include "rp2040/display.h"
#include "rp2040/link.h"
#include "rp2040/pins.h"
#include "rp2040/registers.h"
#include "rp2040/timer.h"

enum {
    CRYSTAL_MHZ = 12,
    XOSC_STARTUP = 47, /* 1 ms in units of 256 crystal cycles (2.16.3) */
    PLL_FBDIV = 125,   /* VCO at 1500 MHz ... */
    PLL_POSTDIV1 = 6,  /* ... divided to 125 MHz (2.18.2) */
    PLL_POSTDIV2 = 2,
    /* 8 s, nearly the longest: the benchmark's S3 takes 2.2 s for a frame. In half microseconds, because the watchdog
     * counts twice per tick (erratum RP2040-E1). */
    WATCHDOG_HALF_US = 8 * 2000000
};
_Static_assert(1000000LL * CRYSTAL_MHZ * PLL_FBDIV == 1LL * EL_PICO_CLOCK_HZ * PLL_POSTDIV1 * PLL_POSTDIV2,
               "the rate that the other files count with");
_Static_assert(WATCHDOG_HALF_US < 1 << 24, "the watchdog counts 24 bits");

/* Waits until a bit is set that the hardware always sets, within milliseconds: a crystal or PLL that does not start
 * leaves nothing to run on and nobody to tell, so there is nothing better to do than to wait for it. */
static void wait_for(const el_register *at, uint32_t bits)
{
    while ((*at & bits) != bits) {
    }
}

static void release(uint32_t peripherals)
{
    el_clear_bits(&EL_RESETS->reset, peripherals);
    wait_for(&EL_RESETS->reset_done, peripherals);
}

/* clk_ref from the crystal, clk_sys and clk_peri from the PLL, a tick each microsecond. The boot ROM leaves clk_sys on
 * clk_ref, and its switches are free of glitches (2.15.3.2), so the order is: sources first, then those who use them. */
static void start_clocks(void)
{
    EL_XOSC->startup = XOSC_STARTUP;
    EL_XOSC->ctrl = EL_XOSC_1_15_MHZ;
    el_set_bits(&EL_XOSC->ctrl, EL_XOSC_ENABLE);
    wait_for(&EL_XOSC->status, EL_XOSC_STABLE);
    EL_CLK_REF->ctrl = EL_CLK_REF_XOSC;
    wait_for(&EL_CLK_REF->selected, 1U << EL_CLK_REF_XOSC);

    release(EL_RESET_PLL_SYS);
    EL_PLL_SYS->cs = 1; /* the crystal, not divided */
    EL_PLL_SYS->fbdiv_int = PLL_FBDIV;
    el_clear_bits(&EL_PLL_SYS->pwr, EL_PLL_PD | EL_PLL_VCOPD);
    wait_for(&EL_PLL_SYS->cs, EL_PLL_LOCK);
    EL_PLL_SYS->prim = PLL_POSTDIV1 << 16 | PLL_POSTDIV2 << 12;
    el_clear_bits(&EL_PLL_SYS->pwr, EL_PLL_POSTDIVPD);
    EL_CLK_SYS->ctrl = EL_CLK_SYS_AUX_PLL_SYS; /* its auxiliary source 0 is this PLL */
    wait_for(&EL_CLK_SYS->selected, 1U << EL_CLK_SYS_AUX_PLL_SYS);
    EL_CLK_PERI->ctrl = EL_CLK_PERI_ENABLE; /* its source 0 is clk_sys */

    EL_WATCHDOG->tick = EL_WATCHDOG_TICK_ENABLE | CRYSTAL_MHZ;
}

static void start_watchdog(void)
{
    EL_PSM->wdsel = EL_PSM_ALL_BUT_OSCILLATORS;
    el_board_feed();
    EL_WATCHDOG->ctrl = EL_WATCHDOG_ENABLE | EL_WATCHDOG_PAUSE_IN_DEBUGGER;
}

/* Noise of the ring oscillator, which runs beside the crystal (2.17.5): each bit of the id is made of eight. */
static uint32_t make_boot_id(void)
{
    uint32_t id = 0;
    for (int i = 0; i < 8 * 32; i++) {
        id = (id << 1 | id >> 31) ^ (*EL_ROSC_RANDOMBIT & 1U);
    }
    return id;
}

uint32_t el_pico_micros(void *context)
{
    (void)context;
    return *EL_TIMERAWL;
}

void el_pico_delay_ms(void *context, uint32_t ms)
{
    const uint32_t begin_us = el_pico_micros(context);
    while (el_pico_micros(context) - begin_us <= ms * 1000U) { /* one more, because the first one has begun already */
    }
}

const el_board *el_board_start(void)
{
    static el_board board = {.name = "Raspberry Pi Pico", .max_baud = EL_PICO_BAUD};
    start_clocks();
    release(EL_RESET_IO_BANK0 | EL_RESET_PADS_BANK0 | EL_RESET_TIMER | EL_RESET_DMA | EL_RESET_SPI0 | EL_RESET_UART0);
    board.bus = el_pico_display_start();
    board.port = el_pico_link_start();
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
__attribute__((section(".vectors.irq"), used)) static const el_vector irq_vectors[EL_IRQ_COUNT] = {
    [0] = el_fault_entry,  [1] = el_fault_entry,  [2] = el_fault_entry,
    [3] = el_fault_entry,  [4] = el_fault_entry,  [5] = el_fault_entry,
    [6] = el_fault_entry,  [7] = el_fault_entry,  [8] = el_fault_entry,
    [9] = el_fault_entry,  [10] = el_fault_entry, [EL_IRQ_DMA_0] = el_pico_display_interrupt,
    [12] = el_fault_entry, [13] = el_fault_entry, [14] = el_fault_entry,
    [15] = el_fault_entry, [16] = el_fault_entry, [17] = el_fault_entry,
    [18] = el_fault_entry, [19] = el_fault_entry, [EL_IRQ_UART0] = el_pico_link_interrupt,
    [21] = el_fault_entry, [22] = el_fault_entry, [23] = el_fault_entry,
    [24] = el_fault_entry, [25] = el_fault_entry,
};
