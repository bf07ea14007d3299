/* stripes.h. The weights 1, 2, 3, 2, 1 are three times three ones: sums of three neighbours, of which again three are added.
 * All channels of a stripe are added in one word. */
#include "raster/stripes.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/rgb565.h"

#if EL_WITH_STRIPES

void el_stripes_cut(uint16_t *pixels, uint32_t count)
{
    while (count-- > 0) {
        const uint16_t pixel = pixels[count];
        uint16_t *const stripes = pixels + EL_STRIPES_PER_PIXEL * count;
        stripes[0] = stripes[1] = stripes[2] = pixel;
    }
}

/* A ninth, rounded to nearest, of a sum of nine channels: at most 9 * 63. 7282 / 2^16 is larger than a ninth by less than
 * 2^-18, which at 571 is less than the ninth that a quotient is below the next whole number at most. */
static inline uint32_t ninth(uint32_t sum)
{
    return (sum + 4U) * 7282U >> 16;
}

/* The pixel whose first stripe is s[2]. */
static uint16_t filtered(const uint16_t s[7], bool blue_first)
{
    const uint32_t b = el_rgb565_spread(s[1]);
    const uint32_t c = el_rgb565_spread(s[2]);
    const uint32_t d = el_rgb565_spread(s[3]);
    const uint32_t e = el_rgb565_spread(s[4]);
    const uint32_t f = el_rgb565_spread(s[5]);
    const uint32_t left = b + c + d;
    const uint32_t middle = c + d + e;
    const uint32_t right = d + e + f;
    const uint32_t first = el_rgb565_spread(s[0]) + b + c + left + middle;
    const uint32_t last = middle + right + e + f + el_rgb565_spread(s[6]);
    const uint32_t red = ninth((blue_first ? last : first) >> 11 & 0x3FFU);
    const uint32_t green = ninth((left + middle + right) >> 21);
    const uint32_t blue = ninth((blue_first ? first : last) & 0x7FFU);
    return (uint16_t)(red << 11 | green << 5 | blue);
}

/* The same at a side of the screen. */
static uint16_t filtered_at_side(const uint16_t *line, int32_t first, int32_t end, bool blue_first)
{
    uint16_t s[7];
    for (int32_t i = 0; i < 7; i++) {
        s[i] = line[el_max_i32(el_min_i32(first - 2 + i, end - 1), 0)];
    }
    return filtered(s, blue_first);
}

/* One line, which may be moved towards the front: what is written lies before all that is read then. Most pixels lie among
 * equal ones, and stay as they are. */
static void filter_line(uint16_t *to, const uint16_t *line, int32_t width, bool blue_first)
{
    const int32_t end = EL_STRIPES_PER_PIXEL * width;
    const uint16_t at_end = filtered_at_side(line, end - EL_STRIPES_PER_PIXEL, end, blue_first);
    to[0] = filtered_at_side(line, 0, end, blue_first);
    bool was_flat = false;
    for (int32_t x = 1; x < width - 1; x++) {
        const uint16_t *const s = line + EL_STRIPES_PER_PIXEL * x - 2;
        const uint16_t colour = s[3];
        const bool is_flat = s[4] == colour && s[5] == colour && s[6] == colour &&
                             (was_flat || (s[0] == colour && s[1] == colour && s[2] == colour));
        to[x] = is_flat ? colour : filtered(s, blue_first);
        was_flat = is_flat;
    }
    to[width - 1] = at_end;
}

void el_stripes_filter(uint16_t *pixels, uint16_t *depth, uint32_t width, uint32_t lines, bool blue_first)
{
    for (uint32_t line = 0; line < lines; line++) {
        filter_line(pixels + line * width, pixels + line * width * EL_STRIPES_PER_PIXEL, (int32_t)width, blue_first);
    }
    const uint16_t *middle = depth + 1;
    for (const uint16_t *const end = depth + (size_t)width * lines; depth != end; middle += EL_STRIPES_PER_PIXEL) {
        *depth++ = *middle;
    }
}

#endif
