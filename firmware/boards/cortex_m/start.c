/* Reset and the core's exceptions, for Armv6-M, Armv7-M and Armv8-M alike. */
#include "start.h"

#include <stddef.h>
#include <string.h>

extern uint8_t el_data_begin[], el_data_end[], el_data_load[], el_bss_begin[], el_bss_end[];
extern uint32_t el_stack_end[];

static void reset(void)
{
#ifdef __ARM_FP
    /* Coprocessor access: full for CP10 and CP11, the floating-point unit (Armv7-M Architecture Reference Manual,
     * B3.2.20). A compiler may keep integers in its registers. */
    *(volatile uint32_t *)0xE000ED88 |= 0xFU << 20;
    __asm__ volatile("dsb\n isb");
#endif
    memcpy(el_data_begin, el_data_load, (size_t)(el_data_end - el_data_begin));
    memset(el_bss_begin, 0, (size_t)(el_bss_end - el_bss_begin));
    (void)main();
    el_fault(NULL, 0);
}

/* The frame's address is only believed where it lies between the first variable and the stack's end. */
__attribute__((used)) static _Noreturn void el_fault_at(const el_fault_frame *frame)
{
    uint32_t ipsr;
    __asm__ volatile("mrs %0, ipsr" : "=r"(ipsr));
    const uintptr_t at = (uintptr_t)frame;
    const int good = (at & 3U) == 0 && at >= (uintptr_t)el_data_begin && at + sizeof *frame <= (uintptr_t)el_stack_end;
    el_fault(good ? frame : NULL, ipsr & 0x1FFU);
}

/* Everything runs on the main stack, which holds the frame. The report goes on below it where there is a kilobyte of
 * room, and else from the stack's end, because a stack that overflowed would fault again. */
__attribute__((naked)) void el_fault_entry(void)
{
    __asm__ volatile("cpsid i\n"
                     "mrs r0, msp\n"
                     "ldr r1, =el_stack_end\n"
                     "cmp r0, r1\n"
                     "bhi 1f\n"
                     "ldr r2, =el_bss_end + 1024\n"
                     "cmp r0, r2\n"
                     "bhs 2f\n"
                     "1: mov sp, r1\n"
                     "2: bl el_fault_at\n"
                     ".ltorg\n");
}

__attribute__((weak, alias("el_fault_entry"))) void el_systick_entry(void);

typedef union core_vector {
    el_vector handler;
    uint32_t *stack;
} core_vector;

/* The initial stack, reset, and the fourteen other exceptions of the core. */
__attribute__((section(".vectors.core"), used)) static const core_vector core_vectors[16] = {
    {.stack = el_stack_end},       {.handler = reset},          {.handler = el_fault_entry},
    {.handler = el_fault_entry},   {.handler = el_fault_entry}, {.handler = el_fault_entry},
    {.handler = el_fault_entry},   {.handler = el_fault_entry}, {.handler = el_fault_entry},
    {.handler = el_fault_entry},   {.handler = el_fault_entry}, {.handler = el_fault_entry},
    {.handler = el_fault_entry},   {.handler = el_fault_entry}, {.handler = el_fault_entry},
    {.handler = el_systick_entry},
};
