#include "raster/sampler.h"

#include "base/fixed.h"
#include "raster/texture.h"

#if EL_WITH_MIXED || EL_WITH_DEBUG_VIEWS

/* Coordinates are within 2,048 texels (geometry/mesh.h), and so far beyond for what the walk is off and a neighbour. */
enum { FARTHEST = 2048 + 8, NUMBER_BITS = 13 };
_Static_assert(2 * FARTHEST + 2 * EL_TEXTURE_MAX_SIDE <= 1 << NUMBER_BITS, "a coordinate and its bias");

static void make_axis(el_sampler_axis *axis, uint32_t size, uint8_t wrap)
{
    const uint32_t period = wrap == EL_WRAP_CLAMP ? 0U : (wrap == EL_WRAP_MIRROR ? 2U * size : size);
    *axis = (el_sampler_axis){.size = size, .period = period};
    if (period != 0) {
        axis->bias = (FARTHEST + period - 1U) / period * period;
        axis->shift = NUMBER_BITS + (uint32_t)el_bit_length_u32(period - 1U);
        axis->reciprocal = ((1U << axis->shift) + period - 1U) / period; /* at most 2^14 */
    }
}

void el_sampler_make(el_sampler *sampler, const el_texture *texture)
{
    *sampler = (el_sampler){
        .image = {.width = (uint16_t)el_texture_width(texture),
                  .height = (uint16_t)el_texture_height(texture),
                  .format = EL_IMAGE_RGB565,
                  .pixels = texture->texels},
    };
    uint8_t wrap_u = EL_WRAP_REPEAT;
    uint8_t wrap_v = EL_WRAP_REPEAT;
#if EL_WITH_MIXED
    if (texture->image != NULL) {
        sampler->image = *texture->image;
        sampler->is_open =
            sampler->image.has_key || sampler->image.alpha != NULL || sampler->image.format == EL_IMAGE_MASK;
    }
    wrap_u = texture->wrap_u;
    wrap_v = texture->wrap_v;
    sampler->smooth = texture->smooth;
#endif
    make_axis(&sampler->u, sampler->image.width, wrap_u);
    make_axis(&sampler->v, sampler->image.height, wrap_v);
}

uint32_t el_sampler_in_period(const el_sampler_axis *axis, int32_t at)
{
    const uint32_t n = ((uint32_t)at + axis->bias) & ((1U << NUMBER_BITS) - 1U);
    return n - (n * axis->reciprocal >> axis->shift) * axis->period; /* 2^13 * 2^14 */
}

uint32_t el_sampler_place(const el_sampler_axis *axis, int32_t at)
{
    if (axis->period == 0) {
        return (uint32_t)el_max_i32(el_min_i32(at, (int32_t)axis->size - 1), 0);
    }
    const uint32_t in_period = el_sampler_in_period(axis, at);
    return in_period < axis->size ? in_period : axis->period - 1U - in_period;
}

uint32_t el_sampler_at(const el_sampler *sampler, uint32_t u_q16, uint32_t v_q16, uint16_t *colour)
{
    const el_image *const image = &sampler->image;
    if (!sampler->smooth) {
        return el_image_at(image, (el_image_format)image->format, el_sampler_place(&sampler->u, (int32_t)u_q16 >> 16),
                           el_sampler_place(&sampler->v, (int32_t)v_q16 >> 16), colour);
    }
    /* From the centre of one texel to that of the next. */
    const int32_t u = (int32_t)(u_q16 - (1U << 15)) >> 12;
    const int32_t v = (int32_t)(v_q16 - (1U << 15)) >> 12;
    const el_image_spot spot = {
        .x = {el_sampler_place(&sampler->u, u >> 4), el_sampler_place(&sampler->u, (u >> 4) + 1)},
        .y = {el_sampler_place(&sampler->v, v >> 4), el_sampler_place(&sampler->v, (v >> 4) + 1)},
        .right = (uint32_t)u & 15U,
        .down = (uint32_t)v & 15U,
    };
    return el_image_smooth_at(image, &spot, colour);
}
#endif
