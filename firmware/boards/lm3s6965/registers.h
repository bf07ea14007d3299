/* What the LM3S6965 has and where: the registers that this board uses, no others.
 *
 * Names as in the data sheet (Texas Instruments, "Stellaris LM3S6965 Microcontroller"), chapters System Control (RCC,
 * RIS, RCGC), GPIOs, Watchdog Timer, UARTs and SSI; UART and SSI are Arm's PL011 and PL022. Tried in QEMU alone, which
 * has no clock tree: the order in start_clock is the data sheet's. */
#ifndef EL_BOARDS_LM3S6965_REGISTERS_H
#define EL_BOARDS_LM3S6965_REGISTERS_H

#include <stdint.h>

#include "arm/pl011.h"

#define EL_REGISTER(address) (*(volatile uint32_t *)(address))

/* System control. */
#define SYSCTL_RIS EL_REGISTER(0x400FE050)
#define SYSCTL_RCC EL_REGISTER(0x400FE060)
#define SYSCTL_RCGC0 EL_REGISTER(0x400FE100)
#define SYSCTL_RCGC1 EL_REGISTER(0x400FE104)
#define SYSCTL_RCGC2 EL_REGISTER(0x400FE108)
#define RIS_PLL_LOCKED (1U << 6)
#define RCC_MAIN_OSCILLATOR_OFF (1U << 0)
#define RCC_SOURCE_MASK (3U << 4)
#define RCC_SOURCE_MAIN (0U << 4)
#define RCC_SOURCE_INTERNAL (1U << 4)
#define RCC_CRYSTAL_MASK (15U << 6)
#define RCC_CRYSTAL_8MHZ (14U << 6)
#define RCC_BYPASS (1U << 11)
#define RCC_PLL_OFF (1U << 13)
#define RCC_USE_DIVIDER (1U << 22)
#define RCC_DIVIDER_MASK (15U << 23)
#define RCC_DIVIDE_BY_4 (3U << 23)
#define RCGC0_WATCHDOG (1U << 3)
#define RCGC1_UART0 (1U << 0)
#define RCGC1_SSI0 (1U << 4)
#define RCGC2_PORT_A (1U << 0)
#define RCGC2_PORT_C (1U << 2)
#define RCGC2_PORT_D (1U << 3)

/* GPIO ports. An access to the data register changes those pins alone that bits 9..2 of its address name. */
#define GPIO_A 0x40004000U
#define GPIO_C 0x40006000U
#define GPIO_D 0x40007000U
#define GPIO_PIN(port, pin) EL_REGISTER((port) + (4U << (pin)))
#define GPIO_DIRECTION(port) EL_REGISTER((port) + 0x400U)
#define GPIO_ALTERNATE(port) EL_REGISTER((port) + 0x420U)
#define GPIO_DIGITAL(port) EL_REGISTER((port) + 0x51CU)

/* Watchdog: an interrupt when it ends for the first time, a reset at the second. */
#define WATCHDOG_LOAD EL_REGISTER(0x40000000)
#define WATCHDOG_CONTROL EL_REGISTER(0x40000008)
#define WATCHDOG_CLEAR EL_REGISTER(0x4000000C)
#define WATCHDOG_CONTROL_START (1U << 0)
#define WATCHDOG_CONTROL_RESET (1U << 1)

/* UART0: arm/pl011.h. */
#define UART0 ((el_pl011_registers *)0x4000C000)

/* SSI0: FIFOs of 8 words in each direction. */
#define SSI_CONTROL0 EL_REGISTER(0x40008000)
#define SSI_CONTROL1 EL_REGISTER(0x40008004)
#define SSI_DATA EL_REGISTER(0x40008008)
#define SSI_STATUS EL_REGISTER(0x4000800C)
#define SSI_PRESCALER EL_REGISTER(0x40008010)
#define SSI_INTERRUPTS EL_REGISTER(0x40008014)
#define SSI_CONTROL0_8_BITS (7U << 0)
#define SSI_CONTROL0_IDLE_HIGH (1U << 6)
#define SSI_CONTROL0_SECOND_EDGE (1U << 7)
#define SSI_CONTROL0_RATE(divider) (((divider)-1U) << 8)
#define SSI_CONTROL1_ENABLE (1U << 1)
#define SSI_STATUS_TX_NOT_FULL (1U << 1)
#define SSI_STATUS_RX_NOT_EMPTY (1U << 2)
#define SSI_STATUS_BUSY (1U << 4)
#define SSI_INTERRUPT_TX (1U << 3)
#define SSI_FIFO_WORDS 8U

/* Interrupts, by number. */
#define IRQ_UART0 5U
#define IRQ_SSI0 7U

#endif
