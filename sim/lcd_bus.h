/* base/bus.h on a PC: the wire of the LCD model.
 *
 * Two ways of sending pixels, as boards have them. Immediate: pixels() returns when all is sent, as a polling SPI
 * driver does. Deferred: pixels() only notes the transfer, and each wait() sends `chunk_words` of it, reading the
 * caller's words at that moment, as a DMA does; a renderer that draws into a band in flight sends the wrong picture
 * here too. Simulated time passes with each byte, at eight periods of SCK, and with delay_ms. */
#ifndef EL_SIM_LCD_BUS_H
#define EL_SIM_LCD_BUS_H

#include <stddef.h>
#include <stdint.h>

#include "base/bus.h"
#include "lcd/dcs_lcd.h"

typedef struct el_lcd_bus_config {
    el_lcd *lcd;        /* must outlive the bus, and stays the caller's */
    uint32_t sck_hz;    /* 1 or more */
    size_t chunk_words; /* words that one wait() sends; 0: immediate */
} el_lcd_bus_config;

/* What went over the wire so far. The bytes times 8 over sck_hz is the wire's time. */
typedef struct el_lcd_bus_traffic {
    uint64_t command_bytes; /* commands and their parameters */
    uint64_t pixel_bytes;
    uint64_t transfers; /* calls of pixels() */
    uint64_t now_ns;    /* simulated time: bytes and delays */
} el_lcd_bus_traffic;

/* The caller's memory; all members are the implementation's, except that `traffic` may be read. */
typedef struct el_lcd_bus {
    el_lcd_bus_config config;
    el_lcd_bus_traffic traffic;
    uint64_t remainder; /* of the division by sck_hz, so that rounding does not add up */
    const uint16_t *words;
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
