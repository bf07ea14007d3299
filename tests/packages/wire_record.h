/* One record of a wire trace, as sim/wire_trace.h describes them: for stand-ins of C and C++, which see the library's headers
 * alone. */
#ifndef EL_TEST_WIRE_RECORD_H
#define EL_TEST_WIRE_RECORD_H

#include <stdint.h>
#include <stdio.h>

enum { TRACE_COMMAND, TRACE_DATA, TRACE_RESET, TRACE_TIME };

/* `passed_ns` since the last record, which is left out where it is 0. */
static inline void write_record(FILE *trace, uint32_t passed_ns, int kind, int value)
{
    if (passed_ns > 0) {
        fputc(TRACE_TIME, trace);
        fputc(0, trace);
        for (unsigned shift = 0; shift < 32; shift += 8) {
            fputc((int)(passed_ns >> shift & 255U), trace);
        }
    }
    fputc(kind, trace);
    fputc(value, trace);
}

#endif
