/* base/bus.h on a PC: the wire of the display models.
 *
 * Two ways of sending pixels, as boards have them. Immediate: pixels() and bytes() return when all is sent, as a polling
 * SPI driver does. Deferred: they only note the transfer, and each wait() sends `chunk` words or bytes of it, reading the
 * caller's memory at that moment, as a DMA does; a renderer that draws into a band in flight sends the wrong picture
 * here too. Simulated time passes with each byte, at eight periods of SCK, and with delay_ms. */
#ifndef EL_SIM_LCD_BUS_H
#define EL_SIM_LCD_BUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/bus.h"
#include "lcd/lcd.h"

/* Sees what goes over the wire, before the display does. NULL functions see nothing. */
typedef struct el_lcd_tap {
    void *context;
    void (*byte)(void *context, int dc, uint8_t byte);
    void (*reset)(void *context, int level);
    void (*time)(void *context, uint64_t ns); /* that passes */
} el_lcd_tap;

typedef struct el_lcd_bus_config {
    el_lcd *lcd;     /* must outlive the bus, and stays the caller's */
    uint32_t sck_hz; /* 1 or more */
    size_t chunk;    /* words or bytes that one wait() sends; 0: immediate */
    bool bytes_only; /* the bus has no 16-bit words: el_bus.pixels is NULL */
    el_lcd_tap tap;
} el_lcd_bus_config;

/* What went over the wire so far. The bytes times 8 over sck_hz is the wire's time. */
typedef struct el_lcd_bus_traffic {
    uint64_t command_bytes; /* commands and their parameters */
    uint64_t pixel_bytes;
    uint64_t transfers; /* calls of pixels() and bytes() */
    uint64_t now_ns;    /* simulated time: bytes and delays */
} el_lcd_bus_traffic;

/* The caller's memory; all members are the implementation's, except that `traffic` may be read. */
typedef struct el_lcd_bus {
    el_lcd_bus_config config;
    el_lcd_bus_traffic traffic;
    uint64_t remainder;    /* of the division by sck_hz, so that rounding does not add up */
    const uint16_t *words; /* of the open transfer: these, or */
    const uint8_t *bytes;  /* these if not NULL */
    size_t left;
    void (*done)(void *argument); /* not NULL while a transfer is open */
    void *argument;
} el_lcd_bus;

void el_lcd_bus_init(el_lcd_bus *bus, const el_lcd_bus_config *config);

/* The functions that a panel driver calls; `bus` must stay where it is. */
el_bus el_lcd_bus_functions(el_lcd_bus *bus);

/* Sends what is still open, its `done` included: before the picture is looked at, or the bus given up. */
void el_lcd_bus_drain(el_lcd_bus *bus);

#endif
