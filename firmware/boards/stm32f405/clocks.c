/* 168 MHz from the crystal, or from the chip's own oscillator where no crystal swings; 16 MHz where the PLL does not
 * lock, which no chip does and emulators without clocks do. Each wait has an end, so the program starts in any case. */
#include "registers.h"
#include "stm32f405.h"

enum {
    CRYSTAL_MHZ = EDGELINE_CRYSTAL_MHZ,
    INTERNAL_MHZ = 16,
    /* The PLL gets 1 MHz and swings at 336 (RM0090, 7.3.2: 100 to 432). */
    PLL_FACTOR = 336,
    CORE_DIVIDER = 2, /* 168 MHz, the most that the chip may have (DS8626, 5.3.1) */
    USB_DIVIDER = 7,  /* 48 MHz, for the random numbers */
    /* About ten cycles each at 16 MHz: a tenth of a second. Crystals take some milliseconds, the PLL 0.3. */
    READY_POLLS = 160000
};
_Static_assert(CRYSTAL_MHZ >= 4 && CRYSTAL_MHZ <= 26, "what the oscillator can drive (DS8626, 5.3.8)");

static int comes_up(uint32_t ready)
{
    for (uint32_t polls = 0; polls < READY_POLLS; polls++) {
        if ((RCC_CR & ready) != 0) {
            return 1;
        }
    }
    return 0;
}

static int start_pll(void)
{
    uint32_t source = RCC_PLLCFGR_M(INTERNAL_MHZ);
    RCC_CR |= RCC_CR_HSE_ON;
    if (comes_up(RCC_CR_HSE_READY)) {
        source = RCC_PLLCFGR_M(CRYSTAL_MHZ) | RCC_PLLCFGR_FROM_HSE;
    }
    RCC_PLLCFGR = source | RCC_PLLCFGR_N(PLL_FACTOR) | RCC_PLLCFGR_P(CORE_DIVIDER) | RCC_PLLCFGR_Q(USB_DIVIDER);
    RCC_CR |= RCC_CR_PLL_ON;
    return comes_up(RCC_CR_PLL_READY);
}

el_stm32f405_clocks el_stm32f405_clocks_start(void)
{
    RCC_APB1ENR |= RCC_APB1ENR_PWR;
    PWR_CR |= PWR_CR_SCALE_1; /* the voltage that more than 144 MHz need (DS8626, 5.3.1) */
    if (!start_pll()) {
        return (el_stm32f405_clocks){.core_hz = INTERNAL_MHZ * 1000000U, .apb2_hz = INTERNAL_MHZ * 1000000U};
    }
    /* Five wait states above 150 MHz at 2.7 to 3.6 V (RM0090, table 10), in force before the clock is faster. */
    FLASH_ACR = FLASH_ACR_LATENCY(5U) | FLASH_ACR_PREFETCH | FLASH_ACR_INSTRUCTION_CACHE | FLASH_ACR_DATA_CACHE;
    while ((FLASH_ACR & FLASH_ACR_LATENCY_MASK) != FLASH_ACR_LATENCY(5U)) { /* reads back within some cycles */
    }
    RCC_CFGR = RCC_CFGR_APB1_BY_4 | RCC_CFGR_APB2_BY_2; /* 42 and 84 MHz, their most, before the clock is faster */
    RCC_CFGR |= RCC_CFGR_FROM_PLL;
    while ((RCC_CFGR & RCC_CFGR_STATUS_MASK) != RCC_CFGR_STATUS_PLL) { /* at once: the PLL is ready */
    }
    const uint32_t core_hz = PLL_FACTOR / CORE_DIVIDER * 1000000U;
    return (el_stm32f405_clocks){.core_hz = core_hz, .apb2_hz = core_hz / 2U};
}
