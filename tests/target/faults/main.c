/* Fails as a letter asks that the emulator's loader puts into memory, at each start anew. QEMU's MPS2 board; its UART is
 * Arm's CMSDK one (Cortex-M System Design Kit Technical Reference Manual, 4.3). */
#include <stddef.h>
#include <string.h>

#include "board.h"
#include "start.h"

typedef struct uart {
    volatile uint32_t data;
    volatile uint32_t state; /* 1: the transmitter is full */
    volatile uint32_t control;
    volatile uint32_t interrupts;
    volatile uint32_t divider;
} uart;

static uart *const uart0 = (uart *)0x40004000;
static volatile uint32_t *const letter = (volatile uint32_t *)0x20000000; /* memory that the program has no use for */

/* System control block: Armv7-M Architecture Reference Manual, B3.2.4, B3.2.6 and B3.2.8. */
static volatile uint32_t *const icsr = (volatile uint32_t *)0xE000ED04;
static volatile uint32_t *const aircr = (volatile uint32_t *)0xE000ED0C;
static volatile uint32_t *const ccr = (volatile uint32_t *)0xE000ED14;

enum { ICSR_SET_NMI = 31, AIRCR_RESET = 0x05FA0004, CCR_TRAP_UNALIGNED = 1 << 3, CCR_TRAP_DIVIDE = 1 << 4 };

const char el_firmware_name[] = "faults 1.0";

static uint8_t variables[1024]; /* where a stack that is too deep ends up */

void el_board_panic_write(const uint8_t *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        while ((uart0->state & 1) != 0) {
        }
        uart0->data = bytes[i];
    }
}

_Noreturn void el_board_restart(void)
{
    *aircr = AIRCR_RESET;
    for (;;) {
    }
}

/* Each has a name of its own for addr2line to find. */

__attribute__((noinline)) static void undefined_instruction(void)
{
    __asm__ volatile("udf #1");
}

/* Aligned for even_address, which jumps to it as if it were Arm code. */
__attribute__((noinline, aligned(4))) static void bad_address(void)
{
    *(volatile uint32_t *)0xF0000000 = 1;
}

__attribute__((noinline)) static void unaligned_access(void)
{
    uint32_t value;
    __asm__ volatile("ldr %0, [%1]" : "=r"(value) : "r"(variables + 1));
}

__attribute__((noinline)) static void even_address(void)
{
    __asm__ volatile("bx %0" : : "r"((uintptr_t)bad_address & ~(uintptr_t)1));
}

#ifndef __ARM_ARCH_6M__
__attribute__((noinline)) static void divide_by_zero(void)
{
    uint32_t value;
    __asm__ volatile("udiv %0, %1, %2" : "=r"(value) : "r"(1), "r"(0));
}
#endif

__attribute__((noinline)) static void stack_where_no_memory_is(void)
{
    __asm__ volatile("mov sp, %0\n push {r0-r7}" : : "r"(0xF0000000));
}

__attribute__((noinline)) static void stack_in_the_variables(void)
{
    __asm__ volatile("mov sp, %0\n udf #2" : : "r"((uintptr_t)(variables + 512) & ~(uintptr_t)7));
}

__attribute__((noinline)) static void system_call(void)
{
    __asm__ volatile("svc #0");
}

__attribute__((noinline)) static void in_mid_packet(void)
{
    static const uint8_t begun[] = {0x20, 0x03, 0x05, 'b', 'a', 'n', 'd'};
    el_board_panic_write(begun, sizeof begun);
    __asm__ volatile("udf #3");
}

int main(void)
{
    static const uint8_t ready[] = "ready";

    uart0->divider = 16;
    uart0->control = 1;
    memset(variables, 0, sizeof variables);
    *ccr |= CCR_TRAP_DIVIDE | CCR_TRAP_UNALIGNED;
    el_board_panic_write(ready, sizeof ready);
    switch (*letter) {
    case 'u':
        undefined_instruction();
        break;
    case 'a':
        bad_address();
        break;
    case 'l':
        unaligned_access();
        break;
    case 'e':
        even_address();
        break;
#ifndef __ARM_ARCH_6M__
    case 'd':
        divide_by_zero();
        break;
#endif
    case 'o':
        stack_where_no_memory_is();
        break;
    case 'v':
        stack_in_the_variables();
        break;
    case 'c':
        system_call();
        break;
    case 'n':
        *icsr = 1U << ICSR_SET_NMI;
        break;
    case 'p':
        in_mid_packet();
        break;
    default:
        break;
    }
    return 0;
}
