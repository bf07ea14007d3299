/* The fills with a texture: alone, or times light or vertex colours. Each is the same code with its choices made at compile
 * time, as in fill.c. */
#include "base/fixed.h"
#include "raster/field.h"
#include "raster/fill_texture_row.h"

#if !EL_SMALL_CODE
static EL_SPECIALISED int32_t fill(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    el_texture_brush b;
    b.texels = el_texels_of(triangle->surface.texture);
    b.y = (kind & EL_FILL_DITHER) != 0 ? (uint32_t)el_screen_row(target->field, triangle->y) : 0U;
    el_texture_walk_start(&b.walk, triangle);
    const el_perspective *const planes = &triangle->perspective;
    el_cursor cursor = el_cursor_at(target, triangle->y, kind);
    el_spans spans;
    const int32_t rows = el_spans_next(triangle, target, stats, &spans);
    b.slopes = el_slopes_of(triangle, kind);
    for (int32_t i = 0; i < rows; i++) {
        const uint32_t x = spans.x[i];
        const uint32_t x_end = spans.x_end[i];
        uint16_t *const row = el_colour_at(&cursor, cursor.row);
        if (x >= x_end) {
            el_count_empty(stats);
        } else if ((kind & EL_FILL_DEPTH) != 0) {
            el_texture_draw_tested(&b, planes, &b.slopes, row, cursor.row, x, x_end, kind);
        } else {
            el_texture_draw_all(&b, planes, row, x, x_end, kind);
        }
        el_values_add(&b.slopes.first, &b.slopes.per_row, kind);
        el_perspective_next_row(&triangle->perspective);
        cursor.row += target->width;
        if ((kind & EL_FILL_DITHER) != 0) {
            b.y += el_field_step(target->field);
        }
    }
    el_slopes_keep(&b.slopes, triangle, kind);
    return rows;
}

/* A function of its own for each kind, and for each with and without depth. */
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
#if EL_WITH_MIXED
    return el_fill_mixed(triangle, target, stats, asked);
#else
    return 0; /* there is no other */
#endif
}
#endif
