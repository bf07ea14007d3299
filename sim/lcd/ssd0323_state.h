/* The SSD0323's registers, private to sim/lcd. */
#ifndef EL_SIM_LCD_SSD0323_STATE_H
#define EL_SIM_LCD_SSD0323_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "solomon.h"

typedef struct el_lcd_ssd0323 {
    bool on;
    uint8_t display_mode; /* A4h..A7h */
    uint8_t remap;
    el_axis columns; /* bytes of two pixels */
    el_axis rows;
    uint8_t start_line;
    uint8_t offset;
    uint8_t multiplex; /* rows that are driven, less 1 */
} el_lcd_ssd0323;

#endif
