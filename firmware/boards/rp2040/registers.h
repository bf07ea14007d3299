/* The registers of the RP2040 that this board uses, and no others. Section numbers are those of the RP2040 data sheet
 * (Raspberry Pi Ltd, "RP2040 Datasheet") in its editions of 2022 and later, the first ones count otherwise; names are
 * its names in lower case. No board was at hand: what is here ran in rp2040js alone, with checks of what that lets
 * pass. */
#ifndef EL_BOARDS_RP2040_REGISTERS_H
#define EL_BOARDS_RP2040_REGISTERS_H

#include <stddef.h>
#include <stdint.h>

#include "arm/pl011.h"

typedef volatile uint32_t el_register;

/* Every register of a peripheral has aliases that set and clear bits in one store (2.1.2), so that a program and an
 * interrupt can change different bits of it. */
static inline void el_set_bits(el_register *at, uint32_t bits)
{
    *(el_register *)((uintptr_t)at + 0x2000U) = bits;
}

static inline void el_clear_bits(el_register *at, uint32_t bits)
{
    *(el_register *)((uintptr_t)at + 0x3000U) = bits;
}

/* 2.14.3 Resets: a peripheral whose bit is set is held in reset. */
typedef struct el_resets {
    el_register reset, wdsel, reset_done;
} el_resets;
#define EL_RESETS ((el_resets *)0x4000C000U)
enum {
    EL_RESET_DMA = 1 << 2,
    EL_RESET_IO_BANK0 = 1 << 5,
    EL_RESET_PADS_BANK0 = 1 << 8,
    EL_RESET_PLL_SYS = 1 << 12,
    EL_RESET_SPI0 = 1 << 16,
    EL_RESET_TIMER = 1 << 21,
    EL_RESET_UART0 = 1 << 22
};

/* 2.13.5 Power-on state machine: what the watchdog starts anew. */
typedef struct el_psm {
    el_register frce_on, frce_off, wdsel, done;
} el_psm;
#define EL_PSM ((el_psm *)0x40010000U)
enum { EL_PSM_ALL_BUT_OSCILLATORS = 0x1FFFC };

/* 2.16.7 Crystal oscillator. */
typedef struct el_xosc {
    el_register ctrl, status, dormant, startup;
} el_xosc;
#define EL_XOSC ((el_xosc *)0x40024000U)
enum { EL_XOSC_1_15_MHZ = 0xAA0, EL_XOSC_ENABLE = 0xFAB000 };
#define EL_XOSC_STABLE 0x80000000U

/* 2.17.8 Ring oscillator: a bit of noise. */
#define EL_ROSC_RANDOMBIT ((el_register *)0x4006001CU)

/* 2.18.4 PLL. */
typedef struct el_pll {
    el_register cs, pwr, fbdiv_int, prim;
} el_pll;
#define EL_PLL_SYS ((el_pll *)0x40028000U)
#define EL_PLL_LOCK 0x80000000U
enum { EL_PLL_PD = 1 << 0, EL_PLL_POSTDIVPD = 1 << 3, EL_PLL_VCOPD = 1 << 5 };

/* 2.15.7 Clocks: clk_ref, clk_sys and clk_peri. */
typedef struct el_clock {
    el_register ctrl, div, selected;
} el_clock;
#define EL_CLK_REF ((el_clock *)0x40008030U)
#define EL_CLK_SYS ((el_clock *)0x4000803CU)
#define EL_CLK_PERI ((el_clock *)0x40008048U)
enum { EL_CLK_REF_XOSC = 2, EL_CLK_SYS_AUX_PLL_SYS = 1, EL_CLK_PERI_ENABLE = 1 << 11 };

/* 4.7.6 Watchdog; its tick is the timer's too. */
typedef struct el_watchdog {
    el_register ctrl, load, reason, scratch[8], tick;
} el_watchdog;
#define EL_WATCHDOG ((el_watchdog *)0x40058000U)
#define EL_WATCHDOG_TRIGGER 0x80000000U
enum { EL_WATCHDOG_ENABLE = 1 << 30, EL_WATCHDOG_PAUSE_IN_DEBUGGER = 7 << 24, EL_WATCHDOG_TICK_ENABLE = 1 << 9 };

/* 4.6.5 Timer: its low word without latching the high one, and the first of four alarms. */
typedef struct el_timer {
    el_register timehw, timelw, timehr, timelr, alarm[4], armed, timerawh, timerawl, dbgpause, pause, intr, inte;
} el_timer;
#define EL_TIMER ((el_timer *)0x40054000U)
_Static_assert(offsetof(el_timer, timerawl) == 0x28 && offsetof(el_timer, inte) == 0x38, "4.6.5");

/* 2.19.6.1 Pin functions and 2.19.6.3 pads. */
#define EL_GPIO_CTRL(pin) ((el_register *)(0x40014004U + 8U * (pin)))
#define EL_PAD(pin) ((el_register *)(0x4001C004U + 4U * (pin)))
enum { EL_FUNCTION_SPI = 1, EL_FUNCTION_UART = 2, EL_FUNCTION_SIO = 5 };
enum {
    EL_PAD_FAST = 1 << 0,
    EL_PAD_SCHMITT = 1 << 1,
    EL_PAD_PULL_UP = 1 << 3,
    EL_PAD_4_MA = 1 << 4,
    EL_PAD_8_MA = 2 << 4,
    EL_PAD_INPUT = 1 << 6
};

/* 2.3.1.7 SIO: pins as plain outputs. */
typedef struct el_sio {
    el_register cpuid, gpio_in, gpio_hi_in, unused, gpio_out, gpio_out_set, gpio_out_clr, gpio_out_xor;
    el_register gpio_oe, gpio_oe_set, gpio_oe_clr, gpio_oe_xor;
} el_sio;
#define EL_SIO ((el_sio *)0xD0000000U)

/* 4.4.4 SPI, ARM's PL022. */
typedef struct el_spi {
    el_register cr0, cr1, dr, sr, cpsr, imsc, ris, mis, icr, dmacr;
} el_spi;
#define EL_SPI0 ((el_spi *)0x4003C000U)
enum {
    EL_SPI_CR0_8_BITS = 7,
    EL_SPI_CR0_16_BITS = 15,
    EL_SPI_CR0_SPO = 1 << 6,
    EL_SPI_CR0_SPH = 1 << 7,
    EL_SPI_CR1_SSE = 1 << 1,
    EL_SPI_SR_TNF = 1 << 1,
    EL_SPI_SR_BSY = 1 << 4,
    EL_SPI_DMACR_TXDMAE = 1 << 1
};

/* 2.5.7 DMA: channel 0, the interrupts of all channels, and aborting. */
typedef struct el_dma_channel {
    el_register read_addr, write_addr, trans_count, ctrl_trig;
} el_dma_channel;
#define EL_DMA_0 ((el_dma_channel *)0x50000000U)
#define EL_DMA_INTE0 ((el_register *)0x50000404U)
#define EL_DMA_INTS0 ((el_register *)0x5000040CU)
enum {
    EL_DMA_ENABLE = 1 << 0,
    EL_DMA_HIGH_PRIORITY = 1 << 1,
    EL_DMA_BYTES = 0 << 2,
    EL_DMA_HALFWORDS = 1 << 2,
    EL_DMA_INCR_READ = 1 << 4,
    EL_DMA_CHAIN_TO_ITSELF = 0 << 11, /* channel 0's own number: no chain */
    EL_DMA_DREQ_SPI0_TX = 16 << 15
};

/* 4.2.8 UART, Arm's PL011: arm/pl011.h. */
#define EL_UART0 ((el_pl011_registers *)0x40034000U)

/* 2.3.2 Interrupts. */
enum { EL_IRQ_TIMER_0 = 0, EL_IRQ_DMA_0 = 11, EL_IRQ_UART0 = 20, EL_IRQ_COUNT = 26 };

#endif
