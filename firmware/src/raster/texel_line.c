#include "raster/texel_line.h"

#include "raster/texture.h"

#if EL_WITH_MIXED && !EL_SMALL_CODE

static bool is_power(uint32_t x)
{
    return (x & (x - 1U)) == 0;
}

/* --- What they are ------------------------------------------------------------------------------------------------------- */

enum { NO_KEY = 1 << 16 };

/* How much of texels shows: all, all or nothing, or what their alpha says. */
typedef enum showing { ALL, KEYED, ALPHA } showing;

/* u and v are within the picture, or anywhere if it repeats with powers of two. Products are below 2^20. */
static EL_SPECIALISED void look_up(const el_texel_line *line, const el_texel_row *row, uint16_t *shown,
                                   el_image_format format, showing shows)
{
    const el_image *const image = &line->sampler->image;
    const void *const pixels = image->pixels;
    const uint16_t *const palette = image->palette;
    const uint8_t *const alpha = image->alpha;
    const uint32_t key = line->key;
    const uint32_t pitch = line->strips.pitch;
    const bool is_within = format == EL_IMAGE_RGB565 && shows == ALL; /* see LOOK_UPS */
    const uint32_t u_mask = is_within ? ~0U : line->u_mask;
    const uint32_t v_mask = is_within ? ~0U : line->v_mask;
    const uint32_t u_step_q16 = row->u_step_q16;
    const uint32_t v_step_q16 = row->v_step_q16;
    uint32_t u_q16 = row->u_q16;
    uint32_t v_q16 = row->v_q16;
    uint16_t *colour = row->colour;
    const uint16_t *const end = colour + row->count;
    do {
        const uint32_t i = (v_q16 >> 16 & v_mask) * pitch + (u_q16 >> 16 & u_mask);
        u_q16 += u_step_q16;
        v_q16 += v_step_q16;
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

/* A loop for each format and how it shows, a palette's alpha apart. Words all of which show have ways of their own where they
 * repeat with powers of two; what else does is looked up as it is. */
#define LOOK_UPS_THAT_REPEAT(DO)                                                                                       \
    DO(words_keyed, EL_IMAGE_RGB565, KEYED)                                                                            \
    DO(words_alpha, EL_IMAGE_RGB565, ALPHA)                                                                            \
    DO(bytes, EL_IMAGE_INDEX8, ALL)                                                                                    \
    DO(bytes_keyed, EL_IMAGE_INDEX8, KEYED)                                                                            \
    DO(halves, EL_IMAGE_INDEX4, ALL)                                                                                   \
    DO(halves_keyed, EL_IMAGE_INDEX4, KEYED)                                                                           \
    DO(bits_keyed, EL_IMAGE_MASK, KEYED)
#define LOOK_UPS(DO)                                                                                                   \
    LOOK_UPS_THAT_REPEAT(DO)                                                                                           \
    DO(words, EL_IMAGE_RGB565, ALL)

#define DEFINE(name, format, shows)                                                                                    \
    static EL_APART void look_up_##name(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)           \
    {                                                                                                                  \
        look_up(line, row, shown, (format), (shows));                                                                  \
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

/* Its look-up. What a palette's texels have of alpha is put to it afterwards. A mean of four asks each what shows of it. */
static void choose_loop(el_texel_line *line)
{
    const el_sampler *const sampler = line->sampler;
    const el_image *const image = &sampler->image;
    line->has_alpha_apart = image->alpha != NULL && image->format != EL_IMAGE_RGB565;
    const showing shows =
        image->alpha != NULL && !line->has_alpha_apart ? ALPHA : (sampler->is_open || sampler->smooth ? KEYED : ALL);
    line->key = image->has_key ? image->key : NO_KEY;
    line->loop = 0;
    while (formats[line->loop] != image->format || showings[line->loop] != shows) {
        line->loop++;
    }
}

static EL_APART void weaken(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    const el_image *const image = &line->sampler->image;
    uint32_t u_q16 = row->u_q16;
    uint32_t v_q16 = row->v_q16;
    for (uint32_t i = 0; i < row->count; i++) {
        const uint32_t at = (v_q16 >> 16 & line->v_mask) * image->width + (u_q16 >> 16 & line->u_mask);
        /* Alpha is of a look-up that says what shows. NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
        shown[i] = (uint16_t)(shown[i] * el_alpha_256(image->alpha[at]) >> 8);
        u_q16 += row->u_step_q16;
        v_q16 += row->v_step_q16;
    }
}

static EL_APART void look_up_any(const el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    switch (line->loop) {
#define LOOK_UP(name, format, shows)                                                                                   \
    case LOOP_##name:                                                                                                  \
        look_up_##name(line, row, shown);                                                                              \
        break;
        LOOK_UPS(LOOK_UP)
    default:
        break;
    }
    if (line->has_alpha_apart) {
        weaken(line, row, shown);
    }
}

/* --- Strip by strip -------------------------------------------------------------------------------------------------------- */

/* Counts from the picture's begin what counts from the strip's. Where that is turned around, step / 2^16 is 0xFFFF: the end of
 * texel `place` is where it begins. */
static inline void to_picture(const el_texel_strip *strip, uint32_t *at_q16, uint32_t *step_q16)
{
    *at_q16 = (strip->place << 16 | strip->step >> 16) + *at_q16 * strip->step;
    *step_q16 *= strip->step;
}

static inline void row_to_picture(const el_texel_strips *strips, el_texel_row *row)
{
    to_picture(&strips->u, &row->u_q16, &row->u_step_q16);
    to_picture(&strips->v, &row->v_q16, &row->v_step_q16);
}

static EL_APART void draw_in_strips(el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    el_texel_row rest = *row;
    for (;;) {
        el_texel_row part;
        const uint32_t count = el_texel_strips_enter(&line->strips, &rest, &part);
        row_to_picture(&line->strips, &part);
        look_up_any(line, &part, shown);
        if (count == rest.count) {
            return;
        }
        el_texel_row_skip(&rest, count);
        shown += count;
    }
}

/* --- The mean of four ---------------------------------------------------------------------------------------------------- */

/* So many pixels at a time have lines of their four texels, on the stack. */
enum { CHUNK = 16 };

typedef struct four_lines {
    uint16_t colour[4][CHUNK], shown[4][CHUNK];
} four_lines;

/* Of a part of CHUNK pixels at most, which is in strips: the left texels of the upper row, the right ones, and below. */
static void look_up_four(const el_texel_line *line, const el_texel_row *part, four_lines *lines)
{
    el_texel_row left = *part;
    row_to_picture(&line->strips, &left);
    for (uint32_t i = 0; i < 4; i++) {
        el_texel_row row = left;
        row.u_q16 += (i & 1U) * (line->strips.u.more << 16);
        row.v_q16 += (i >> 1) * (line->strips.v.more << 16);
        row.colour = lines->colour[i];
        look_up_any(line, &row, lines->shown[i]);
    }
}

static EL_APART void draw_means(el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    four_lines lines;
    el_texel_row rest = el_texel_row_between_centres(row);
    while (rest.count > 0) {
        el_texel_row part;
        (void)el_texel_strips_enter(&line->strips, &rest, &part);
        part.count = part.count < CHUNK ? part.count : CHUNK;
        look_up_four(line, &part, &lines);
        for (uint32_t i = 0; i < part.count; i++) {
            el_image_four four;
            for (uint32_t j = 0; j < 4; j++) {
                four.colour[j] = lines.colour[j][i];
                four.shown[j] = lines.shown[j][i];
            }
            shown[i] = (uint16_t)el_image_mean(&four, part.u_q16 >> 12 & 15U, part.v_q16 >> 12 & 15U, &part.colour[i]);
            part.u_q16 += part.u_step_q16;
            part.v_q16 += part.v_step_q16;
        }
        shown += part.count;
        el_texel_row_skip(&rest, part.count);
    }
}

/* --- The way of each ------------------------------------------------------------------------------------------------------ */

static unsigned way_of(const el_texel_line *line, bool repeats)
{
    const el_sampler *const sampler = line->sampler;
    const el_image_format format = (el_image_format)sampler->image.format;
    if (repeats && format == EL_IMAGE_RGB565 && !sampler->is_open) {
        return sampler->smooth ? EL_TEXELS_SMOOTH_REPEATED : EL_TEXELS_PLAIN;
    }
    if (sampler->smooth) {
        const bool is_simple = !sampler->is_open && (format == EL_IMAGE_RGB565 || format == EL_IMAGE_INDEX8);
        return is_simple ? EL_TEXELS_SMOOTH : EL_TEXELS_MEANS;
    }
    return repeats && !line->has_alpha_apart ? (unsigned)EL_TEXELS_REPEATED + line->loop : (unsigned)EL_TEXELS_STRIPS;
}

void el_texel_line_make(el_texel_line *line, const el_sampler *sampler)
{
    const el_image *const image = &sampler->image;
    line->sampler = sampler;
    const uint32_t width = image->width;
    const uint32_t height = image->height;
    const bool repeats =
        sampler->u.period == width && sampler->v.period == height && is_power(width) && is_power(height);
    line->u_mask = repeats ? width - 1U : ~0U;
    line->v_mask = repeats ? height - 1U : ~0U;
    if (repeats) {
        line->texels = el_texels_of(&(el_texture){.texels = image->pixels,
                                                  .width_log2 = (uint8_t)(31U - el_leading_zeros(width)),
                                                  .height_log2 = (uint8_t)(31U - el_leading_zeros(height))});
    }
    choose_loop(line);
    el_texel_strips_make(&line->strips, sampler);
    line->way = (uint8_t)way_of(line, repeats);
}

void el_texel_line_draw_plain(const el_texel_line *line, const el_texel_row *row)
{
    el_draw_texels(&line->texels, row);
}

void el_texel_line_draw_other(el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    switch (line->way) {
#define REPEATED(name, format, shows)                                                                                  \
    case EL_TEXELS_REPEATED + LOOP_##name:                                                                             \
        look_up_##name(line, row, shown);                                                                              \
        break;
        LOOK_UPS_THAT_REPEAT(REPEATED)
    case EL_TEXELS_STRIPS:
        draw_in_strips(line, row, shown);
        break;
    case EL_TEXELS_SMOOTH_REPEATED:
        el_texel_smooth_repeat(&line->texels.source, row);
        break;
    case EL_TEXELS_SMOOTH:
        el_texel_smooth_draw(&line->strips, row);
        break;
    default:
        draw_means(line, row, shown);
        break;
    }
}
#endif
