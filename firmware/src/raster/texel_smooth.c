/* Means of four texels that are all there, in the fewest instructions: a loop of its own for each way in which the four are
 * found, one mean for all (base/rgb565.h). */
#include "raster/texel_smooth.h"

#if EL_WITH_MIXED && !EL_SMALL_CODE

static EL_SPECIALISED uint16_t word_at(const void *texels, uint32_t offset)
{
    return *(const uint16_t *)(const void *)((const uint8_t *)texels + offset);
}

/* Masks and sums are of bytes. */
void el_texel_smooth_repeat(const el_texel_source *source, const el_texel_row *row)
{
    const void *const texels = source->texels;
    const uint32_t u_mask = source->u_mask << 1;
    const uint32_t v_mask = source->v_mask << 1;
    const unsigned v_down = source->v_down - 1U; /* at least 5 */
    const uint32_t to_lower = u_mask + 2U;
    const uint32_t u_step_q16 = row->u_step_q16;
    const uint32_t v_step_q16 = row->v_step_q16;
    uint32_t u_q16 = row->u_q16 - (1U << 15);
    uint32_t v_q16 = row->v_q16 - (1U << 15);
    uint16_t *colour = row->colour;
    const uint16_t *const end = colour + row->count;
    do {
        const uint32_t left = u_q16 >> 15 & u_mask;
        const uint32_t right = (left + 2U) & u_mask;
        const uint32_t upper = v_q16 >> v_down & v_mask;
        const uint32_t lower = (upper + to_lower) & v_mask;
        const uint16_t four[4] = {word_at(texels, upper + left), word_at(texels, upper + right),
                                  word_at(texels, lower + left), word_at(texels, lower + right)};
        *colour++ = el_rgb565_mean(four, u_q16 >> 12 & 15U, v_q16 >> 12 & 15U);
        u_q16 += u_step_q16;
        v_q16 += v_step_q16;
    } while (colour != end);
}

/* Of a palette's bytes or of words, whose place is that of their first byte. */
static EL_SPECIALISED uint16_t texel_at(const void *texels, const uint16_t *palette, uint32_t place)
{
    return palette != NULL ? palette[((const uint8_t *)texels)[place]] : word_at(texels, place);
}

static EL_SPECIALISED void draw_part(const el_texel_strips *strips, const el_texel_row *part, const uint16_t *palette)
{
    const void *const texels = strips->sampler->image.pixels;
    const unsigned to_bytes = palette != NULL ? 0 : 1;
    const uint32_t first = strips->first << to_bytes;
    const uint32_t to_right = strips->right << to_bytes;
    const uint32_t to_lower = strips->down << to_bytes;
    const uint32_t u_step_q16 = part->u_step_q16;
    const uint32_t v_step_q16 = part->v_step_q16;
    uint32_t u_q16 = part->u_q16;
    uint32_t v_q16 = part->v_q16;
    uint16_t *colour = part->colour;
    const uint16_t *const end = colour + part->count;
    do {
        const uint32_t upper = first + (v_q16 >> 16) * to_lower + (u_q16 >> 16) * to_right;
        const uint32_t lower = upper + to_lower;
        const uint16_t four[4] = {texel_at(texels, palette, upper), texel_at(texels, palette, upper + to_right),
                                  texel_at(texels, palette, lower), texel_at(texels, palette, lower + to_right)};
        *colour++ = el_rgb565_mean(four, u_q16 >> 12 & 15U, v_q16 >> 12 & 15U);
        u_q16 += u_step_q16;
        v_q16 += v_step_q16;
    } while (colour != end);
}

static EL_APART void draw_words(const el_texel_strips *strips, const el_texel_row *part)
{
    draw_part(strips, part, NULL);
}

static EL_APART void draw_bytes(const el_texel_strips *strips, const el_texel_row *part)
{
    draw_part(strips, part, strips->sampler->image.palette);
}

void el_texel_smooth_draw(el_texel_strips *strips, const el_texel_row *row)
{
    el_texel_row rest = el_texel_row_between_centres(row);
    for (;;) {
        el_texel_row part;
        const uint32_t count = el_texel_strips_enter(strips, &rest, &part);
        if (strips->sampler->image.format == EL_IMAGE_RGB565) {
            draw_words(strips, &part);
        } else {
            draw_bytes(strips, &part);
        }
        if (count == rest.count) {
            return;
        }
        el_texel_row_skip(&rest, count);
    }
}
#endif
