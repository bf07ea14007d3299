/* The el_bus functions over the LCD model. Every path that sends bytes goes through pass_time and el_lcd_write, so the
 * traffic counters and the clock cannot disagree. */
#include "lcd_bus.h"

static void pass_time(el_lcd_bus *bus, uint64_t ns)
{
    bus->traffic.now_ns += ns;
    el_lcd_advance_ns(bus->config.lcd, ns);
}

/* A chunk's bytes stay far below the 2.3 * 10^9 at which this product would leave 64 bits. */
static void pass_bytes(el_lcd_bus *bus, uint64_t bytes)
{
    const uint64_t scaled = bytes * UINT64_C(8000000000) + bus->remainder;
    bus->remainder = scaled % bus->config.sck_hz;
    pass_time(bus, scaled / bus->config.sck_hz);
}

static void send_words(el_lcd_bus *bus, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint16_t word = *bus->words++;
        el_lcd_write(bus->config.lcd, 1, (uint8_t)(word >> 8));
        el_lcd_write(bus->config.lcd, 1, (uint8_t)(word & 0xFF));
    }
    bus->left -= count;
    bus->traffic.pixel_bytes += 2 * (uint64_t)count;
    pass_bytes(bus, 2 * (uint64_t)count);
}

/* Cleared before the call, because `done` may start the next transfer. */
static void end_transfer(el_lcd_bus *bus)
{
    void (*done)(void *argument) = bus->done;
    bus->done = NULL;
    done(bus->argument);
}

static void drive(el_lcd_bus *bus, size_t words)
{
    if (bus->done == NULL) {
        return;
    }
    send_words(bus, words < bus->left ? words : bus->left);
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
    el_lcd_reset(bus->config.lcd, level);
}

static void send_byte(el_lcd_bus *bus, int dc, uint8_t byte)
{
    bus->traffic.command_bytes++;
    pass_bytes(bus, 1);
    el_lcd_write(bus->config.lcd, dc, byte);
}

static void bus_command(void *context, uint8_t command, const uint8_t *parameters, size_t count)
{
    el_lcd_bus *bus = context;
    el_lcd_bus_drain(bus);
    send_byte(bus, 0, command);
    for (size_t i = 0; i < count; i++) {
        send_byte(bus, 1, parameters[i]);
    }
}

static void bus_pixels(void *context, const uint16_t *words, size_t count, void (*done)(void *argument), void *argument)
{
    el_lcd_bus *bus = context;
    el_lcd_bus_drain(bus);
    bus->words = words;
    bus->left = count;
    bus->done = done;
    bus->argument = argument;
    bus->traffic.transfers++;
    if (bus->config.chunk_words == 0) {
        drive(bus, count);
    }
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
    drive(bus, bus->config.chunk_words);
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
                    .pixels = bus_pixels,
                    .delay_ms = bus_delay_ms,
                    .wait = bus_wait};
}
