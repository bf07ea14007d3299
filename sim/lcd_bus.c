/* The el_bus functions over a display model. All bytes go through send_byte and all time through pass_time, so the
 * traffic counters, the clock and the tap cannot disagree. */
#include "lcd_bus.h"

static void pass_time(el_lcd_bus *bus, uint64_t ns)
{
    bus->traffic.now_ns += ns;
    if (bus->config.tap.time != NULL) {
        bus->config.tap.time(bus->config.tap.context, ns);
    }
    el_lcd_advance_ns(bus->config.lcd, ns);
}

/* A chunk's bytes stay far below the 2.3 * 10^9 at which this product would leave 64 bits. */
static void pass_bytes(el_lcd_bus *bus, uint64_t bytes)
{
    const uint64_t scaled = bytes * UINT64_C(8000000000) + bus->remainder;
    bus->remainder = scaled % bus->config.sck_hz;
    pass_time(bus, scaled / bus->config.sck_hz);
}

static void send_byte(el_lcd_bus *bus, int dc, uint8_t byte)
{
    if (bus->config.tap.byte != NULL) {
        bus->config.tap.byte(bus->config.tap.context, dc, byte);
    }
    el_lcd_write(bus->config.lcd, dc, byte);
}

/* `count` words or bytes of the open transfer, the time that they take after them. */
static void send_data(el_lcd_bus *bus, size_t count)
{
    const uint64_t bytes = bus->bytes != NULL ? count : 2 * (uint64_t)count;
    for (size_t i = 0; i < count; i++) {
        if (bus->bytes != NULL) {
            send_byte(bus, 1, *bus->bytes++);
        } else {
            const uint16_t word = *bus->words++;
            send_byte(bus, 1, (uint8_t)(word >> 8));
            send_byte(bus, 1, (uint8_t)(word & 0xFF));
        }
    }
    bus->left -= count;
    bus->traffic.pixel_bytes += bytes;
    pass_bytes(bus, bytes);
}

/* Cleared before the call, because `done` may start the next transfer. */
static void end_transfer(el_lcd_bus *bus)
{
    void (*done)(void *argument) = bus->done;
    bus->done = NULL;
    done(bus->argument);
}

static void drive(el_lcd_bus *bus, size_t count)
{
    if (bus->done == NULL) {
        return;
    }
    send_data(bus, count < bus->left ? count : bus->left);
    if (bus->left == 0) {
        end_transfer(bus);
    }
}

void el_lcd_bus_drain(el_lcd_bus *bus)
{
    while (bus->done != NULL) {
        drive(bus, bus->left);
    }
}

static void bus_reset(void *context, int level)
{
    el_lcd_bus *bus = context;
    el_lcd_bus_drain(bus);
    if (bus->config.tap.reset != NULL) {
        bus->config.tap.reset(bus->config.tap.context, level);
    }
    el_lcd_reset(bus->config.lcd, level);
}

static void send_command_byte(el_lcd_bus *bus, int dc, uint8_t byte)
{
    bus->traffic.command_bytes++;
    pass_bytes(bus, 1);
    send_byte(bus, dc, byte);
}

static void bus_command(void *context, uint8_t command, const uint8_t *parameters, size_t count)
{
    el_lcd_bus *bus = context;
    el_lcd_bus_drain(bus);
    send_command_byte(bus, 0, command);
    for (size_t i = 0; i < count; i++) {
        send_command_byte(bus, 1, parameters[i]);
    }
}

static void begin_transfer(el_lcd_bus *bus, size_t count, void (*done)(void *argument), void *argument)
{
    bus->left = count;
    bus->done = done;
    bus->argument = argument;
    bus->traffic.transfers++;
    if (bus->config.chunk == 0) {
        drive(bus, count);
    }
}

static void bus_pixels(void *context, const uint16_t *words, size_t count, void (*done)(void *argument), void *argument)
{
    el_lcd_bus *bus = context;
    el_lcd_bus_drain(bus);
    bus->words = words;
    bus->bytes = NULL;
    begin_transfer(bus, count, done, argument);
}

static void bus_bytes(void *context, const uint8_t *bytes, size_t count, void (*done)(void *argument), void *argument)
{
    el_lcd_bus *bus = context;
    el_lcd_bus_drain(bus);
    bus->bytes = bytes;
    begin_transfer(bus, count, done, argument);
}

static void bus_delay_ms(void *context, uint32_t ms)
{
    el_lcd_bus *bus = context;
    el_lcd_bus_drain(bus);
    pass_time(bus, UINT64_C(1000000) * ms);
}

static void bus_wait(void *context)
{
    el_lcd_bus *bus = context;
    drive(bus, bus->config.chunk);
}

void el_lcd_bus_init(el_lcd_bus *bus, const el_lcd_bus_config *config)
{
    *bus = (el_lcd_bus){.config = *config};
}

el_bus el_lcd_bus_functions(el_lcd_bus *bus)
{
    return (el_bus){.context = bus,
                    .reset = bus_reset,
                    .command = bus_command,
                    .pixels = bus->config.bytes_only ? NULL : bus_pixels,
                    .bytes = bus_bytes,
                    .delay_ms = bus_delay_ms,
                    .wait = bus_wait};
}
