/* A display as a product has it: the model of a module, the simulated wire to it, and the driver that a firmware would
 * use, mounted at an angle. */
#ifndef EL_SIM_DISPLAY_H
#define EL_SIM_DISPLAY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/bus.h"
#include "base/sink.h"
#include "lcd/lcd.h"
#include "lcd_bus.h"
#include "panel/oled.h"
#include "panel/tft.h"

typedef struct el_display_config {
    const char *panel; /* as in lcd/lcd.h; NULL: a controller that does not exist, for glass of the size below */
    uint16_t columns;  /* of that glass, upright */
    uint16_t rows;
    uint16_t band_lines; /* of the bands that will come */
    el_rotation rotation;
    uint8_t mirrored; /* these five as the drivers have them; only colour panels have the last two */
    uint8_t inverted;
    uint8_t rgb_order;
    el_byte_order byte_order;
    bool bytes_only; /* the bus has no 16-bit words */
    bool sparing;    /* a colour panel's driver sends what has changed only */
    size_t chunk;    /* of the bus; 0: immediate */
    el_lcd_tap tap;  /* of the bus */
} el_display_config;

/* Zeroed it is a closed one; all members are the implementation's, except that those of the first group may be read. */
typedef struct el_display {
    uint16_t width; /* of the glass as the viewer sees it */
    uint16_t height;
    el_sink sink;
    el_lcd *lcd;
    el_lcd_bus bus_state;

    unsigned degrees; /* as el_lcd_look takes them */
    el_bus bus;
    el_tft_model model; /* of the controller that does not exist */
    union {
        el_tft tft;
        el_oled oled;
    } driver;
    void *memory; /* of the driver */
} el_display;

/* How the module is turned for the viewer, as el_lcd_look takes it: EL_ROTATION_90 has the upper edge on the left. */
unsigned el_display_degrees(el_rotation rotation);

/* The profile of a panel's name. NULL after one line on stderr that lists the names. */
const el_lcd_profile *el_display_profile(const char *panel);

/* Makes the display and initialises it by its driver. False after one line on stderr. Close it in any case; it must stay
 * where it is. */
bool el_display_open(el_display *display, const el_display_config *config);
void el_display_close(el_display *display);

/* Waits for the wire and writes width * height pixels that the viewer sees. False after one line on stderr when the
 * chip got bytes that it would not have taken. */
bool el_display_look(el_display *display, uint16_t *rgb565);

#endif
