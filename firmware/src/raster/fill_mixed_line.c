/* What fill_mixed.c draws, where speed counts: pieces of a span, which become what they are in a line, one property after
 * another - texels, light, fog - and are then mixed with what is there. Each property is a loop of its own: a pixel pays for
 * those it has, loops add up where properties would multiply, and each has the registers that it needs. What is opaque is
 * made in its place on the screen. What the depth test hides is known before: it costs neither texel nor fog. */
#include "raster/fill_mixed.h"

#include "base/fill.h"
#include "base/fixed.h"
#include "raster/depth_row.h"

#if EL_WITH_MIXED && !EL_SMALL_CODE

/* Pieces that are gathered until they are as long as one can be are less than two. */
enum { LINE = 2 * EL_MAX_PIECE };

/* A stretch of pixels that pass the depth test, 1 to LINE. */
typedef struct stretch {
    uint32_t y, x, count;
    uint16_t *pixels, *depth; /* on the screen */
    uint16_t *colour;         /* where it is made */
} stretch;

/* --- What they are made of ----------------------------------------------------------------------------------------------- */

static inline void fill_line(uint16_t *colour, uint16_t value, uint32_t count)
{
    const uint16_t *const end = colour + count;
    do {
        *colour++ = value;
    } while (colour != end);
}

static EL_APART void colour_plain(const el_mixed_brush *b, const stretch *s)
{
    el_values v = el_values_at(&b->slopes, (int32_t)s->x, EL_FILL_COLOURS);
    uint16_t *colour = s->colour;
    const uint16_t *const end = colour + s->count;
    do {
        *colour = (uint16_t)el_coloured(&v);
        el_values_add(&v, &b->slopes.per_column, EL_FILL_COLOURS);
    } while (++colour != end);
}

static EL_APART void shade_plain(const el_mixed_brush *b, const stretch *s)
{
    el_light_row(&b->slopes, s->y, s->x, s->colour, s->colour + s->count, EL_FILL_COLOURS);
}

static EL_APART void shade_dithered(const el_mixed_brush *b, const stretch *s)
{
    el_light_row(&b->slopes, s->y, s->x, s->colour, s->colour + s->count, EL_FILL_COLOURS | EL_FILL_DITHER);
}

/* Leading zeros of x >= 1, which are `last` mostly: depth goes on by little from pixel to pixel. */
static inline uint32_t zeros_like(uint32_t x, uint32_t last)
{
#if !defined(__ARM_FEATURE_CLZ)
    if (x >> (31U - last) == 1) {
        return last;
    }
#endif
    (void)last;
    return el_leading_zeros(x);
}

static EL_APART void add_fog(const el_mixed_brush *b, const stretch *s)
{
    const el_fog *const fog = b->fog;
    const uint16_t fog_colour = fog->colour;
    const uint64_t z_step = b->slopes.per_column.z;
    uint64_t z = el_values_at(&b->slopes, (int32_t)s->x, EL_FILL_DEPTH).z;
    uint16_t *colour = s->colour;
    const uint16_t *const end = colour + s->count;
    uint32_t leading = 0;
    do {
        const uint32_t nearness = fog->scale_q12 - ((uint32_t)(z >> 32) << 12);
        leading = zeros_like(nearness, leading);
        const uint32_t alpha = el_fog_at_place(fog, el_fog_place_of(nearness, leading));
        if (alpha != 0) {
            *colour = el_rgb565_blend(*colour, fog_colour, alpha);
        }
        z += z_step;
    } while (++colour != end);
}

/* --- How they come to the screen ----------------------------------------------------------------------------------------- */

/* Two pixels at a time, from a word's begin on; the line of colours has its words where the screen has. */
static EL_APART void blend(const el_mixed_brush *b, const stretch *s)
{
    const uint32_t alpha = b->alpha;
    const uint16_t *colour = s->colour;
    uint16_t *pixel = s->pixels;
    uint32_t count = s->count;
    if (((uintptr_t)pixel & 2U) != 0) {
        *pixel = el_rgb565_blend(*pixel, *colour, alpha);
        pixel++;
        colour++;
        count--;
    }
    el_word *word = (el_word *)(void *)pixel;
    const el_word *colours = (const el_word *)(const void *)colour;
    for (const el_word *const end = word + count / 2U; word != end; word++) {
        *word = el_rgb565_blend_pair(*word, *colours++, alpha);
    }
    if ((count & 1U) != 0) {
        pixel[count - 1U] = el_rgb565_blend(pixel[count - 1U], colour[count - 1U], alpha);
    }
}

/* One colour over `count` pixels, its share a constant; two at a time, from a word's begin on. */
static EL_APART void blend_colour(uint16_t *pixel, uint32_t count, uint16_t colour, uint32_t alpha)
{
    const uint32_t rest = 256U - alpha;
    const uint32_t red = el_rgb565_share(colour >> 11, alpha);
    const uint32_t green = el_rgb565_share(colour >> 5 & 63U, alpha);
    const uint32_t blue = el_rgb565_share(colour & 31U, alpha);
    if (((uintptr_t)pixel & 2U) != 0) {
        *pixel = el_rgb565_blend(*pixel, colour, alpha);
        pixel++;
        count--;
    }
    el_word *word = (el_word *)(void *)pixel;
    for (const el_word *const end = word + count / 2U; word != end; word++) {
        *word = el_rgb565_blend_shares(*word, rest, red, green, blue);
    }
    if ((count & 1U) != 0) {
        pixel[count - 1U] = el_rgb565_blend(pixel[count - 1U], colour, alpha);
    }
}

static EL_SPECIALISED void show(const el_mixed_brush *b, const stretch *s, const uint16_t *shown, bool is_tested,
                                bool writes)
{
    const uint64_t z_step = b->slopes.per_column.z;
    uint64_t z = writes ? el_values_at(&b->slopes, (int32_t)s->x, EL_FILL_DEPTH).z : 0U;
    const uint16_t *colour = s->colour;
    uint16_t *pixel = s->pixels;
    uint16_t *depth = s->depth;
    const uint16_t *const end = pixel + s->count;
    do {
        const uint32_t part = is_tested ? *shown++ : (*shown++ * b->alpha + 128U) >> 8;
        if (part >= (is_tested ? 128U : 1U)) {
            *pixel = is_tested ? *colour : el_rgb565_blend(*pixel, *colour, part);
            if (writes) {
                *depth = (uint16_t)(z >> 32);
            }
        }
        colour++;
        if (writes) {
            depth++;
            z += z_step;
        }
    } while (++pixel != end);
}

static EL_APART void test(const el_mixed_brush *b, const stretch *s, const uint16_t *shown)
{
    show(b, s, shown, true, false);
}

static EL_APART void test_and_write(const el_mixed_brush *b, const stretch *s, const uint16_t *shown)
{
    show(b, s, shown, true, true);
}

static EL_APART void blend_shown(const el_mixed_brush *b, const stretch *s, const uint16_t *shown)
{
    show(b, s, shown, false, false);
}

static EL_APART void blend_and_write(const el_mixed_brush *b, const stretch *s, const uint16_t *shown)
{
    show(b, s, shown, false, true);
}

/* --- Stretches ------------------------------------------------------------------------------------------------------------ */

/* Its colours but for texels, which are there already. */
static void finish_colours(const el_mixed_brush *b, const stretch *s)
{
    const bool has_texels = (b->kind & EL_FILL_TEXTURE) != 0;
    const bool has_colours = (b->kind & EL_FILL_COLOURS) != 0;
    const bool is_dithered = (b->kind & EL_FILL_DITHER) != 0;
    if (!has_texels && (!has_colours || is_dithered)) {
        fill_line(s->colour, has_colours ? 0xFFFF : b->flat, s->count);
    }
    if (is_dithered) {
        shade_dithered(b, s);
    } else if (has_colours && has_texels) {
        shade_plain(b, s);
    } else if (has_colours) {
        colour_plain(b, s);
    }
    if (b->fog != NULL) {
        add_fog(b, s);
    }
}

/* Of what has no texels all shows alike. */
static void draw_plain_stretch(const el_mixed_brush *b, const stretch *s)
{
    const bool is_flat = (b->kind & EL_FILL_COLOURS) == 0 && b->fog == NULL;
    if (b->way == EL_MIXED_BLENDED && is_flat) {
        blend_colour(s->pixels, s->count, b->flat, b->alpha);
        return;
    }
    finish_colours(b, s);
    if (b->way == EL_MIXED_BLENDED) {
        blend(b, s);
    }
}

static void draw_textured_stretch(const el_mixed_brush *b, const stretch *s, const uint16_t *shown)
{
    const bool writes = b->writes_depth && (b->kind & EL_FILL_DEPTH) != 0;
    finish_colours(b, s);
    if (b->way == EL_MIXED_BLENDED) {
        blend(b, s);
    } else if (b->way == EL_MIXED_TESTED) {
        writes ? test_and_write(b, s, shown) : test(b, s, shown);
    } else if (b->way == EL_MIXED_SHOWN) {
        writes ? blend_and_write(b, s, shown) : blend_shown(b, s, shown);
    }
}

/* --- Spans --------------------------------------------------------------------------------------------------------------- */

/* What of a span is seen, run by run; `end` of one that begins at its end is that, too. */
typedef struct runs {
    el_depth_row depth;
    uint32_t begin, end;
} runs;

static inline void go_on(runs *r, const el_mixed_brush *b)
{
    r->begin = r->end + el_depth_row_skip(&r->depth);
    const bool takes = b->writes_depth && b->way <= EL_MIXED_BLENDED; /* all that passes is drawn */
    r->end = r->begin + (takes ? el_depth_row_take(&r->depth) : el_depth_row_pass(&r->depth));
}

/* Where there is no test, all is. */
static inline void begin_runs(runs *r, const el_mixed_brush *b, const el_mixed_span *span)
{
    const uint32_t x = span->x;
    const uint32_t x_end = span->x_end;
    r->begin = x;
    r->end = x_end;
    if ((b->kind & EL_FILL_DEPTH) != 0) {
        el_depth_row_begin(&r->depth, span->depth + x, x_end - x, el_values_at(&b->slopes, (int32_t)x, EL_FILL_DEPTH).z,
                           b->slopes.per_column.z);
        r->end = x;
        go_on(r, b);
    }
}

/* Where a stretch's colours are made: in their place, or in a line. */
static inline uint16_t *colours_of(const el_mixed_brush *b, uint16_t *pixels, uint16_t *line)
{
    return b->way == EL_MIXED_OPAQUE ? pixels : line + ((uintptr_t)pixels >> 1 & 1U);
}

static EL_APART void draw_plain(const el_mixed_brush *b, const el_mixed_span *span)
{
    const uint32_t x_end = span->x_end;
    _Alignas(4) uint16_t line[LINE + 1];
    runs r;
    begin_runs(&r, b, span);
    while (r.begin < x_end) {
        const uint32_t count = r.end - r.begin < LINE ? r.end - r.begin : LINE;
        uint16_t *const pixels = span->row + r.begin;
        const stretch s = {span->y, r.begin, count, pixels, NULL, colours_of(b, pixels, line)};
        draw_plain_stretch(b, &s);
        r.begin += count;
        if (r.begin == r.end && r.begin < x_end) {
            go_on(&r, b);
        }
    }
}

/* Makes the piece from x on, along which texture coordinates are linear, in a span that begins `at` pixels before. */
static inline uint32_t piece_from(el_texture_walk *walk, uint32_t x, uint32_t at, uint32_t x_end)
{
    const uint32_t last = x_end - 1U;
    if (x < last) {
        return el_texture_walk_piece(walk, at, last - x);
    }
    el_texture_walk_last(walk);
    return 1;
}

static inline void draw_texels(el_mixed_brush *b, uint16_t *colour, uint16_t *shown, uint32_t count)
{
    const el_texel_row row = {.u_q16 = (uint32_t)b->walk.u.q16,
                              .v_q16 = (uint32_t)b->walk.v.q16,
                              .u_step_q16 = (uint32_t)b->walk.u.step_q16,
                              .v_step_q16 = (uint32_t)b->walk.v.step_q16,
                              .colour = colour,
                              .count = count};
    el_texel_line_draw(&b->texels, &row, shown);
}

/* Texels come piece by piece; what is seen of some pieces is a stretch. */
static EL_APART void draw_textured(el_mixed_brush *b, const el_mixed_span *span, const el_perspective *planes)
{
    const uint32_t begin = span->x;
    const uint32_t x_end = span->x_end;
    _Alignas(4) uint16_t line[LINE + 1];
    uint16_t shown[LINE];
    runs r;
    begin_runs(&r, b, span);
    if (r.begin == x_end) {
        return;
    }
    el_texture_walk_begin(&b->walk, planes, begin, x_end - begin);
    uint32_t x = begin;
    uint32_t drawn = r.begin; /* up to there */
    while (r.begin < x_end) {
        const uint32_t piece_end = x + piece_from(&b->walk, x, x - begin, x_end);
        while (drawn < piece_end) {
            const uint32_t end = r.end < piece_end ? r.end : piece_end;
            uint16_t *const pixels = span->row + r.begin;
            uint16_t *const colour = colours_of(b, pixels, line);
            el_texture_walk_skip(&b->walk, drawn - x);
            draw_texels(b, colour + (drawn - r.begin), shown + (drawn - r.begin), end - drawn);
            x = drawn;
            drawn = end;
            if (drawn == r.end || drawn - r.begin >= EL_MAX_PIECE) {
                const stretch s = {span->y, r.begin, drawn - r.begin, pixels, span->depth + r.begin, colour};
                draw_textured_stretch(b, &s, shown);
                r.begin = drawn;
                if (drawn == r.end && drawn < x_end) {
                    go_on(&r, b);
                    drawn = r.begin;
                }
            }
        }
        x = piece_end;
    }
}

void el_mixed_draw_span(el_mixed_brush *b, const el_mixed_span *span, const el_perspective *planes)
{
    if ((b->kind & EL_FILL_TEXTURE) != 0) {
        draw_textured(b, span, planes);
    } else {
        draw_plain(b, span);
    }
}
#endif
