/* Reports a fault and starts the board anew, by report.h, for example
 *
 *     HardFault: divide by zero, at 00001a36, called from 00001b05, xPSR 61000000, stack 2000ff58, CFSR 02000000,
 *     HFSR 40000000; edgeline-demo 0.1.0
 *
 * The addresses become lines of the source by `arm-none-eabi-addr2line -fipe PROGRAM.elf 1a36 1b05`. A fault in here
 * ends in lockup, out of which only a watchdog helps. */
#include <stddef.h>

#include "report.h"
#include "start.h"

#if defined(__ARM_ARCH_7M__) || defined(__ARM_ARCH_7EM__) || defined(__ARM_ARCH_8M_MAIN__)
#define HAS_FAULT_STATUS 1
#else
#define HAS_FAULT_STATUS 0 /* Armv6-M and Armv8-M Baseline tell nothing but where it was */
#endif

extern uint8_t el_bss_end[];

/* Numbers and names: Armv7-M Architecture Reference Manual, B1.5.2; 7: Armv8-M's, B3.9. */
static void put_exception(el_report *report, uint32_t number)
{
    enum { EXCEPTIONS = 16 };
    static const char *const names[EXCEPTIONS] = {
        [0] = "main returned", [2] = "NMI",        [3] = "HardFault",   [4] = "MemManage fault",
        [5] = "BusFault",      [6] = "UsageFault", [7] = "SecureFault", [11] = "SVCall",
        [12] = "DebugMonitor", [14] = "PendSV",    [15] = "SysTick"};

    if (number < EXCEPTIONS && names[number] != NULL) {
        el_report_text(report, names[number]);
    } else if (number >= EXCEPTIONS) {
        el_report_hex(report, "nobody serves interrupt ", number - EXCEPTIONS);
    } else {
        el_report_hex(report, "exception ", number);
    }
}

#if HAS_FAULT_STATUS

/* System control block: Armv7-M Architecture Reference Manual, B3.2.15 to B3.2.18. */
static volatile uint32_t *const cfsr = (volatile uint32_t *)0xE000ED28;
static volatile uint32_t *const hfsr = (volatile uint32_t *)0xE000ED2C;
static volatile uint32_t *const mmfar = (volatile uint32_t *)0xE000ED34;
static volatile uint32_t *const bfar = (volatile uint32_t *)0xE000ED38;

enum { MMFAR_IS_VALID = 1U << 7, BFAR_IS_VALID = 1U << 15, HFSR_VECTOR = 1U << 1 };

static void put_cause(el_report *report)
{
    static const struct {
        uint8_t bit; /* of CFSR */
        const char *meaning;
    } causes[] = {
        {0, "execution of no code"},
        {1, "access to a forbidden address"},
        {3, "forbidden address while returning from an exception"},
        {4, "stack overflow: forbidden address while entering an exception"},
        {5, "forbidden address while saving the FPU's registers"},
        {8, "execution where no memory is"},
        {9, "access to an address without memory"},
        {10, "access to an address without memory, a few instructions before"},
        {11, "no memory while returning from an exception"},
        {12, "stack overflow: no memory while entering an exception"},
        {13, "no memory while saving the FPU's registers"},
        {16, "undefined instruction"},
        {17, "jump to an even address, which is no Thumb code"},
        {18, "broken return from an exception"},
        {19, "coprocessor or FPU that is off or missing"},
        {20, "stack overflow"}, /* Armv8-M alone */
        {24, "unaligned access"},
        {25, "divide by zero"},
    };
    const char *before = ": ";
    for (size_t i = 0; i < sizeof causes / sizeof causes[0]; i++) {
        if ((*cfsr >> causes[i].bit & 1U) != 0) {
            el_report_text(report, before);
            el_report_text(report, causes[i].meaning);
            before = ", ";
        }
    }
    if ((*hfsr & HFSR_VECTOR) != 0) {
        el_report_text(report, before);
        el_report_text(report, "unreadable vector");
    }
    if ((*cfsr & BFAR_IS_VALID) != 0) {
        el_report_hex(report, ", address ", *bfar);
    } else if ((*cfsr & MMFAR_IS_VALID) != 0) {
        el_report_hex(report, ", address ", *mmfar);
    }
}

static void put_status(el_report *report)
{
    el_report_hex(report, ", CFSR ", *cfsr);
    el_report_hex(report, ", HFSR ", *hfsr);
}

#else

static void put_cause(el_report *report)
{
    (void)report;
}

static void put_status(el_report *report)
{
    (void)report;
}

#endif

static void put_place(el_report *report, const el_fault_frame *frame)
{
    const uintptr_t stack = (uintptr_t)frame;

    if (frame == NULL) {
        el_report_text(report, ", the stack is lost");
        return;
    }
    if (stack < (uintptr_t)el_bss_end) {
        el_report_text(report, ", stack overflow into the variables");
    }
    el_report_hex(report, ", at ", frame->pc);
    el_report_hex(report, ", called from ", frame->lr);
    el_report_hex(report, ", xPSR ", frame->xpsr);
    el_report_hex(report, ", stack ", (uint32_t)stack);
}

_Noreturn void el_fault(const el_fault_frame *frame, uint32_t number)
{
    el_report report;

    el_report_begin(&report);
    put_exception(&report, number);
    if (number != 0) {
        put_cause(&report);
        put_place(&report, frame);
        put_status(&report);
    }
    el_report_end(&report);
}
