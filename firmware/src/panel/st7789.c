#include "panel/st7789.h"

/* Data sheet V1.3, sections 9.1 (table 1) and 9.2 (table 2). */
enum {
    CMD_PIXEL_FORMAT = 0x3A, /* 9.1.32 */
    CMD_RAM_CONTROL = 0xB0,  /* 9.2.1 */

    MEMORY_COLUMNS = 240, /* 8.12 */
    MEMORY_ROWS = 320
};

/* Voltages and gamma stay as the module's maker has burnt them into the controller. */
static const el_tft_command start_up[] = {
    {CMD_PIXEL_FORMAT, 1, {EL_TFT_16_BIT}},
};

/* Memory written by the microcontroller; upper bits and colour expansion as reset has them, ENDIAN (8) set. */
static const el_tft_command low_byte_first = {CMD_RAM_CONTROL, 2, {0x00, 0xF8}};

const el_tft_model el_st7789 = {
    .start_up = start_up,
    .start_up_count = sizeof start_up / sizeof start_up[0],
    .access = 0, /* column 0 is on the viewer's left */
    .inverted = 1,
    .scrolls = 1,
    .low_byte_first = &low_byte_first,
    .memory_columns = MEMORY_COLUMNS,
    .memory_rows = MEMORY_ROWS,
    .first_column = 0,
    .first_row = 0,
    .columns = 240,
    .rows = 320,
};

const el_tft_model el_st7789_240x240 = {
    .start_up = start_up,
    .start_up_count = sizeof start_up / sizeof start_up[0],
    .access = 0,
    .inverted = 1,
    .scrolls = 1,
    .low_byte_first = &low_byte_first,
    .memory_columns = MEMORY_COLUMNS,
    .memory_rows = MEMORY_ROWS,
    .first_column = 0,
    .first_row = 0,
    .columns = 240,
    .rows = 240,
};
