/* One picture of small multiples: each method's pixels of the same closed fan, or of the same polygons, coloured by what
 * is right, missing and too much. */
#ifndef EL_METHODS_PICTURE_H
#define EL_METHODS_PICTURE_H

#include "methods/text.h"

enum { EL_METHODS_PICTURE_WIDTH = 1000, EL_METHODS_PICTURE_HEIGHT = 1092 };

/* Pre: the canvas has that size. */
void el_methods_picture(el_sheet *canvas);

#endif
