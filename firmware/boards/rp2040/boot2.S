/* The second stage of the boot: the 256 bytes at the beginning of the flash, which the boot ROM copies to RAM and runs
 * (RP2040 data sheet, 2.8.1.3). They make the flash readable as memory, fast, and start the program behind them.
 *
 * The flash of the Pico is a W25Q16JV. Its quickest read is EBh with four data lines: the address goes in 6 clocks, then
 * a mode byte in 2 and 4 idle clocks; with the mode byte A0h the next read needs no command byte (W25Q16JV data sheet,
 * 8.2.11, "Fast Read Quad I/O with Continuous Read Mode"). That needs the chip's bit QE, which is bit 1 of status
 * register 2 and is set here, once for ever, where it is not.
 *
 * The SSI's registers: RP2040 data sheet, 4.10.13. It may be set up only while it is disabled (SSIENR 0). */
    .syntax unified
    .cpu cortex-m0plus
    .thumb

    .equ PADS_QSPI, 0x40020000
    .equ PAD_SCLK, 0x04
    .equ PAD_SD0, 0x08
    .equ PAD_SD3, 0x14
    .equ PAD_8_MA_FAST, 0x21        /* 2.19.6.4: drive strength 2 << 4, fast edges */
    .equ PAD_SD, 0x50               /* input, 4 mA, no Schmitt trigger, whose delay costs half a clock */

    .equ SSI, 0x18000000
    .equ CTRLR0, 0x00
    .equ CTRLR1, 0x04
    .equ SSIENR, 0x08
    .equ BAUDR, 0x14
    .equ SR, 0x28
    .equ DR0, 0x60
    .equ RX_SAMPLE_DLY, 0xF0        /* from here on beyond the reach of an immediate offset */
    .equ SPI_CTRLR0, 0xF4
    .equ SR_BUSY, 0x01
    .equ SR_TFE, 0x04

    .equ CTRLR0_BYTES, 7 << 16                              /* both ways, 8 bits a frame, one line */
    .equ CTRLR0_XIP, (2 << 21) | (31 << 16) | (3 << 8)      /* four lines, 32 bits a frame, read by command and address */
    .equ XIP_FIRST, (4 << 11) | (2 << 8) | (8 << 2) | 1     /* 4 idle clocks, 8 bits of command on one line, 32 of address */
    .equ XIP_NEXT, (0xA0 << 24) | (4 << 11) | (8 << 2) | 2  /* no command, the mode byte after the address */

    .equ FLASH_WRITE_STATUS, 0x01
    .equ FLASH_READ_STATUS_1, 0x05
    .equ FLASH_WRITE_ENABLE, 0x06
    .equ FLASH_READ_STATUS_2, 0x35
    .equ FLASH_QUAD_READ, 0xEB
    .equ FLASH_CONTINUOUS, 0xA0
    .equ FLASH_QE, 0x02
    .equ FLASH_BUSY, 0x01

    .equ VTOR, 0xE000ED08
    .equ VECTORS, 0x10000100

    .section .boot2, "ax"
    .global el_boot2
    .type el_boot2, %function
    .thumb_func
el_boot2:
    ldr  r0, =PADS_QSPI
    movs r1, #PAD_8_MA_FAST
    str  r1, [r0, #PAD_SCLK]
    movs r1, #PAD_SD
    str  r1, [r0, #PAD_SD0]
    str  r1, [r0, #PAD_SD0 + 4]
    str  r1, [r0, #PAD_SD0 + 8]
    str  r1, [r0, #PAD_SD3]

    ldr  r4, =SSI
    movs r5, #0
    movs r6, #1
    str  r5, [r4, #SSIENR]
    movs r1, #2                     /* 62.5 MHz once clk_sys runs at 125 MHz */
    str  r1, [r4, #BAUDR]
    movs r0, #RX_SAMPLE_DLY         /* data arrive one clock of clk_sys later than at the pin */
    str  r6, [r4, r0]
    ldr  r1, =CTRLR0_BYTES
    str  r1, [r4, #CTRLR0]
    str  r6, [r4, #SSIENR]

    movs r0, #FLASH_READ_STATUS_2
    bl   read_status
    movs r1, #FLASH_QE
    tst  r0, r1
    bne  quad
    movs r0, #FLASH_WRITE_ENABLE
    bl   exchange
    movs r0, #FLASH_WRITE_STATUS    /* both status registers: nothing protected, QE */
    str  r0, [r4, #DR0]
    str  r5, [r4, #DR0]
    movs r0, #FLASH_QE
    bl   exchange
    ldr  r0, [r4, #DR0]
    ldr  r0, [r4, #DR0]
1:  movs r0, #FLASH_READ_STATUS_1   /* 15 ms at most, W25Q16JV data sheet, 9.6 */
    bl   read_status
    movs r1, #FLASH_BUSY
    tst  r0, r1
    bne  1b

quad:
    str  r5, [r4, #SSIENR]
    ldr  r1, =CTRLR0_XIP
    str  r1, [r4, #CTRLR0]
    str  r5, [r4, #CTRLR1]
    ldr  r1, =XIP_FIRST
    movs r0, #SPI_CTRLR0
    str  r1, [r4, r0]
    str  r6, [r4, #SSIENR]
    movs r1, #FLASH_QUAD_READ       /* a first read by hand, with its command: the chip goes on without */
    str  r1, [r4, #DR0]
    movs r1, #FLASH_CONTINUOUS
    str  r1, [r4, #DR0]
    bl   wait
    str  r5, [r4, #SSIENR]
    ldr  r1, =XIP_NEXT
    movs r0, #SPI_CTRLR0
    str  r1, [r4, r0]
    str  r6, [r4, #SSIENR]

    ldr  r0, =VECTORS
    ldr  r1, =VTOR
    str  r0, [r1]
    ldmia r0!, {r1, r2}
    msr  msp, r1
    bx   r2

/* r0: a command that answers with one byte; returns it in r0. */
read_status:
    mov  r7, lr
    str  r0, [r4, #DR0]
    bl   exchange                   /* the byte that makes the clock for the answer; it may be anything */
    ldr  r0, [r4, #DR0]
    bx   r7

/* Sends the byte r0 and returns in r0 what came for the first byte that waits. */
exchange:
    str  r0, [r4, #DR0]
    mov  r3, lr
    bl   wait
    ldr  r0, [r4, #DR0]
    bx   r3

/* Until all is sent. No bound: the SSI is the master of this bus. */
wait:
    ldr  r1, [r4, #SR]
    movs r2, #SR_TFE
    tst  r1, r2
    beq  wait
    movs r2, #SR_BUSY
    tst  r1, r2
    bne  wait
    bx   lr

    .ltorg
    .size el_boot2, . - el_boot2

/* CRC-32 of the 252 bytes before it, polynomial 04C11DB7h, initial value FFFFFFFFh, most significant bit first, no final
 * inversion (2.8.1.3.1). make_uf2.py refuses a program in which it is wrong, and says what it must be. */
    .section .boot2.crc, "a"
    .word 0x30fd67bd
