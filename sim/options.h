/* Command-line values: whole strings or nothing. Each function prints one line on stderr and returns false when the text
 * is not what it should be. `option` is the option's name, for that line. */
#ifndef EL_SIM_OPTIONS_H
#define EL_SIM_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "panel/panel.h"

bool el_option_integer(const char *option, const char *text, long least, long most, long *value);
bool el_option_number(const char *option, const char *text, double least, double most, double *value);
/* "X,Y,Z", each within +-limit. */
bool el_option_vector(const char *option, const char *text, double limit, double vector[3]);
/* "WIDTHxHEIGHT", each 1..EL_MAX_WIDTH, EL_MAX_HEIGHT. */
bool el_option_size(const char *option, const char *text, uint16_t *width, uint16_t *height);
/* Lines of a band, 1 to `height`; without a text (NULL) 8, or `height` where that is less. */
bool el_option_band(const char *text, uint16_t height, uint16_t *lines);

/* 0, 90, 180 or 270. */
bool el_option_rotation(const char *option, const char *text, el_rotation *rotation);

#endif
