/* RGB565 pictures as PNG files, by libpng. */
#ifndef EL_SIM_PNG_FILE_H
#define EL_SIM_PNG_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "files.h"

/* Writes width * height pixels, each channel widened to 8 bits by repeating its upper ones. False, after one line on
 * stderr, when they cannot be written. */
bool el_png_write(el_output *output, const uint16_t *rgb565, uint16_t width, uint16_t height);

#endif
