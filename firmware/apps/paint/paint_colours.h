/* Colours of the pages, and places on them. */
#ifndef EL_APPS_PAINT_COLOURS_H
#define EL_APPS_PAINT_COLOURS_H

#include "base/rgb565.h"

enum {
    BLACK = 0x0000,
    WHITE = 0xFFFF,
    GREY = 0x8410,
    DARK = 0x18E3,
    NIGHT = 0x10A3,
    RED = 0xF9C7,
    GREEN = 0x3E6B,
    BLUE = 0x3B9F,
    CYAN = 0x5EFC,
    YELLOW = 0xFF09,
    ORANGE = 0xFC63
};

#endif
