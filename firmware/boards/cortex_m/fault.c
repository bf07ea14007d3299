/* Reports a fault and starts the board anew.
 *
 * What the program left behind is not believed: the packet is made on the stack from constants and from the processor's
 * registers, with a sequence of its own from 0, after a 00 that ends whatever stood on the line; and it leaves by
 * polling. A fault in here ends in lockup, out of which only a watchdog helps. */
#include "fault.h"

#include "board.h"
#include "start.h"
#include "stream/packet.h"

#if defined(__ARM_ARCH_7M__) || defined(__ARM_ARCH_7EM__) || defined(__ARM_ARCH_8M_MAIN__)
#define HAS_FAULT_STATUS 1
#else
#define HAS_FAULT_STATUS 0 /* Armv6-M and Armv8-M Baseline tell nothing but where it was */
#endif

extern uint8_t el_bss_end[];

__attribute__((weak)) const char el_firmware_name[] = "";

static void put_text(el_packet_writer *writer, const char *text)
{
    for (; *text != '\0'; text++) {
        el_packet_put_u8(writer, (uint8_t)*text);
    }
}

static void put_hex(el_packet_writer *writer, const char *before, uint32_t value)
{
    put_text(writer, before);
    for (int shift = 28; shift >= 0; shift -= 4) {
        el_packet_put_u8(writer, (uint8_t) "0123456789abcdef"[value >> shift & 15]);
    }
}

/* Numbers and names: Armv7-M Architecture Reference Manual, B1.5.2; 7: Armv8-M's, B3.9. */
static void put_exception(el_packet_writer *writer, uint32_t number)
{
    enum { EXCEPTIONS = 16 };
    static const char *const names[EXCEPTIONS] = {
        [0] = "main returned", [2] = "NMI",        [3] = "HardFault",   [4] = "MemManage fault",
        [5] = "BusFault",      [6] = "UsageFault", [7] = "SecureFault", [11] = "SVCall",
        [12] = "DebugMonitor", [14] = "PendSV",    [15] = "SysTick"};

    if (number < EXCEPTIONS && names[number] != NULL) {
        put_text(writer, names[number]);
    } else if (number >= EXCEPTIONS) {
        put_hex(writer, "nobody serves interrupt ", number - EXCEPTIONS);
    } else {
        put_hex(writer, "exception ", number);
    }
}

#if HAS_FAULT_STATUS

/* System control block: Armv7-M Architecture Reference Manual, B3.2.15 to B3.2.18. */
static volatile uint32_t *const cfsr = (volatile uint32_t *)0xE000ED28;
static volatile uint32_t *const hfsr = (volatile uint32_t *)0xE000ED2C;
static volatile uint32_t *const mmfar = (volatile uint32_t *)0xE000ED34;
static volatile uint32_t *const bfar = (volatile uint32_t *)0xE000ED38;

enum { MMFAR_IS_VALID = 1U << 7, BFAR_IS_VALID = 1U << 15, HFSR_VECTOR = 1U << 1 };

static void put_cause(el_packet_writer *writer)
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
            put_text(writer, before);
            put_text(writer, causes[i].meaning);
            before = ", ";
        }
    }
    if ((*hfsr & HFSR_VECTOR) != 0) {
        put_text(writer, before);
        put_text(writer, "unreadable vector");
    }
    if ((*cfsr & BFAR_IS_VALID) != 0) {
        put_hex(writer, ", address ", *bfar);
    } else if ((*cfsr & MMFAR_IS_VALID) != 0) {
        put_hex(writer, ", address ", *mmfar);
    }
}

static void put_status(el_packet_writer *writer)
{
    put_hex(writer, ", CFSR ", *cfsr);
    put_hex(writer, ", HFSR ", *hfsr);
}

#else

static void put_cause(el_packet_writer *writer)
{
    (void)writer;
}

static void put_status(el_packet_writer *writer)
{
    (void)writer;
}

#endif

static void put_place(el_packet_writer *writer, const el_fault_frame *frame)
{
    const uintptr_t stack = (uintptr_t)frame;

    if (frame == NULL) {
        put_text(writer, ", the stack is lost");
        return;
    }
    if (stack < (uintptr_t)el_bss_end) {
        put_text(writer, ", stack overflow into the variables");
    }
    put_hex(writer, ", at ", frame->pc);
    put_hex(writer, ", called from ", frame->lr);
    put_hex(writer, ", xPSR ", frame->xpsr);
    put_hex(writer, ", stack ", (uint32_t)stack);
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

_Noreturn void el_fault(const el_fault_frame *frame, uint32_t number)
{
    uint8_t queue[EL_COBS_ENCODER_MIN_BYTES];
    el_packet_writer writer;

    el_packet_writer_init(&writer, queue, sizeof queue, drain, &writer);
    el_packet_begin(&writer, EL_PACKET_LOG);
    put_exception(&writer, number);
    if (number != 0) {
        put_cause(&writer);
        put_place(&writer, frame);
        put_status(&writer);
    }
    if (el_firmware_name[0] != '\0') {
        put_text(&writer, "; ");
        put_text(&writer, el_firmware_name);
    }
    (void)el_packet_end(&writer);
    (void)drain(&writer);
    el_board_restart();
}
