#include "methods/text.h"

/* One octal digit per row, from the top; 4 is the left pixel, 1 the right. */
static const uint16_t letters[26] = {
    025755, 065656, 034443, 065556, 074647, 074644, 034553, 055755, 072227, 011152, 055655, 044447, 057755,
    065555, 025552, 065644, 025563, 065655, 034216, 072222, 055557, 055552, 055775, 055255, 055222, 071247,
};
static const uint16_t digits[10] = {075557, 026227, 061247, 061216, 055711, 074616, 034757, 071122, 075757, 075716};

static uint16_t glyph_of(char c)
{
    if (c >= 'a' && c <= 'z') {
        return letters[c - 'a'];
    }
    if (c >= 'A' && c <= 'Z') {
        return letters[c - 'A'];
    }
    if (c >= '0' && c <= '9') {
        return digits[c - '0'];
    }
    switch (c) {
    case '-':
        return 000700;
    case ',':
        return 000024;
    case '.':
        return 000002;
    case ':':
        return 002020;
    default:
        return 0;
    }
}

void el_sheet_fill(el_sheet *canvas, int32_t x, int32_t y, int32_t width, int32_t height, uint16_t colour)
{
    for (int32_t row = y < 0 ? 0 : y; row < y + height && row < canvas->height; row++) {
        for (int32_t column = x < 0 ? 0 : x; column < x + width && column < canvas->width; column++) {
            canvas->pixels[row * canvas->width + column] = colour;
        }
    }
}

void el_sheet_write(el_sheet *canvas, int32_t x, int32_t y, int32_t scale, uint16_t colour, const char *text)
{
    for (; *text != '\0'; text++, x += 4 * scale) {
        const uint16_t glyph = glyph_of(*text);
        for (int32_t bit = 0; bit < 15; bit++) {
            if ((glyph >> (14 - bit) & 1) != 0) {
                el_sheet_fill(canvas, x + bit % 3 * scale, y + bit / 3 * scale, scale, scale, colour);
            }
        }
    }
}
