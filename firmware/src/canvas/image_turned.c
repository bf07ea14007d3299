/* Turned and scaled images: for each pixel of the screen, where it lies in the image.
 *
 * That is u = a x + b y + c, v = -b x + a y + d, in 1/65536 of the image's pixels, with whole numbers a to d: exact from any
 * pixel on, and stepped by additions. For each line the columns whose u and v lie within the image are found by division, so
 * that no pixel is tested. */
#include "base/fixed.h"
#include "base/options.h"
#include "base/rgb565.h"
#include "canvas/floor.h"
#include "canvas/image.h"

enum { LEAST_SCALE_Q16 = 1 << 8, MOST_SCALE_Q16 = 1 << 24 };

/* With the steps up to 2^24, the screen up to 2^11 and places up to 2^12 pixels, all below 2^38. */
typedef struct mapping {
    int64_t a, b, c, d;
} mapping;

/* cos or sin over the scale, rounded down: at most 2^30 * 4 / 2^8. */
static int64_t over_scale_q16(int32_t ratio_q30, uint32_t scale_q16)
{
    int64_t rest;
    return el_floor_divide((int64_t)ratio_q30 * 4, scale_q16, &rest);
}

static mapping mapping_of(const el_image *image, const el_image_place *place)
{
    mapping m = {.a = over_scale_q16(el_cos_q30(place->angle), place->scale_q16),
                 .b = over_scale_q16(el_sin_q30(place->angle), place->scale_q16)};
    /* A pixel's centre is half a pixel from its number. */
    const int64_t x = place->x - EL_SUBPIXELS / 2;
    const int64_t y = place->y - EL_SUBPIXELS / 2;
    m.c = ((int64_t)image->width << 15) - ((m.a * x + m.b * y) >> EL_SUBPIXEL_BITS);
    m.d = ((int64_t)image->height << 15) - ((m.a * y - m.b * x) >> EL_SUBPIXEL_BITS);
    return m;
}

/* Columns of [*begin, *end) for which 0 <= start + step x < limit. */
static void narrow(int64_t start, int64_t step, int64_t limit, int32_t *begin, int32_t *end)
{
    int64_t first = *begin;
    int64_t last = *end;
    int64_t rest;
    if (step == 0) {
        last = start >= 0 && start < limit ? last : first;
    } else if (step > 0) {
        first = el_floor_divide(step - 1 - start, step, &rest);        /* -start / step, rounded up */
        last = el_floor_divide(step - 1 + limit - start, step, &rest); /* the first that is too far */
    } else {
        first = el_floor_divide(start - limit, -step, &rest) + 1;
        last = el_floor_divide(start, -step, &rest) + 1;
    }
    *begin = first > *begin ? (int32_t)(first < *end ? first : *end) : *begin;
    *end = last < *end ? (int32_t)(last > *begin ? last : *begin) : *end;
}

typedef struct walk {
    uint32_t u_q16, v_q16;   /* at the row's first column */
    uint32_t u_step, v_step; /* modulo 2^32 */
    uint32_t alpha;          /* 0..256 */
} walk;

static inline void draw_pixel(uint16_t *at, uint16_t colour, uint32_t shown)
{
    if (shown == 256) {
        *at = colour;
    } else if (shown != 0) {
        *at = el_rgb565_blend(*at, colour, shown);
    }
}

static EL_SPECIALISED void draw_nearest(uint16_t *at, uint32_t count, const el_image *image, el_image_format format,
                                        const walk *w)
{
    uint32_t u_q16 = w->u_q16;
    uint32_t v_q16 = w->v_q16;
    for (; count > 0; count--, at++) {
        uint16_t colour;
        const uint32_t there = el_image_at(image, format, u_q16 >> 16, v_q16 >> 16, &colour);
        draw_pixel(at, colour, (there * w->alpha + 128U) >> 8);
        u_q16 += w->u_step;
        v_q16 += w->v_step;
    }
}

/* One function for all formats, which it asks about four times per pixel: one for each would be four times as long. */
static void draw_smooth(uint16_t *at, uint32_t count, const el_image *image, const walk *w)
{
    uint32_t u_q16 = w->u_q16;
    uint32_t v_q16 = w->v_q16;
    for (; count > 0; count--, at++) {
        /* Places are moved by a pixel so that they are not below 0; -1 is beyond the image, too. */
        const uint32_t x = u_q16 >> 16;
        const uint32_t y = v_q16 >> 16;
        const el_image_spot spot = {
            .x = {x - 1U, x}, .y = {y - 1U, y}, .right = u_q16 >> 12 & 15U, .down = v_q16 >> 12 & 15U};
        uint16_t colour = 0;
        const uint32_t there = el_image_smooth_at(image, &spot, &colour);
        draw_pixel(at, colour, (there * w->alpha + 128U) >> 8);
        u_q16 += w->u_step;
        v_q16 += w->v_step;
    }
}

static void draw_row(uint16_t *at, uint32_t count, const el_image *image, bool smooth, const walk *w)
{
    if (smooth) {
        draw_smooth(at, count, image, w);
    } else if (image->format == EL_IMAGE_RGB565) {
        draw_nearest(at, count, image, EL_IMAGE_RGB565, w);
    } else if (image->format == EL_IMAGE_INDEX8) {
        draw_nearest(at, count, image, EL_IMAGE_INDEX8, w);
    } else if (image->format == EL_IMAGE_INDEX4) {
        draw_nearest(at, count, image, EL_IMAGE_INDEX4, w);
    } else {
        draw_nearest(at, count, image, EL_IMAGE_MASK, w);
    }
}

el_status el_canvas_image_turned(const el_canvas *canvas, const el_image *image, const el_image_place *place)
{
    if (image->width < 1 || image->width > EL_IMAGE_MAX || image->height < 1 || image->height > EL_IMAGE_MAX) {
        return EL_ERROR_SIZE;
    }
    if (place->scale_q16 < LEAST_SCALE_Q16 || place->scale_q16 > MOST_SCALE_Q16 || place->x < -EL_GUARD_SUB ||
        place->x > EL_GUARD_SUB || place->y < -EL_GUARD_SUB || place->y > EL_GUARD_SUB) {
        return EL_ERROR_RANGE;
    }
    mapping m = mapping_of(image, place);
    int64_t width_q16 = (int64_t)image->width << 16;
    int64_t height_q16 = (int64_t)image->height << 16;
    if (place->smooth) {
        /* Pixels' values hold at their centres, and what they show reaches a pixel further: half a pixel back, and one
         * forward so that nothing is below 0. */
        m.c += 1 << 15;
        m.d += 1 << 15;
        width_q16 += 1 << 16;
        height_q16 += 1 << 16;
    }
    const el_rect *const clip = &canvas->clip;
    for (int32_t y = clip->y; y < clip->y_end; y++) {
        int32_t begin = clip->x;
        int32_t end = clip->x_end;
        const int64_t u = m.b * y + m.c;
        const int64_t v = m.a * y + m.d;
        narrow(u, m.a, width_q16, &begin, &end);
        narrow(v, -m.b, height_q16, &begin, &end);
        if (begin < end) {
            const walk w = {.u_q16 = (uint32_t)(u + m.a * begin),
                            .v_q16 = (uint32_t)(v - m.b * begin),
                            .u_step = (uint32_t)m.a,
                            .v_step = (uint32_t)-m.b,
                            .alpha = el_alpha_256(place->alpha)};
            draw_row(el_canvas_line_at(canvas, y) + begin, (uint32_t)(end - begin), image, place->smooth, &w);
        }
    }
    return EL_OK;
}
