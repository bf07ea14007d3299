/* Picture out: from the LCD model's memory to what a viewer of the glass sees.
 *
 * The way is that of the chip: scrolling chooses the memory line of a gate, GS and SS the direction of gates and
 * sources, then idle mode, inversion and the colour order act on each pixel. MADCTL's MX, MY and MV have no part in
 * it: they act when pixels are written, and what is in the memory stays where it is. */
#include "dcs_lcd.h"

#include "dcs_state.h"

/* While the chip sleeps or the display is off it drives no voltage (section 8.2.18: "blank page inserted"), and the
 * modules' normally white liquid crystal (REV of section 8.3.7) lets the backlight through. */
static const uint16_t BLANK = 0xFFFF;

/* The memory row that gate `line` shows, sections 8.2.26 and 8.2.30; with ML the lines count from the bottom. */
static unsigned memory_row(const el_lcd *lcd, unsigned line)
{
    const unsigned top = lcd->top_fixed;
    const unsigned area = lcd->scroll_area;
    const bool from_bottom = (lcd->madctl & EL_MADCTL_ML) != 0;
    unsigned counted = from_bottom ? lcd->profile.rows - 1U - line : line;
    if (lcd->scrolling && counted >= top && counted < top + area) {
        counted = top + (counted - top + lcd->scroll_start - top) % area;
    }
    return from_bottom ? lcd->profile.rows - 1U - counted : counted;
}

static uint16_t shown_pixel(const el_lcd *lcd, uint32_t rgb18)
{
    if (lcd->idle) { /* section 8.2.32: the highest bit of each colour counts */
        rgb18 = (rgb18 >> 17 & 1) * 0x3F000 | (rgb18 >> 11 & 1) * 0x00FC0 | (rgb18 >> 5 & 1) * 0x0003F;
    }
    const bool reversed = (lcd->disctrl & EL_DISCTRL_REV) == 0;
    if (lcd->inverted != reversed) {
        rgb18 ^= 0x3FFFF;
    }
    uint32_t red = rgb18 >> 13;
    const uint32_t green = rgb18 >> 6 & 0x3F;
    uint32_t blue = rgb18 >> 1 & 0x1F;
    if (((lcd->madctl & EL_MADCTL_BGR) != 0) != lcd->profile.bgr_filter) {
        const uint32_t other = red;
        red = blue;
        blue = other;
    }
    return (uint16_t)(red << 11 | green << 5 | blue);
}

static uint16_t glass_pixel(const el_lcd *lcd, unsigned x, unsigned y)
{
    const bool sources_reversed = (lcd->disctrl & EL_DISCTRL_SS) != 0;
    const bool gates_reversed = (lcd->disctrl & EL_DISCTRL_GS) != 0;
    const unsigned column = lcd->profile.mirrored != sources_reversed ? lcd->profile.columns - 1U - x : x;
    const unsigned line = gates_reversed ? lcd->profile.rows - 1U - y : y;
    return shown_pixel(lcd, el_lcd_memory(lcd, column, memory_row(lcd, line)));
}

int el_lcd_look(const el_lcd *lcd, unsigned degrees, uint16_t *rgb565)
{
    if (degrees % 90 != 0 || degrees >= 360) {
        return -1;
    }
    const unsigned columns = lcd->profile.columns;
    const unsigned rows = lcd->profile.rows;
    const bool lies = degrees == 90 || degrees == 270;
    const unsigned width = lies ? rows : columns;
    const unsigned height = lies ? columns : rows;
    for (unsigned y = 0; y < height; y++) {
        for (unsigned x = 0; x < width; x++) {
            unsigned glass_x = lies ? y : x;
            unsigned glass_y = lies ? x : y;
            if (degrees == 180 || degrees == 270) {
                glass_x = columns - 1 - glass_x;
            }
            if (degrees == 90 || degrees == 180) {
                glass_y = rows - 1 - glass_y;
            }
            *rgb565++ = lcd->awake && lcd->on ? glass_pixel(lcd, glass_x, glass_y) : BLANK;
        }
    }
    return 0;
}

void el_lcd_glass(const el_lcd *lcd, uint16_t *rgb565)
{
    (void)el_lcd_look(lcd, 0, rgb565);
}
