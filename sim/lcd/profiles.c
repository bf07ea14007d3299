/* The modules by name. */
#include <string.h>

#include "lcd.h"

const el_lcd_profile *el_lcd_profile_at(size_t index)
{
    static const el_lcd_profile *const PROFILES[] = {
        &EL_LCD_ILI9341, &EL_LCD_ST7789, &EL_LCD_ST7789_240X240, &EL_LCD_ST7735, &EL_LCD_SSD1306, &EL_LCD_SSD0323,
    };
    return index < sizeof PROFILES / sizeof PROFILES[0] ? PROFILES[index] : NULL;
}

const el_lcd_profile *el_lcd_profile_find(const char *panel)
{
    const el_lcd_profile *profile;
    for (size_t i = 0; (profile = el_lcd_profile_at(i)) != NULL; i++) {
        if (strcmp(profile->panel, panel) == 0) {
            return profile;
        }
    }
    return NULL;
}
