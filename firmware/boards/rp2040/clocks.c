/* clk_ref from the crystal, clk_sys and clk_peri from the PLL, a tick each microsecond. The boot ROM leaves clk_sys on
 * clk_ref and that on the ring oscillator (2.17.1), and their switches are free of glitches (2.15.3.2), so the order
 * is: sources first, then those who use them. */
#include "rp2040/clocks.h"

#include <stdbool.h>

#include "rp2040/registers.h"

enum {
    XOSC_STARTUP = 47, /* 1 ms in units of 256 crystal cycles (2.16.3) */
    PLL_FBDIV = 125,   /* VCO at 1500 MHz ... */
    PLL_POSTDIV1 = 6,  /* ... divided to 125 MHz (2.18.2) */
    PLL_POSTDIV2 = 2,
    /* Cycles of clk_ref. The ring oscillator has 12 MHz at most after a reset (2.17.4): from it the microseconds are
     * longer than they should be, never shorter, so that a display's waiting times hold. */
    TICK = EL_PICO_CRYSTAL_HZ / 1000000,
    /* Of 8 cycles and more at 12 MHz at most: a tenth of a second. The crystal takes some milliseconds, the PLL less.
     * */
    READY_POLLS = 150000
};
_Static_assert(1LL * EL_PICO_CRYSTAL_HZ * PLL_FBDIV == 1LL * EL_PICO_CLOCK_HZ * PLL_POSTDIV1 * PLL_POSTDIV2,
               "the rate that the other files count with");

static bool comes_up(const el_register *at, uint32_t bits)
{
    for (uint32_t polls = 0; polls < READY_POLLS; polls++) {
        if ((*at & bits) == bits) {
            return true;
        }
    }
    return false;
}

void el_pico_release(uint32_t peripherals)
{
    el_clear_bits(&EL_RESETS->reset, peripherals);
    (void)comes_up(&EL_RESETS->reset_done, peripherals); /* within some cycles of their clocks, which run */
}

static bool start_crystal(void)
{
    EL_XOSC->startup = XOSC_STARTUP;
    EL_XOSC->ctrl = EL_XOSC_1_15_MHZ;
    el_set_bits(&EL_XOSC->ctrl, EL_XOSC_ENABLE);
    if (!comes_up(&EL_XOSC->status, EL_XOSC_STABLE)) {
        return false;
    }
    EL_CLK_REF->ctrl = EL_CLK_REF_XOSC;
    return comes_up(&EL_CLK_REF->selected, 1U << EL_CLK_REF_XOSC);
}

static bool start_pll(void)
{
    el_pico_release(EL_RESET_PLL_SYS);
    EL_PLL_SYS->cs = 1; /* the crystal, not divided */
    EL_PLL_SYS->fbdiv_int = PLL_FBDIV;
    el_clear_bits(&EL_PLL_SYS->pwr, EL_PLL_PD | EL_PLL_VCOPD);
    if (!comes_up(&EL_PLL_SYS->cs, EL_PLL_LOCK)) {
        return false;
    }
    EL_PLL_SYS->prim = PLL_POSTDIV1 << 16 | PLL_POSTDIV2 << 12;
    el_clear_bits(&EL_PLL_SYS->pwr, EL_PLL_POSTDIVPD);
    EL_CLK_SYS->ctrl = EL_CLK_SYS_AUX_PLL_SYS; /* its auxiliary source 0 is this PLL */
    return comes_up(&EL_CLK_SYS->selected, 1U << EL_CLK_SYS_AUX_PLL_SYS);
}

uint32_t el_pico_clocks_start(void)
{
    uint32_t hz = EL_PICO_RING_HZ;

    if (start_crystal()) {
        hz = start_pll() ? EL_PICO_CLOCK_HZ : EL_PICO_CRYSTAL_HZ;
    }
    EL_CLK_PERI->ctrl = EL_CLK_PERI_ENABLE; /* its source 0 is clk_sys */
    EL_WATCHDOG->tick = EL_WATCHDOG_TICK_ENABLE | TICK;
    return hz;
}
