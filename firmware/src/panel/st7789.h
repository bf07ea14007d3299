/* ST7789 (Sitronix, data sheet ST7789V V1.3): IPS modules of 1.3 to 2.8 inches.
 *
 * Both models are for modules with red-green-blue IPS glass, which shows true colours with inversion on; give
 * `inverted` for TN glass. EL_LOW_BYTE_FIRST: RAMCTRL has it (9.2.1), with the note that it is for interfaces of 8 and 9
 * bits; ESP-IDF and NuttX use it over SPI. */
#ifndef EL_PANEL_ST7789_H
#define EL_PANEL_ST7789_H

#include "panel/tft.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const el_tft_model el_st7789;         /* 240x320 */
extern const el_tft_model el_st7789_240x240; /* 1.3 and 1.54 inches: the first 240 of the memory's 320 rows */

#ifdef __cplusplus
}
#endif

#endif
