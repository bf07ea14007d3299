/* The simulated product: a renderer, a panel driver, a bus and an LCD. What it shows is what the LCD model shows. */
#ifndef EL_SIM_MACHINE_H
#define EL_SIM_MACHINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "display.h"
#include "edgeline.h"
#include "threads.h"

typedef struct el_machine_config {
    uint16_t width; /* of the frames */
    uint16_t height;
    uint16_t band_lines;
    uint16_t background;       /* RGB565 */
    uint8_t uv_error_log2;     /* as el_config has it */
    unsigned threads;          /* that draw; 0 is 1 */
    size_t arena_bytes;        /* 0: what EL_MEMORY_BYTES says for EL_MACHINE_VERTICES and EL_MACHINE_TRIANGLES */
    const el_sink *extra_sink; /* beside the panel and the depth; NULL: none */
    const char *panel;         /* as in lcd/lcd.h, with glass as large as the frames or larger; NULL: see below */
    el_rotation rotation;      /* of that panel */
    el_lcd_tap tap;            /* of the display's wire */
    uint8_t samples;           /* per pixel; 0 is 1 */
    uint8_t stripes;           /* el_stripes */
    bool depth_prepass;        /* el_config.depth_prepass */
    bool sparing;              /* what has not changed is neither drawn nor sent */
} el_machine_config;

enum { EL_MACHINE_VERTICES = 2000, EL_MACHINE_TRIANGLES = 3000, EL_MACHINE_DRAWS = 16 };

typedef struct el_machine {
    el_machine_config config;
    el_renderer renderer;
    el_threads *threads; /* NULL: one */
    void *arena;
    size_t arena_bytes;
    el_display display;
    el_sink depth_sink;
    uint16_t *glass;         /* what the display shows */
    uint16_t picture_width;  /* of the glass where a panel is named, else of the frames */
    uint16_t picture_height; /* the same */
    uint16_t *picture;       /* RGB565 */
    uint16_t *depth;         /* width * height */
} el_machine;

/* Builds and initialises the product. Without the name of a panel it has an ILI9341 where the frames fit its 240x320 or
 * 320x240 pixels, else a larger controller of the same command set, and the picture is the frame's part of the glass.
 * False after one line on stderr. Close it in any case. */
bool el_machine_open(el_machine *machine, const el_machine_config *config);
void el_machine_close(el_machine *machine);

/* Waits for the wire and reads the LCD: machine->picture is what it shows. False after one line on stderr when the LCD
 * got bytes that the chip would not have taken. */
bool el_machine_look(el_machine *machine);

/* A line of text for an el_status. */
const char *el_machine_message(el_status status);

#endif
