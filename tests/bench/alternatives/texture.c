/* Texture coordinates along a span: pieces as short as a bound asks for (the renderer's), pieces of a fixed length, none,
 * or a division per pixel. What is recorded of a pixel is u and v in Q16 texels. */
#include "base/divide.h"
#include "raster/texture_walk.h"
#include "spans.h"

enum { VALUES = 2, RECORD_BYTES = PICTURES * PIXELS * VALUES * 4 };

/* The renderer fetches from it too, so it is a real one: 64 x 64, each texel its own index. */
enum { TEXELS_LOG2 = 6, TEXELS = 1 << (2 * TEXELS_LOG2) };
static uint16_t texels[TEXELS];
static const el_texture texture = {.texels = texels, .width_log2 = TEXELS_LOG2, .height_log2 = TEXELS_LOG2};

BENCH_INLINE void put(const el_triangle *triangle, const span_target *row, int32_t x, uint32_t u_q16, uint32_t v_q16)
{
    const el_texture *const from = triangle->surface.texture;
    if (row->record != NULL) {
        row->record[VALUES * x] = (int32_t)u_q16;
        row->record[VALUES * x + 1] = (int32_t)v_q16;
    }
    const uint32_t column = (u_q16 >> 16) & ((1U << from->width_log2) - 1U);
    const uint32_t line = (v_q16 >> 16) & ((1U << from->height_log2) - 1U);
    row->colour[x] = from->texels[(line << from->width_log2) + column];
}

BENCH_INLINE void linear(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end, int32_t u_q16,
                         int32_t v_q16, int32_t u_step_q16, int32_t v_step_q16)
{
    uint32_t u = (uint32_t)u_q16;
    uint32_t v = (uint32_t)v_q16;
    for (; x < x_end; x++) {
        put(triangle, row, x, u, v);
        u += (uint32_t)u_step_q16;
        v += (uint32_t)v_step_q16;
    }
}

BENCH_INLINE void bounded(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    el_texture_walk walk;
    el_texture_walk_start(&walk, triangle);
    el_texture_walk_begin(&walk, &triangle->perspective, (uint32_t)x, (uint32_t)(x_end - x));
    uint32_t at = 0;
    while (x < x_end - 1) {
        const uint32_t length = el_texture_walk_piece(&walk, at, (uint32_t)(x_end - 1 - x));
        const int32_t piece_end = x + (int32_t)length;
        linear(triangle, row, x, piece_end, walk.u.q16, walk.v.q16, walk.u.step_q16, walk.v.step_q16);
        at += length;
        x = piece_end;
    }
    el_texture_walk_last(&walk);
    linear(triangle, row, x, x_end, walk.u.q16, walk.v.q16, 0, 0);
}

typedef struct coordinates {
    int32_t u_q16, v_q16;
} coordinates;

/* base + (U << shift) / W at pixel x: one reciprocal, two quotients. */
static coordinates divided(const el_triangle *triangle, int32_t x)
{
    const uint64_t half = 1ULL << 31;
    const uint32_t w = (uint32_t)((plane_at(&triangle->perspective.w, x) + half) >> 32);
    const int32_t u = (int32_t)(uint32_t)((plane_at(&triangle->perspective.u, x) + half) >> 32);
    const int32_t v = (int32_t)(uint32_t)((plane_at(&triangle->perspective.v, x) + half) >> 32);
    const el_divisor by = el_divisor_make(w);
    return (coordinates){
        triangle->perspective.u_base_q16 + el_divide_floor_i64(u * ((int64_t)1 << triangle->perspective.u_shift), &by),
        triangle->perspective.v_base_q16 + el_divide_floor_i64(v * ((int64_t)1 << triangle->perspective.v_shift), &by),
    };
}

/* Exact at both ends of pieces of 2^length_log2 pixels and of the span. */
BENCH_INLINE void fixed(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end, int32_t length)
{
    coordinates from = divided(triangle, x);
    while (x_end - x > length) {
        const coordinates to = divided(triangle, x + length);
        linear(triangle, row, x, x + length, from.u_q16, from.v_q16, (to.u_q16 - from.u_q16) / length,
               (to.v_q16 - from.v_q16) / length);
        x += length;
        from = to;
    }
    const int32_t rest = x_end - 1 - x;
    const coordinates to = rest == 0 ? from : divided(triangle, x_end - 1);
    const int32_t steps = rest == 0 ? 1 : rest;
    linear(triangle, row, x, x_end, from.u_q16, from.v_q16, (to.u_q16 - from.u_q16) / steps,
           (to.v_q16 - from.v_q16) / steps);
}

BENCH_INLINE void fixed_16(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    fixed(triangle, row, x, x_end, 16);
}

BENCH_INLINE void fixed_8(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    fixed(triangle, row, x, x_end, 8);
}

BENCH_INLINE void affine(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    fixed(triangle, row, x, x_end, WIDTH);
}

BENCH_INLINE void per_pixel(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    for (; x < x_end; x++) {
        const coordinates at = divided(triangle, x);
        put(triangle, row, x, (uint32_t)at.u_q16, (uint32_t)at.v_q16);
    }
}

static el_surface surface_of(const bench_case *self)
{
    for (unsigned i = 0; i < TEXELS; i++) {
        texels[i] = (uint16_t)i;
    }
    return (el_surface){.shading = EL_SHADE_TEXTURED, .uv_error_log2 = self->uv_error_log2, .texture = &texture};
}

SPAN_CASE(bounded, VALUES, bounded)
SPAN_CASE(affine, VALUES, affine)
SPAN_CASE(fixed16, VALUES, fixed_16)
SPAN_CASE(fixed8, VALUES, fixed_8)
SPAN_CASE(per_pixel, VALUES, per_pixel)
SPAN_CASE(renderer, VALUES, NULL)

#define ROW(group, name, run, bytes, uv_error_log2, begin, end)                                                        \
    {                                                                                                                  \
        group, name, run, bench_colour, sizeof bench_colour, bytes, {begin, end}, uv_error_log2                        \
    }

/* What pays on a wall need not pay on a fine mesh, whose spans are a few pixels short. */
#define GROUP(group, begin, end)                                                                                       \
    ROW(group, "bound8", bounded_case, RECORD_BYTES, 3, begin, end),                                                   \
        ROW(group, "renderer", renderer_case, 0, 3, begin, end),                                                       \
        ROW(group, "bound2", bounded_case, RECORD_BYTES, 1, begin, end),                                               \
        ROW(group, "bound4", bounded_case, RECORD_BYTES, 2, begin, end),                                               \
        ROW(group, "bound16", bounded_case, RECORD_BYTES, 4, begin, end),                                              \
        ROW(group, "bound32", bounded_case, RECORD_BYTES, 5, begin, end),                                              \
        ROW(group, "affine", affine_case, RECORD_BYTES, 3, begin, end),                                                \
        ROW(group, "fixed16", fixed16_case, RECORD_BYTES, 3, begin, end),                                              \
        ROW(group, "fixed8", fixed8_case, RECORD_BYTES, 3, begin, end),                                                \
        ROW(group, "per_pixel", per_pixel_case, RECORD_BYTES, 3, begin, end)

const bench_case texture_cases[] = {
    GROUP("texture_walls", SMALL_TRIANGLES, SMALL_TRIANGLES + WALL_TRIANGLES),
    GROUP("texture_steep", SMALL_TRIANGLES + WALL_TRIANGLES, TRIANGLES),
    GROUP("texture_small", 0, SMALL_TRIANGLES),
    {0},
};
