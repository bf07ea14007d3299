/* What the parts of this board give each other: time, interrupts, semihosting, the two links. */
#ifndef EL_RISCV_VIRT_H
#define EL_RISCV_VIRT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/bus.h"
#include "base/port.h"

/* timer.c: microseconds since the machine was switched on; wraps at 2^32. Works in interrupts and faults, too. */
uint32_t el_virt_micros(void);

/* timer.c: the tick of 1 ms, which its interrupt sets anew. False when nobody has fed the watchdog for its time. */
void el_virt_tick_start(void);
bool el_virt_tick(void);

/* start.S: the timer's interrupts and the interrupt controller's, both of which have to be ready. */
void el_virt_interrupts_on(void);
void el_virt_interrupts_off(void);
/* From here on a trap resets the machine without a word: what fails within a fault report must not begin another. */
void el_virt_traps_reset(void);

/* start.S: asks the machine's semihosting for something (RISC-V Semihosting 1.0; the operations are those of
 * "Semihosting for AArch32 and AArch64"). -1 where QEMU runs without it: its EBREAK is a trap then, and trap.c sees
 * to it. */
int32_t el_virt_semihost(uint32_t operation, const void *parameters);

/* uart.c */
extern const el_port el_virt_uart;
enum { EL_VIRT_BAUD = 115200, EL_VIRT_MAX_BAUD = 230400 }; /* at the start; all of its clock */
void el_virt_uart_start(void);
void el_virt_uart_interrupt(void);

/* wire.c */
extern const el_bus el_virt_wire;
void el_virt_wire_start(void);

#endif
