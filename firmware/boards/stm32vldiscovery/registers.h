/* What the STM32F100RB has and where: the registers that this board uses, no others.
 *
 * Names as in the reference manual (STMicroelectronics, RM0041, "STM32F100xx advanced Arm-based 32-bit MCUs"), chapters
 * "Reset and clock control" (RCC), "General-purpose and alternate-function I/Os", "Independent watchdog" (IWDG),
 * "Serial peripheral interface" and "Universal synchronous asynchronous receiver transmitter". Tried in emulators
 * alone. */
#ifndef EL_BOARDS_STM32VLDISCOVERY_REGISTERS_H
#define EL_BOARDS_STM32VLDISCOVERY_REGISTERS_H

#include <stdint.h>

#include "stm32/usart.h"

#define EL_REGISTER(address) (*(volatile uint32_t *)(address))

/* Reset and clock control. */
#define RCC_CR EL_REGISTER(0x40021000)
#define RCC_CFGR EL_REGISTER(0x40021004)
#define RCC_APB2ENR EL_REGISTER(0x40021018)
#define RCC_CR_HSE_ON (1U << 16)
#define RCC_CR_HSE_READY (1U << 17)
#define RCC_CR_PLL_ON (1U << 24)
#define RCC_CR_PLL_READY (1U << 25)
#define RCC_CFGR_PLL (2U << 0)
#define RCC_CFGR_PLL_ACTIVE (2U << 2)
#define RCC_CFGR_PLL_FROM_HSE (1U << 16)
#define RCC_CFGR_PLL_TIMES(n) (((n)-2U) << 18)
#define RCC_APB2ENR_PORT_A (1U << 2)
#define RCC_APB2ENR_SPI1 (1U << 12)
#define RCC_APB2ENR_USART1 (1U << 14)

/* GPIO ports: four bits of configuration for each pin, pins 0..7 in the low register. A store to the set-reset register
 * sets those pins that its lower half names and clears those of its upper half. */
#define GPIO_A 0x40010800U
#define GPIO_CONFIG(port, pin) EL_REGISTER((port) + ((pin) < 8U ? 0x00U : 0x04U))
#define GPIO_SET_RESET(port) EL_REGISTER((port) + 0x10U)
#define GPIO_SET(pin) (1U << (pin))
#define GPIO_CLEAR(pin) (1U << ((pin) + 16U))
#define GPIO_MODE_OUTPUT 0x3U    /* push-pull, 50 MHz */
#define GPIO_MODE_ALTERNATE 0xBU /* the same, driven by a peripheral */
#define GPIO_MODE_PULLED 0x8U    /* input, with pull-up where the pin has been set */

static inline void el_gpio_configure(uint32_t port, uint32_t pin, uint32_t mode)
{
    const uint32_t place = pin % 8U * 4U;
    GPIO_CONFIG(port, pin) = (GPIO_CONFIG(port, pin) & ~(15U << place)) | mode << place;
}

/* Independent watchdog, on the 40 kHz oscillator. */
#define IWDG_KEY EL_REGISTER(0x40003000)
#define IWDG_PRESCALER EL_REGISTER(0x40003004)
#define IWDG_RELOAD EL_REGISTER(0x40003008)
#define IWDG_KEY_FEED 0xAAAAU
#define IWDG_KEY_UNLOCK 0x5555U
#define IWDG_KEY_START 0xCCCCU
#define IWDG_PRESCALER_64 4U

/* SPI1. */
#define SPI_CR1 EL_REGISTER(0x40013000)
#define SPI_SR EL_REGISTER(0x40013008)
#define SPI_DR EL_REGISTER(0x4001300C)
#define SPI_CR1_MASTER (1U << 2)
#define SPI_CR1_DIVIDE_BY_4 (1U << 3)
#define SPI_CR1_ENABLE (1U << 6)
#define SPI_CR1_SELECTED (1U << 8) /* with the next one: the chip select is the program's */
#define SPI_CR1_SOFTWARE_SELECT (1U << 9)
#define SPI_CR1_TRANSMIT_ONLY (3U << 14)
#define SPI_SR_TX_EMPTY (1U << 1)
#define SPI_SR_BUSY (1U << 7)

/* USART1: stm32/usart.h. */
#define USART1 ((el_stm32_usart_registers *)0x40013800)

/* Interrupts, by number. */
#define IRQ_USART1 37U

#endif
