/* The simulated product: a renderer, a panel driver, a bus and an LCD. What it shows is what the LCD model shows. */
#ifndef EL_SIM_MACHINE_H
#define EL_SIM_MACHINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "edgeline.h"
#include "lcd/dcs_lcd.h"
#include "lcd_bus.h"
#include "panel/ili9341.h"

typedef struct el_machine_config {
    uint16_t width;
    uint16_t height;
    uint16_t band_lines;
    uint16_t background;       /* RGB565 */
    uint8_t uv_error_log2;     /* as el_config has it */
    size_t arena_bytes;        /* 0: what EL_MEMORY_BYTES says for EL_MACHINE_VERTICES and EL_MACHINE_TRIANGLES */
    const el_sink *extra_sink; /* beside the panel and the depth; NULL: none */
} el_machine_config;

enum { EL_MACHINE_VERTICES = 2000, EL_MACHINE_TRIANGLES = 3000, EL_MACHINE_DRAWS = 16 };

typedef struct el_machine {
    el_machine_config config;
    el_renderer renderer;
    void *arena;
    size_t arena_bytes;
    el_lcd *lcd;
    el_lcd_bus bus_state;
    el_bus bus;
    el_ili9341 panel;
    el_sink panel_sink;
    el_sink depth_sink;
    unsigned mounting;    /* degrees, as el_lcd_look takes them */
    uint16_t glass_width; /* of the picture as mounted */
    uint16_t glass_height;
    uint16_t *glass;   /* scratch for el_lcd_look */
    uint16_t *picture; /* width * height, RGB565 */
    uint16_t *depth;   /* width * height */
} el_machine;

/* Builds and initialises the product: an ILI9341 where the picture fits its 240x320 or 320x240 pixels, else a larger
 * controller of the same command set. False after one line on stderr. Close it in any case. */
bool el_machine_open(el_machine *machine, const el_machine_config *config);
void el_machine_close(el_machine *machine);

/* Waits for the wire and reads the LCD: machine->picture is what it shows. False after one line on stderr when the LCD
 * got bytes that the chip would not have taken. */
bool el_machine_look(el_machine *machine);

/* A line of text for an el_status. */
const char *el_machine_message(el_status status);

#endif
