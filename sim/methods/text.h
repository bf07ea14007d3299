/* Letters for pictures: 3x5 pixels each, enough for a title under a cell. */
#ifndef EL_METHODS_TEXT_H
#define EL_METHODS_TEXT_H

#include <stdint.h>

typedef struct el_sheet {
    uint16_t width, height;
    uint16_t *pixels; /* RGB565 */
} el_sheet;

void el_sheet_fill(el_sheet *canvas, int32_t x, int32_t y, int32_t width, int32_t height, uint16_t colour);

/* Writes `text` with its upper left corner at (x, y), each of a letter's pixels `scale` pixels wide; a letter takes 4
 * of them with the gap. Small letters are written as capitals, other characters as blanks. What lies beside the canvas
 * is left out. */
void el_sheet_write(el_sheet *canvas, int32_t x, int32_t y, int32_t scale, uint16_t colour, const char *text);

#endif
