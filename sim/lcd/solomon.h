/* What the controllers of Solomon Systech share, private to sim/lcd: an address counter of two axes in a window, each
 * axis with a command of two parameters that sets its start, its end (included) and the counter itself. */
#ifndef EL_SIM_LCD_SOLOMON_H
#define EL_SIM_LCD_SOLOMON_H

#include <stdbool.h>
#include <stdint.h>

#include "lcd.h"

typedef struct el_axis {
    uint8_t start;
    uint8_t end;
    uint8_t at;
} el_axis;

/* Obeys the command that is being received: takes its two parameters, below `limit`. */
void el_axis_set(el_lcd *lcd, el_axis *axis, uint8_t limit);

/* One step on an axis of `limit` places. True when it went back from the end to the start. */
bool el_axis_step(el_axis *axis, uint8_t limit);

#endif
