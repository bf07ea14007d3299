/* The loops: rows of a triangle, pixels of a span. Each shading, with and without depth, is the same code with its
 * choices made at compile time, so that none pays for another; in small code one loop asks, in half the memory. */
#include "base/dither.h"
#include "raster/texture_walk.h"
#include "raster/triangle.h"

/* Rounding to nearest at the end is made once, at the start of a span. Depth gets the bound of its plane's error more than
 * its half (plane.h): values exactly between two units, which truncated gradients leave a little too low, are rounded up like
 * all others. */
#define HALF_Q32 ((1ULL << 31) + (1U << 13)) /* of depth, Q32 */

/* What a span carries from pixel to pixel, texture coordinates apart. Depth is stepped with all 32 bits of fraction: on a
 * 32-bit core that costs one addition more than 16.16 and saves the shift, and it makes the plane exact at every pixel of
 * the widest screen. */
typedef struct span {
    uint64_t z, z_step;        /* Q32, its half added */
    uint32_t red, green, blue; /* 8.24 modulo 2^32, their half added */
    uint32_t red_step, green_step, blue_step;
} span;

/* What a loop does: bits of a number that the compiler knows, so that each loop holds only what it needs. What options.h
 * leaves out has no bit. */
enum {
    DEPTH = 1,
    COLOURS = EL_WITH_GOURAUD ? 2 : 0,
    TEXTURE = EL_WITH_TEXTURE ? 4 : 0,
    COUNT = EL_WITH_OVERDRAW ? 8 : 0,
    DITHER = EL_WITH_GOURAUD && EL_WITH_DITHER ? 16 : 0
};

static EL_SPECIALISED span span_begin(const el_triangle *triangle, int32_t skipped, unsigned kind)
{
    span s;
    if ((kind & DEPTH) != 0) {
        s.z = triangle->z.value + HALF_Q32;
        s.z_step = triangle->z.dx;
        if (skipped != 0) {
            s.z += el_plane_times(s.z_step, skipped);
        }
    }
    if ((kind & COLOURS) != 0) {
        s.red_step = triangle->rgb[0].dx;
        s.green_step = triangle->rgb[1].dx;
        s.blue_step = triangle->rgb[2].dx;
        s.red = triangle->rgb[0].value + s.red_step * (uint32_t)skipped;
        s.green = triangle->rgb[1].value + s.green_step * (uint32_t)skipped;
        s.blue = triangle->rgb[2].value + s.blue_step * (uint32_t)skipped;
    }
    return s;
}

static EL_SPECIALISED void span_step(span *s, unsigned kind)
{
    if ((kind & DEPTH) != 0) {
        s->z += s->z_step;
    }
    if ((kind & COLOURS) != 0) {
        s->red += s->red_step;
        s->green += s->green_step;
        s->blue += s->blue_step;
    }
}

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

/* A colour, 0..255 in 8.24 with its half added, as 0..1 in Q16, modulo 2^32: what rounding leaves below 0 is made up for
 * by the smallest threshold. */
static EL_SPECIALISED uint32_t fraction_q16(uint32_t plus_half_q24)
{
    return (uint32_t)(((int32_t)(plus_half_q24 >> 16) - 0x80) * 257 >> 8);
}

/* A channel of a texel times light / 255, where 255 leaves it as it is. */
static EL_SPECIALISED uint32_t lit(uint32_t channel, uint32_t light, uint32_t threshold_q16, unsigned kind)
{
    return (kind & DITHER) != 0 ? el_dither(fraction_q16(light), channel, threshold_q16)
                                : (channel * ((light >> 24) + 1U)) >> 8;
}

static EL_SPECIALISED uint16_t modulate(uint32_t texel, const span *s, uint32_t threshold_q16, unsigned kind)
{
    return (uint16_t)(lit(texel >> 11, s->red, threshold_q16, kind) << 11 |
                      lit((texel >> 5) & 63U, s->green, threshold_q16, kind) << 5 |
                      lit(texel & 31U, s->blue, threshold_q16, kind));
}

static EL_SPECIALISED uint16_t coloured(const span *s, uint32_t threshold_q16, unsigned kind)
{
    if ((kind & DITHER) != 0) {
        return (uint16_t)(el_dither(fraction_q16(s->red), 31, threshold_q16) << 11 |
                          el_dither(fraction_q16(s->green), 63, threshold_q16) << 5 |
                          el_dither(fraction_q16(s->blue), 31, threshold_q16));
    }
    return (uint16_t)((s->red >> 27 << 11) | (s->green >> 26 << 5) | s->blue >> 27);
}

/* Whether the pixel at depth[i] is drawn; its depth is stored then. Without DEPTH there may be no such array. */
static EL_SPECIALISED bool passes(const span *s, uint16_t *depth, int32_t i, unsigned kind)
{
    if ((kind & DEPTH) == 0) {
        return true;
    }
    const uint32_t z = (uint32_t)(s->z >> 32); /* 0..65535: the plane stays within its corners' range */
    if (z >= depth[i]) {
        return false;
    }
    depth[i] = (uint16_t)z;
    return true;
}

/* The pixels of a row: where they are and where they go. */
typedef struct row {
    uint16_t *colour;
    uint16_t *depth;
    int32_t x, x_end;
    int32_t skipped; /* left of the screen */
} row;

/* In one colour or in the vertices' colours. Counting up to 0 from the row's end leaves one number to step. */
static EL_SPECIALISED void draw_coloured(const el_triangle *triangle, row r, unsigned kind)
{
    span s = span_begin(triangle, r.skipped, kind);
    const uint16_t flat = triangle->surface.colour;
    uint16_t *const colour = r.colour + r.x_end;
    uint16_t *const depth = r.depth + ((kind & DEPTH) != 0 ? r.x_end : 0);
    const uint32_t y = (uint32_t)triangle->y;
    for (int32_t i = r.x - r.x_end; i < 0; i++) {
        if (passes(&s, depth, i, kind)) {
            colour[i] =
                (kind & COLOURS) != 0 ? coloured(&s, el_dither_threshold_q16((uint32_t)(r.x_end + i), y), kind) : flat;
        }
        span_step(&s, kind);
    }
}

/* With a texture, in pieces along which texture coordinates are linear. */
static EL_SPECIALISED void draw_textured(const el_triangle *triangle, row r, unsigned kind)
{
    span s = span_begin(triangle, r.skipped, kind);
    const texel_source source = source_of(triangle->surface.texture);
    const uint32_t y = (uint32_t)triangle->y;
    el_texture_walk walk;
    el_texture_walk_begin(&walk, triangle, r.skipped);
    int32_t x = r.x;
    while (x < r.x_end) {
        const int32_t length = el_texture_walk_piece(&walk, r.x_end - x);
        x += length;
        uint16_t *const colour = r.colour + x;
        uint16_t *const depth = r.depth + ((kind & DEPTH) != 0 ? x : 0);
        uint32_t u_q16 = (uint32_t)walk.u_q16;
        uint32_t v_q16 = (uint32_t)walk.v_q16;
        const uint32_t u_step_q16 = (uint32_t)walk.u_step_q16;
        const uint32_t v_step_q16 = (uint32_t)walk.v_step_q16;
        for (int32_t i = -length; i < 0; i++) {
            if (passes(&s, depth, i, kind)) {
                const uint32_t texel = texel_at(&source, u_q16, v_q16);
                colour[i] = (kind & COLOURS) != 0
                                ? modulate(texel, &s, el_dither_threshold_q16((uint32_t)(x + i), y), kind)
                                : (uint16_t)texel;
            }
            span_step(&s, kind);
            u_q16 += u_step_q16;
            v_q16 += v_step_q16;
        }
    }
}

/* Overdraw: the picture counts. */
static EL_SPECIALISED void draw_count(row r)
{
    for (int32_t x = r.x; x < r.x_end; x++) {
        r.colour[x]++;
    }
}

/* The picture counts what the depth test rejects. */
static EL_SPECIALISED void draw_rejected(const el_triangle *triangle, row r)
{
    span s = span_begin(triangle, r.skipped, DEPTH);
    for (int32_t x = r.x; x < r.x_end; x++) {
        if (!passes(&s, r.depth, x, DEPTH)) {
            r.colour[x]++;
        }
        span_step(&s, DEPTH);
    }
}

/* A plane's way along the left edge: its whole step, and a pixel more where its fraction ran over. */
static EL_SPECIALISED void plane_next_row(el_plane *plane, bool carry)
{
    plane->value += plane->down;
    if (carry) {
        plane->value += plane->dx;
    }
}

static EL_SPECIALISED void channel_next_row(el_channel *channel, bool carry)
{
    channel->value += channel->down + (carry ? channel->dx : 0U);
}

static EL_SPECIALISED void next_row(el_triangle *triangle, unsigned kind)
{
    const uint32_t fraction = (uint32_t)triangle->left.x_q32;
    el_edge_next_row(&triangle->left);
    el_edge_next_row(&triangle->right);
    const bool carry = (uint32_t)triangle->left.x_q32 < fraction;
    if ((kind & DEPTH) != 0) {
        plane_next_row(&triangle->z, carry);
    }
    if ((kind & COLOURS) != 0) {
        channel_next_row(&triangle->rgb[0], carry);
        channel_next_row(&triangle->rgb[1], carry);
        channel_next_row(&triangle->rgb[2], carry);
    }
    if ((kind & TEXTURE) != 0) {
        plane_next_row(&triangle->perspective.w, carry);
        plane_next_row(&triangle->perspective.u, carry);
        plane_next_row(&triangle->perspective.v, carry);
    }
}

static void bend_plane(el_plane *plane, int32_t aside, int32_t steeper)
{
    plane->value += el_plane_times(plane->dx, aside);
    plane->down += el_plane_times(plane->dx, steeper);
}

/* The lower part begins: one edge gives way to the other, and the planes follow if it is the left one. */
static void bend(el_triangle *triangle, unsigned kind)
{
    if (!triangle->short_is_left) {
        triangle->right = triangle->lower;
        return;
    }
    const int32_t aside = el_edge_x(&triangle->lower) - el_edge_x(&triangle->left);
    const int32_t steeper = (int32_t)(triangle->lower.step_q32 >> 32) - (int32_t)(triangle->left.step_q32 >> 32);
    triangle->left = triangle->lower;
    if ((kind & DEPTH) != 0) {
        bend_plane(&triangle->z, aside, steeper);
    }
    for (unsigned i = 0; i < 3 && (kind & COLOURS) != 0; i++) {
        triangle->rgb[i].value += triangle->rgb[i].dx * (uint32_t)aside;
        triangle->rgb[i].down += triangle->rgb[i].dx * (uint32_t)steeper;
    }
    if ((kind & TEXTURE) != 0) {
        bend_plane(&triangle->perspective.w, aside, steeper);
        bend_plane(&triangle->perspective.u, aside, steeper);
        bend_plane(&triangle->perspective.v, aside, steeper);
    }
}

static EL_SPECIALISED void draw_rows(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind)
{
    const int32_t y_end = triangle->y_end < target->y_end ? triangle->y_end : target->y_end;
    const int32_t width = target->width;
    int32_t y = triangle->y;
    const int32_t offset = (y - target->y) * width;
    row r = {.colour = target->colour + offset, .depth = target->depth + ((kind & DEPTH) != 0 ? offset : 0)};
    uint32_t spans = 0;
    uint32_t pixels = 0;
    el_count(&stats->rows, (uint32_t)(y_end - y));
    while (y < y_end) {
        const int32_t left = el_edge_x(&triangle->left);
        const int32_t right = el_edge_x(&triangle->right);
        r.x = left < 0 ? 0 : left;
        r.skipped = r.x - left;
        r.x_end = right > width ? width : right;
        if (r.x < r.x_end) {
            spans++;
            pixels += (uint32_t)(r.x_end - r.x);
            if (EL_WITH_DEBUG_VIEWS && (kind & COUNT) != 0 && (kind & DEPTH) != 0) {
                draw_rejected(triangle, r);
            } else if ((kind & COUNT) != 0) {
                draw_count(r);
            } else if ((kind & TEXTURE) != 0) {
                draw_textured(triangle, r, kind);
            } else {
                draw_coloured(triangle, r, kind);
            }
        }
        next_row(triangle, kind);
        r.colour += width;
        r.depth += (kind & DEPTH) != 0 ? width : 0;
        y++;
        triangle->y = (int16_t)y;
        if (y == triangle->y_middle) {
            bend(triangle, kind);
        }
    }
    el_count(&stats->spans, spans);
    el_count(&stats->pixels, pixels);
}

static unsigned kind_of(const el_surface *surface)
{
    _Static_assert(EL_SHADE_GOURAUD << 1 == 2 && EL_SHADE_TEXTURED << 1 == 4 && EL_SHADE_OVERDRAW << 1 == 8,
                   "a shading's bits are those of its loop");
    const unsigned kind = (unsigned)surface->shading << 1 & (COLOURS | TEXTURE | COUNT);
    const bool dithers = surface->dither && (kind & COLOURS) != 0;
    const bool depth = surface->depth && (EL_WITH_DEBUG_VIEWS || (kind & COUNT) == 0);
    return kind | (dithers ? DITHER : 0U) | (depth ? DEPTH : 0U);
}

#if EL_SMALL_CODE
void el_triangle_draw(el_triangle *triangle, const el_target *target, el_stats *stats)
{
    draw_rows(triangle, target, stats, kind_of(&triangle->surface));
}
#else
#if EL_WITH_DEBUG_VIEWS
#define REJECTED(DO) DO(rejected, COUNT | DEPTH)
#else
#define REJECTED(DO)
#endif

/* A loop of its own for each kind there is, in a function of its own, so that none has the registers of another; kinds
 * that options.h makes equal have one. */
#define LOOPS(DO)                                                                                                      \
    DO(flat, 0)                                                                                                        \
    DO(flat_depth, DEPTH)                                                                                              \
    DO(coloured, COLOURS)                                                                                              \
    DO(coloured_depth, COLOURS | DEPTH)                                                                                \
    DO(dithered, COLOURS | DITHER)                                                                                     \
    DO(dithered_depth, COLOURS | DITHER | DEPTH)                                                                       \
    DO(textured, TEXTURE)                                                                                              \
    DO(textured_depth, TEXTURE | DEPTH)                                                                                \
    DO(lit, TEXTURE | COLOURS)                                                                                         \
    DO(lit_depth, TEXTURE | COLOURS | DEPTH)                                                                           \
    DO(lit_dithered, TEXTURE | COLOURS | DITHER)                                                                       \
    DO(lit_dithered_depth, TEXTURE | COLOURS | DITHER | DEPTH)                                                         \
    DO(count, COUNT)                                                                                                   \
    REJECTED(DO)

#define DEFINE(name, kind)                                                                                             \
    static __attribute__((noinline)) void rows_##name(el_triangle *triangle, const el_target *target, el_stats *stats) \
    {                                                                                                                  \
        draw_rows(triangle, target, stats, (kind));                                                                    \
    }
LOOPS(DEFINE)

#define CALL(name, kind)                                                                                               \
    if (asked == (kind)) {                                                                                             \
        rows_##name(triangle, target, stats);                                                                          \
        return;                                                                                                        \
    }

void el_triangle_draw(el_triangle *triangle, const el_target *target, el_stats *stats)
{
    const unsigned asked = kind_of(&triangle->surface);
    LOOPS(CALL)
}
#endif

void el_triangle_next_row(el_triangle *triangle)
{
    const unsigned kind = kind_of(&triangle->surface);
    next_row(triangle, kind);
    triangle->y++;
    if (triangle->y == triangle->y_middle) {
        bend(triangle, kind);
    }
}

void el_triangle_sample(const el_triangle *triangle, int32_t x, int32_t width, el_sample *sample)
{
    const unsigned kind = kind_of(&triangle->surface);
    const int32_t left = el_edge_x(&triangle->left);
    const int32_t begin = left < 0 ? 0 : left;
    const int32_t end = el_edge_x(&triangle->right) > width ? width : el_edge_x(&triangle->right);
    span s = span_begin(triangle, begin - left, kind);
    for (int32_t at = begin; at < x; at++) {
        span_step(&s, kind);
    }
    *sample = (el_sample){.z_plus_half_q16 = (kind & DEPTH) != 0 ? (uint32_t)(s.z >> 16) : 0U};
    if ((kind & COLOURS) != 0) {
        sample->rgb_plus_half_q24[0] = s.red;
        sample->rgb_plus_half_q24[1] = s.green;
        sample->rgb_plus_half_q24[2] = s.blue;
    }
    if ((kind & TEXTURE) == 0) {
        return;
    }
    el_texture_walk walk;
    el_texture_walk_begin(&walk, triangle, begin - left);
    int32_t at = begin;
    int32_t length = el_texture_walk_piece(&walk, end - at);
    while (x >= at + length) {
        at += length;
        length = el_texture_walk_piece(&walk, end - at);
    }
    sample->u_q16 = walk.u_q16 + (x - at) * walk.u_step_q16;
    sample->v_q16 = walk.v_q16 + (x - at) * walk.v_step_q16;
}
