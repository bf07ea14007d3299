/* Text in bitmap fonts, sharp or smooth, in UTF-8. `edgeline font FILE.ttf --size 16 -o font.h` makes a font.
 *
 * Where a font lacks a character, a box is drawn. Bytes that are no UTF-8 are drawn as U+FFFD, the replacement character,
 * one for each longest piece that could have begun a character, as Unicode (chapter 3, "U+FFFD Substitution of Maximal
 * Subparts") recommends. */
#ifndef EL_CANVAS_TEXT_H
#define EL_CANVAS_TEXT_H

#include <stdint.h>

#include "canvas/canvas.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A character's picture: width x height values of el_font.bits_per_pixel, row by row without gaps, the first value in a
 * byte's highest bits. */
typedef struct el_glyph {
    uint32_t at; /* its first byte in el_font.bits */
    uint8_t width, height;
    int8_t left;     /* pixels from where the text has got to its first column */
    int8_t top;      /* pixels from the base line up to its first row */
    uint8_t advance; /* pixels on to the next character */
} el_glyph;

/* Characters first..first + count - 1 have glyphs from `glyph` on. Ranges are in order. */
typedef struct el_font_range {
    uint32_t first;
    uint16_t count, glyph;
} el_font_range;

/* How much nearer, or further, a glyph comes after another one than its advance says. In order of both. */
typedef struct el_font_kern {
    uint16_t before, after; /* glyphs */
    int8_t by;              /* pixels to the right */
} el_font_kern;

/* Trusted as a mesh is; what the converter makes is sound. */
typedef struct el_font {
    const el_glyph *glyphs;
    const el_font_range *ranges;
    const uint8_t *bits;
    const el_font_kern *kerns;
    uint16_t range_count, kern_count;
    uint8_t bits_per_pixel; /* 1, 2 or 4: how much of a pixel is covered */
    int8_t ascent, descent; /* pixels from the base line up and down to where no glyph of the font reaches further */
    uint8_t line_height;    /* pixels from a base line to the next */
} el_font;

typedef enum el_align { EL_ALIGN_LEFT, EL_ALIGN_CENTRE, EL_ALIGN_RIGHT } el_align;

/* The next character of a NUL-terminated text, after which *text stands then; 0 at its end, where it stays. */
uint32_t el_utf8_next(const char **text);

/* Pixels from the beginning to the end of a text's longest line; lines end with '\n'. */
int32_t el_text_width(const el_font *font, const char *text);

/* Draws `text` with its first base line above line y: its lowest pixels without descenders are in line y - 1. Each line
 * begins at x, ends there or has its middle there. */
void el_canvas_text(const el_canvas *canvas, const el_font *font, int16_t x, int16_t y, el_align align,
                    const char *text, el_paint paint);

#ifdef __cplusplus
}
#endif

#endif
