/* The board as a whole: clocks, pins of the USART, watchdog, interrupt vectors. */
#include "board.h"

#include "cortex_m/start.h"
#include "cortex_m/systick.h"
#include "registers.h"
#include "stm32f405.h"

/* Up to the last one that is ever enabled. */
#define FAULT_1 el_fault_entry
#define FAULT_4 FAULT_1, FAULT_1, FAULT_1, FAULT_1
#define FAULT_16 FAULT_4, FAULT_4, FAULT_4, FAULT_4
__attribute__((section(".vectors.irq"), used)) static const el_vector irq_vectors[] = {
    FAULT_16,
    FAULT_16,
    FAULT_4,
    FAULT_1,
    el_stm32f405_usart1_entry, /* 0 to 37 */
    FAULT_16,
    FAULT_4,
    FAULT_1,
    el_stm32f405_dma2_stream3_entry, /* to 59 */
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

static void start_usart_pins(void)
{
    enum { PIN_TX = 9, PIN_RX = 10, FUNCTION_USART1 = 7 }; /* DS8626, table 9 */
    GPIOA_AFRH |= FUNCTION_USART1 << 4 * (PIN_TX - 8) | FUNCTION_USART1 << 4 * (PIN_RX - 8);
    GPIOA_PUPDR |= GPIO_PULL_UP << 2 * PIN_RX; /* silence where no cable is */
    GPIOA_MODER |= GPIO_ALTERNATE << 2 * PIN_TX | GPIO_ALTERNATE << 2 * PIN_RX;
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
    static el_board board = {
        .name = "STM32F405", .bus = &el_stm32f405_bus, .port = &el_stm32f405_port, .max_baud = EL_STM32F405_BAUD};
    const el_stm32f405_clocks clocks = el_stm32f405_clocks_start();
    RCC_AHB1ENR |= RCC_AHB1ENR_GPIOA | RCC_AHB1ENR_DMA2;
    RCC_AHB2ENR |= RCC_AHB2ENR_RNG;
    RCC_APB2ENR |= RCC_APB2ENR_USART1 | RCC_APB2ENR_SPI1;
    (void)RCC_APB2ENR; /* a part may be touched two clocks after it got its own (RM0090, 7.2) */
    el_systick_start(clocks.core_hz);
    start_usart_pins();
    el_stm32f405_usart_start(clocks);
    el_stm32f405_display_start();
    start_watchdog();
    board.boot_id = make_boot_id();
    return &board;
}

void el_board_feed(void)
{
    IWDG_KR = IWDG_KR_FEED;
}

_Noreturn void el_board_restart(void)
{
    SCB_AIRCR = AIRCR_RESET;
    for (;;) { /* until it happens */
    }
}
