/* QEMU's RISC-V machine `virt` as a board (boards/board.h). Its clocks run from the start. */
#include "board.h"

#include "registers.h"
#include "riscv_virt.h"

const el_board *el_board_start(void)
{
    static el_board board = {.name = "QEMU RISC-V virt",
                             .bus = &el_virt_wire,
                             .port = &el_virt_uart,
                             .baud = EL_VIRT_BAUD,
                             .max_baud = EL_VIRT_MAX_BAUD};
    board.boot_id = RTC_LOW;
    el_virt_uart_start();
    el_virt_wire_start();
    el_virt_tick_start();
    el_virt_interrupts_on();
    return &board;
}

_Noreturn void el_board_restart(void)
{
    el_virt_interrupts_off();
    TEST = TEST_RESET;
    for (;;) {
    }
}
