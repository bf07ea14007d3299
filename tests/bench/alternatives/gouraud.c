/* Vertex colours along a span: three words, or two that carry three channels. What is recorded of a pixel is red, green
 * and blue, 8.24, half a unit added. */
#include "spans.h"

enum { VALUES = 3, RECORD_BYTES = PICTURES * PIXELS * VALUES * 4, ANCHOR = 16 };

static el_surface surface_of(const bench_case *self)
{
    (void)self;
    return (el_surface){.shading = EL_SHADE_GOURAUD};
}

/* Channels in 8.24 each, of which the upper bits are the pixel. */
BENCH_INLINE void put(const span_target *row, int32_t x, uint32_t red, uint32_t green, uint32_t blue)
{
    if (row->record != NULL) {
        row->record[VALUES * x] = (int32_t)red;
        row->record[VALUES * x + 1] = (int32_t)green;
        row->record[VALUES * x + 2] = (int32_t)blue;
    }
    row->colour[x] = (uint16_t)(red >> 27 << 11 | green >> 26 << 5 | blue >> 27);
}

/* 8.24 with its half added. */
BENCH_INLINE uint32_t channel_at(const el_triangle *triangle, unsigned i, int32_t x)
{
    return triangle->rgb[i].value + triangle->rgb[i].dx * (uint32_t)x;
}

/* The renderer's: 8.24 each, the step rounded to nearest. */
BENCH_INLINE void per_channel(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    uint32_t value[3];
    uint32_t step[3];
    for (unsigned i = 0; i < 3; i++) {
        value[i] = channel_at(triangle, i, x);
        step[i] = triangle->rgb[i].dx;
    }
    for (; x < x_end; x++) {
        put(row, x, value[0], value[1], value[2]);
        for (unsigned i = 0; i < 3; i++) {
            value[i] += step[i];
        }
    }
}

/* Red and blue 8.8 in one word, green 8.8 in another. A word is red * 2^16 + blue as a sum, so a falling blue borrows from
 * red what it gives back later; steps are rounded to 2^-8. */
typedef struct packed {
    uint32_t red_blue, green;
} packed;

BENCH_INLINE packed packed_at(const el_triangle *triangle, int32_t x)
{
    const uint32_t red = channel_at(triangle, 0, x);
    const uint32_t blue = channel_at(triangle, 2, x);
    return (packed){(red & 0xFFFF0000U) | blue >> 16, channel_at(triangle, 1, x) >> 16};
}

BENCH_INLINE packed packed_step(const el_triangle *triangle)
{
    uint32_t step[3];
    for (unsigned i = 0; i < 3; i++) {
        step[i] = (uint32_t)((int32_t)(triangle->rgb[i].dx + 0x8000U) >> 16);
    }
    return (packed){(step[0] << 16) + step[2], step[1]};
}

BENCH_INLINE void packed_pixels(const span_target *row, int32_t x, int32_t x_end, packed at, packed step)
{
    for (; x < x_end; x++) {
        put(row, x, at.red_blue & 0xFFFF0000U, at.green << 16, at.red_blue << 16);
        at.red_blue += step.red_blue;
        at.green += step.green;
    }
}

BENCH_INLINE void packed_words(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    packed_pixels(row, x, x_end, packed_at(triangle, x), packed_step(triangle));
}

/* The same, from the exact planes again every ANCHOR pixels. */
BENCH_INLINE void packed_anchored(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    const packed step = packed_step(triangle);
    while (x < x_end) {
        const int32_t end = x_end - x > ANCHOR ? x + ANCHOR : x_end;
        packed_pixels(row, x, end, packed_at(triangle, x), step);
        x = end;
    }
}

SPAN_CASE(per_channel, VALUES, per_channel)
SPAN_CASE(packed, VALUES, packed_words)
SPAN_CASE(packed_anchored, VALUES, packed_anchored)
SPAN_CASE(renderer, VALUES, NULL)

#define GOURAUD(name, record_bytes)                                                                                    \
    {                                                                                                                  \
        "gouraud", #name, name##_case, bench_colour, sizeof bench_colour, record_bytes, {0, TRIANGLES}, 0              \
    }

/* What the renderer does before rounding cannot be seen; its pixels are those of per_channel. */
const bench_case gouraud_cases[] = {
    GOURAUD(per_channel, RECORD_BYTES),
    GOURAUD(renderer, 0),
    GOURAUD(packed, RECORD_BYTES),
    GOURAUD(packed_anchored, RECORD_BYTES),
    {0},
};
