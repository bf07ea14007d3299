#include "panel/ili9341.h"

#include <stddef.h>

/* Data sheet V1.11, sections 8.2 (level 1) and 8.3 (level 2). */
enum {
    CMD_PIXEL_FORMAT = 0x3A,     /* 8.2.33 */
    CMD_FRAME_RATE = 0xB1,       /* 8.3.2 */
    CMD_DISPLAY_FUNCTION = 0xB6, /* 8.3.7 */
    CMD_POWER_1 = 0xC0,          /* 8.3.14 */
    CMD_POWER_2 = 0xC1,          /* 8.3.15 */
    CMD_VCOM_1 = 0xC5,           /* 8.3.16 */
    CMD_VCOM_2 = 0xC7            /* 8.3.17 */
};

/* Voltages as in ILI Technology's application note. */
static const el_tft_command start_up[] = {
    {CMD_POWER_1, 1, {0x23}},                      /* GVDD 4.60 V */
    {CMD_POWER_2, 1, {0x10}},                      /* booster steps: AVDD 2 VCI, VGH 7 VCI, VGL -4 VCI */
    {CMD_VCOM_1, 2, {0x3E, 0x28}},                 /* VCOMH 4.250 V, VCOML -1.500 V */
    {CMD_VCOM_2, 1, {0x86}},                       /* VCOM offset -58 steps */
    {CMD_FRAME_RATE, 2, {0x00, 0x18}},             /* 79 Hz: no division, 24 clocks per line */
    {CMD_DISPLAY_FUNCTION, 3, {0x08, 0x82, 0x27}}, /* normally white, scan and shift as reset has them, 320 lines */
    {CMD_PIXEL_FORMAT, 1, {EL_TFT_16_BIT}},
};

const el_tft_model el_ili9341 = {
    .start_up = start_up,
    .start_up_count = sizeof start_up / sizeof start_up[0],
    .access = EL_TFT_ACCESS_MX | EL_TFT_ACCESS_BGR, /* column 0 of the memory is on the viewer's right */
    .inverted = 0,
    .scrolls = 1,
    .low_byte_first = NULL,
    .memory_columns = 240,
    .memory_rows = 320,
    .first_column = 0,
    .first_row = 0,
    .columns = 240,
    .rows = 320,
};
