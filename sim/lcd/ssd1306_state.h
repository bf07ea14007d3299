/* The SSD1306's registers, private to sim/lcd. */
#ifndef EL_SIM_LCD_SSD1306_STATE_H
#define EL_SIM_LCD_SSD1306_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "solomon.h"

typedef struct el_lcd_ssd1306 {
    bool on;
    bool all_lit;
    bool inverted;
    bool pump; /* the charge pump, the module's only supply of its glass */
    bool segments_reversed;
    bool coms_reversed;
    uint8_t mode; /* 0 horizontal, 1 vertical, 2 page */
    el_axis columns;
    el_axis pages;           /* of 8 rows */
    uint8_t page_mode_start; /* column, of 00h..1Fh */
    uint8_t start_line;
    uint8_t offset;
} el_lcd_ssd1306;

#endif
