/* The display's wire of a machine that has no display: a recording.
 *
 * QEMU may be told the name of a file (`-semihosting-config enable=on,target=native -append trace=FILE`). Everything
 * that a panel's pins would have carried goes there as a wire trace (sim/wire_trace.h has the format), which
 * `edgeline-sim look` turns into the picture. Otherwise the bytes go nowhere, and the program is the same.
 *
 * There is nothing to wait for, so all of the bus is synchronous: the records of a transfer are in the file when `done`
 * is called. */
#include <string.h>

#include "registers.h"
#include "riscv_virt.h"

enum { SYS_OPEN = 0x01, SYS_WRITE0 = 0x04, SYS_WRITE = 0x05, SYS_GET_CMDLINE = 0x15 };
enum { OPEN_TO_WRITE_BINARY = 5 };
enum { KIND_COMMAND = 0, KIND_DATA = 1, KIND_RESET = 2, KIND_TIME = 3 };

static int32_t file = -1; /* -1: nothing is recorded */
static uint32_t last_us;  /* what the recording has told of time */
static uint8_t records[4096];
static size_t used;

static void stop(const char *why)
{
    file = -1;
    (void)el_virt_semihost(SYS_WRITE0, why);
}

static void flush(void)
{
    const uint32_t parameters[] = {(uint32_t)file, (uint32_t)(uintptr_t)records, used};
    if (file >= 0 && used > 0 && el_virt_semihost(SYS_WRITE, parameters) != 0) {
        stop("edgeline: the trace is not whole: no room for more of it\n"); /* and a hole in it would mislead */
    }
    used = 0;
}

static void put(uint8_t kind, uint8_t value)
{
    if (used > sizeof records - 2) {
        flush();
    }
    records[used++] = kind;
    records[used++] = value;
}

/* Records the time since the last call: it matters around resets and commands, so it is not told for each byte. */
static void put_time(void)
{
    const uint32_t now_us = el_virt_micros();
    const uint32_t passed_us = now_us - last_us;
    last_us = now_us;
    const uint32_t ns = passed_us < UINT32_MAX / 1000U ? passed_us * 1000U : UINT32_MAX;
    put(KIND_TIME, 0);
    put((uint8_t)ns, (uint8_t)(ns >> 8));
    put((uint8_t)(ns >> 16), (uint8_t)(ns >> 24));
}

/* The text behind the last "trace=" of QEMU's -append; NULL without. */
static const char *trace_name(char *line, size_t capacity)
{
    static const char key[] = " trace=";
    uint32_t parameters[] = {(uint32_t)(uintptr_t)line, capacity};
    if (el_virt_semihost(SYS_GET_CMDLINE, parameters) != 0) {
        return NULL;
    }
    const char *name = NULL;
    for (const char *at = line; (at = strstr(at, key)) != NULL;) {
        name = at += sizeof key - 1;
    }
    return name;
}

void el_virt_wire_start(void)
{
    char line[512];
    const char *name = trace_name(line, sizeof line);
    if (name == NULL) {
        return;
    }
    const uint32_t parameters[] = {(uint32_t)(uintptr_t)name, OPEN_TO_WRITE_BINARY, strlen(name)};
    file = el_virt_semihost(SYS_OPEN, parameters);
    if (file < 0) {
        stop("edgeline: the trace's file cannot be written\n");
        return;
    }
    last_us = el_virt_micros();
    put('H', 'O');
    put('T', '1');
}

static void wire_reset(void *context, int level)
{
    (void)context;
    put_time();
    put(KIND_RESET, (uint8_t)level);
    flush();
}

static void wire_command(void *context, uint8_t command, const uint8_t *parameters, size_t count)
{
    (void)context;
    put_time();
    put(KIND_COMMAND, command);
    for (size_t i = 0; i < count; i++) {
        put(KIND_DATA, parameters[i]);
    }
    flush();
}

static void wire_pixels(void *context, const uint16_t *words, size_t count, void (*done)(void *argument),
                        void *argument)
{
    (void)context;
    if (file >= 0) {
        for (size_t i = 0; i < count; i++) {
            put(KIND_DATA, (uint8_t)(words[i] >> 8));
            put(KIND_DATA, (uint8_t)words[i]);
        }
        flush();
    }
    done(argument);
}

static void wire_bytes(void *context, const uint8_t *bytes, size_t count, void (*done)(void *argument), void *argument)
{
    (void)context;
    if (file >= 0) {
        for (size_t i = 0; i < count; i++) {
            put(KIND_DATA, bytes[i]);
        }
        flush();
    }
    done(argument);
}

static void wire_delay_ms(void *context, uint32_t ms)
{
    (void)context;
    const uint32_t begin_us = el_virt_micros();
    while (el_virt_micros() - begin_us <= ms * 1000U) {
    }
}

const el_bus el_virt_wire = {.reset = wire_reset,
                             .command = wire_command,
                             .pixels = wire_pixels,
                             .bytes = wire_bytes,
                             .delay_ms = wire_delay_ms};
