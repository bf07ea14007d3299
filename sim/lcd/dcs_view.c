/* Picture out: from the memory of a MIPI DCS controller to what a viewer of the glass sees.
 *
 * The way is that of the chip: scrolling chooses the memory line of a gate, then come the direction of gates and
 * sources, idle mode, inversion and the colour order. MADCTL's MX, MY and MV have no part in it: they act when pixels
 * are written, and what is in the memory stays where it is. Sections are of the ILI9341 data sheet V1.11. */
#include "lcd_state.h"

/* The memory row that gate `line` shows, sections 8.2.26 and 8.2.30; with ML the lines count from the bottom. */
static unsigned memory_row(const el_lcd *lcd, unsigned line)
{
    const el_dcs *const dcs = &lcd->chip.dcs;
    const unsigned top = dcs->top_fixed;
    const unsigned area = dcs->scroll_area;
    const bool from_bottom = (dcs->madctl & EL_MADCTL_ML) != 0;
    unsigned counted = from_bottom ? lcd->profile.memory_rows - 1U - line : line;
    if (dcs->scrolling && counted >= top && counted < top + area) {
        counted = top + (counted - top + dcs->scroll_start - top) % area;
    }
    return from_bottom ? lcd->profile.memory_rows - 1U - counted : counted;
}

static uint16_t shown_pixel(const el_lcd *lcd, uint32_t rgb18)
{
    const el_dcs *const dcs = &lcd->chip.dcs;
    if (dcs->idle) { /* section 8.2.32: the highest bit of each colour counts */
        rgb18 = (rgb18 >> 17 & 1) * 0x3F000 | (rgb18 >> 11 & 1) * 0x00FC0 | (rgb18 >> 5 & 1) * 0x0003F;
    }
    if ((dcs->inverted != dcs->values_reversed) != lcd->profile.inverting) {
        rgb18 ^= 0x3FFFF;
    }
    uint32_t red = rgb18 >> 13;
    const uint32_t green = rgb18 >> 6 & 0x3F;
    uint32_t blue = rgb18 >> 1 & 0x1F;
    if (((dcs->madctl & EL_MADCTL_BGR) != 0) != lcd->profile.bgr_filter) {
        const uint32_t other = red;
        red = blue;
        blue = other;
    }
    return (uint16_t)(red << 11 | green << 5 | blue);
}

uint16_t el_dcs_glass_pixel(const el_lcd *lcd, unsigned x, unsigned y)
{
    const el_lcd_profile *const module = &lcd->profile;
    const el_dcs *const dcs = &lcd->chip.dcs;
    unsigned column = module->first_column + (module->mirrored ? module->columns - 1U - x : x);
    unsigned line = module->first_row + (module->flipped ? module->rows - 1U - y : y);
    if (dcs->sources_reversed) {
        column = module->memory_columns - 1U - column;
    }
    if (dcs->gates_reversed) {
        line = module->memory_rows - 1U - line;
    }
    return shown_pixel(lcd, el_lcd_memory(lcd, column, memory_row(lcd, line)));
}

/* While the chip sleeps or the display is off it drives no voltage (section 8.2.18: "blank page inserted"). */
bool el_dcs_is_lit(const el_lcd *lcd)
{
    return lcd->chip.dcs.awake && lcd->chip.dcs.on;
}
