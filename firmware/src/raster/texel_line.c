#include "raster/texel_line.h"

#include "raster/texture.h"

#if EL_WITH_MIXED && !EL_SMALL_CODE

static bool is_power(uint32_t x)
{
    return (x & (x - 1U)) == 0;
}

/* Whether a texel is its row's first and so many on: rows of half bytes and bits may be filled up. */
static bool has_indices(const el_image *image)
{
    const uint32_t per_byte = image->format == EL_IMAGE_INDEX4 ? 2 : (image->format == EL_IMAGE_MASK ? 8 : 1);
    return image->width % per_byte == 0;
}

void el_texel_line_make(el_texel_line *line, const el_texture *texture)
{
    el_sampler *const sampler = &line->sampler;
    const el_image *const image = &sampler->image;
    el_sampler_make(sampler, texture);
    const uint32_t width = image->width;
    const uint32_t height = image->height;
    line->shows = image->has_key || image->format == EL_IMAGE_MASK || image->alpha != NULL;
    line->repeats = sampler->u.period == width && sampler->v.period == height && is_power(width) && is_power(height);
    if (line->repeats) {
        line->texels = el_texels_of(&(el_texture){.texels = image->pixels,
                                                  .width_log2 = (uint8_t)(el_bit_length_u32(width) - 1),
                                                  .height_log2 = (uint8_t)(el_bit_length_u32(height) - 1)});
    }
    const bool is_plain = line->repeats && image->format == EL_IMAGE_RGB565 && !line->shows;
    if (is_plain) {
        line->way = sampler->smooth ? EL_TEXELS_SMOOTH : EL_TEXELS_PLAIN;
    } else {
        line->way = !sampler->smooth && has_indices(image) ? EL_TEXELS_NEAREST : EL_TEXELS_ANY;
    }
}

/* --- Where they are: y * width + x, below 2^20 --------------------------------------------------------------------------- */

static EL_APART void find_repeated(uint32_t *index, const el_texel_line *line, const el_texel_row *row)
{
    const el_texel_source from = line->texels.source;
    const uint32_t *const end = index + row->count;
    uint32_t u_q16 = row->u_q16;
    uint32_t v_q16 = row->v_q16;
    do {
        *index++ = ((v_q16 >> from.v_down) & from.v_mask) | ((u_q16 >> 16) & from.u_mask);
        u_q16 += row->u_step_q16;
        v_q16 += row->v_step_q16;
    } while (index != end);
}

/* Adds one axis' part: its place times `stride`. */
typedef struct axis_steps {
    uint32_t q16, step_q16, stride;
} axis_steps;

static EL_APART void add_clamped(uint32_t *index, const uint32_t *end, const el_sampler_axis *axis,
                                 const axis_steps *steps)
{
    const int32_t last = (int32_t)axis->size - 1;
    uint32_t q16 = steps->q16;
    do {
        *index++ += (uint32_t)el_max_i32(el_min_i32((int32_t)q16 >> 16, last), 0) * steps->stride;
        q16 += steps->step_q16;
    } while (index != end);
}

/* Periods that are powers of two. */
static EL_APART void add_masked(uint32_t *index, const uint32_t *end, const el_sampler_axis *axis,
                                const axis_steps *steps)
{
    const uint32_t last = axis->period - 1U;
    const uint32_t size = axis->size;
    uint32_t q16 = steps->q16;
    do {
        const uint32_t place = q16 >> 16 & last;
        *index++ += (place < size ? place : last - place) * steps->stride;
        q16 += steps->step_q16;
    } while (index != end);
}

static EL_APART void add_any(uint32_t *index, const uint32_t *end, const el_sampler_axis *axis, const axis_steps *steps)
{
    uint32_t q16 = steps->q16;
    do {
        *index++ += el_sampler_place(axis, (int32_t)q16 >> 16) * steps->stride;
        q16 += steps->step_q16;
    } while (index != end);
}

static void add_axis(uint32_t *index, const uint32_t *end, const el_sampler_axis *axis, const axis_steps *steps)
{
    if (axis->period == 0) {
        add_clamped(index, end, axis, steps);
    } else if (is_power(axis->period)) {
        add_masked(index, end, axis, steps);
    } else {
        add_any(index, end, axis, steps);
    }
}

static void find(uint32_t *index, const el_texel_line *line, const el_texel_row *row)
{
    if (line->repeats) {
        find_repeated(index, line, row);
        return;
    }
    const uint32_t *const end = index + row->count;
    for (uint32_t i = 0; i < row->count; i++) {
        index[i] = 0;
    }
    const el_sampler *const sampler = &line->sampler;
    add_axis(index, end, &sampler->v, &(axis_steps){row->v_q16, row->v_step_q16, sampler->image.width});
    add_axis(index, end, &sampler->u, &(axis_steps){row->u_q16, row->u_step_q16, 1});
}

/* --- What they are ------------------------------------------------------------------------------------------------------- */

enum { NO_KEY = 1 << 16 };

static EL_SPECIALISED void look_up(const el_image *image, const uint32_t *index, const el_texel_row *row,
                                   uint16_t *shown, el_image_format format, bool shows)
{
    const void *const pixels = image->pixels;
    const uint16_t *const palette = image->palette;
    const uint32_t key = image->has_key ? image->key : NO_KEY;
    uint16_t *colour = row->colour;
    const uint16_t *const end = colour + row->count;
    do {
        const uint32_t i = *index++;
        uint32_t value;
        if (format == EL_IMAGE_RGB565) {
            value = ((const uint16_t *)pixels)[i];
            *colour = (uint16_t)value;
        } else if (format == EL_IMAGE_INDEX8) {
            value = ((const uint8_t *)pixels)[i];
            *colour = palette[value];
        } else if (format == EL_IMAGE_INDEX4) {
            value = (uint32_t)((const uint8_t *)pixels)[i / 2U] >> ((~i & 1U) << 2) & 15U;
            *colour = palette[value];
        } else {
            value = (uint32_t)((const uint8_t *)pixels)[i / 8U] >> (~i & 7U) & 1U;
            *colour = palette[0];
        }
        if (shows) {
            *shown++ = value == key || (format == EL_IMAGE_MASK && value == 0) ? 0 : 256;
        }
    } while (++colour != end);
}

/* A loop for each format, all of which shows or not. */
#define LOOK_UPS(DO)                                                                                                   \
    DO(words, EL_IMAGE_RGB565, false)                                                                                  \
    DO(words_shown, EL_IMAGE_RGB565, true)                                                                             \
    DO(bytes, EL_IMAGE_INDEX8, false)                                                                                  \
    DO(bytes_shown, EL_IMAGE_INDEX8, true)                                                                             \
    DO(halves, EL_IMAGE_INDEX4, false)                                                                                 \
    DO(halves_shown, EL_IMAGE_INDEX4, true)                                                                            \
    DO(bits_shown, EL_IMAGE_MASK, true)

#define DEFINE(name, format, shows)                                                                                    \
    static EL_APART void look_up_##name(const el_image *image, const uint32_t *index, const el_texel_row *row,         \
                                        uint16_t *shown)                                                               \
    {                                                                                                                  \
        look_up(image, index, row, shown, (format), (shows));                                                          \
    }
LOOK_UPS(DEFINE)

static EL_APART void weaken(const uint8_t *alpha, const uint32_t *index, uint16_t *shown, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        shown[i] = (uint16_t)(shown[i] * el_alpha_256(alpha[index[i]]) >> 8);
    }
}

static void draw_nearest(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    const el_image *const image = &line->sampler.image;
    uint32_t index[EL_MAX_PIECE];
    find(index, line, row);
#define CALL(name, is_format, is_shown)                                                                                \
    if (image->format == (is_format) && line->shows == (is_shown)) {                                                   \
        look_up_##name(image, index, row, shown);                                                                      \
    }
    LOOK_UPS(CALL)
    if (image->alpha != NULL) {
        weaken(image->alpha, index, shown, row->count);
    }
}

/* --- The mean of four ---------------------------------------------------------------------------------------------------- */

/* Red, green and blue far enough apart that each can be times 16. */
static inline uint32_t apart(uint32_t rgb565)
{
    return (rgb565 | rgb565 << 16) & 0x07E0F81FU;
}

/* Sixteen times the colour between two. Below 2^9, 2^9 and 2^10 from bits 0, 11 and 21 on; modulo 2^32 in between. */
static inline uint32_t between(uint32_t left, uint32_t right, uint32_t sixteenths)
{
    return (left << 4) + (right - left) * sixteenths;
}

/* As el_sampler_at: 256 times the mean is a sum of products by parts of 256, whichever way they are added up. */
static EL_APART void draw_smooth(const el_texel_line *line, const el_texel_row *row)
{
    const el_texel_source from = line->texels.source;
    const uint32_t width = from.u_mask + 1U;
    const uint32_t u_step_q16 = row->u_step_q16;
    const uint32_t v_step_q16 = row->v_step_q16;
    uint32_t u_q16 = row->u_q16 - (1U << 15);
    uint32_t v_q16 = row->v_q16 - (1U << 15);
    uint16_t *colour = row->colour;
    const uint16_t *const end = colour + row->count;
    do {
        const uint32_t x = (u_q16 >> 16) & from.u_mask;
        const uint32_t x_next = (x + 1U) & from.u_mask;
        const uint32_t y = (v_q16 >> from.v_down) & from.v_mask;
        const uint16_t *const upper = from.texels + y;
        const uint16_t *const lower = from.texels + ((y + width) & from.v_mask);
        const uint32_t right = u_q16 >> 12 & 15U;
        const uint32_t down = v_q16 >> 12 & 15U;
        const uint32_t above = between(apart(upper[x]), apart(upper[x_next]), right);
        const uint32_t below = between(apart(lower[x]), apart(lower[x_next]), right);
        /* Red from bit 16 on: sums below 2^13, 2^13 and 2^14. */
        const uint32_t rb_above = (above & 0x1FFU) | (above & 0xFF800U) << 5;
        const uint32_t rb_below = (below & 0x1FFU) | (below & 0xFF800U) << 5;
        const uint32_t rb = between(rb_above, rb_below, down) + 0x00800080U;
        const uint32_t g = between(above >> 21, below >> 21, down) + 0x80U;
        *colour++ = (uint16_t)((rb >> 13 & 0xF800U) | (g >> 3 & 0x07E0U) | (rb >> 8 & 0x1FU));
        u_q16 += u_step_q16;
        v_q16 += v_step_q16;
    } while (colour != end);
}

/* --- One at a time ------------------------------------------------------------------------------------------------------- */

static EL_APART void draw_any(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    uint32_t u_q16 = row->u_q16;
    uint32_t v_q16 = row->v_q16;
    for (uint32_t i = 0; i < row->count; i++) {
        const uint32_t parts = el_sampler_at(&line->sampler, u_q16, v_q16, &row->colour[i]);
        if (line->shows) {
            shown[i] = (uint16_t)parts;
        }
        u_q16 += row->u_step_q16;
        v_q16 += row->v_step_q16;
    }
}

void el_texel_line_draw(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    switch (line->way) {
    case EL_TEXELS_PLAIN:
        el_draw_texels(&line->texels, row);
        break;
    case EL_TEXELS_NEAREST:
        draw_nearest(line, row, shown);
        break;
    case EL_TEXELS_SMOOTH:
        draw_smooth(line, row);
        break;
    default:
        draw_any(line, row, shown);
        break;
    }
}
#endif
