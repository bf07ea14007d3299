#include "panel/st7735.h"

#include <stddef.h>

enum {
    CMD_PIXEL_FORMAT = 0x3A, /* ST7735 V1.7, 10.1.29 */
    FORMAT_16_BIT = 0x05,    /* this controller has one field, bits 2..0 */

    COLUMNS = 128,
    ROWS = 160
};

/* Voltages, frame rate and gamma stay as the module's maker has burnt them into the controller. */
static const el_tft_command start_up[] = {
    {CMD_PIXEL_FORMAT, 1, {FORMAT_16_BIT}},
};

/* The upright module is upside down in the memory. */
enum { ACCESS = EL_TFT_ACCESS_MX | EL_TFT_ACCESS_MY | EL_TFT_ACCESS_BGR };

const el_tft_model el_st7735 = {
    .start_up = start_up,
    .start_up_count = sizeof start_up / sizeof start_up[0],
    .access = ACCESS,
    .inverted = 0,
    .low_byte_first = NULL,
    .memory_columns = 132,
    .memory_rows = 162,
    .first_column = 2,
    .first_row = 1,
    .columns = COLUMNS,
    .rows = ROWS,
};

const el_tft_model el_st7735_128x160_memory = {
    .start_up = start_up,
    .start_up_count = sizeof start_up / sizeof start_up[0],
    .access = ACCESS,
    .inverted = 0,
    .low_byte_first = NULL,
    .memory_columns = COLUMNS,
    .memory_rows = ROWS,
    .first_column = 0,
    .first_row = 0,
    .columns = COLUMNS,
    .rows = ROWS,
};
