/* The loops: rows of a triangle, pixels of a span. Each shading, with and without depth, is the same code with its
 * choices made at compile time, so that none pays for another. */
#include "raster/texture_walk.h"
#include "raster/triangle.h"

/* Rounding to nearest at the end is made once, at the start of a span. */
#define HALF_Q16 0x8000U       /* of depth, 16.16 */
#define HALF_Q24 (0x80U << 16) /* of colour, 8.24 */

/* A value that is stepped in 32 bits along a span: depth as 16.16 or a colour as 8.24, modulo 2^32. The plane holds
 * depth with 32 bits of fraction and colours (8.8) with 40, so both take the same 32 bits out of the middle. The step
 * is rounded: after n pixels depth is off by n * 2^-17 units at most, colour by n * 2^-25. */
typedef struct stepped {
    uint32_t value;
    uint32_t step;
} stepped;

static inline stepped stepped_at(const el_plane *plane, int32_t x, uint32_t half)
{
    const uint64_t start = plane->row + plane->dx * (uint64_t)(int64_t)x;
    return (stepped){.value = (uint32_t)(start >> 16) + half, .step = (uint32_t)((plane->dx + 0x8000U) >> 16)};
}

/* What a span carries from pixel to pixel, texture coordinates apart. */
typedef struct span {
    stepped z;
    stepped rgb[3];
} span;

/* The choices that the compiler makes once per loop. */
typedef struct loop_kind {
    bool depth;
    bool colours;
    bool texture;
} loop_kind;

static inline span span_begin(const el_triangle *triangle, int32_t x, loop_kind kind)
{
    span s = {0};
    if (kind.depth) {
        s.z = stepped_at(&triangle->planes[EL_PLANE_Z], x, HALF_Q16);
    }
    if (kind.colours) {
        const el_plane *planes = &triangle->planes[kind.texture ? EL_PLANE_LIGHT_RED : EL_PLANE_RED];
        for (unsigned i = 0; i < 3; i++) {
            s.rgb[i] = stepped_at(&planes[i], x, HALF_Q24);
        }
    }
    return s;
}

static inline void span_step(span *s, loop_kind kind)
{
    if (kind.depth) {
        s->z.value += s->z.step;
    }
    if (kind.colours) {
        for (unsigned i = 0; i < 3; i++) {
            s->rgb[i].value += s->rgb[i].step;
        }
    }
}

static inline uint16_t texel_at(const el_texture *texture, uint32_t u_q16, uint32_t v_q16)
{
    const uint32_t column = (u_q16 >> 16) & ((1U << texture->width_log2) - 1U);
    const uint32_t line = (v_q16 >> 16) & ((1U << texture->height_log2) - 1U);
    return texture->texels[(line << texture->width_log2) + column];
}

/* Each channel of the texel times light / 255, where 255 leaves it as it is. */
static inline uint16_t modulate(uint16_t texel, const stepped light[3])
{
    const uint32_t red = ((texel >> 11) * ((light[0].value >> 24) + 1U)) >> 8;
    const uint32_t green = (((texel >> 5) & 63U) * ((light[1].value >> 24) + 1U)) >> 8;
    const uint32_t blue = ((texel & 31U) * ((light[2].value >> 24) + 1U)) >> 8;
    return (uint16_t)((red << 11) | (green << 5) | blue);
}

static inline uint16_t span_colour(const span *s, const el_triangle *triangle, loop_kind kind)
{
    if (kind.colours) {
        return (uint16_t)((s->rgb[0].value >> 27 << 11) | (s->rgb[1].value >> 26 << 5) | s->rgb[2].value >> 27);
    }
    return triangle->surface.colour;
}

/* Whether the pixel is drawn; its depth is stored then. */
static inline bool passes(const span *s, uint16_t *depth, loop_kind kind)
{
    if (!kind.depth) {
        return true;
    }
    const uint32_t z = s->z.value >> 16;
    if (z >= *depth) {
        return false;
    }
    *depth = (uint16_t)z;
    return true;
}

/* Pixels [x, x_end) of one row, in one colour or in the vertices' colours. */
static inline void draw_coloured(const el_triangle *triangle, uint16_t *colour, uint16_t *depth, int32_t x,
                                 int32_t x_end, loop_kind kind)
{
    span s = span_begin(triangle, x, kind);
    for (; x < x_end; x++) {
        if (passes(&s, &depth[x], kind)) {
            colour[x] = span_colour(&s, triangle, kind);
        }
        span_step(&s, kind);
    }
}

/* The same with a texture, in pieces along which texture coordinates are linear. */
static inline void draw_textured(const el_triangle *triangle, uint16_t *colour, uint16_t *depth, int32_t x,
                                 int32_t x_end, loop_kind kind)
{
    span s = span_begin(triangle, x, kind);
    el_texture_walk walk;
    el_texture_walk_begin(&walk, triangle, x);
    while (x < x_end) {
        const int32_t length = el_texture_walk_piece(&walk, triangle, x_end - x);
        uint32_t u_q16 = (uint32_t)walk.u_q16;
        uint32_t v_q16 = (uint32_t)walk.v_q16;
        for (const int32_t piece_end = x + length; x < piece_end; x++) {
            if (passes(&s, &depth[x], kind)) {
                const uint16_t texel = texel_at(triangle->surface.texture, u_q16, v_q16);
                colour[x] = kind.colours ? modulate(texel, s.rgb) : texel;
            }
            span_step(&s, kind);
            u_q16 += (uint32_t)walk.u_step_q16;
            v_q16 += (uint32_t)walk.v_step_q16;
        }
        el_texture_walk_next(&walk, triangle, length);
    }
}

/* Overdraw: the picture counts. */
static void count_span(uint16_t *colour, int32_t x, int32_t x_end)
{
    for (; x < x_end; x++) {
        colour[x]++;
    }
}

static void next_row(el_triangle *triangle)
{
    triangle->y++;
    el_edge_next_row(&triangle->edges[0]);
    el_edge_next_row(&triangle->edges[1]);
    if (triangle->y == triangle->y_middle) {
        triangle->edges[triangle->short_is_left ? 0 : 1] = triangle->edges[2];
    }
    const unsigned count = el_plane_count(triangle->surface.shading);
    for (unsigned i = 0; i < count; i++) {
        triangle->planes[i].row += triangle->planes[i].dy;
    }
}

static inline void draw_rows(el_triangle *triangle, const el_target *target, el_stats *stats, loop_kind kind,
                             bool count)
{
    const int32_t y_end = triangle->y_end < target->y_end ? triangle->y_end : target->y_end;
    while (triangle->y < y_end) {
        int32_t x = triangle->edges[0].x;
        int32_t x_end = triangle->edges[1].x;
        x = x < 0 ? 0 : x;
        x_end = x_end > target->width ? target->width : x_end;
        stats->rows++;
        if (x < x_end) {
            const int32_t row = (triangle->y - target->y) * target->width;
            stats->spans++;
            stats->pixels += (uint32_t)(x_end - x);
            if (count) {
                count_span(target->colour + row, x, x_end);
            } else if (kind.texture) {
                draw_textured(triangle, target->colour + row, target->depth + row, x, x_end, kind);
            } else {
                draw_coloured(triangle, target->colour + row, target->depth + row, x, x_end, kind);
            }
        }
        next_row(triangle);
    }
}

static loop_kind kind_of(const el_surface *surface)
{
    return (loop_kind){
        .depth = surface->depth,
        .colours = surface->shading == EL_SHADE_GOURAUD || surface->shading == EL_SHADE_TEXTURED_GOURAUD,
        .texture = surface->shading == EL_SHADE_TEXTURED || surface->shading == EL_SHADE_TEXTURED_GOURAUD,
    };
}

void el_triangle_draw(el_triangle *triangle, const el_target *target, el_stats *stats)
{
    const bool depth = triangle->surface.depth;
    switch (triangle->surface.shading) {
    case EL_SHADE_FLAT:
        if (depth) {
            draw_rows(triangle, target, stats, (loop_kind){.depth = true}, false);
        } else {
            draw_rows(triangle, target, stats, (loop_kind){.depth = false}, false);
        }
        break;
    case EL_SHADE_GOURAUD:
        if (depth) {
            draw_rows(triangle, target, stats, (loop_kind){.depth = true, .colours = true}, false);
        } else {
            draw_rows(triangle, target, stats, (loop_kind){.colours = true}, false);
        }
        break;
    case EL_SHADE_TEXTURED:
        if (depth) {
            draw_rows(triangle, target, stats, (loop_kind){.depth = true, .texture = true}, false);
        } else {
            draw_rows(triangle, target, stats, (loop_kind){.texture = true}, false);
        }
        break;
    case EL_SHADE_TEXTURED_GOURAUD:
        if (depth) {
            draw_rows(triangle, target, stats, (loop_kind){.depth = true, .colours = true, .texture = true}, false);
        } else {
            draw_rows(triangle, target, stats, (loop_kind){.colours = true, .texture = true}, false);
        }
        break;
    case EL_SHADE_OVERDRAW:
        draw_rows(triangle, target, stats, (loop_kind){.depth = false}, true);
        break;
    }
}

void el_triangle_sample(const el_triangle *triangle, int32_t x, int32_t width, el_sample *sample)
{
    const loop_kind kind = kind_of(&triangle->surface);
    const int32_t begin = triangle->edges[0].x < 0 ? 0 : triangle->edges[0].x;
    const int32_t end = triangle->edges[1].x > width ? width : triangle->edges[1].x;
    span s = span_begin(triangle, begin, kind);
    for (int32_t at = begin; at < x; at++) {
        span_step(&s, kind);
    }
    *sample = (el_sample){.z_plus_half_q16 = s.z.value};
    for (unsigned i = 0; i < 3; i++) {
        sample->rgb_plus_half_q24[i] = s.rgb[i].value;
    }
    if (!kind.texture) {
        return;
    }
    el_texture_walk walk;
    el_texture_walk_begin(&walk, triangle, begin);
    int32_t at = begin;
    int32_t length = el_texture_walk_piece(&walk, triangle, end - at);
    while (x >= at + length) {
        el_texture_walk_next(&walk, triangle, length);
        at += length;
        length = el_texture_walk_piece(&walk, triangle, end - at);
    }
    sample->u_q16 = walk.u_q16 + (x - at) * walk.u_step_q16;
    sample->v_q16 = walk.v_q16 + (x - at) * walk.v_step_q16;
}
