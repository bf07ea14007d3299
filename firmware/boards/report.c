#include "report.h"

#include <stdbool.h>
#include <stddef.h>

#include "board.h"

__attribute__((weak)) const char el_firmware_name[] = "";

static void turn_interrupts_off(void)
{
#if defined(__arm__)
    __asm__ volatile("cpsid i" ::: "memory");
#elif defined(__riscv)
    /* MIE. The compiler may have been told of a processor without Zicsr, because that name is younger than its
     * libraries. */
    __asm__ volatile(".option push\n.option arch, +zicsr\ncsrci mstatus, 8\n.option pop" ::: "memory");
#else
#error "report.c: say here how this processor turns its interrupts off"
#endif
}

static bool drain(void *context)
{
    el_packet_writer *writer = context;
    size_t count;
    const uint8_t *bytes = el_cobs_final(&writer->wire, &count);
    el_board_panic_write(bytes, count);
    el_cobs_take(&writer->wire, count);
    return true;
}

void el_report_begin(el_report *report)
{
    turn_interrupts_off();
    el_packet_writer_init(&report->writer, report->queue, sizeof report->queue, drain, &report->writer);
    el_packet_begin(&report->writer, EL_PACKET_LOG);
}

void el_report_text(el_report *report, const char *text)
{
    for (; *text != '\0'; text++) {
        el_packet_put_u8(&report->writer, (uint8_t)*text);
    }
}

void el_report_hex(el_report *report, const char *before, uint32_t value)
{
    el_report_text(report, before);
    for (int shift = 28; shift >= 0; shift -= 4) {
        el_packet_put_u8(&report->writer, (uint8_t) "0123456789abcdef"[value >> shift & 15]);
    }
}

_Noreturn void el_report_end(el_report *report)
{
    if (el_firmware_name[0] != '\0') {
        el_report_text(report, "; ");
        el_report_text(report, el_firmware_name);
    }
    (void)el_packet_end(&report->writer);
    (void)drain(&report->writer);
    el_board_restart();
}

static void put_decimal(el_report *report, int32_t value)
{
    char digits[sizeof "-2147483648"];
    char *at = digits + sizeof digits - 1;
    uint32_t rest = value < 0 ? 0U - (uint32_t)value : (uint32_t)value;

    *at = '\0';
    do {
        *--at = (char)('0' + (char)(rest % 10U));
        rest /= 10U;
    } while (rest != 0);
    if (value < 0) {
        *--at = '-';
    }
    el_report_text(report, at);
}

_Noreturn void el_report_failure(const char *call, int32_t status)
{
    el_report report;

    el_report_begin(&report);
    el_report_text(&report, call);
    el_report_text(&report, " failed with status ");
    put_decimal(&report, status);
    el_report_end(&report);
}
