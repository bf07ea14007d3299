/* What the STM32F405 has and where: the registers that this board uses, no others.
 *
 * Names, addresses and bits as in ST's reference manual RM0090, whose section numbers stand beside them as the
 * revisions have them that describe the STM32F42x too (earlier ones count otherwise from chapter 21 on); the register
 * map is in its section 2.3. Limits of clocks and pins are of the data sheet, DS8626. No such chip was at hand: what is
 * here ran in emulators alone, whose models were written from the same documents. */
#ifndef EL_BOARDS_STM32F405_REGISTERS_H
#define EL_BOARDS_STM32F405_REGISTERS_H

#include <stdint.h>

#include "stm32/usart.h"

#define EL_REGISTER(address) (*(volatile uint32_t *)(address))

/* Flash: wait states and caches (3.9.1). */
#define FLASH_ACR EL_REGISTER(0x40023C00)
#define FLASH_ACR_LATENCY(wait_states) (wait_states)
#define FLASH_ACR_LATENCY_MASK 7U
#define FLASH_ACR_PREFETCH (1U << 8)
#define FLASH_ACR_INSTRUCTION_CACHE (1U << 9)
#define FLASH_ACR_DATA_CACHE (1U << 10)

/* Power: the core's voltage (5.4.1). */
#define PWR_CR EL_REGISTER(0x40007000)
#define PWR_CR_SCALE_1 (1U << 14)

/* Clocks (7.3.1 to 7.3.3). */
#define RCC_CR EL_REGISTER(0x40023800)
#define RCC_CR_HSE_ON (1U << 16)
#define RCC_CR_HSE_READY (1U << 17)
#define RCC_CR_PLL_ON (1U << 24)
#define RCC_CR_PLL_READY (1U << 25)
#define RCC_PLLCFGR EL_REGISTER(0x40023804)
#define RCC_PLLCFGR_M(divider) (divider)
#define RCC_PLLCFGR_N(factor) ((factor) << 6)
#define RCC_PLLCFGR_P(divider) (((divider) / 2U - 1U) << 16)
#define RCC_PLLCFGR_FROM_HSE (1U << 22)
#define RCC_PLLCFGR_Q(divider) ((divider) << 24)
#define RCC_CFGR EL_REGISTER(0x40023808)
#define RCC_CFGR_FROM_PLL (2U << 0)
#define RCC_CFGR_STATUS_MASK (3U << 2)
#define RCC_CFGR_STATUS_PLL (2U << 2)
#define RCC_CFGR_APB1_BY_4 (5U << 10)
#define RCC_CFGR_APB2_BY_2 (4U << 13)
/* The same: which parts have a clock (7.3.10, 7.3.11, 7.3.13, 7.3.14). */
#define RCC_AHB1ENR EL_REGISTER(0x40023830)
#define RCC_AHB1ENR_GPIOA (1U << 0)
#define RCC_AHB1ENR_DMA2 (1U << 22)
#define RCC_AHB2ENR EL_REGISTER(0x40023834)
#define RCC_AHB2ENR_RNG (1U << 6)
#define RCC_APB1ENR EL_REGISTER(0x40023840)
#define RCC_APB1ENR_PWR (1U << 28)
#define RCC_APB2ENR EL_REGISTER(0x40023844)
#define RCC_APB2ENR_USART1 (1U << 4)
#define RCC_APB2ENR_SPI1 (1U << 12)

/* Port A (8.4): two bits a pin, four for the alternate function. */
#define GPIOA_MODER EL_REGISTER(0x40020000)
#define GPIOA_OSPEEDR EL_REGISTER(0x40020008)
#define GPIOA_PUPDR EL_REGISTER(0x4002000C)
#define GPIOA_BSRR EL_REGISTER(0x40020018)
#define GPIOA_AFRL EL_REGISTER(0x40020020)
#define GPIOA_AFRH EL_REGISTER(0x40020024)
#define GPIO_OUTPUT 1U
#define GPIO_ALTERNATE 2U
#define GPIO_50_MHZ 2U
#define GPIO_PULL_UP 1U
#define GPIO_PULL_DOWN 2U

/* DMA2, stream 3 (10.5.1, 10.5.3, 10.5.5 to 10.5.10). */
#define DMA2_LIFCR EL_REGISTER(0x40026408)
#define DMA2_LIFCR_STREAM_3 (0x3DU << 22)
#define DMA2_S3CR EL_REGISTER(0x40026458)
#define DMA2_S3CR_ENABLE (1U << 0)
#define DMA2_S3CR_COMPLETE_INTERRUPT (1U << 4)
#define DMA2_S3CR_TO_PERIPHERAL (1U << 6)
#define DMA2_S3CR_NEXT_ADDRESS (1U << 10)
#define DMA2_S3CR_16_BITS (1U << 11 | 1U << 13)
#define DMA2_S3CR_CHANNEL(channel) ((channel) << 25)
#define DMA2_S3NDTR EL_REGISTER(0x4002645C)
#define DMA2_S3PAR EL_REGISTER(0x40026460)
#define DMA2_S3M0AR EL_REGISTER(0x40026464)
#define DMA_MAX_WORDS 65535U

/* SPI1 (28.5). */
#define SPI1_CR1 EL_REGISTER(0x40013000)
#define SPI_CR1_MASTER (1U << 2)
#define SPI_CR1_ENABLE (1U << 6)
#define SPI_CR1_SELECTED (3U << 8) /* SSM and SSI: the NSS pin is not looked at */
#define SPI_CR1_16_BITS (1U << 11)
#define SPI_CR1_TRANSMIT_ONLY (3U << 14) /* BIDIMODE and BIDIOE */
#define SPI1_CR2 EL_REGISTER(0x40013004)
#define SPI_CR2_TX_DMA (1U << 1)
#define SPI1_SR EL_REGISTER(0x40013008)
#define SPI_SR_TX_EMPTY (1U << 1)
#define SPI_SR_BUSY (1U << 7)
#define SPI1_DR EL_REGISTER(0x4001300C)

/* USART1 (30.6): stm32/usart.h. */
#define USART1 ((el_stm32_usart_registers *)0x40011000)

/* The independent watchdog, on its own 32 kHz (21.4). */
#define IWDG_KR EL_REGISTER(0x40003000)
#define IWDG_KR_FEED 0xAAAAU
#define IWDG_KR_UNLOCK 0x5555U
#define IWDG_KR_START 0xCCCCU
#define IWDG_PR EL_REGISTER(0x40003004)
#define IWDG_PR_BY_64 4U
#define IWDG_RLR EL_REGISTER(0x40003008)

/* Random numbers (24.4). */
#define RNG_CR EL_REGISTER(0x50060800)
#define RNG_CR_ENABLE (1U << 2)
#define RNG_SR EL_REGISTER(0x50060804)
#define RNG_SR_READY (1U << 0)
#define RNG_DR EL_REGISTER(0x50060808)

/* Interrupts (12.2, table 61). */
#define IRQ_USART1 37U
#define IRQ_DMA2_STREAM_3 59U

#endif
