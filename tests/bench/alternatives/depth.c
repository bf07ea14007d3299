/* Depth along a span, tested and written: stepped in 32 or 64 bits, or evaluated anew at each pixel. */
#include "spans.h"

static el_surface surface_of(const bench_case *self)
{
    (void)self;
    return (el_surface){.shading = EL_SHADE_FLAT, .depth = true, .colour = 1};
}

BENCH_INLINE void test_and_write(const span_target *row, int32_t x, uint32_t z)
{
    if (z < row->depth[x]) {
        row->depth[x] = (uint16_t)z;
        row->colour[x] = 1;
    }
}

BENCH_INLINE void step_q16(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end,
                           uint32_t rounding)
{
    const el_plane *const plane = &triangle->z;
    uint32_t z_q16 = (uint32_t)(plane_at(&triangle->z, x) >> 16) + 0x8000U;
    const uint32_t step_q16 = (uint32_t)((plane->dx + rounding) >> 16);
    for (; x < x_end; x++) {
        test_and_write(row, x, z_q16 >> 16);
        z_q16 += step_q16;
    }
}

/* 16.16 from the exact row, the step rounded to nearest. */
BENCH_INLINE void rounded_step(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    step_q16(triangle, row, x, x_end, 0x8000U);
}

BENCH_INLINE void floored_step(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    step_q16(triangle, row, x, x_end, 0);
}

/* The renderer's: all of the plane's fraction; the plane's error is added to the half. */
BENCH_INLINE void wide_step(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    const el_plane *const plane = &triangle->z;
    uint64_t z_q32 = plane_at(&triangle->z, x) + (1ULL << 31) + (1U << 13);
    for (; x < x_end; x++) {
        test_and_write(row, x, (uint32_t)(z_q32 >> 32));
        z_q32 += plane->dx;
    }
}

BENCH_INLINE void evaluated(const el_triangle *triangle, const span_target *row, int32_t x, int32_t x_end)
{
    for (; x < x_end; x++) {
        /* Hidden from the compiler, which would make a sum of the product. */
        int32_t column = x;
        __asm__("" : "+r"(column));
        test_and_write(row, x, (uint32_t)((plane_at(&triangle->z, column) + (1ULL << 31)) >> 32));
    }
}

SPAN_CASE(rounded_step, 0, rounded_step)
SPAN_CASE(floored_step, 0, floored_step)
SPAN_CASE(wide_step, 0, wide_step)
SPAN_CASE(evaluated, 0, evaluated)
SPAN_CASE(renderer, 0, NULL)

#define DEPTH(name)                                                                                                    \
    {                                                                                                                  \
        "depth", #name, name##_case, bench_depth, sizeof bench_depth, 0, {0, TRIANGLES}, 0                             \
    }

const bench_case depth_cases[] = {
    DEPTH(wide_step), DEPTH(renderer), DEPTH(rounded_step), DEPTH(floored_step), DEPTH(evaluated), {0},
};
