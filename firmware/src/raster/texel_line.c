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

/* --- Where they are: y * width + x, below 2^20 --------------------------------------------------------------------------- */

/* In a period that is a power of two; where every other one is turned around, the second half runs back. */
static inline uint32_t place_in_power(const el_sampler_axis *axis, uint32_t at)
{
    const uint32_t place = at & (axis->period - 1U);
    return place < axis->size ? place : axis->period - 1U - place;
}

static inline uint32_t place_clamped(const el_sampler_axis *axis, int32_t at)
{
    return (uint32_t)el_max_i32(el_min_i32(at, (int32_t)axis->size - 1), 0);
}

/* How places are found, for both axes. */
typedef enum places { IN_POWERS, CLAMPED, ANY } places;

static EL_SPECIALISED void find_places(uint32_t *index, const el_texel_line *line, const el_texel_row *row, places how)
{
    const el_sampler_axis u = line->sampler->u;
    const el_sampler_axis v = line->sampler->v;
    const uint32_t width = u.size;
    const uint32_t *const end = index + row->count;
    uint32_t u_q16 = row->u_q16;
    uint32_t v_q16 = row->v_q16;
    do {
        if (how == IN_POWERS) {
            *index++ = place_in_power(&v, v_q16 >> 16) * width + place_in_power(&u, u_q16 >> 16);
        } else if (how == CLAMPED) {
            *index++ = place_clamped(&v, (int32_t)v_q16 >> 16) * width + place_clamped(&u, (int32_t)u_q16 >> 16);
        } else {
            *index++ = el_sampler_place(&v, (int32_t)v_q16 >> 16) * width + el_sampler_place(&u, (int32_t)u_q16 >> 16);
        }
        u_q16 += row->u_step_q16;
        v_q16 += row->v_step_q16;
    } while (index != end);
}

static EL_APART void find_in_powers(uint32_t *index, const el_texel_line *line, const el_texel_row *row)
{
    find_places(index, line, row, IN_POWERS);
}

static EL_APART void find_clamped(uint32_t *index, const el_texel_line *line, const el_texel_row *row)
{
    find_places(index, line, row, CLAMPED);
}

static EL_APART void find_any(uint32_t *index, const el_texel_line *line, const el_texel_row *row)
{
    find_places(index, line, row, ANY);
}

static void find(uint32_t *index, const el_texel_line *line, const el_texel_row *row)
{
    const uint32_t u_period = line->sampler->u.period;
    const uint32_t v_period = line->sampler->v.period;
    if ((u_period | v_period) == 0) {
        find_clamped(index, line, row);
    } else if (u_period != 0 && v_period != 0 && is_power(u_period) && is_power(v_period)) {
        find_in_powers(index, line, row);
    } else {
        find_any(index, line, row);
    }
}

/* --- What they are ------------------------------------------------------------------------------------------------------- */

enum { NO_KEY = 1 << 16 };

/* How much of texels shows: all, all or nothing, or what their alpha says. */
typedef enum showing { ALL, KEYED, ALPHA } showing;

/* Of texels whose places are found; or, without places, of those that repeat with powers of two. */
static EL_SPECIALISED void look_up(const el_texel_line *line, const uint32_t *index, const el_texel_row *row,
                                   uint16_t *shown, el_image_format format, showing shows)
{
    const el_image *const image = &line->sampler->image;
    const void *const pixels = image->pixels;
    const uint16_t *const palette = image->palette;
    const uint8_t *const alpha = image->alpha;
    const uint32_t key = image->has_key ? image->key : NO_KEY;
    const el_texel_source from = line->texels.source;
    const uint32_t u_step_q16 = row->u_step_q16;
    const uint32_t v_step_q16 = row->v_step_q16;
    uint32_t u_q16 = row->u_q16;
    uint32_t v_q16 = row->v_q16;
    uint16_t *colour = row->colour;
    const uint16_t *const end = colour + row->count;
    do {
        uint32_t i;
        if (index != NULL) {
            i = *index++;
        } else {
            i = ((v_q16 >> from.v_down) & from.v_mask) | ((u_q16 >> 16) & from.u_mask);
            u_q16 += u_step_q16;
            v_q16 += v_step_q16;
        }
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
        if (shows != ALL) {
            const bool is_there = value != key && (format != EL_IMAGE_MASK || value != 0);
            *shown++ = (uint16_t)(!is_there ? 0U : (shows == ALPHA ? el_alpha_256(alpha[i]) : 256U));
        }
    } while (++colour != end);
}

/* A loop for each format and how it shows, a palette's alpha apart. */
#define LOOK_UPS(DO)                                                                                                   \
    DO(words, EL_IMAGE_RGB565, ALL)                                                                                    \
    DO(words_keyed, EL_IMAGE_RGB565, KEYED)                                                                            \
    DO(words_alpha, EL_IMAGE_RGB565, ALPHA)                                                                            \
    DO(bytes, EL_IMAGE_INDEX8, ALL)                                                                                    \
    DO(bytes_keyed, EL_IMAGE_INDEX8, KEYED)                                                                            \
    DO(halves, EL_IMAGE_INDEX4, ALL)                                                                                   \
    DO(halves_keyed, EL_IMAGE_INDEX4, KEYED)                                                                           \
    DO(bits_keyed, EL_IMAGE_MASK, KEYED)

#define DEFINE(name, format, shows)                                                                                    \
    static EL_APART void look_up_##name(const el_texel_line *line, const uint32_t *index, const el_texel_row *row,     \
                                        uint16_t *shown)                                                               \
    {                                                                                                                  \
        look_up(line, index, row, shown, (format), (shows));                                                           \
    }                                                                                                                  \
    static EL_APART void repeat_##name(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)            \
    {                                                                                                                  \
        look_up(line, NULL, row, shown, (format), (shows));                                                            \
    }
LOOK_UPS(DEFINE)

#define NAME(name, format, shows) LOOP_##name,
enum { LOOK_UPS(NAME) LOOPS };

static const uint8_t formats[LOOPS] = {
#define FORMAT(name, format, shows) (format),
    LOOK_UPS(FORMAT)};

static const uint8_t showings[LOOPS] = {
#define SHOWING(name, format, shows) (shows),
    LOOK_UPS(SHOWING)};

/* Its look-up. What a palette's texels have of alpha is put to it afterwards. */
static void choose_loop(el_texel_line *line)
{
    const el_image *const image = &line->sampler->image;
    line->has_alpha_apart = image->alpha != NULL && image->format != EL_IMAGE_RGB565;
    const showing shows =
        image->alpha != NULL && !line->has_alpha_apart ? ALPHA : (line->sampler->is_open ? KEYED : ALL);
    line->loop = 0;
    while (formats[line->loop] != image->format || showings[line->loop] != shows) {
        line->loop++;
    }
}

static void weaken(const uint8_t *alpha, const uint32_t *index, uint16_t *shown, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        shown[i] = (uint16_t)(shown[i] * el_alpha_256(alpha[index[i]]) >> 8);
    }
}

static void draw_repeated(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    switch (line->loop) {
#define REPEAT(name, format, shows)                                                                                    \
    case LOOP_##name:                                                                                                  \
        repeat_##name(line, row, shown);                                                                               \
        break;
        LOOK_UPS(REPEAT)
    default:
        break;
    }
}

static EL_APART void draw_found(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    uint32_t index[EL_MAX_PIECE];
    find(index, line, row);
    switch (line->loop) {
#define LOOK_UP(name, format, shows)                                                                                   \
    case LOOP_##name:                                                                                                  \
        look_up_##name(line, index, row, shown);                                                                       \
        break;
        LOOK_UPS(LOOK_UP)
    default:
        break;
    }
    if (line->has_alpha_apart) {
        weaken(line->sampler->image.alpha, index, shown, row->count);
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
        const uint32_t parts = el_sampler_at(line->sampler, u_q16, v_q16, &row->colour[i]);
        if (line->sampler->is_open) {
            shown[i] = (uint16_t)parts;
        }
        u_q16 += row->u_step_q16;
        v_q16 += row->v_step_q16;
    }
}

void el_texel_line_make(el_texel_line *line, const el_sampler *sampler)
{
    const el_image *const image = &sampler->image;
    line->sampler = sampler;
    const uint32_t width = image->width;
    const uint32_t height = image->height;
    line->repeats = sampler->u.period == width && sampler->v.period == height && is_power(width) && is_power(height);
    if (line->repeats) {
        line->texels = el_texels_of(&(el_texture){.texels = image->pixels,
                                                  .width_log2 = (uint8_t)(31U - el_leading_zeros(width)),
                                                  .height_log2 = (uint8_t)(31U - el_leading_zeros(height))});
    }
    choose_loop(line);
    const bool is_plain = line->repeats && image->format == EL_IMAGE_RGB565 && !sampler->is_open;
    if (is_plain) {
        line->way = sampler->smooth ? EL_TEXELS_SMOOTH : EL_TEXELS_PLAIN;
    } else if (sampler->smooth || !has_indices(image)) {
        line->way = EL_TEXELS_ANY;
    } else {
        line->way = line->repeats && !line->has_alpha_apart ? EL_TEXELS_REPEATED : EL_TEXELS_FOUND;
    }
}

void el_texel_line_draw(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    switch (line->way) {
    case EL_TEXELS_PLAIN:
        el_draw_texels(&line->texels, row);
        break;
    case EL_TEXELS_REPEATED:
        draw_repeated(line, row, shown);
        break;
    case EL_TEXELS_FOUND:
        draw_found(line, row, shown);
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
