/* The board as a whole: clocks, watchdog, interrupt vectors. */
#include "board.h"

#include "cortex_m/cycles.h"
#include "cortex_m/start.h"
#include "cortex_m/systick.h"
#include "registers.h"
#include "stm32f405.h"

/* Up to the last one that is ever enabled. */
__attribute__((section(".vectors.irq"), used)) static const el_vector irq_vectors[] = {
    EL_FAULT_ENTRY_16,     EL_FAULT_ENTRY_16, EL_FAULT_ENTRY_4, el_fault_entry,
    el_stm32_usart1_entry,                                                                       /* 0 to 37 */
    EL_FAULT_ENTRY_16,     EL_FAULT_ENTRY_4,  el_fault_entry,   el_stm32f405_dma2_stream3_entry, /* to 59 */
};
_Static_assert(IRQ_USART1 == 37 && IRQ_DMA2_STREAM_3 == 59 &&
                   sizeof irq_vectors / sizeof irq_vectors[0] == IRQ_DMA2_STREAM_3 + 1,
               "the places in the table");

/* Counts the starts that RAM outlived. */
__attribute__((section(".noinit"))) static uint32_t starts;

/* Another one after each start: the chip's random number, and where there is none, the count of starts. */
static uint32_t make_boot_id(void)
{
    enum { READY_POLLS = 10000 }; /* a number takes 40 clocks of 48 MHz (RM0090, 24.3) */
    RNG_CR = RNG_CR_ENABLE;
    for (uint32_t polls = 0; polls < READY_POLLS; polls++) {
        if ((RNG_SR & RNG_SR_READY) != 0) {
            return RNG_DR;
        }
    }
    return ++starts;
}

static void start_watchdog(void)
{
    enum { WATCHDOG_S = 8, CLOCK_HZ = 32000 / 64 }; /* 5 to 15 s: the oscillator has 17 to 47 kHz (DS8626, 5.3.9) */
    IWDG_KR = IWDG_KR_UNLOCK;
    IWDG_PR = IWDG_PR_BY_64;
    IWDG_RLR = WATCHDOG_S * CLOCK_HZ - 1;
    IWDG_KR = IWDG_KR_START;
}

const el_board *el_board_start(void)
{
    static el_board board = {.name = "STM32F405",
                             .bus = &el_stm32f405_bus,
                             .port = &el_stm32_usart1_port,
                             .baud = EL_STM32F405_BAUD,
                             .max_baud = EL_STM32F405_MAX_BAUD};
    const el_stm32f405_clocks clocks = el_stm32f405_clocks_start();
    RCC_AHB1ENR |= RCC_AHB1ENR_GPIOA | RCC_AHB1ENR_DMA2;
    RCC_AHB2ENR |= RCC_AHB2ENR_RNG;
    RCC_APB2ENR |= RCC_APB2ENR_USART1 | RCC_APB2ENR_SPI1;
    (void)RCC_APB2ENR; /* a part may be touched two clocks after it got its own (RM0090, 7.2) */
    el_systick_start(clocks.core_hz);
    el_cycles_start();
    el_stm32f405_usart_start(clocks.apb2_hz);
    el_stm32f405_display_start();
    start_watchdog();
    board.boot_id = make_boot_id();
    return &board;
}

void el_board_feed(void)
{
    IWDG_KR = IWDG_KR_FEED;
}
