/* The board as a whole: clocks, watchdog, interrupt vectors. */
#include "stm32vldiscovery.h"

#include "cortex_m/cycles.h"
#include "cortex_m/start.h"
#include "cortex_m/systick.h"
#include "registers.h"

/* Another one after each start: RAM keeps what it holds over a reset, and holds anything after power-up. */
__attribute__((section(".noinit"))) static uint32_t starts;

/* The others are never enabled. */
__attribute__((section(".vectors.irq"), used)) static const el_vector irq_vectors[] = {
    [IRQ_USART1] = el_stm32_usart1_entry,
};

/* Whether a bit of the clock control was seen within 25 ms at 8 MHz, far more than a crystal or the PLL needs. Not for
 * ever: a crystal may be missing, and QEMU's model of this chip has no clock control at all. */
static int seen(volatile uint32_t *word, uint32_t bits)
{
    enum { POLLS = 40000 };
    for (uint32_t polls = 0; polls < POLLS; polls++) {
        if ((*word & bits) == bits) {
            return 1;
        }
    }
    return 0;
}

/* 24 MHz from the 8 MHz crystal times 3, or without it from the internal oscillator: 8 MHz / 2 * 6, +-2.5%. Flash needs
 * no wait states at 24 MHz, and neither bus a divider. */
static void start_clock(void)
{
    RCC_CR |= RCC_CR_HSE_ON;
    RCC_CFGR =
        seen(&RCC_CR, RCC_CR_HSE_READY) ? RCC_CFGR_PLL_FROM_HSE | RCC_CFGR_PLL_TIMES(3U) : RCC_CFGR_PLL_TIMES(6U);
    RCC_CR |= RCC_CR_PLL_ON;
    (void)seen(&RCC_CR, RCC_CR_PLL_READY);
    RCC_CFGR |= RCC_CFGR_PLL;
    (void)seen(&RCC_CFGR, RCC_CFGR_PLL_ACTIVE);
}

static void start_watchdog(void)
{
    IWDG_KEY = IWDG_KEY_START;
    IWDG_KEY = IWDG_KEY_UNLOCK;
    IWDG_PRESCALER = IWDG_PRESCALER_64;
    IWDG_RELOAD = 4095; /* 4096 * 64 / 40 kHz = 6.6 s; the oscillator has 30..60 kHz */
    IWDG_KEY = IWDG_KEY_FEED;
}

const el_board *el_board_start(void)
{
    static el_board board = {.name = "STM32 VL Discovery",
                             .bus = &el_vldiscovery_bus,
                             .port = &el_stm32_usart1_port,
                             .baud = EL_VLDISCOVERY_BAUD,
                             .max_baud = EL_VLDISCOVERY_MAX_BAUD};
    start_clock();
    RCC_APB2ENR |= RCC_APB2ENR_PORT_A | RCC_APB2ENR_SPI1 | RCC_APB2ENR_USART1;
    (void)RCC_APB2ENR; /* a part may be touched two clocks after it got its own */
    el_systick_start(EL_VLDISCOVERY_HZ);
    el_cycles_start();
    el_vldiscovery_uart_start();
    el_vldiscovery_display_start();
    start_watchdog();
    board.boot_id = ++starts;
    return &board;
}

void el_board_feed(void)
{
    IWDG_KEY = IWDG_KEY_FEED;
}
