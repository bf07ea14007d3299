/* All fills in small code, and those of rare shadings where pixels have several samples: one loop, which asks at each pixel
 * what its shading needs, and one row at a time, whose state stays in the triangle. The pixels are those of fill.c and
 * fill_texture.c. */
#include "base/fixed.h"
#include "raster/fill_row.h"

#if EL_SMALL_CODE || EL_WITH_SAMPLES

/* The triangle's linear values in column x of its next row. */
static inline el_values values_at(const el_triangle *triangle, uint32_t x, unsigned kind)
{
    el_values v;
    if ((kind & EL_FILL_DEPTH) != 0) {
        v.z = triangle->z.value + EL_HALF_Q32 + el_multiply_u16(triangle->z.dx, x);
    }
    if ((kind & EL_FILL_COLOURS) != 0) {
        const el_channel *const rgb = triangle->rgb;
        v.red = rgb[0].value + rgb[0].dx * x;
        v.green = rgb[1].value + rgb[1].dx * x;
        v.blue = rgb[2].value + rgb[2].dx * x;
    }
    return v;
}

/* A texel, all ones where there is no texture, in the light or the colours of the vertices. */
static EL_APART_IF_SMALL uint16_t shaded(uint32_t texel, const el_values *v, uint32_t threshold_q16, unsigned kind)
{
    return el_modulate(texel, v, threshold_q16, kind);
}

#if !EL_WITH_SAMPLES
static EL_APART_IF_SMALL
#endif
    void
    el_fill_row(const el_triangle *triangle, el_row_brush *b, const el_cursor *cursor, uint32_t x, uint32_t x_end)
{
    const unsigned kind = triangle->kind;
    const bool counts_hidden = EL_WITH_DEBUG_VIEWS && (kind & EL_FILL_COUNT) != 0 && (kind & EL_FILL_DEPTH) != 0;
    const uint32_t last = x_end - 1U;
    const uint32_t begin = x;
    uint32_t piece_end = x_end;
    el_values values = values_at(triangle, x, kind);
    if ((kind & EL_FILL_TEXTURE) != 0) {
        el_texture_walk_begin(&b->walk, &triangle->perspective, x, x_end - x);
    }
    while (x < x_end) {
        uint32_t u_q16 = 0;
        uint32_t v_q16 = 0;
        if ((kind & EL_FILL_TEXTURE) != 0) {
            piece_end = x_end;
            if (x < last) {
                piece_end = x + el_texture_walk_piece(&b->walk, x - begin, last - x);
            } else {
                el_texture_walk_last(&b->walk);
            }
            u_q16 = (uint32_t)b->walk.u.q16;
            v_q16 = (uint32_t)b->walk.v.q16;
        }
        for (; x < piece_end; x++) {
            uint16_t *const at = cursor->row + x;
            if (el_passes(&values, at, kind) != counts_hidden) {
                uint16_t *const pixel = el_colour_at(cursor, at);
                uint32_t colour = triangle->surface.colour;
                if (kind > EL_FILL_DEPTH) {
                    colour = (kind & EL_FILL_COUNT) != 0 ? *pixel + 1U : 0xFFFFU;
                    if ((kind & EL_FILL_TEXTURE) != 0) {
                        colour = el_texel_at(&b->source, u_q16, v_q16);
                    }
                    if ((kind & (EL_FILL_TEXTURE | EL_FILL_DITHER)) == 0 && (kind & EL_FILL_COLOURS) != 0) {
                        colour = ((values.red >> 27 << 6 | values.green >> 26) << 5) | values.blue >> 27;
                    } else if ((kind & EL_FILL_COLOURS) != 0) {
                        colour = shaded(colour, &values, el_dither_threshold_q16(x, (uint32_t)triangle->y), kind);
                    }
                }
                *pixel = (uint16_t)colour;
            }
            if ((kind & EL_FILL_DEPTH) != 0) {
                values.z += triangle->z.dx;
            }
            if (kind > EL_FILL_DEPTH) {
                if ((kind & EL_FILL_COLOURS) != 0) {
                    values.red += triangle->rgb[0].dx;
                    values.green += triangle->rgb[1].dx;
                    values.blue += triangle->rgb[2].dx;
                }
                if ((kind & EL_FILL_TEXTURE) != 0) {
                    u_q16 += (uint32_t)b->walk.u.step_q16;
                    v_q16 += (uint32_t)b->walk.v.step_q16;
                }
            }
        }
    }
}

#if EL_SMALL_CODE
static void plane_next_row(el_plane *plane)
{
    plane->value += plane->dy;
}

static EL_APART_IF_SMALL void next_row(el_triangle *triangle, unsigned kind)
{
    if ((kind & EL_FILL_DEPTH) != 0) {
        plane_next_row(&triangle->z);
    }
    for (unsigned i = 0; i < 3 && (kind & EL_FILL_COLOURS) != 0; i++) {
        triangle->rgb[i].value += triangle->rgb[i].dy;
    }
    if ((kind & EL_FILL_TEXTURE) != 0) {
        plane_next_row(&triangle->perspective.w);
        plane_next_row(&triangle->perspective.u);
        plane_next_row(&triangle->perspective.v);
    }
    el_edge_next_row(&triangle->left);
    el_edge_next_row(&triangle->right);
    triangle->y++;
    if (triangle->y == triangle->y_middle) {
        *(triangle->short_is_left ? &triangle->left : &triangle->right) = triangle->lower;
    }
}

void el_triangle_draw(el_triangle *triangle, const el_target *target, el_stats *stats)
{
    const unsigned kind = triangle->kind;
    const int32_t y_end = el_min_i32(triangle->y_end, target->y_end);
#if EL_WITH_MIXED
    if ((kind & EL_FILL_MIXED) != 0) {
        while (triangle->y < y_end) {
            (void)el_fill_mixed(triangle, target, stats, kind);
        }
        return;
    }
#endif
    el_cursor cursor = el_cursor_at(target, triangle->y, kind);
    el_row_brush b;
    el_row_brush_begin(&b, triangle);
    while (triangle->y < y_end) {
        const int32_t x = el_max_i32(el_edge_x(&triangle->left), 0);
        const int32_t x_end = el_min_i32(el_edge_x(&triangle->right), target->width);
        el_count(&stats->rows, 1);
        if (x < x_end) {
            el_count(&stats->spans, 1);
            el_count(&stats->pixels, (uint32_t)(x_end - x));
            el_fill_row(triangle, &b, &cursor, (uint32_t)x, (uint32_t)x_end);
        }
        next_row(triangle, kind);
        cursor.row += target->width;
    }
}
#endif
#endif
