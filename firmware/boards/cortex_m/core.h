/* The processor's own parts that boards use: interrupts, sleep. Numbers of interrupts are the chip's.
 *
 * Registers: Armv7-M Architecture Reference Manual, "Nested Vectored Interrupt Controller"; Armv6-M's are the same,
 * with the first 32 numbers. */
#ifndef EL_BOARDS_CORTEX_M_CORE_H
#define EL_BOARDS_CORTEX_M_CORE_H

#include <stdbool.h>
#include <stdint.h>

static inline void el_core_set_interrupt_bit(uintptr_t array, unsigned number)
{
    ((volatile uint32_t *)array)[number / 32U] = 1U << number % 32U;
}

static inline void el_core_enable_interrupt(unsigned number)
{
    el_core_set_interrupt_bit(0xE000E100, number);
}

/* It does not come any more when this returns. */
static inline void el_core_disable_interrupt(unsigned number)
{
    el_core_set_interrupt_bit(0xE000E180, number);
    __asm__ volatile("dsb\n isb" ::: "memory");
}

/* Makes it come as if its source had asked. */
static inline void el_core_pend_interrupt(unsigned number)
{
    el_core_set_interrupt_bit(0xE000E200, number);
}

/* Sleeps until an interrupt unless `*waiting`, which one of them clears, is false. Interrupts are held back between the
 * look and the sleep, lest the one that clears it comes there; sleep ends all the same when one is pending. */
static inline void el_core_sleep_while(const volatile bool *waiting)
{
    __asm__ volatile("cpsid i" ::: "memory");
    if (*waiting) {
        __asm__ volatile("wfi" ::: "memory");
    }
    __asm__ volatile("cpsie i\n isb" ::: "memory");
}

#endif
