/* The fill whose pixels are mixed from several things: textures of any kind, light or vertex colours, fog, and what is there
 * already; and one of its pixels alone, for a sample. Here is the way of small code, one loop that asks at each pixel; where
 * speed counts, fill_mixed_line.c draws the same. The walk along texture coordinates is that of fill_texture.c; only what is
 * fetched there is another. */
#include "raster/fill_mixed.h"

#include "base/fixed.h"
#include "raster/field.h"
#include "raster/texel.h"
#include "raster/texture.h"

#if EL_WITH_MIXED

void el_mixed_brush_begin(el_mixed_brush *b, const el_triangle *triangle)
{
    const el_material *const material = triangle->surface.material;
    const bool is_blended = el_is_blended(material);
    bool is_open = false;
    b->kind = triangle->kind;
    b->flat = triangle->surface.colour;
    b->writes_depth = !is_blended || (material->flags & EL_MATERIAL_BLEND_DEPTH) != 0;
    b->alpha = material->alpha == 0 ? 256U : el_alpha_256(material->alpha);
    b->fog = (b->kind & EL_FILL_DEPTH) != 0 ? material->fog : NULL;
    b->slopes = el_slopes_of(triangle, b->kind);
    if ((b->kind & EL_FILL_TEXTURE) != 0) {
        el_sampler_make(&b->sampler, el_texture_at_level(material->texture, triangle->surface.level));
#if !EL_SMALL_CODE
        el_texel_line_make(&b->texels, &b->sampler);
#endif
        el_texture_walk_start(&b->walk, triangle);
        is_open = b->sampler.is_open;
    }
    if (is_open) {
        b->way = is_blended ? EL_MIXED_SHOWN : EL_MIXED_TESTED;
    } else {
        b->way = b->alpha < 256 ? EL_MIXED_BLENDED : EL_MIXED_OPAQUE;
    }
}

#if EL_SMALL_CODE || EL_WITH_SAMPLES
/* A pixel and its values. */
typedef struct spot {
    uint32_t x, y;
    uint32_t u_q16, v_q16;
    el_values values;
} spot;

/* Its colour, and how much of it shows, 0..256. */
static inline uint32_t colour_at(const el_mixed_brush *b, const spot *at, uint16_t *colour)
{
    uint32_t shown = 256;
    uint16_t base = b->flat;
    if ((b->kind & EL_FILL_TEXTURE) != 0) {
        shown = el_sampler_at(&b->sampler, at->u_q16, at->v_q16, &base);
        if (b->way == EL_MIXED_TESTED) {
            shown = shown >= 128 ? 256U : 0U;
        }
        if (shown == 0) {
            return 0;
        }
    }
    if ((b->kind & (EL_FILL_TEXTURE | EL_FILL_DITHER)) == 0 && (b->kind & EL_FILL_COLOURS) != 0) {
        base = (uint16_t)el_coloured(&at->values);
    } else if ((b->kind & EL_FILL_COLOURS) != 0) {
        const uint32_t texel = (b->kind & EL_FILL_TEXTURE) != 0 ? base : 0xFFFFU;
        base = el_modulate(texel, &at->values, el_dither_threshold_q16(at->x, at->y), b->kind);
    }
    *colour = base;
    return (shown * b->alpha + 128U) >> 8;
}
#endif

#if EL_SMALL_CODE
/* Where it is nearer than `depth`, or there is no test. */
static void draw_pixel(const el_mixed_brush *b, const spot *at, uint16_t *pixel, uint16_t *depth)
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

/* In pieces along which texture coordinates are linear. */
void el_mixed_draw_span(el_mixed_brush *b, const el_mixed_span *span, const el_perspective *planes)
{
    const uint32_t begin = span->x;
    const uint32_t x_end = span->x_end;
    uint32_t u_step = 0;
    uint32_t v_step = 0;
    spot at = {.x = begin, .y = span->y, .values = el_values_at(&b->slopes, (int32_t)begin, b->kind)};
    if ((b->kind & EL_FILL_TEXTURE) != 0) {
        el_texture_walk_begin(&b->walk, planes, begin, x_end - begin);
    }
    while (at.x < x_end) {
        uint32_t piece_end = x_end;
        if ((b->kind & EL_FILL_TEXTURE) != 0) {
            const uint32_t last = x_end - 1U;
            if (at.x < last) {
                piece_end = at.x + el_texture_walk_piece(&b->walk, at.x - begin, last - at.x);
            } else {
                el_texture_walk_last(&b->walk);
            }
            at.u_q16 = (uint32_t)b->walk.u.q16;
            at.v_q16 = (uint32_t)b->walk.v.q16;
            u_step = (uint32_t)b->walk.u.step_q16;
            v_step = (uint32_t)b->walk.v.step_q16;
        }
        for (; at.x < piece_end; at.x++) {
            draw_pixel(b, &at, span->row + at.x, span->depth + at.x);
            el_values_add(&at.values, &b->slopes.per_column, b->kind);
            at.u_q16 += u_step;
            at.v_q16 += v_step;
        }
    }
}
#endif

int32_t el_fill_mixed(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    el_mixed_brush b;
    el_mixed_brush_begin(&b, triangle);
    const int32_t y = triangle->y;
    el_spans spans;
    const int32_t rows = el_spans_next(triangle, target, stats, &spans);
    for (int32_t i = 0; i < rows; i++) {
        const int32_t at = (y + i - target->y) * target->width;
        if (spans.x[i] < spans.x_end[i]) {
            const el_mixed_span span = {(uint32_t)el_screen_row(target->field, y + i), spans.x[i], spans.x_end[i],
                                        target->colour + at, target->depth + at};
            el_mixed_draw_span(&b, &span, &triangle->perspective);
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

#if EL_WITH_SAMPLES
void el_mixed_draw_row(el_mixed_brush *b, const el_triangle *triangle, uint32_t x, uint32_t x_end, uint16_t *row,
                       uint16_t *depth)
{
    const el_mixed_span span = {(uint32_t)triangle->y, x, x_end, row, depth};
    b->slopes = el_slopes_of(triangle, b->kind);
    el_mixed_draw_span(b, &span, &triangle->perspective);
}

uint32_t el_mixed_pixel(el_mixed_brush *b, const el_triangle *triangle, uint32_t x, uint32_t z, uint16_t *colour)
{
    spot at = {.x = x, .y = (uint32_t)triangle->y};
    const el_slopes slopes = el_slopes_of(triangle, b->kind);
    at.values = el_values_at(&slopes, (int32_t)x, b->kind);
    if ((b->kind & EL_FILL_TEXTURE) != 0) {
        el_texture_walk_begin(&b->walk, &triangle->perspective, x, 1);
        el_texture_walk_last(&b->walk);
        at.u_q16 = (uint32_t)b->walk.u.q16;
        at.v_q16 = (uint32_t)b->walk.v.q16;
    }
    const uint32_t shown = colour_at(b, &at, colour);
    if (shown != 0 && b->fog != NULL) {
        *colour = el_rgb565_blend(*colour, b->fog->colour, el_fog_at(b->fog, z));
    }
    return shown;
}
#endif
#endif
