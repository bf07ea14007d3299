/* All traps of the processor: the tick, the UART, and faults, which become a LOG packet and a new start, for example
 *
 *     load access fault, at 80000ed2, called from 80000dde, mcause 00000005, mtval 00000000, stack 801130d0;
 *     edgeline-demo 0.1.0
 *
 * The addresses become functions by `riscv64-unknown-elf-addr2line -fipe PROGRAM.elf 80000ed2 80000dde`. The second is
 * where the function returns to, if it had not yet called another one. */
#include <stddef.h>

#include "registers.h"
#include "report.h"
#include "riscv_virt.h"

/* As start.S pushes it. */
typedef struct el_trap_frame {
    uint32_t ra;
    uint32_t t[7];
    uint32_t a[8];
    uint32_t sp;
} el_trap_frame;

_Static_assert(offsetof(el_trap_frame, a) == 32 && offsetof(el_trap_frame, sp) == 64,
               "start.S stores at these offsets");

/* start.S calls it with interrupts off; returns where the program goes on. */
uint32_t el_trap(uint32_t mcause, uint32_t mepc, uint32_t mtval, el_trap_frame *frame);

extern const char el_virt_semihost_break[]; /* the instruction */
extern const char el_stack_begin[], el_stack_end[];

/* mcause (priv 3.1.15) */
#define CAUSE_INTERRUPT 0x80000000U
#define CAUSE_TIMER (CAUSE_INTERRUPT | 7U)
#define CAUSE_EXTERNAL (CAUSE_INTERRUPT | 11U)
#define CAUSE_BREAKPOINT 3U

static const char *name_of(uint32_t mcause)
{
    static const char *const names[] = {
        "instruction address misaligned", "instruction access fault", "illegal instruction",      "breakpoint",
        "load address misaligned",        "load access fault",        "store address misaligned", "store access fault",
    };
    return mcause < sizeof names / sizeof names[0] ? names[mcause] : "unexpected trap";
}

static _Noreturn void fail(const char *what, uint32_t mcause, uint32_t mepc, uint32_t mtval, const el_trap_frame *frame)
{
    el_virt_traps_reset();
    el_report report;
    el_report_begin(&report);
    el_report_text(&report, what);
    el_report_hex(&report, ", at ", mepc);
    el_report_hex(&report, ", called from ", frame->ra);
    el_report_hex(&report, ", mcause ", mcause);
    el_report_hex(&report, ", mtval ", mtval);
    el_report_hex(&report, ", stack ", frame->sp);
    el_report_end(&report);
}

static bool is_within_stack(uintptr_t address)
{
    return address >= (uintptr_t)el_stack_begin && address <= (uintptr_t)el_stack_end;
}

/* A trap within a trap pushes onto the program's stack, because the two stack pointers change places once more. */
static bool is_stack_lost(const el_trap_frame *frame)
{
    return !is_within_stack(frame->sp) && !is_within_stack((uintptr_t)frame);
}

uint32_t el_trap(uint32_t mcause, uint32_t mepc, uint32_t mtval, el_trap_frame *frame)
{
    if (is_stack_lost(frame)) {
        fail("stack overflow", mcause, mepc, mtval, frame);
    }
    if (mcause == CAUSE_TIMER) {
        if (!el_virt_tick()) {
            fail("the program hangs", mcause, mepc, mtval, frame);
        }
        return mepc;
    }
    if (mcause == CAUSE_EXTERNAL) {
        for (uint32_t source; (source = PLIC_CLAIM) != 0; PLIC_CLAIM = source) {
            el_virt_uart_interrupt(); /* the one source that is enabled */
        }
        return mepc;
    }
    if (mcause == CAUSE_BREAKPOINT && mepc == (uintptr_t)el_virt_semihost_break) {
        frame->a[0] = UINT32_MAX; /* -1, as where the file does not open */
        return mepc + 4;
    }
    fail(name_of(mcause), mcause, mepc, mtval, frame);
}
