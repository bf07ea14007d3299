/* The fill whose pixels are mixed from several things: textures of any kind, light or vertex colours, fog, and what is there
 * already. One loop for all, which asks at each pixel: in small code; where speed counts, fill_mixed_line.c draws the same.
 * The walk along texture coordinates is that of fill_texture.c; only what is fetched there is another. */
#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/fog.h"
#include "raster/sampler.h"
#include "raster/texel.h"
#include "raster/texture.h"
#include "raster/texture_walk.h"

#if EL_WITH_MIXED && EL_SMALL_CODE

/* What the pixels of a triangle are drawn with. */
typedef struct brush {
    unsigned kind;
    uint16_t flat;
    bool is_tested; /* texels show or do not */
    bool writes_depth;
    uint32_t alpha; /* 0..256 */
    const el_fog *fog;
    el_slopes slopes;
#if EL_WITH_TEXTURE
    el_sampler sampler;
    el_texture_walk walk;
#endif
} brush;

static void take_up(brush *b, const el_triangle *triangle)
{
    const el_material *const material = triangle->surface.material;
    const bool is_blended = el_is_blended(material);
    b->kind = triangle->kind;
    b->flat = triangle->surface.colour;
    b->is_tested = !is_blended;
    b->writes_depth = !is_blended || (material->flags & EL_MATERIAL_BLEND_DEPTH) != 0;
    b->alpha = material->alpha == 0 ? 256U : el_alpha_256(material->alpha);
    b->fog = material->fog;
    b->slopes = el_slopes_of(triangle, b->kind);
#if EL_WITH_TEXTURE
    if ((b->kind & EL_FILL_TEXTURE) != 0) {
        el_sampler_make(&b->sampler, el_texture_at_level(material->texture, triangle->surface.level));
        el_texture_walk_start(&b->walk, triangle);
    }
#endif
}

/* A pixel and its values. */
typedef struct spot {
    uint32_t x, y;
    uint32_t u_q16, v_q16;
    el_values values;
} spot;

/* Its colour, and how much of it shows, 0..256. */
static inline uint32_t colour_at(const brush *b, const spot *at, uint16_t *colour)
{
    uint32_t shown = 256;
    uint16_t base = b->flat;
#if EL_WITH_TEXTURE
    if ((b->kind & EL_FILL_TEXTURE) != 0) {
        shown = el_sampler_at(&b->sampler, at->u_q16, at->v_q16, &base);
        if (b->is_tested) {
            shown = shown >= 128 ? 256U : 0U;
        }
        if (shown == 0) {
            return 0;
        }
    }
#endif
    if ((b->kind & (EL_FILL_TEXTURE | EL_FILL_DITHER)) == 0 && (b->kind & EL_FILL_COLOURS) != 0) {
        base = (uint16_t)el_coloured(&at->values);
    } else if ((b->kind & EL_FILL_COLOURS) != 0) {
        const uint32_t texel = (b->kind & EL_FILL_TEXTURE) != 0 ? base : 0xFFFFU;
        base = el_modulate(texel, &at->values, el_dither_threshold_q16(at->x, at->y), b->kind);
    }
    *colour = base;
    return (shown * b->alpha + 128U) >> 8;
}

/* Where it is nearer than `depth`, or there is no test. */
static void draw_pixel(const brush *b, const spot *at, uint16_t *pixel, uint16_t *depth)
{
    const uint32_t z = (b->kind & EL_FILL_DEPTH) != 0 ? (uint32_t)(at->values.z >> 32) : 0U;
    if ((b->kind & EL_FILL_DEPTH) != 0 && z >= *depth) {
        return;
    }
    uint16_t colour = 0;
    const uint32_t shown = colour_at(b, at, &colour);
    if (shown == 0) {
        return;
    }
    if ((b->kind & EL_FILL_DEPTH) != 0 && b->writes_depth) {
        *depth = (uint16_t)z;
    }
    if (b->fog != NULL) {
        colour = el_rgb565_blend(colour, b->fog->colour, el_fog_at(b->fog, z));
    }
    *pixel = shown == 256 ? colour : el_rgb565_blend(*pixel, colour, shown);
}

/* The span from at->x to x_end, in pieces along which texture coordinates are linear. */
static void draw_span(brush *b, spot *at, uint32_t x_end, const el_perspective *planes, uint16_t *row, uint16_t *depth)
{
    const uint32_t begin = at->x;
    uint32_t u_step = 0;
    uint32_t v_step = 0;
    at->values = el_values_at(&b->slopes, (int32_t)begin, b->kind);
#if EL_WITH_TEXTURE
    if ((b->kind & EL_FILL_TEXTURE) != 0) {
        el_texture_walk_begin(&b->walk, planes, begin, x_end - begin);
    }
#else
    (void)planes;
#endif
    while (at->x < x_end) {
        uint32_t piece_end = x_end;
#if EL_WITH_TEXTURE
        if ((b->kind & EL_FILL_TEXTURE) != 0) {
            const uint32_t last = x_end - 1U;
            if (at->x < last) {
                piece_end = at->x + el_texture_walk_piece(&b->walk, at->x - begin, last - at->x);
            } else {
                el_texture_walk_last(&b->walk);
            }
            at->u_q16 = (uint32_t)b->walk.u.q16;
            at->v_q16 = (uint32_t)b->walk.v.q16;
            u_step = (uint32_t)b->walk.u.step_q16;
            v_step = (uint32_t)b->walk.v.step_q16;
        }
#endif
        for (; at->x < piece_end; at->x++) {
            draw_pixel(b, at, row + at->x, depth + at->x);
            el_values_add(&at->values, &b->slopes.per_column, b->kind);
            at->u_q16 += u_step;
            at->v_q16 += v_step;
        }
    }
}

int32_t el_fill_mixed(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    brush b;
    take_up(&b, triangle);
    const int32_t y = triangle->y;
    el_spans spans;
    const int32_t rows = el_spans_next(triangle, target, stats, &spans);
    for (int32_t i = 0; i < rows; i++) {
        const int32_t at = (y + i - target->y) * target->width;
        if (spans.x[i] < spans.x_end[i]) {
            spot first = {.x = spans.x[i], .y = (uint32_t)(y + i)};
            draw_span(&b, &first, spans.x_end[i], &triangle->perspective, target->colour + at, target->depth + at);
        } else {
            el_count_empty(stats);
        }
        el_values_add(&b.slopes.first, &b.slopes.per_row, kind);
        if ((kind & EL_FILL_TEXTURE) != 0) {
            el_perspective_next_row(&triangle->perspective);
        }
    }
    el_slopes_keep(&b.slopes, triangle, kind);
    return rows;
}
#endif
