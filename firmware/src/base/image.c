#include "base/image.h"

/* A weighted sum of colours, and of what they show. */
typedef struct mix {
    uint32_t red, green, blue; /* at most 63 * 2^16 */
    uint32_t shown;            /* at most 2^16 */
} mix;

static inline void add_colour(mix *m, uint16_t colour, uint32_t part)
{
    m->red += (colour >> 11) * part;
    m->green += (colour >> 5 & 63U) * part;
    m->blue += (colour & 31U) * part;
    m->shown += part;
}

static void add_to(mix *m, const el_image *image, uint32_t x, uint32_t y, uint32_t weight)
{
    if (weight != 0 && x < image->width && y < image->height) {
        uint16_t colour;
        const uint32_t part = el_image_at(image, (el_image_format)image->format, x, y, &colour) * weight;
        add_colour(m, colour, part);
    }
}

/* The mean of what shows, each channel rounded to nearest. */
static inline uint32_t mean_of(const mix *m, uint16_t *colour)
{
    if (m->shown == 0) {
        return 0;
    }
    const uint32_t half = m->shown / 2U;
    if (m->shown == 1U << 16) {
        *colour = (uint16_t)(((m->red + half) >> 16) << 11 | ((m->green + half) >> 16) << 5 | (m->blue + half) >> 16);
        return 256;
    }
    *colour =
        (uint16_t)((m->red + half) / m->shown << 11 | (m->green + half) / m->shown << 5 | (m->blue + half) / m->shown);
    return (m->shown + 128U) >> 8;
}

uint32_t el_image_smooth_at(const el_image *image, const el_image_spot *spot, uint16_t *colour)
{
    const uint32_t right = spot->right;
    const uint32_t down = spot->down;
    mix m = {0};
    add_to(&m, image, spot->x[0], spot->y[0], (16U - right) * (16U - down));
    add_to(&m, image, spot->x[1], spot->y[0], right * (16U - down));
    add_to(&m, image, spot->x[0], spot->y[1], (16U - right) * down);
    add_to(&m, image, spot->x[1], spot->y[1], right * down);
    return mean_of(&m, colour);
}

uint32_t el_image_mean(const el_image_four *four, uint32_t right, uint32_t down, uint16_t *colour)
{
    if ((four->shown[0] & four->shown[1] & four->shown[2] & four->shown[3]) == 256) {
        *colour = el_rgb565_mean(four->colour, right, down);
        return 256;
    }
    mix m = {0};
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t across = (i & 1U) != 0 ? right : 16U - right;
        add_colour(&m, four->colour[i], four->shown[i] * across * (i >= 2 ? down : 16U - down));
    }
    return mean_of(&m, colour);
}
