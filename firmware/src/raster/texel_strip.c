#include "raster/texel_strip.h"

#include "raster/texture_walk.h"

#if EL_WITH_MIXED && !EL_SMALL_CODE

/* Coordinates have 16 bits for whole texels. */
enum { BEYOND = 1 << 15 };

void el_texel_strips_make(el_texel_strips *strips, const el_sampler *sampler)
{
    const el_image *const image = &sampler->image;
    const uint32_t fill = image->format == EL_IMAGE_INDEX4 ? 1U : (image->format == EL_IMAGE_MASK ? 7U : 0U);
    *strips = (el_texel_strips){.sampler = sampler, .pitch = (image->width + fill) & ~fill};
}

/* So many whole texels from `begin` on. */
static inline el_texel_strip strip_from(uint32_t begin, uint32_t length, uint32_t place, uint32_t step)
{
    return (el_texel_strip){begin << 16, length << 16, place, step, step};
}

/* That of whole texel `at`. Where neighbours count, the last texel of a picture is by itself: its neighbour is the first of the
 * next one, or, where that is turned around, the same again. */
static EL_APART el_texel_strip strip_of(const el_sampler_axis *axis, int32_t at, bool has_neighbours)
{
    const uint32_t last = axis->size - 1U;
    const uint32_t length = has_neighbours ? last : axis->size;
    const uint32_t x = (uint32_t)at;
    if (axis->period == 0) {
        if (at < 0) {
            return strip_from(0U - BEYOND, BEYOND, 0, 0);
        }
        return x < length ? strip_from(0, length, 0, 1) : strip_from(length, BEYOND - length, last, 0);
    }
    const uint32_t in_period = el_sampler_in_period(axis, at);
    const bool is_turned = in_period >= axis->size;
    const uint32_t in_picture = is_turned ? in_period - axis->size : in_period;
    if (in_picture < length) {
        return strip_from(x - in_picture, length, is_turned ? last : 0U, is_turned ? 0U - 1U : 1U);
    }
    el_texel_strip single = strip_from(x, 1, is_turned ? 0U : last, 0);
    if (axis->period == axis->size) {
        single.more = 0U - last;
    }
    return single;
}

static EL_APART void find_strips(el_texel_strips *strips, uint32_t u_q16, uint32_t v_q16)
{
    const el_sampler *const sampler = strips->sampler;
    if (u_q16 - strips->u.begin_q16 >= strips->u.length_q16) {
        strips->u = strip_of(&sampler->u, (int32_t)u_q16 >> 16, sampler->smooth);
    }
    if (v_q16 - strips->v.begin_q16 >= strips->v.length_q16) {
        strips->v = strip_of(&sampler->v, (int32_t)v_q16 >> 16, sampler->smooth);
    }
    strips->first = strips->v.place * strips->pitch + strips->u.place; /* below 2^20 */
    strips->right = strips->u.more;
    strips->down = strips->v.more * strips->pitch;
}

/* How many of a part's pixels are in both strips, in which the first one is. A part of short steps does not lead around all
 * coordinates: if it ends in a strip, it was nowhere else. Steps are short as a rule, 512 texels. */
static inline uint32_t count_in(const el_texel_strips *strips, const el_texel_row *part)
{
    enum { SHORT = 1 << 25 };
    _Static_assert((uint64_t)EL_MAX_PIECE * SHORT <= 1U << 31, "a part's length and half of all coordinates");
    const uint32_t u_length_q16 = strips->u.length_q16;
    const uint32_t v_length_q16 = strips->v.length_q16;
    const uint32_t u_step_q16 = part->u_step_q16;
    const uint32_t v_step_q16 = part->v_step_q16;
    const uint32_t count = part->count;
    uint32_t u_q16 = part->u_q16;
    uint32_t v_q16 = part->v_q16;
    if (u_q16 + (count - 1U) * u_step_q16 < u_length_q16 && v_q16 + (count - 1U) * v_step_q16 < v_length_q16 &&
        u_step_q16 + SHORT < 2U * SHORT && v_step_q16 + SHORT < 2U * SHORT) {
        return count;
    }
    uint32_t in = 0;
    do {
        in++;
        u_q16 += u_step_q16;
        v_q16 += v_step_q16;
    } while (in < count && u_q16 < u_length_q16 && v_q16 < v_length_q16);
    return in;
}

uint32_t el_texel_strips_enter(el_texel_strips *strips, const el_texel_row *row, el_texel_row *part)
{
    if (row->u_q16 - strips->u.begin_q16 >= strips->u.length_q16 ||
        row->v_q16 - strips->v.begin_q16 >= strips->v.length_q16) {
        find_strips(strips, row->u_q16, row->v_q16);
    }
    part->u_q16 = row->u_q16 - strips->u.begin_q16;
    part->v_q16 = row->v_q16 - strips->v.begin_q16;
    part->u_step_q16 = row->u_step_q16;
    part->v_step_q16 = row->v_step_q16;
    part->colour = row->colour;
    part->count = row->count;
    part->count = count_in(strips, part);
    return part->count;
}
#endif
