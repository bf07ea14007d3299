/* Start-up of every Cortex-M: vectors, memory, faults. The linker script gives el_stack_end, el_data_begin,
 * el_data_end, el_data_load, el_bss_begin and el_bss_end (8-byte aligned), and places `.vectors.core`, then
 * `.vectors.irq`, which is the board's own table of its interrupts. */
#ifndef EL_BOARDS_CORTEX_M_START_H
#define EL_BOARDS_CORTEX_M_START_H

#include <stdint.h>

typedef void (*el_vector)(void);

/* The program. It must not return. */
int main(void);

/* Of a fault: what the processor pushed (Armv6-M and Armv7-M Architecture Reference Manuals, "Stack alignment on
 * exception entry"). */
typedef struct el_fault_frame {
    uint32_t r0, r1, r2, r3, r12;
    uint32_t lr; /* where the function that failed was called from */
    uint32_t pc; /* the instruction that failed, or one shortly after it */
    uint32_t xpsr;
} el_fault_frame;

/* Called once on any fault or unexpected exception, with interrupts off; `number` is the exception's. `frame` may be
 * NULL when the stack pointer was no address of RAM. The program gives it: fault.c, or a test's own. */
_Noreturn void el_fault(const el_fault_frame *frame, uint32_t number);

/* Any interrupt that nobody serves ends in el_fault; for `.vectors.irq`, also so many in a row. */
void el_fault_entry(void);
#define EL_FAULT_ENTRY_4 el_fault_entry, el_fault_entry, el_fault_entry, el_fault_entry
#define EL_FAULT_ENTRY_16 EL_FAULT_ENTRY_4, EL_FAULT_ENTRY_4, EL_FAULT_ENTRY_4, EL_FAULT_ENTRY_4

/* The core's timer; el_fault_entry unless a board has a handler (systick.c). */
void el_systick_entry(void);

#endif
