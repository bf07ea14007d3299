/* Reset, the way into and out of traps, and the few things that C cannot say: control registers, semihosting's call.
 *
 * Traps have a stack of their own (riscv_virt.ld), whose end waits in mscratch while the program runs: so a fault can
 * be reported whatever the program's stack pointer is. Interrupts do not nest. */

    .option norelax /* relaxed code loads addresses relative to gp, which the first lines have yet to load */
    .option arch, +zicsr

    .equ MSTATUS_MIE, 1 << 3
    .equ MIE_TIMER_AND_EXTERNAL, (1 << 7) | (1 << 11)

    /* The first bytes of the image: with `-bios none` QEMU's reset jumps to the beginning of RAM. */
    .section .reset, "ax"
    .globl el_reset
    .type el_reset, @function
el_reset:
    csrci mstatus, MSTATUS_MIE
    csrw mie, zero
    csrr t0, mhartid
park:
    bnez t0, park /* -smp: the first processor alone works */
    la gp, __global_pointer$
    la sp, el_stack_end
    la t0, el_trap_stack_end
    csrw mscratch, t0
    la t0, trap
    csrw mtvec, t0

    la t0, el_data_begin
    la t1, el_data_end
    la t2, el_data_load
    j 2f
1:  lw t3, 0(t2)
    sw t3, 0(t0)
    addi t0, t0, 4
    addi t2, t2, 4
2:  bltu t0, t1, 1b

    la t0, el_bss_begin
    la t1, el_bss_end
    j 4f
3:  sw zero, 0(t0)
    addi t0, t0, 4
4:  bltu t0, t1, 3b

    call main
    ebreak /* main does not return; if it does, the report says `breakpoint` and this address */
    .size el_reset, . - el_reset

    .text
    .balign 4 /* mtvec's two low bits are its mode */
    .type trap, @function
trap:
    csrrw sp, mscratch, sp
    addi sp, sp, -80
    sw ra, 0(sp)
    sw t0, 4(sp)
    sw t1, 8(sp)
    sw t2, 12(sp)
    sw t3, 16(sp)
    sw t4, 20(sp)
    sw t5, 24(sp)
    sw t6, 28(sp)
    sw a0, 32(sp) /* el_trap_frame of trap.c knows where ra, a0 and sp are */
    sw a1, 36(sp)
    sw a2, 40(sp)
    sw a3, 44(sp)
    sw a4, 48(sp)
    sw a5, 52(sp)
    sw a6, 56(sp)
    sw a7, 60(sp)
    csrr t0, mscratch
    sw t0, 64(sp)

    csrr a0, mcause
    csrr a1, mepc
    csrr a2, mtval
    mv a3, sp
    call el_trap
    csrw mepc, a0

    lw ra, 0(sp)
    lw t0, 4(sp)
    lw t1, 8(sp)
    lw t2, 12(sp)
    lw t3, 16(sp)
    lw t4, 20(sp)
    lw t5, 24(sp)
    lw t6, 28(sp)
    lw a0, 32(sp)
    lw a1, 36(sp)
    lw a2, 40(sp)
    lw a3, 44(sp)
    lw a4, 48(sp)
    lw a5, 52(sp)
    lw a6, 56(sp)
    lw a7, 60(sp)
    addi sp, sp, 80
    csrrw sp, mscratch, sp
    mret
    .size trap, . - trap

    .globl el_virt_traps_reset
    .type el_virt_traps_reset, @function
el_virt_traps_reset:
    la t0, 1f
    csrw mtvec, t0
    ret
    .balign 4
1:  la sp, el_trap_stack_end
    j el_board_restart
    .size el_virt_traps_reset, . - el_virt_traps_reset

    .globl el_virt_interrupts_on
    .type el_virt_interrupts_on, @function
el_virt_interrupts_on:
    li t0, MIE_TIMER_AND_EXTERNAL
    csrs mie, t0
    csrsi mstatus, MSTATUS_MIE
    ret
    .size el_virt_interrupts_on, . - el_virt_interrupts_on

    .globl el_virt_interrupts_off
    .type el_virt_interrupts_off, @function
el_virt_interrupts_off:
    csrci mstatus, MSTATUS_MIE
    ret
    .size el_virt_interrupts_off, . - el_virt_interrupts_off

    /* Three uncompressed instructions within one page are the call; the first and the last do nothing but mark it. */
    .globl el_virt_semihost
    .globl el_virt_semihost_break
    .type el_virt_semihost, @function
    .option norvc
    .balign 16
el_virt_semihost:
    slli zero, zero, 0x1f
el_virt_semihost_break:
    ebreak
    srai zero, zero, 7
    ret
    .size el_virt_semihost, . - el_virt_semihost
