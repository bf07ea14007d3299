#include "wire_trace.h"

#include <string.h>

#include "report.h"

enum { KIND_COMMAND, KIND_DATA, KIND_RESET, KIND_TIME };

static const char MAGIC[4] = {'H', 'O', 'T', '1'};

void el_wire_begin(el_wire_writer *writer, FILE *stream)
{
    *writer = (el_wire_writer){.stream = stream};
    fwrite(MAGIC, 1, sizeof MAGIC, stream);
}

static void write_record(el_wire_writer *writer, uint8_t kind, uint8_t value)
{
    while (writer->pending_ns != 0) {
        const uint32_t ns = writer->pending_ns < UINT32_MAX ? (uint32_t)writer->pending_ns : UINT32_MAX;
        const uint8_t record[6] = {KIND_TIME,          0, (uint8_t)ns, (uint8_t)(ns >> 8), (uint8_t)(ns >> 16),
                                   (uint8_t)(ns >> 24)};
        fwrite(record, 1, sizeof record, writer->stream);
        writer->pending_ns -= ns;
    }
    const uint8_t record[2] = {kind, value};
    fwrite(record, 1, sizeof record, writer->stream);
}

static void byte_passes(void *context, int dc, uint8_t byte)
{
    write_record(context, dc != 0 ? KIND_DATA : KIND_COMMAND, byte);
}

static void reset_changes(void *context, int level)
{
    write_record(context, KIND_RESET, level != 0);
}

static void time_passes(void *context, uint64_t ns)
{
    el_wire_writer *const writer = context;
    writer->pending_ns += ns;
}

el_lcd_tap el_wire_tap(el_wire_writer *writer)
{
    return (el_lcd_tap){.context = writer, .byte = byte_passes, .reset = reset_changes, .time = time_passes};
}

bool el_wire_play(const char *path, const uint8_t *bytes, size_t size, el_lcd *lcd)
{
    if (size < sizeof MAGIC || memcmp(bytes, MAGIC, sizeof MAGIC) != 0) {
        el_report("%s is no wire trace: it does not begin with HOT1", path);
        return false;
    }
    size_t at = sizeof MAGIC;
    while (at < size) {
        const size_t record_size = bytes[at] == KIND_TIME ? 6 : 2;
        if (size - at < record_size) {
            el_report("%s: byte %zu: the trace ends in the middle of a record", path, at);
            return false;
        }
        const uint8_t kind = bytes[at];
        const uint8_t value = bytes[at + 1];
        if (kind > KIND_TIME || (kind == KIND_RESET && value > 1) || (kind == KIND_TIME && value != 0)) {
            el_report("%s: byte %zu: there is no record %02Xh %02Xh", path, at, kind, value);
            return false;
        }
        if (kind == KIND_RESET) {
            el_lcd_reset(lcd, value);
        } else if (kind == KIND_TIME) {
            const uint8_t *const ns = &bytes[at + 2];
            el_lcd_advance_ns(lcd, ns[0] | (uint32_t)ns[1] << 8 | (uint32_t)ns[2] << 16 | (uint32_t)ns[3] << 24);
        } else {
            el_lcd_write(lcd, kind == KIND_DATA, value);
        }
        at += record_size;
    }
    return true;
}
