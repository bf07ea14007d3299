/* ILI9341 (ILI Technology, data sheet V1.11): 240x320, the usual 2.2 to 3.2 inch modules with TN glass. */
#ifndef EL_PANEL_ILI9341_H
#define EL_PANEL_ILI9341_H

#include "panel/tft.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Blue-green-red glass. High byte first only: the ENDIAN bit of F6h is for the parallel interface (8.3.33). */
extern const el_tft_model el_ili9341;

#ifdef __cplusplus
}
#endif

#endif
