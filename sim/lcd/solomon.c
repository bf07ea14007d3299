#include "solomon.h"

#include "lcd_state.h"

void el_axis_set(el_lcd *lcd, el_axis *axis, uint8_t limit)
{
    const uint8_t start = lcd->parameters[0];
    const uint8_t end = lcd->parameters[1];
    if (start > end || end >= limit) {
        el_lcd_report(lcd, EL_LCD_BAD_WINDOW, "%02Xh %s: %u..%u is %s (section %s)", lcd->code, lcd->command->name,
                      start, end, end >= limit ? "out of range" : "reversed", lcd->command->section);
        return;
    }
    *axis = (el_axis){.start = start, .end = end, .at = start};
}

bool el_axis_step(el_axis *axis, uint8_t limit)
{
    if (axis->at == axis->end) {
        axis->at = axis->start;
        return true;
    }
    axis->at = (uint8_t)((axis->at + 1) % limit);
    return false;
}
