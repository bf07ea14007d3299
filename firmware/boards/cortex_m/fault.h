/* The last words of a program: a LOG packet (WIRE.md) that says what failed and where, for example
 *
 *     HardFault: divide by zero, at 00001a36, called from 00001b05, xPSR 61000000, stack 2000ff58, CFSR 02000000,
 *     HFSR 40000000; edgeline-demo 0.1.0
 *
 * The addresses become lines of the source by `arm-none-eabi-addr2line -fipe PROGRAM.elf 1a36 1b05`. */
#ifndef EL_BOARDS_CORTEX_M_FAULT_H
#define EL_BOARDS_CORTEX_M_FAULT_H

/* The program gives it: its name and version, as HELLO tells it, at most 64 bytes. Without it the report ends before. */
extern const char el_firmware_name[];

#endif
