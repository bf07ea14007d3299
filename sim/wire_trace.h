/* A recording of what a display's wire carried, as all harnesses write it that watch a display's bus.
 *
 *     4 bytes "HOT1", then records of 2 bytes {kind, value}:
 *     0  a byte with D/C low
 *     1  a byte with D/C high
 *     2  the reset line's level, 0 or 1; it is high at first
 *     3  value is 0, and 4 bytes little-endian follow: that many nanoseconds pass */
#ifndef EL_SIM_WIRE_TRACE_H
#define EL_SIM_WIRE_TRACE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "lcd_bus.h"

/* The caller's memory; all members are the implementation's. */
typedef struct el_wire_writer {
    FILE *stream;
    uint64_t pending_ns; /* not yet written, so that one record serves all the time between two bytes */
} el_wire_writer;

/* Starts a recording on `stream`, which stays the caller's; its errors are the stream's, ferror tells. */
void el_wire_begin(el_wire_writer *writer, FILE *stream);
/* Time that passes after the last byte is lost: nothing depends on it. `writer` must stay where it is. */
el_lcd_tap el_wire_tap(el_wire_writer *writer);

/* Plays a recording of `size` bytes to `lcd`. False, after one line on stderr that begins with `path`, when it is no
 * recording or its end is missing. */
bool el_wire_play(const char *path, const uint8_t *bytes, size_t size, el_lcd *lcd);

#endif
