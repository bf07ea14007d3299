/* A RISC-V program's traps: any exception ends it with status 99, where picolibc's start-up would leave it spinning. */
#include <stdint.h>
#include <stdlib.h>

#include "semihost.h"

/* mtvec holds a multiple of 4 and a mode in its lower bits, 0: all traps come here (Privileged Architecture, 3.1.7). */
__attribute__((aligned(4))) static void trapped(void)
{
    _Exit(SEMIHOST_FAULT);
}

__attribute__((constructor)) static void catch_traps(void)
{
    __asm__ volatile(".option push\n.option arch, +zicsr\ncsrw mtvec, %0\n.option pop" : : "r"((uintptr_t)trapped));
}
