/* The pages' own functions, which pages.c lists. */
#ifndef EL_APPS_PAINT_PAGE_FUNCTIONS_H
#define EL_APPS_PAINT_PAGE_FUNCTIONS_H

#include "edgeline.h"

void el_card_draw(uint32_t frame, const el_canvas *canvas);
void el_lines_draw(uint32_t frame, const el_canvas *canvas);
void el_horizon_draw(uint32_t frame, const el_canvas *canvas);
void el_hud_draw(uint32_t frame, const el_canvas *canvas);

#endif
