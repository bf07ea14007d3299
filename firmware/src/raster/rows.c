/* The loops: rows of a triangle, pixels of a span. Each shading, with and without depth, is the same code with its
 * choices made at compile time, so that none pays for another. */
#include "base/dither.h"
#include "raster/texture_walk.h"
#include "raster/triangle.h"

/* Rounding to nearest at the end is made once, at the start of a span. Depth gets the bound of its plane's error more than
 * its half (plane.h): values exactly between two units, which truncated gradients leave a little too low, are rounded up like
 * all others. */
#define HALF_Q32 ((1ULL << 31) + (1U << 13)) /* of depth, Q32 */
#define HALF_Q24 (0x80U << 16)               /* of colour, 8.24 */

/* Depth is stepped with all 32 bits of fraction: on a 32-bit core that costs one addition more than 16.16 and saves the
 * shift, and it makes the plane exact at every pixel of the widest screen. */
typedef struct stepped_depth {
    uint64_t value; /* Q32, its half added */
    uint64_t step;
} stepped_depth;

/* A colour, 8.24 modulo 2^32: its plane holds 8.8 with 32 bits of fraction, so the 32 bits are taken out of the middle. The
 * step is rounded: after n pixels the colour is off by n * 2^-25. */
typedef struct stepped {
    uint32_t value; /* its half added */
    uint32_t step;
} stepped;

static inline uint64_t value_at(const el_plane *plane, int32_t x)
{
    return plane->row + plane->dx * (uint64_t)(int64_t)x;
}

static inline stepped colour_at(const el_plane *plane, int32_t x)
{
    return (stepped){.value = (uint32_t)(value_at(plane, x) >> 16) + HALF_Q24,
                     .step = (uint32_t)((plane->dx + 0x8000U) >> 16)};
}

/* What a span carries from pixel to pixel, texture coordinates apart. */
typedef struct span {
    stepped_depth z;
    stepped rgb[3];
} span;

/* What a loop does: bits of a number that the compiler knows, so that each loop holds only what it needs. */
enum { DEPTH = 1, COLOURS = 2, TEXTURE = 4, DITHER = 8, COUNT = 16 };

static inline span span_begin(const el_triangle *triangle, int32_t x, unsigned kind)
{
    span s = {0};
    if ((kind & DEPTH) != 0) {
        const el_plane *const plane = &triangle->planes[EL_PLANE_Z];
        s.z = (stepped_depth){.value = value_at(plane, x) + HALF_Q32, .step = plane->dx};
    }
    if ((kind & COLOURS) != 0) {
        const el_plane *planes = &triangle->planes[(kind & TEXTURE) != 0 ? EL_PLANE_LIGHT_RED : EL_PLANE_RED];
        for (unsigned i = 0; i < 3; i++) {
            s.rgb[i] = colour_at(&planes[i], x);
        }
    }
    return s;
}

static inline void span_step(span *s, unsigned kind)
{
    if ((kind & DEPTH) != 0) {
        s->z.value += s->z.step;
    }
    if ((kind & COLOURS) != 0) {
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

/* A colour, 0..255 in 8.24 with its half added, as 0..1 in Q16, modulo 2^32: what rounding leaves below 0 is made up for
 * by the smallest threshold. */
static inline uint32_t fraction_q16(uint32_t plus_half_q24)
{
    return (uint32_t)(((int32_t)(plus_half_q24 >> 16) - 0x80) * 257 >> 8);
}

/* Each channel of the texel times light / 255, where 255 leaves it as it is. */
static inline uint16_t modulate(uint16_t texel, const stepped light[3], uint32_t threshold_q16, unsigned kind)
{
    const uint32_t channels[3] = {texel >> 11, (texel >> 5) & 63U, texel & 31U};
    uint32_t lit[3];
    for (unsigned i = 0; i < 3; i++) {
        lit[i] = (kind & DITHER) != 0 ? el_dither(fraction_q16(light[i].value), channels[i], threshold_q16)
                                      : (channels[i] * ((light[i].value >> 24) + 1U)) >> 8;
    }
    return (uint16_t)((lit[0] << 11) | (lit[1] << 5) | lit[2]);
}

static inline uint16_t coloured(const stepped rgb[3], uint32_t threshold_q16, unsigned kind)
{
    if ((kind & DITHER) != 0) {
        return (uint16_t)(el_dither(fraction_q16(rgb[0].value), 31, threshold_q16) << 11 |
                          el_dither(fraction_q16(rgb[1].value), 63, threshold_q16) << 5 |
                          el_dither(fraction_q16(rgb[2].value), 31, threshold_q16));
    }
    return (uint16_t)((rgb[0].value >> 27 << 11) | (rgb[1].value >> 26 << 5) | rgb[2].value >> 27);
}

/* Whether the pixel is drawn; its depth is stored then. */
static inline bool passes(const span *s, uint16_t *depth, unsigned kind)
{
    if ((kind & DEPTH) == 0) {
        return true;
    }
    const uint32_t z = (uint32_t)(s->z.value >> 32); /* 0..65535: the plane stays within its corners' range */
    if (z >= *depth) {
        return false;
    }
    *depth = (uint16_t)z;
    return true;
}

/* The pixels of a row: where they are and where they go. */
typedef struct row {
    uint16_t *colour;
    uint16_t *depth;
    int32_t x, x_end;
} row;

/* In one colour or in the vertices' colours. */
static inline void draw_coloured(const el_triangle *triangle, row r, unsigned kind)
{
    span s = span_begin(triangle, r.x, kind);
    for (int32_t x = r.x; x < r.x_end; x++) {
        if (passes(&s, &r.depth[x], kind)) {
            r.colour[x] = (kind & COLOURS) != 0
                              ? coloured(s.rgb, el_dither_threshold_q16((uint32_t)x, (uint32_t)triangle->y), kind)
                              : triangle->surface.colour;
        }
        span_step(&s, kind);
    }
}

/* With a texture, in pieces along which texture coordinates are linear. */
static inline void draw_textured(const el_triangle *triangle, row r, unsigned kind)
{
    span s = span_begin(triangle, r.x, kind);
    el_texture_walk walk;
    el_texture_walk_begin(&walk, triangle, r.x);
    int32_t x = r.x;
    while (x < r.x_end) {
        const int32_t length = el_texture_walk_piece(&walk, triangle, r.x_end - x);
        uint32_t u_q16 = (uint32_t)walk.u_q16;
        uint32_t v_q16 = (uint32_t)walk.v_q16;
        for (const int32_t piece_end = x + length; x < piece_end; x++) {
            if (passes(&s, &r.depth[x], kind)) {
                const uint16_t texel = texel_at(triangle->surface.texture, u_q16, v_q16);
                r.colour[x] =
                    (kind & COLOURS) != 0
                        ? modulate(texel, s.rgb, el_dither_threshold_q16((uint32_t)x, (uint32_t)triangle->y), kind)
                        : texel;
            }
            span_step(&s, kind);
            u_q16 += (uint32_t)walk.u_step_q16;
            v_q16 += (uint32_t)walk.v_step_q16;
        }
        el_texture_walk_next(&walk, triangle, length);
    }
}

/* Overdraw: the picture counts. */
static void draw_count(row r)
{
    for (int32_t x = r.x; x < r.x_end; x++) {
        r.colour[x]++;
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

static inline void draw_rows(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    const int32_t y_end = triangle->y_end < target->y_end ? triangle->y_end : target->y_end;
    while (triangle->y < y_end) {
        const int32_t offset = (triangle->y - target->y) * target->width;
        const int32_t left = triangle->edges[0].x;
        const int32_t right = triangle->edges[1].x;
        const row r = {
            .colour = target->colour + offset,
            .depth = target->depth + ((kind & DEPTH) != 0 ? offset : 0),
            .x = left < 0 ? 0 : left,
            .x_end = right > target->width ? target->width : right,
        };
        stats->rows++;
        if (r.x < r.x_end) {
            stats->spans++;
            stats->pixels += (uint32_t)(r.x_end - r.x);
            if ((kind & COUNT) != 0) {
                draw_count(r);
            } else if ((kind & TEXTURE) != 0) {
                draw_textured(triangle, r, kind);
            } else {
                draw_coloured(triangle, r, kind);
            }
        }
        next_row(triangle);
    }
}

static unsigned kind_of(const el_surface *surface)
{
    static const uint8_t kinds[] = {
        [EL_SHADE_FLAT] = 0,           [EL_SHADE_GOURAUD] = COLOURS,
        [EL_SHADE_TEXTURED] = TEXTURE, [EL_SHADE_TEXTURED_GOURAUD] = TEXTURE | COLOURS,
        [EL_SHADE_OVERDRAW] = COUNT,
    };
    const unsigned kind = kinds[surface->shading];
    const bool dithers = surface->dither && (kind & COLOURS) != 0;
    const bool depth = surface->depth && (kind & COUNT) == 0;
    return kind | (dithers ? DITHER : 0U) | (depth ? DEPTH : 0U);
}

/* A loop of its own for each kind there is. */
#define DRAW(kind)                                                                                                     \
    case (kind):                                                                                                       \
        draw_rows(triangle, target, stats, (kind));                                                                    \
        break

void el_triangle_draw(el_triangle *triangle, const el_target *target, el_stats *stats)
{
    switch (kind_of(&triangle->surface)) {
        DRAW(0);
        DRAW(DEPTH);
        DRAW(COLOURS);
        DRAW(COLOURS | DEPTH);
        DRAW(COLOURS | DITHER);
        DRAW(COLOURS | DITHER | DEPTH);
        DRAW(TEXTURE);
        DRAW(TEXTURE | DEPTH);
        DRAW(TEXTURE | COLOURS);
        DRAW(TEXTURE | COLOURS | DEPTH);
        DRAW(TEXTURE | COLOURS | DITHER);
        DRAW(TEXTURE | COLOURS | DITHER | DEPTH);
        DRAW(COUNT);
    default:
        break;
    }
}

void el_triangle_sample(const el_triangle *triangle, int32_t x, int32_t width, el_sample *sample)
{
    const unsigned kind = kind_of(&triangle->surface);
    const int32_t begin = triangle->edges[0].x < 0 ? 0 : triangle->edges[0].x;
    const int32_t end = triangle->edges[1].x > width ? width : triangle->edges[1].x;
    span s = span_begin(triangle, begin, kind);
    for (int32_t at = begin; at < x; at++) {
        span_step(&s, kind);
    }
    *sample = (el_sample){.z_plus_half_q16 = (uint32_t)(s.z.value >> 16)};
    for (unsigned i = 0; i < 3; i++) {
        sample->rgb_plus_half_q24[i] = s.rgb[i].value;
    }
    if ((kind & TEXTURE) == 0) {
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
