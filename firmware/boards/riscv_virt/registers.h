/* Registers of QEMU's RISC-V machine `virt`: addresses and what the bits mean, nothing else.
 *
 * The memory map is QEMU's (its manual, "virt Generic Virtual Platform", and the device tree that `-machine
 * dumpdtb=FILE` writes). Chapters: "PLIC" is the RISC-V Platform-Level Interrupt Controller Specification 1.0.0,
 * "priv" The RISC-V Instruction Set Manual II: Privileged Architecture 1.12, "16550" the PC16550D's data sheet. */
#ifndef EL_RISCV_VIRT_REGISTERS_H
#define EL_RISCV_VIRT_REGISTERS_H

#include <stdint.h>

#define EL_REGISTER_8(address) (*(volatile uint8_t *)(uintptr_t)(address))
#define EL_REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))

/* Timer of hart 0 (priv 3.2.1): 64 bits in two words; an interrupt is pending while mtime >= mtimecmp. */
#define MTIMECMP_LOW EL_REGISTER(0x02004000)
#define MTIMECMP_HIGH EL_REGISTER(0x02004004)
#define MTIME_LOW EL_REGISTER(0x0200BFF8)
#define MTIME_HIGH EL_REGISTER(0x0200BFFC)
enum { MTIME_HZ = 10000000 };

/* Interrupt controller (PLIC 3): context 0 is hart 0's machine mode. */
#define PLIC_PRIORITY(source) EL_REGISTER(0x0C000000U + 4U * (source))
#define PLIC_ENABLE EL_REGISTER(0x0C002000) /* sources 0 .. 31, one bit each */
#define PLIC_THRESHOLD EL_REGISTER(0x0C200000)
#define PLIC_CLAIM EL_REGISTER(0x0C200004) /* read: the source, 0 for none; written: it has been served */
enum { PLIC_SOURCE_UART = 10 };

/* UART (16550 8.0, table II). DLAB in the line register, 0 from reset on, makes the first two the rate's divider. The
 * machine takes it and sends as fast as it can. */
#define UART_DATA EL_REGISTER_8(0x10000000)
#define UART_INTERRUPTS EL_REGISTER_8(0x10000001)
#define UART_DIVIDER_LOW EL_REGISTER_8(0x10000000)
#define UART_DIVIDER_HIGH EL_REGISTER_8(0x10000001)
#define UART_FIFO EL_REGISTER_8(0x10000002)
#define UART_LINE EL_REGISTER_8(0x10000003)
#define UART_MODEM EL_REGISTER_8(0x10000004)
#define UART_STATUS EL_REGISTER_8(0x10000005)
enum {
    UART_INTERRUPTS_RECEIVED = 1 << 0,
    UART_INTERRUPTS_EMPTY = 1 << 1, /* the transmit FIFO has become empty, or is when this bit is set */
    UART_FIFO_ON_AND_CLEARED = 7,
    UART_LINE_8N1 = 3,
    UART_LINE_DLAB = 1 << 7,
    UART_CLOCK_HZ = 3686400, /* as the device tree says; 16 for each bit */
    UART_MODEM_DTR_RTS = 3,
    UART_STATUS_RECEIVED = 1 << 0,
    UART_STATUS_EMPTY = 1 << 5, /* the transmit FIFO is */
    UART_STATUS_IDLE = 1 << 6,  /* the last bit is out, too */
    UART_FIFO_BYTES = 16
};

/* Clock of the day (QEMU's goldfish-rtc): nanoseconds since 1970, the low word. */
#define RTC_LOW EL_REGISTER(0x00101000)

/* SiFive's test device: ends QEMU, or resets the machine. */
#define TEST EL_REGISTER(0x00100000)
enum { TEST_RESET = 0x7777 };

#endif
