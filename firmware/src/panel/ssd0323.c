#include "panel/ssd0323.h"

/* Data sheet of the SSD1325, Rev 2.3, section 10. */
enum {
    CMD_COLUMN_RANGE = 0x15,      /* 10.1: of bytes, 0..63 */
    CMD_ROW_RANGE = 0x75,         /* 10.2 */
    CMD_CONTRAST = 0x81,          /* 10.3 */
    CMD_HALF_CURRENT = 0x85,      /* 10.4 */
    CMD_REMAP = 0xA0,             /* 10.5 */
    CMD_OFFSET = 0xA2,            /* 10.7 */
    CMD_SHOW_NORMAL = 0xA4,       /* 10.8 */
    CMD_SHOW_INVERSE = 0xA7,      /* 10.8 */
    CMD_MULTIPLEX = 0xA8,         /* 10.9 */
    CMD_CONVERTER = 0xAD,         /* 10.10 */
    CMD_DISPLAY_ON = 0xAF,        /* 10.11 */
    CMD_PHASES = 0xB1,            /* 10.12 */
    CMD_ROW_PERIOD = 0xB2,        /* 10.13 */
    CMD_CLOCK = 0xB3,             /* 10.14 */
    CMD_GREY_TABLE = 0xB8,        /* 10.15 */
    CMD_PRECHARGE_VOLTAGE = 0xBC, /* 10.16 */
    CMD_COM_VOLTAGE = 0xBE,       /* 10.17 */
    CMD_SEGMENT_VOLTAGE = 0xBF,   /* 10.18 */

    REMAP_NIBBLES = 0x02,  /* the left pixel is the upper half of a byte */
    REMAP_VERTICAL = 0x04, /* rows follow each other before columns */
    REMAP_COMS = 0x10,     /* row 0 is the last COM */
    REMAP_SPLIT = 0x40,    /* odd COMs on one side of the glass, even ones on the other */
    REMAP = REMAP_NIBBLES | REMAP_COMS | REMAP_SPLIT
};

/* For the glass of the board, after AN018. */
static const el_oled_command start_up[] = {
    {CMD_CONTRAST, 1, {50}}, /* of 127 */
    {CMD_HALF_CURRENT, 0, {0}},
    {CMD_OFFSET, 1, {76}},              /* of 80: the glass is at COM 4 and following */
    {CMD_MULTIPLEX, 1, {63}},           /* 64 rows */
    {CMD_PHASES, 1, {0x22}},            /* reset and pre-charge of 2 clocks each */
    {CMD_ROW_PERIOD, 1, {70}},          /* clocks */
    {CMD_CLOCK, 1, {0xF1}},             /* the fastest oscillator, halved */
    {CMD_SEGMENT_VOLTAGE, 1, {0x0D}},   /* of dark segments */
    {CMD_COM_VOLTAGE, 1, {0x02}},       /* of COMs that are not driven */
    {CMD_PRECHARGE_VOLTAGE, 1, {0x10}}, /* of segments */
    /* Steps of the pulse width: of level 1, of 3 and 2, ... of 15 and 14. */
    {CMD_GREY_TABLE, 8, {0x01, 0x11, 0x22, 0x32, 0x43, 0x54, 0x65, 0x76}},
    {CMD_CONVERTER, 1, {0x03}}, /* DC-DC converter and inner COM voltage on */
};

static const el_oled_model model = {
    .start_up = start_up,
    .start_up_count = sizeof start_up / sizeof start_up[0],
    .along_rows = {CMD_REMAP, 1, {REMAP}},
    .along_columns = {CMD_REMAP, 1, {REMAP | REMAP_VERTICAL}},
    .show_positive = CMD_SHOW_NORMAL,
    .show_negative = CMD_SHOW_INVERSE,
    .display_on = CMD_DISPLAY_ON,
    .column_range = CMD_COLUMN_RANGE,
    .row_range = CMD_ROW_RANGE,
    .columns = 128,
    .rows = 64,
    .packed_log2 = 1,
    .packs_columns = 0,
    .first_is_high = 1,
    .reset_wait_ms = 1,
};

el_status el_ssd0323_init(el_ssd0323 *panel, const el_ssd0323_config *config)
{
    return el_oled_init(panel, &model, config);
}

el_sink el_ssd0323_sink(el_ssd0323 *panel)
{
    return el_oled_sink(panel);
}
