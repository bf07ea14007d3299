/* The last words of a program: a LOG packet (WIRE.md, "Fault reports") that says what failed, for example
 *
 *     el_init failed with status -3; edgeline-demo 0.1.0
 *
 * What the program left behind is not believed: the packet is made on the stack, with a sequence of its own from 0,
 * after a 00 that ends whatever stood on the line; and it leaves by polling. Any board; the cores' fault handlers use
 * it. */
#ifndef EL_BOARDS_REPORT_H
#define EL_BOARDS_REPORT_H

#include <stdint.h>

#include "stream/packet.h"

/* Private; it refers to itself, so it stays where el_report_begin found it. */
typedef struct el_report {
    el_packet_writer writer;
    uint8_t queue[EL_COBS_ENCODER_MIN_BYTES];
} el_report;

/* Turns interrupts off, for good: nothing else may speak on the link. */
void el_report_begin(el_report *report);

void el_report_text(el_report *report, const char *text);

/* `before`, then eight digits. */
void el_report_hex(el_report *report, const char *before, uint32_t value);

/* Adds the program's name, sends what is left, and starts the board anew. */
_Noreturn void el_report_end(el_report *report);

/* The whole report of a call that answered `status`, after which the program cannot go on. */
_Noreturn void el_report_failure(const char *call, int32_t status);

#endif
