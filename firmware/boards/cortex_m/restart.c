/* Restart by the core's own request, for chips without a better one. */
#include "board.h"

/* Application interrupt and reset control (Armv7-M Architecture Reference Manual, B3.2.6): the key, SYSRESETREQ. */
static volatile uint32_t *const aircr = (volatile uint32_t *)0xE000ED0C;

enum { AIRCR_RESET = 0x05FA0004 };

_Noreturn void el_board_restart(void)
{
    __asm__ volatile("dsb" ::: "memory"); /* what was stored has arrived */
    *aircr = AIRCR_RESET;
    for (;;) { /* until it happens */
    }
}
