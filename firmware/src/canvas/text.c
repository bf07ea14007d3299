/* From bytes to characters, from characters to glyphs, from glyphs to runs of pixels. */
#include "canvas/text.h"

#include <stdbool.h>

#include "base/fixed.h"

enum { REPLACEMENT = 0xFFFD, NO_GLYPH = 0xFFFF };

/* How far a text goes at most, so that sums fit: no screen is so wide. */
enum { FAR = 1 << 24 };

uint32_t el_utf8_next(const char **text)
{
    const uint8_t *at = (const uint8_t *)*text;
    const uint8_t first = *at;
    if (first == 0) {
        return 0;
    }
    at++;
    uint32_t character = first;
    unsigned more = 0;
    /* What the second byte may be: neither longer than needed, nor half of a pair, nor beyond U+10FFFF. */
    uint8_t least = 0x80;
    uint8_t most = 0xBF;
    if (first >= 0xF0 && first <= 0xF4) {
        more = 3;
        character = first & 7U;
        least = first == 0xF0 ? 0x90 : 0x80;
        most = first == 0xF4 ? 0x8F : 0xBF;
    } else if (first >= 0xE0 && first < 0xF0) {
        more = 2;
        character = first & 15U;
        least = first == 0xE0 ? 0xA0 : 0x80;
        most = first == 0xED ? 0x9F : 0xBF;
    } else if (first >= 0xC2 && first < 0xE0) {
        more = 1;
        character = first & 31U;
    } else if (first >= 0x80) {
        character = REPLACEMENT;
    }
    for (; more > 0; more--) {
        if (*at < least || *at > most) { /* the text's end, too */
            character = REPLACEMENT;
            break;
        }
        character = character << 6 | (*at++ & 63U);
        least = 0x80;
        most = 0xBF;
    }
    *text = (const char *)at;
    return character;
}

/* The glyph of a character, or NO_GLYPH. */
static uint32_t find_glyph(const el_font *font, uint32_t character)
{
    uint32_t begin = 0;
    uint32_t end = font->range_count;
    while (begin < end) {
        const uint32_t middle = (begin + end) / 2U;
        const el_font_range *const range = &font->ranges[middle];
        if (character < range->first) {
            end = middle;
        } else if (character - range->first >= range->count) {
            begin = middle + 1U;
        } else {
            return range->glyph + (character - range->first);
        }
    }
    return NO_GLYPH;
}

static int32_t kern_between(const el_font *font, uint32_t before, uint32_t after)
{
    const uint32_t wanted = before << 16 | after;
    uint32_t begin = 0;
    uint32_t end = font->kern_count;
    while (begin < end) {
        const uint32_t middle = (begin + end) / 2U;
        const el_font_kern *const kern = &font->kerns[middle];
        const uint32_t pair = (uint32_t)kern->before << 16 | kern->after;
        if (pair == wanted) {
            return kern->by;
        }
        if (pair < wanted) {
            begin = middle + 1U;
        } else {
            end = middle;
        }
    }
    return 0;
}

/* What is drawn for a character that the font lacks: a frame, three quarters as wide as it is high. */
static int32_t box_width(const el_font *font)
{
    return el_max_i32(3, font->ascent * 3 / 4);
}

/* Where a line of text has got to. */
typedef struct pen {
    const char *at;
    int32_t x;
    uint32_t before; /* the glyph drawn last; NO_GLYPH: none */
} pen;

/* Takes the next character of the line: moves `p` beyond it. Where it is to be drawn, and as which glyph; false at the end
 * of the line, which is left behind. */
static bool next_glyph(pen *p, const el_font *font, int32_t *x, uint32_t *glyph)
{
    const uint32_t character = el_utf8_next(&p->at);
    if (character == 0 || character == '\n') {
        return false;
    }
    *glyph = find_glyph(font, character);
    const bool pair = *glyph != NO_GLYPH && p->before != NO_GLYPH;
    *x = p->x + (pair ? kern_between(font, p->before, *glyph) : 0);
    const int32_t advance = *glyph == NO_GLYPH ? box_width(font) + 1 : font->glyphs[*glyph].advance;
    p->x = el_min_i32(el_max_i32(*x + advance, -FAR), FAR);
    p->before = *glyph;
    return true;
}

/* The width of the line that begins at *text, which is left behind. */
static int32_t line_width(const el_font *font, const char **text)
{
    pen p = {.at = *text, .before = NO_GLYPH};
    int32_t x;
    uint32_t glyph;
    while (next_glyph(&p, font, &x, &glyph)) {
    }
    *text = p.at;
    return p.x;
}

int32_t el_text_width(const el_font *font, const char *text)
{
    int32_t width = 0;
    while (*text != 0) {
        width = el_max_i32(width, line_width(font, &text));
    }
    return width;
}

/* Pixel `index` of a glyph. */
static inline uint32_t value_at(const uint8_t *bits, uint32_t index, uint32_t bits_per_pixel)
{
    const uint32_t bit = index * bits_per_pixel;
    return (uint32_t)bits[bit >> 3] >> (8U - bits_per_pixel - (bit & 7U)) & ((1U << bits_per_pixel) - 1U);
}

/* Its value as a coverage, 0..256, rounded to nearest: all levels of 1 and 2 bits are some of 4. */
static uint32_t coverage_of(uint32_t value, uint32_t bits_per_pixel)
{
    static const uint16_t fifteenths[16] = {0, 17, 34, 51, 68, 85, 102, 119, 137, 154, 171, 188, 205, 222, 239, 256};
    return fifteenths[bits_per_pixel == 4 ? value : bits_per_pixel == 2 ? value * 5U : value * 15U];
}

static void draw_glyph(const el_canvas *canvas, const el_font *font, const el_glyph *glyph, int32_t x, int32_t y,
                       const el_paint *paint)
{
    const int32_t left = x + glyph->left;
    const int32_t top = y - glyph->top;
    const el_rect part = el_rect_shared((el_rect){left, top, left + glyph->width, top + glyph->height}, canvas->clip);
    const uint8_t *const bits = font->bits + glyph->at;
    const uint32_t depth = font->bits_per_pixel;
    for (int32_t j = part.y; j < part.y_end; j++) {
        uint32_t index = (uint32_t)(j - top) * glyph->width + (uint32_t)(part.x - left);
        int32_t i = part.x;
        while (i < part.x_end) {
            const int32_t begin = i;
            const uint32_t value = value_at(bits, index, depth);
            do {
                i++;
                index++;
            } while (i < part.x_end && value_at(bits, index, depth) == value);
            if (value != 0) {
                el_canvas_run(canvas, j, begin, i, paint, coverage_of(value, depth));
            }
        }
    }
}

/* Draws the line of text that begins at *text, which is left behind. */
static void draw_line(const el_canvas *canvas, const el_font *font, int32_t x, int32_t y, const char **text,
                      const el_paint *paint)
{
    pen p = {.at = *text, .x = x, .before = NO_GLYPH};
    int32_t at;
    uint32_t glyph;
    while (next_glyph(&p, font, &at, &glyph)) {
        if (glyph == NO_GLYPH) {
            el_canvas_frame(canvas, (el_rect){at, y - font->ascent, at + box_width(font), y}, 1, *paint);
        } else {
            draw_glyph(canvas, font, &font->glyphs[glyph], at, y, paint);
        }
    }
    *text = p.at;
}

void el_canvas_text(const el_canvas *canvas, const el_font *font, int16_t x, int16_t y, el_align align,
                    const char *text, el_paint paint)
{
    for (int32_t base = y; *text != 0 && base - font->ascent < canvas->clip.y_end; base += font->line_height) {
        const char *end = text;
        int32_t begin = x;
        if (base + font->descent <= canvas->clip.y) {
            (void)line_width(font, &text); /* above the band */
            continue;
        }
        if (align != EL_ALIGN_LEFT) {
            const int32_t width = line_width(font, &end);
            begin -= align == EL_ALIGN_RIGHT ? width : width / 2;
        }
        draw_line(canvas, font, begin, base, &text, &paint);
    }
}
