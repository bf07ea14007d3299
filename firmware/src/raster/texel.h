/* Texels, and what light makes of them. Private to this layer. */
#ifndef EL_RASTER_TEXEL_H
#define EL_RASTER_TEXEL_H

#include "base/dither.h"
#include "raster/fill.h"

/* Where a texture's texels are: masks for the whole parts of u and v, which repeat it, the latter already times the
 * width. A copy, because a compiler must assume that a pixel written may lie in the texture's own description. */
typedef struct el_texel_source {
    const uint16_t *texels;
    uint32_t u_mask, v_mask;
    unsigned v_down; /* from Q16 to whole texels times the width */
} el_texel_source;

static EL_SPECIALISED el_texel_source el_texel_source_of(const el_texture *texture)
{
    return (el_texel_source){
        .texels = texture->texels,
        .u_mask = (1U << texture->width_log2) - 1U,
        .v_mask = ((1U << texture->height_log2) - 1U) << texture->width_log2,
        .v_down = 16U - texture->width_log2,
    };
}

static EL_SPECIALISED uint32_t el_texel_at(const el_texel_source *source, uint32_t u_q16, uint32_t v_q16)
{
    return source->texels[((v_q16 >> source->v_down) & source->v_mask) | ((u_q16 >> 16) & source->u_mask)];
}

/* A channel of a texel times light / 255, where 255 leaves it as it is. */
static EL_SPECIALISED uint32_t el_lit(uint32_t channel, uint32_t light, uint32_t threshold_q16, unsigned kind)
{
    return (kind & EL_FILL_DITHER) != 0 ? el_dither(el_fraction_q16(light), channel, threshold_q16)
                                        : (channel * ((light >> 24) + 1U)) >> 8;
}

static EL_SPECIALISED uint16_t el_modulate(uint32_t texel, const el_values *v, uint32_t threshold_q16, unsigned kind)
{
    return (uint16_t)(el_lit(texel >> 11, v->red, threshold_q16, kind) << 11 |
                      el_lit((texel >> 5) & 63U, v->green, threshold_q16, kind) << 5 |
                      el_lit(texel & 31U, v->blue, threshold_q16, kind));
}

/* Lights texels from `pixel` on, which is in column x of row y, up to `end`, one at least. */
static EL_SPECIALISED void el_light_row(const el_slopes *slopes, uint32_t y, uint32_t x, uint16_t *pixel,
                                        const uint16_t *end, unsigned kind)
{
    el_values light = el_values_at(slopes, (int32_t)x, kind);
    const el_values step = slopes->per_column;
    el_dither_row thresholds = el_dither_row_at(x, y);
    if ((step.red | step.green | step.blue) == 0) {
        /* A surface in one colour, or one that faces the light everywhere alike. */
        do {
            *pixel = el_modulate(*pixel, &light, el_dither_row_next_q16(&thresholds), kind);
        } while (++pixel != end);
        return;
    }
    do {
        *pixel = el_modulate(*pixel, &light, el_dither_row_next_q16(&thresholds), kind);
        el_values_add(&light, &step, kind);
    } while (++pixel != end);
}

#endif
