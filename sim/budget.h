/* The one figure of a budget that no macro can tell: the stack. */
#ifndef EL_SIM_BUDGET_H
#define EL_SIM_BUDGET_H

/* For the deepest chain of calls below el_draw and el_frame_next, panel driver and stream included, on Cortex-M0+ and M4F
 * at -O2 and -Os: tests/host/test_budget_s_stack_is_enough.py follows the compiler's call graph. The functions of bus.h and
 * port.h, interrupts and the caller's own frames are not in it. */
enum {
    EL_BUDGET_STACK_BYTES = 2048,       /* on one core; each further core of el_config.workers has a stack like it */
    EL_BUDGET_WORKERS_STACK_BYTES = 512 /* more for the core that calls el_draw where there are others */
};

#endif
