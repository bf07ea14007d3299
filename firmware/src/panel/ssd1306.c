#include "panel/ssd1306.h"

/* Data sheet Rev 1.1, section 10.1; charge pump: its application note, section 2. */
enum {
    CMD_MEMORY_MODE = 0x20,   /* 10.1.3 */
    CMD_COLUMN_RANGE = 0x21,  /* 10.1.4 */
    CMD_PAGE_RANGE = 0x22,    /* 10.1.5 */
    CMD_START_LINE = 0x40,    /* 10.1.6 */
    CMD_CHARGE_PUMP = 0x8D,   /* application note, 2.1 */
    CMD_SEGMENT_REMAP = 0xA1, /* 10.1.8: column 0 is segment 127 */
    CMD_SHOW_NORMAL = 0xA6,   /* 10.1.10 */
    CMD_SHOW_INVERSE = 0xA7,  /* 10.1.10 */
    CMD_DISPLAY_ON = 0xAF,    /* 10.1.12 */
    CMD_COM_SCAN_DOWN = 0xC8, /* 10.1.14: from COM63 to COM0 */

    MODE_HORIZONTAL = 0x00,
    MODE_VERTICAL = 0x01,
    CHARGE_PUMP_ON = 0x14
};

/* Multiplex, offset, clock and COM pins are right for 128x64 after reset. */
static const el_oled_command start_up[] = {
    {CMD_CHARGE_PUMP, 1, {CHARGE_PUMP_ON}},
    {CMD_SEGMENT_REMAP, 0, {0}},
    {CMD_COM_SCAN_DOWN, 0, {0}},
};

static const el_oled_model model = {
    .start_up = start_up,
    .start_up_count = sizeof start_up / sizeof start_up[0],
    .along_rows = {CMD_MEMORY_MODE, 1, {MODE_HORIZONTAL}},
    .along_columns = {CMD_MEMORY_MODE, 1, {MODE_VERTICAL}},
    .show_positive = CMD_SHOW_NORMAL,
    .show_negative = CMD_SHOW_INVERSE,
    .display_on = CMD_DISPLAY_ON,
    .column_range = CMD_COLUMN_RANGE,
    .row_range = CMD_PAGE_RANGE,
    .start_line = CMD_START_LINE,
    .columns = 128,
    .rows = 64,
    .packed_log2 = 3,
    .packs_columns = 1,
    .first_is_high = 0, /* 8.7: D0 is the top */
    .reset_wait_ms = 1, /* 8.9: 3 us */
};

el_status el_ssd1306_init(el_ssd1306 *panel, const el_ssd1306_config *config)
{
    return el_oled_init(panel, &model, config);
}

el_sink el_ssd1306_sink(el_ssd1306 *panel)
{
    return el_oled_sink(panel);
}
