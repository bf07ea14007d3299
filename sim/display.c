#include "display.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "panel/ili9341.h"
#include "panel/ssd0323.h"
#include "panel/ssd1306.h"
#include "panel/st7735.h"
#include "panel/st7789.h"
#include "report.h"

enum { SCK_HZ = 62500000 };

/* What drives a panel: a model of the colour driver, or else the two functions of an OLED's. */
typedef struct panel_driver {
    const char *panel;
    const el_tft_model *tft;
    el_status (*init)(el_oled *panel, const el_oled_config *config);
    el_sink (*sink)(el_oled *panel);
} panel_driver;

static const panel_driver DRIVERS[] = {
    {"ili9341", &el_ili9341, NULL, NULL},
    {"st7789", &el_st7789, NULL, NULL},
    {"st7789-240x240", &el_st7789_240x240, NULL, NULL},
    {"st7735", &el_st7735, NULL, NULL},
    {"ssd1306", NULL, el_ssd1306_init, el_ssd1306_sink},
    {"ssd0323", NULL, el_ssd0323_init, el_ssd0323_sink},
};

/* Enough for either of the OLEDs. */
static size_t oled_memory_bytes(unsigned band_lines)
{
    const size_t ssd1306 = EL_SSD1306_MEMORY_BYTES(band_lines);
    const size_t ssd0323 = EL_SSD0323_MEMORY_BYTES(band_lines);
    return ssd1306 > ssd0323 ? ssd1306 : ssd0323;
}

unsigned el_display_degrees(el_rotation rotation)
{
    static const unsigned degrees[] = {0, 270, 180, 90};
    return degrees[rotation];
}

const el_lcd_profile *el_display_profile(const char *panel)
{
    const el_lcd_profile *profile = el_lcd_profile_find(panel);
    if (profile == NULL) {
        char names[128] = "";
        for (size_t i = 0; (profile = el_lcd_profile_at(i)) != NULL; i++) {
            const size_t used = strlen(names);
            (void)snprintf(names + used, sizeof names - used, "%s%s", i == 0 ? "" : ", ", profile->panel);
        }
        el_report("there is no panel '%s'; there are %s", panel, names);
    }
    return profile;
}

static const panel_driver *find_driver(const char *panel)
{
    for (size_t i = 0; i < sizeof DRIVERS / sizeof DRIVERS[0]; i++) {
        if (strcmp(DRIVERS[i].panel, panel) == 0) {
            return &DRIVERS[i];
        }
    }
    return NULL;
}

static el_status start_tft(el_display *display, const el_display_config *config, const el_tft_model *model)
{
    const size_t shown_bytes =
        EL_WITH_REUSE && config->sparing ? EL_TFT_SHOWN_BYTES((size_t)display->width, display->height) : 0;
    if (shown_bytes > 0) {
        display->memory = malloc(shown_bytes);
        if (display->memory == NULL) {
            return EL_ERROR_MEMORY;
        }
    }
    const el_status status = el_tft_init(&display->driver.tft, &(el_tft_config){
                                                                   .bus = &display->bus,
                                                                   .model = model,
                                                                   .rotation = config->rotation,
                                                                   .mirrored = config->mirrored,
                                                                   .rgb_order = config->rgb_order,
                                                                   .inverted = config->inverted,
                                                                   .byte_order = config->byte_order,
                                                                   .shown = display->memory,
                                                                   .shown_bytes = shown_bytes,
                                                               });
    display->sink = el_tft_sink(&display->driver.tft);
    return status;
}

static el_status start_oled(el_display *display, const el_display_config *config, const panel_driver *driver)
{
    const size_t memory_bytes = oled_memory_bytes(config->band_lines);
    display->memory = malloc(memory_bytes);
    if (display->memory == NULL) {
        return EL_ERROR_MEMORY;
    }
    const el_status status = driver->init(&display->driver.oled, &(el_oled_config){
                                                                     .bus = &display->bus,
                                                                     .rotation = config->rotation,
                                                                     .mirrored = config->mirrored,
                                                                     .inverted = config->inverted,
                                                                     .memory = display->memory,
                                                                     .memory_bytes = memory_bytes,
                                                                 });
    display->sink = driver->sink(&display->driver.oled);
    return status;
}

static el_status start_driver(el_display *display, const el_display_config *config, const el_lcd_profile *profile)
{
    if (config->panel == NULL) {
        display->model = el_ili9341;
        display->model.columns = display->model.memory_columns = profile->columns;
        display->model.rows = display->model.memory_rows = profile->rows;
        return start_tft(display, config, &display->model);
    }
    const panel_driver *const driver = find_driver(config->panel);
    if (driver == NULL) {
        return EL_ERROR_ARGUMENT;
    }
    return driver->tft != NULL ? start_tft(display, config, driver->tft) : start_oled(display, config, driver);
}

bool el_display_open(el_display *display, const el_display_config *config)
{
    *display = (el_display){0};
    el_lcd_profile profile = el_lcd_dcs(config->columns, config->rows);
    if (config->panel != NULL) {
        const el_lcd_profile *const named = el_display_profile(config->panel);
        if (named == NULL) {
            return false;
        }
        profile = *named;
    }
    const bool sideways = config->rotation == EL_ROTATION_90 || config->rotation == EL_ROTATION_270;
    display->degrees = el_display_degrees(config->rotation);
    display->width = sideways ? profile.rows : profile.columns;
    display->height = sideways ? profile.columns : profile.rows;
    display->lcd = el_lcd_create(&profile);
    if (display->lcd == NULL) {
        el_report("no memory for glass of %u x %u pixels", profile.columns, profile.rows);
        return false;
    }
    el_lcd_bus_init(&display->bus_state, &(el_lcd_bus_config){.lcd = display->lcd,
                                                              .sck_hz = SCK_HZ,
                                                              .chunk = config->chunk,
                                                              .bytes_only = config->bytes_only,
                                                              .tap = config->tap});
    display->bus = el_lcd_bus_functions(&display->bus_state);
    if (start_driver(display, config, &profile) != EL_OK) {
        el_report("the driver of %s does not take this configuration", profile.panel);
        return false;
    }
    return true;
}

void el_display_close(el_display *display)
{
    el_lcd_destroy(display->lcd);
    free(display->memory);
    *display = (el_display){0};
}

bool el_display_look(el_display *display, uint16_t *rgb565)
{
    el_lcd_bus_drain(&display->bus_state);
    const el_lcd_error *const error = el_lcd_error_at(display->lcd, 0);
    if (error != NULL) {
        el_report("the display would not have taken this: %s", error->text);
        return false;
    }
    (void)el_lcd_look(display->lcd, display->degrees, rgb565);
    return true;
}
