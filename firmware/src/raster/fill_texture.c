/* The fills with a texture: alone, or times light or vertex colours. Each is the same code with its choices made at compile
 * time, as in fill.c. */
#include "base/dither.h"
#include "base/fixed.h"
#include "raster/fill.h"
#include "raster/texture_walk.h"

/* Where a texture's texels are: masks for the whole parts of u and v, which repeat it, the latter already times the
 * width. A copy, because a compiler must assume that a pixel written may lie in the texture's own description. */
typedef struct texel_source {
    const uint16_t *texels;
    uint32_t u_mask, v_mask;
    unsigned v_down; /* from Q16 to whole texels times the width */
} texel_source;

static EL_SPECIALISED texel_source source_of(const el_texture *texture)
{
    return (texel_source){
        .texels = texture->texels,
        .u_mask = (1U << texture->width_log2) - 1U,
        .v_mask = ((1U << texture->height_log2) - 1U) << texture->width_log2,
        .v_down = 16U - texture->width_log2,
    };
}

static EL_SPECIALISED uint32_t texel_at(const texel_source *source, uint32_t u_q16, uint32_t v_q16)
{
    return source->texels[((v_q16 >> source->v_down) & source->v_mask) | ((u_q16 >> 16) & source->u_mask)];
}

/* A channel of a texel times light / 255, where 255 leaves it as it is. */
static EL_SPECIALISED uint32_t lit(uint32_t channel, uint32_t light, uint32_t threshold_q16, unsigned kind)
{
    return (kind & EL_FILL_DITHER) != 0 ? el_dither(el_fraction_q16(light), channel, threshold_q16)
                                        : (channel * ((light >> 24) + 1U)) >> 8;
}

static EL_SPECIALISED uint16_t modulate(uint32_t texel, const el_values *v, uint32_t threshold_q16, unsigned kind)
{
    return (uint16_t)(lit(texel >> 11, v->red, threshold_q16, kind) << 11 |
                      lit((texel >> 5) & 63U, v->green, threshold_q16, kind) << 5 |
                      lit(texel & 31U, v->blue, threshold_q16, kind));
}

static EL_SPECIALISED int32_t fill(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    const texel_source source = source_of(triangle->surface.texture);
    uint32_t y = (uint32_t)triangle->y;
    el_cursor cursor = el_cursor_at(target, triangle->y, kind);
    el_spans spans;
    const int32_t rows = el_spans_next(triangle, target, stats, &spans);
    el_slopes s = el_slopes_of(triangle, kind);
    for (int32_t i = 0; i < rows; i++) {
        const int32_t x_end = spans.x_end[i];
        int32_t x = spans.x[i];
        if (x < x_end) {
            el_values v = el_values_at(&s, x, kind);
            /* In pieces along which texture coordinates are linear. */
            el_texture_walk walk;
            el_texture_walk_begin(&walk, triangle, x);
            do {
                const int32_t length = el_texture_walk_piece(&walk, x_end - x);
                uint32_t u_q16 = (uint32_t)walk.u_q16;
                uint32_t v_q16 = (uint32_t)walk.v_q16;
                const uint32_t u_step_q16 = (uint32_t)walk.u_step_q16;
                const uint32_t v_step_q16 = (uint32_t)walk.v_step_q16;
                uint16_t *at = cursor.row + x;
                x += length;
                for (const uint16_t *const end = cursor.row + x; at < end; at++) {
                    if (el_passes(&v, at, kind)) {
                        const uint32_t texel = texel_at(&source, u_q16, v_q16);
                        *el_colour_at(&cursor, at) =
                            (uint16_t)((kind & EL_FILL_COLOURS) != 0
                                           ? modulate(texel, &v,
                                                      el_dither_threshold_q16((uint32_t)(at - cursor.row), y), kind)
                                           : texel);
                    }
                    el_values_add(&v, &s.per_column, kind);
                    u_q16 += u_step_q16;
                    v_q16 += v_step_q16;
                }
            } while (x < x_end);
        } else {
            el_count_empty(stats);
        }
        el_values_add(&s.first, &s.per_row, kind);
        el_perspective_next_row(&triangle->perspective);
        cursor.row += target->width;
        y++;
    }
    el_slopes_keep(&s, triangle, kind);
    return rows;
}

#if EL_SMALL_CODE
int32_t el_fill_textured(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    return fill(triangle, target, stats, kind);
}
#else
/* A function of its own for each kind, as in fill.c. */
#define FILLS(DO)                                                                                                      \
    DO(textured, EL_FILL_TEXTURE)                                                                                      \
    DO(textured_depth, EL_FILL_TEXTURE | EL_FILL_DEPTH)                                                                \
    DO(lit, EL_FILL_TEXTURE | EL_FILL_COLOURS)                                                                         \
    DO(lit_depth, EL_FILL_TEXTURE | EL_FILL_COLOURS | EL_FILL_DEPTH)                                                   \
    DO(lit_dithered, EL_FILL_TEXTURE | EL_FILL_COLOURS | EL_FILL_DITHER)                                               \
    DO(lit_dithered_depth, EL_FILL_TEXTURE | EL_FILL_COLOURS | EL_FILL_DITHER | EL_FILL_DEPTH)

#define DEFINE(name, kind)                                                                                             \
    static __attribute__((noinline))                                                                                   \
    int32_t fill_##name(el_triangle *triangle, const el_target *target, el_stats *stats)                               \
    {                                                                                                                  \
        return fill(triangle, target, stats, (kind));                                                                  \
    }
FILLS(DEFINE)

#define CALL(name, kind)                                                                                               \
    if (asked == (kind)) {                                                                                             \
        return fill_##name(triangle, target, stats);                                                                   \
    }

int32_t el_fill_textured(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned asked)
{
    FILLS(CALL)
    return 0;
}
#endif
