/* A bare program's line to the emulator (Arm, "Semihosting for AArch32 and AArch64", operations SYS_WRITE0 and
 * SYS_EXIT_EXTENDED; RISC-V has taken them over). Whatever faults ends the program with status 99: on Cortex-M semihost.c
 * gives boards/cortex_m/start.c its el_fault, on RISC-V riscv_trap.c sees to it. */
#ifndef EL_TEST_SEMIHOST_H
#define EL_TEST_SEMIHOST_H

enum { SEMIHOST_FAULT = 99 };

/* To the emulator's console. */
void semihost_print(const char *text);

/* Ends the emulator with that status, 0 to 255. */
_Noreturn void semihost_exit(int status);

#endif
