/* ST7735 (Sitronix, data sheets ST7735 V1.7 and ST7735R V0.2; ST7735S is the same here): 128x160 modules of 1.77 and 1.8
 * inches with TN glass.
 *
 * Modules differ in how the glass is bonded to the memory, which the pins GM1 and GM0 of the chip say (9.10); on many, the
 * colour of the tab of the protective film tells it. Wrong: two columns and one line of noise at the edges. High byte
 * first only. Neither data sheet has scrolling: el_tft_scroll refuses. */
#ifndef EL_PANEL_ST7735_H
#define EL_PANEL_ST7735_H

#include "panel/tft.h"

#ifdef __cplusplus
extern "C" {
#endif

/* "Green tab": the memory is 132x162 (GM = 00), the glass is in its middle, from column 2 and row 1. BGR. */
extern const el_tft_model el_st7735;

/* "Red tab" and "black tab": the memory is 128x160 (GM = 11). BGR; black tabs are RGB: give `rgb_order`. */
extern const el_tft_model el_st7735_128x160_memory;

#ifdef __cplusplus
}
#endif

#endif
