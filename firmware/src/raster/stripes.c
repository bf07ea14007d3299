/* stripes.h. The weights 1, 2, 3, 2, 1 are three times three ones: sums of three neighbours, of which again three are added.
 * All channels of a stripe are added in one word. */
#include "raster/stripes.h"

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

/* One line, which may be moved towards the front meanwhile: what is written lies before what is read next. */
static void filter_line(uint16_t *to, const uint16_t *stripes, uint32_t width, bool blue_first)
{
    const uint32_t last = EL_STRIPES_PER_PIXEL * width - 1U;
    uint32_t here = el_rgb565_spread(stripes[0]);
    uint32_t ahead = el_rgb565_spread(stripes[1]);
    /* Sums of three: about the stripe before, and about the one that is looked at. */
    uint32_t before = 3U * here;
    uint32_t about = 2U * here + ahead;
    for (uint32_t x = 0; x < width; x++) {
        uint32_t sums[EL_STRIPES_PER_PIXEL];
        for (uint32_t i = 0; i < EL_STRIPES_PER_PIXEL; i++) {
            const uint32_t next = EL_STRIPES_PER_PIXEL * x + i + 2U;
            const uint32_t beyond = el_rgb565_spread(stripes[el_min_u32(next, last)]);
            const uint32_t after = here + ahead + beyond;
            sums[i] = before + about + after;
            before = about;
            about = after;
            here = ahead;
            ahead = beyond;
        }
        const uint32_t red = ninth(sums[blue_first ? 2 : 0] >> 11 & 0x3FFU);
        const uint32_t green = ninth(sums[1] >> 21);
        const uint32_t blue = ninth(sums[blue_first ? 0 : 2] & 0x7FFU);
        to[x] = (uint16_t)(red << 11 | green << 5 | blue);
    }
}

void el_stripes_filter(uint16_t *pixels, uint16_t *depth, uint32_t width, uint32_t lines, bool blue_first)
{
    for (uint32_t line = 0; line < lines; line++) {
        filter_line(pixels + line * width, pixels + line * width * EL_STRIPES_PER_PIXEL, width, blue_first);
    }
    for (uint32_t i = 0; i < width * lines; i++) {
        const uint16_t *const stripes = depth + EL_STRIPES_PER_PIXEL * i;
        depth[i] = (uint16_t)el_min_u32(stripes[0], el_min_u32(stripes[1], stripes[2]));
    }
}

#endif
