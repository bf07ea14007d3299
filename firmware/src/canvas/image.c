/* Images as they are. */
#include "canvas/image.h"

#include "base/options.h"
#include "base/rgb565.h"

/* Pixels [x, x_end) of the image's row v to the line, whose pixel 0 has the image's column 0. */
static EL_SPECIALISED void draw_row(uint16_t *line, const el_image *image, el_image_format format, uint32_t v,
                                    uint32_t x, uint32_t x_end, uint32_t alpha)
{
    for (; x < x_end; x++) {
        uint16_t colour;
        const uint32_t shown = (el_image_at(image, format, x, v, &colour) * alpha + 128U) >> 8;
        if (shown == 256) {
            line[x] = colour;
        } else if (shown != 0) {
            line[x] = el_rgb565_blend(line[x], colour, shown);
        }
    }
}

void el_canvas_image(const el_canvas *canvas, const el_image *image, int32_t x, int32_t y, uint8_t alpha)
{
    if (x > INT32_MAX - image->width || y > INT32_MAX - image->height) {
        return; /* beside every canvas */
    }
    const el_rect part = el_rect_shared((el_rect){x, y, x + image->width, y + image->height}, canvas->clip);
    if (el_rect_is_empty(part)) {
        return;
    }
    const uint32_t begin = (uint32_t)(part.x - x);
    const uint32_t end = (uint32_t)(part.x_end - x);
    for (int32_t j = part.y; j < part.y_end; j++) {
        uint16_t *const line = el_canvas_line_at(canvas, j) + x;
        const uint32_t v = (uint32_t)(j - y);
        switch (image->format) {
        case EL_IMAGE_RGB565:
            draw_row(line, image, EL_IMAGE_RGB565, v, begin, end, el_alpha_256(alpha));
            break;
        case EL_IMAGE_INDEX8:
            draw_row(line, image, EL_IMAGE_INDEX8, v, begin, end, el_alpha_256(alpha));
            break;
        case EL_IMAGE_INDEX4:
            draw_row(line, image, EL_IMAGE_INDEX4, v, begin, end, el_alpha_256(alpha));
            break;
        default:
            draw_row(line, image, EL_IMAGE_MASK, v, begin, end, el_alpha_256(alpha));
            break;
        }
    }
}
