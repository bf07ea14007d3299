/* platform.h on a bare Cortex-M in QEMU: vectors, start-up, and text and exit by semihosting (Arm, "Semihosting for
 * AArch32 and AArch64", operations SYS_WRITE0 and SYS_EXIT_EXTENDED). Whatever goes wrong ends the program with
 * status 99. */
#include "platform.h"

#include <string.h>

const unsigned bench_repeats = 1;

/* From the linker script. */
extern uint8_t bench_data_begin[], bench_data_end[], bench_data_load[], bench_bss_begin[], bench_bss_end[];
extern uint32_t bench_stack_end[];

enum { SYS_WRITE0 = 0x04, SYS_EXIT_EXTENDED = 0x20, APPLICATION_EXIT = 0x20026, STATUS_FAULT = 99 };

static void semihost(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static _Noreturn void finish(uint32_t status)
{
    const uint32_t reason[2] = {APPLICATION_EXIT, status};
    for (;;) {
        semihost(SYS_EXIT_EXTENDED, reason);
    }
}

/* Empty, but never inlined, merged or left out. */
__attribute__((noinline)) void bench_next(void)
{
    __asm__ volatile("nop" ::: "memory");
}

__attribute__((noinline)) void bench_start(void)
{
    __asm__ volatile("nop" ::: "memory");
}

__attribute__((noinline)) void bench_stop(void)
{
    __asm__ volatile("nop" ::: "memory");
}

uint64_t bench_elapsed_ns(void)
{
    return 0;
}

void bench_print(const char *text)
{
    semihost(SYS_WRITE0, text);
}

void *bench_scratch(size_t size)
{
    (void)size;
    return NULL;
}

void bench_keep(const char *group, const char *name, const void *bytes, size_t size)
{
    (void)group;
    (void)name;
    (void)bytes;
    (void)size;
}

static void fault(void)
{
    finish(STATUS_FAULT);
}

static void reset(void)
{
#ifdef __ARM_FP
    /* Coprocessor access: full for CP10 and CP11, the floating-point unit (Armv7-M Architecture Reference Manual,
     * B3.2.20). A compiler may keep integers in its registers. */
    *(volatile uint32_t *)0xE000ED88 |= 0xFU << 20;
    __asm__ volatile("dsb\n isb");
#endif
    memcpy(bench_data_begin, bench_data_load, (size_t)(bench_data_end - bench_data_begin));
    memset(bench_bss_begin, 0, (size_t)(bench_bss_end - bench_bss_begin));
    finish((uint32_t)bench_main());
}

typedef union vector {
    void (*handler)(void);
    uint32_t *stack;
} vector;

/* The initial stack, reset, and the fourteen other exceptions of the core; no interrupt is ever enabled. */
__attribute__((section(".vectors"), used)) static const vector vectors[16] = {
    {.stack = bench_stack_end}, {.handler = reset}, {.handler = fault}, {.handler = fault},
    {.handler = fault},         {.handler = fault}, {.handler = fault}, {.handler = fault},
    {.handler = fault},         {.handler = fault}, {.handler = fault}, {.handler = fault},
    {.handler = fault},         {.handler = fault}, {.handler = fault}, {.handler = fault},
};
