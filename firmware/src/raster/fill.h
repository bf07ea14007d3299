/* What the fills share: where pixels go, and what is linear on the screen. A fill draws the spans of some rows; edges are
 * behind it (spans.h). Private to this layer. */
#ifndef EL_RASTER_FILL_H
#define EL_RASTER_FILL_H

#include "raster/spans.h"

/* What a fill does: bits of a number that the compiler knows, so that each loop holds only what it needs. What options.h
 * leaves out has no bit. */
enum {
    EL_FILL_DEPTH = 1,
    EL_FILL_COLOURS = EL_WITH_GOURAUD ? 2 : 0,
    EL_FILL_TEXTURE = EL_WITH_TEXTURE ? 4 : 0,
    EL_FILL_COUNT = EL_WITH_OVERDRAW ? 8 : 0,
    EL_FILL_DITHER = EL_FINISH_DITHER,
    EL_FILL_MIXED = EL_FINISH_MIXED /* another loop for all of the above (fill_mixed.c) */
};

static inline uint8_t el_fill_kind(const el_surface *surface)
{
    _Static_assert(EL_SHADE_GOURAUD << 1 == 2 && EL_SHADE_TEXTURED << 1 == 4 && EL_SHADE_OVERDRAW << 1 == 8,
                   "a shading's bits are those of its fill");
    const unsigned kind = (unsigned)surface->shading << 1 & (EL_FILL_COLOURS | EL_FILL_TEXTURE | EL_FILL_COUNT);
    const bool depth = surface->depth && (EL_WITH_DEBUG_VIEWS || (kind & EL_FILL_COUNT) == 0);
    const unsigned finish = surface->finish & (EL_FILL_DITHER | EL_FILL_MIXED);
    return (uint8_t)(kind | finish | (depth ? EL_FILL_DEPTH : 0U));
}

/* Draws the next rows of a triangle with a texture in the target, EL_SPAN_ROWS at most, and returns how many they are. */
int32_t el_fill_textured(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind);

#if EL_WITH_MIXED
/* The same for a triangle of any kind that is mixed. */
int32_t el_fill_mixed(el_triangle *triangle, const el_target *target, el_stats *stats, unsigned kind);
#endif

/* A walk along rows of pixels: through the depth where there is a test, else through the colour. The colour lies at a fixed
 * distance in bytes, so that one register leads to both. */
typedef struct el_cursor {
    uint16_t *row;
    uintptr_t to_colour;
} el_cursor;

static EL_SPECIALISED el_cursor el_cursor_at(const el_target *target, int32_t y, unsigned kind)
{
    uint16_t *const walked = (kind & EL_FILL_DEPTH) != 0 ? target->depth : target->colour;
    return (el_cursor){
        .row = walked + (y - target->y) * target->width,
        .to_colour = (uintptr_t)target->colour - (uintptr_t)walked,
    };
}

static EL_SPECIALISED uint16_t *el_colour_at(const el_cursor *cursor, uint16_t *at)
{
    /* Of another array: a sum of numbers, as pointers have no distance. NOLINTNEXTLINE(performance-no-int-to-ptr) */
    return (uint16_t *)((uintptr_t)at + cursor->to_colour);
}

/* Of the rows that el_spans_next counted as spans, one has no pixel. */
static inline void el_count_empty(el_stats *stats)
{
    el_count(&stats->spans, 0U - 1U);
}

/* Rounding to nearest at the end is made once, at the start. Depth gets the bound of its plane's error more than its half
 * (plane.h): values exactly between two units, which truncated gradients leave a little too low, are rounded up like all
 * others. */
#define EL_HALF_Q32 ((1ULL << 31) + (1U << 13)) /* of depth, Q32 */

/* What is linear on the screen, texture coordinates apart: the values at a pixel, or what a column or a row adds to them.
 * Depth is stepped with all 32 bits of fraction: on a 32-bit core that costs one addition more than 16.16 and saves the
 * shift, and it makes the plane exact at every pixel of the widest screen. */
typedef struct el_values {
    uint64_t z;                /* Q32, its half added */
    uint32_t red, green, blue; /* 8.24 modulo 2^32, their half added */
} el_values;

/* In the first column of the triangle's next row, and what moves them. */
typedef struct el_slopes {
    el_values first, per_column, per_row;
} el_slopes;

static EL_SPECIALISED el_slopes el_slopes_of(const el_triangle *triangle, unsigned kind)
{
    el_slopes s;
    if ((kind & EL_FILL_DEPTH) != 0) {
        s.first.z = triangle->z.value + EL_HALF_Q32;
        s.per_column.z = triangle->z.dx;
        s.per_row.z = triangle->z.dy;
    }
    if ((kind & EL_FILL_COLOURS) != 0) {
        const el_channel *const rgb = triangle->rgb;
        s.first.red = rgb[0].value;
        s.first.green = rgb[1].value;
        s.first.blue = rgb[2].value;
        s.per_column.red = rgb[0].dx;
        s.per_column.green = rgb[1].dx;
        s.per_column.blue = rgb[2].dx;
        s.per_row.red = rgb[0].dy;
        s.per_row.green = rgb[1].dy;
        s.per_row.blue = rgb[2].dy;
    }
    return s;
}

/* Back to the triangle, whose next row they are the values of now, if it has one. */
static EL_SPECIALISED void el_slopes_keep(const el_slopes *s, el_triangle *triangle, unsigned kind)
{
    if (el_triangle_is_done(triangle)) {
        return;
    }
    if ((kind & EL_FILL_DEPTH) != 0) {
        triangle->z.value = s->first.z - EL_HALF_Q32;
    }
    if ((kind & EL_FILL_COLOURS) != 0) {
        triangle->rgb[0].value = s->first.red;
        triangle->rgb[1].value = s->first.green;
        triangle->rgb[2].value = s->first.blue;
    }
}

static inline void el_perspective_next_row(el_perspective *perspective)
{
    perspective->w.value += perspective->w.dy;
    perspective->u.value += perspective->u.dy;
    perspective->v.value += perspective->v.dy;
}

/* One step. */
static EL_SPECIALISED void el_values_add(el_values *values, const el_values *step, unsigned kind)
{
    if ((kind & EL_FILL_DEPTH) != 0) {
        values->z += step->z;
    }
    if ((kind & EL_FILL_COLOURS) != 0) {
        values->red += step->red;
        values->green += step->green;
        values->blue += step->blue;
    }
}

/* The values in column x of the row, 0 <= x < 2^16. */
static EL_SPECIALISED el_values el_values_at(const el_slopes *s, int32_t x, unsigned kind)
{
    const uint32_t columns = (uint32_t)x;
    el_values values;
    if ((kind & EL_FILL_DEPTH) != 0) {
        values.z = s->first.z + el_multiply_u16(s->per_column.z, columns);
    }
    if ((kind & EL_FILL_COLOURS) != 0) {
        values.red = s->first.red + s->per_column.red * columns;
        values.green = s->first.green + s->per_column.green * columns;
        values.blue = s->first.blue + s->per_column.blue * columns;
    }
    return values;
}

/* Thumb-2 has conditional instructions, which take their time whether they do something or not: a pixel that is hidden jumps
 * over its stores instead. On Thumb-1 what is behind a branch is kept from being done before it. */
#if defined(__thumb__)
#define EL_KEEP_BRANCH() __asm__ volatile("")
#else
#define EL_KEEP_BRANCH() ((void)0)
#endif

/* In a loop that adds to it: a compiler does not know beforehand where it arrives, which it makes a long product of. With
 * Thumb-2 it may: it does not, and is free to load and step in one. */
#if !defined(__thumb2__)
#define EL_ADD_UP(value) EL_SETTLE(value)
#else
#define EL_ADD_UP(value) ((void)(value))
#endif

/* RGB565. */
static EL_SPECIALISED uint32_t el_coloured(const el_values *values)
{
    uint32_t colour = values->red >> 27 << 6;
    EL_SETTLE(colour);
    colour = (colour | values->green >> 26) << 5;
    EL_SETTLE(colour);
    return colour | values->blue >> 27;
}

/* Whether the pixel is drawn, by the depth that is there; its own is stored then. */
static EL_SPECIALISED bool el_passes(const el_values *values, uint16_t *depth, unsigned kind)
{
    if ((kind & EL_FILL_DEPTH) == 0) {
        return true;
    }
    const uint32_t z = (uint32_t)(values->z >> 32); /* 0..65535: the plane stays within its corners' range */
    if (z >= *depth) {
        return false;
    }
    EL_KEEP_BRANCH();
    *depth = (uint16_t)z;
    return true;
}

/* A colour, 0..255 in 8.24 with its half added, as 0..1 in Q16, modulo 2^32: what rounding leaves below 0 is made up for
 * by the smallest threshold. */
static EL_SPECIALISED uint32_t el_fraction_q16(uint32_t plus_half_q24)
{
    const int32_t colour_q16 = (int32_t)(plus_half_q24 >> 16) - 0x80;
    return (uint32_t)(colour_q16 + (colour_q16 >> 8)); /* times 257 / 256 */
}

#endif
