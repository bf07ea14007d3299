/* SSD1306 (Solomon Systech, data sheet Rev 1.1): 128x64 OLED, 1 bit per pixel, 8 pixels of a column in a byte.
 *
 * For modules of 0.96 inch that make the panel's voltage by the controller's charge pump and are wired for segment
 * remapping and a reversed COM scan, as nearly all are. The driver is oled.h's. */
#ifndef EL_PANEL_SSD1306_H
#define EL_PANEL_SSD1306_H

#include "panel/oled.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef el_oled el_ssd1306;
typedef el_oled_config el_ssd1306_config;

/* Pages of 8 lines that a band can finish or touch. */
#define EL_SSD1306_PAGES(band_lines)                                                                                   \
    (8 % (band_lines) == 0 ? 1 : (band_lines) % 8 == 0 ? (band_lines) / 8 : ((band_lines) + 14) / 8)

/* Memory for bands of that height: 256 bytes for 1, 2, 4 and 8 lines. With less, but at least 256, `rows` waits for the
 * wire more often, and shows the same. */
#define EL_SSD1306_MEMORY_BYTES(band_lines) (2 * 128 * EL_SSD1306_PAGES(band_lines))

/* Resets and initialises the controller. `config` is copied.
 * EL_ERROR_ARGUMENT: no memory, no bus or one that sends no bytes, or a rotation that does not exist. EL_ERROR_MEMORY:
 * less than 256 bytes (16 at 90 and 270 degrees, where a line is 8 bytes). Then nothing was sent. */
el_status el_ssd1306_init(el_ssd1306 *panel, const el_ssd1306_config *config);

/* The sink, which refers to `panel`. A frame that is larger than the glass is not shown. */
el_sink el_ssd1306_sink(el_ssd1306 *panel);

#ifdef __cplusplus
}
#endif

#endif
