/* The knots of a texture's walk against exact quotients: planes are made by hand here, so that W and U can lie at the very
 * bounds of what set-up makes and of what its rounding leaves. */
#include <stdlib.h>

#include "raster/texture_walk.h"
#include "seeded.h"
#include "unity.h"
#include "wide.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* What texture_walk.c states of a knot, in units of 2^-16 texel. */
enum { KNOT_ERROR = 3 };

/* What u is at a knot where its planes have these values; v has them with the other sign. */
static void check_knot(const seeded *s, uint64_t w_q32, int64_t u_q32, uint8_t shift, int32_t base_q16)
{
    el_triangle triangle = {.surface = {.uv_error_log2 = 3}};
    triangle.perspective = (el_perspective){
        .w = {.value = w_q32},
        .u = {.value = (uint64_t)u_q32},
        .v = {.value = 0U - (uint64_t)u_q32},
        .u_base_q16 = base_q16,
        .v_base_q16 = base_q16,
        .u_shift = shift,
        .v_shift = shift,
    };
    el_texture_walk walk;
    el_texture_walk_start(&walk, &triangle);
    el_texture_walk_begin(&walk, &triangle.perspective, 0, 1);
    /* 2^shift U / W with 8 more bits of fraction, W as it is taken. */
    const int64_t offset_q24 =
        (int64_t)wide_quotient(wide_left(wide_of(u_q32), shift + 8U), (int64_t)(w_q32 + EL_W_MARGIN_Q32)).low;
    const int32_t found[2] = {walk.u.next_q16, walk.v.next_q16};
    for (unsigned i = 0; i < 2; i++) {
        const int64_t exact_q24 = (int64_t)base_q16 * 256 + (i == 0 ? offset_q24 : -offset_q24);
        if (llabs(found[i] * 256LL - exact_q24) >= KNOT_ERROR * 256) {
            fail_at(s, "W %016llx U %016llx shift %u base %ld: %c is %ld, not %lld / 256", (unsigned long long)w_q32,
                    (unsigned long long)u_q32, shift, (long)base_q16, "uv"[i], (long)found[i], (long long)exact_q24);
        }
    }
}

/* 1/w at a covered pixel: 1 to 2^31 - 1, any fraction. */
static uint64_t any_w(seeded *s)
{
    return (1ULL << 32) + any_of_bits(s, 63) % ((1ULL << 63) - (2ULL << 32));
}

static uint8_t any_shift(seeded *s)
{
    return (uint8_t)any_between(s, EL_PLANE_FRACTION_BITS, 27);
}

static void test_knots_are_exact_to_3_units(void)
{
    seeded s = seeded_from(1);
    for (; s.round < PART_OF(200000U); s.round++) {
        const uint64_t w = any_w(&s);
        const int64_t u = (int64_t)(any_u64(&s) % (w + EL_W_MARGIN_Q32 + 1U));
        check_knot(&s, w, u, any_shift(&s), (int32_t)any_between(&s, -(1 << 27), 1 << 27));
    }
}

/* The corner with the largest |u| may have |U| = W, and both planes are rounded. Where W lies below a power of two and |U|
 * does not, U would need a bit more than W does, but for the margin. */
static void test_knots_at_the_edge_of_the_range(void)
{
    seeded s = seeded_from(2);
    for (; s.round < PART_OF(20000U); s.round++) {
        const uint64_t power = 1ULL << any_between(&s, 33, 62);
        const uint64_t w = power - EL_W_MARGIN_Q32 - 64U + any_below(&s, 128);
        const uint8_t shift = any_shift(&s);
        check_knot(&s, w, (int64_t)w, shift, 0);
        check_knot(&s, w, (int64_t)(w + EL_W_MARGIN_Q32 - any_below(&s, 64)), shift, 0);
        check_knot(&s, w, (int64_t)(w + EL_W_MARGIN_Q32), shift, 0);
    }
}

/* The same as it comes from a triangle: its lower corners, at which 1/w is a few units of what has 31 bits at the top, have
 * the ends of the range of texels. The middle one lies on a pixel's centre, so where it is on the left it is covered and a
 * knot. */
static void test_a_covered_corner_has_its_texel(void)
{
    seeded s = seeded_from(3);
    uint32_t covered = 0;
    const int32_t ends_q16[2] = {INT16_MIN * (1 << 12), INT16_MAX * (1 << 12)};
    for (; s.round < PART_OF(20000U); s.round++) {
        const uint32_t far = 1U << any_below(&s, 8);
        const uint32_t w[3] = {0x7FFF8000U, far, far};
        const int32_t columns[3] = {(int32_t)any_below(&s, 100), (int32_t)any_below(&s, 100),
                                    100 + (int32_t)any_below(&s, 50)};
        const int32_t rows[3] = {0, (int32_t)any_between(&s, 1, 50), 51 + (int32_t)any_below(&s, 50)};
        el_corner corners[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = (el_corner){
                .x = (el_coordinate)(columns[i] * EL_SUBPIXELS + EL_SUBPIXELS / 2),
                .y = (el_coordinate)(rows[i] * EL_SUBPIXELS + EL_SUBPIXELS / 2),
                .w = w[i],
                .u_q16 = ends_q16[any_below(&s, 2)],
                .v_q16 = ends_q16[any_below(&s, 2)],
            };
        }
        const el_surface surface = {.shading = EL_SHADE_TEXTURED, .uv_error_log2 = 3};
        el_triangle triangle;
        if (!el_triangle_setup(&triangle, corners, &surface, 0)) {
            continue;
        }
        while (triangle.y < rows[1]) {
            el_triangle_next_row(&triangle);
        }
        if (!triangle.short_is_left) {
            continue;
        }
        covered++;
        el_sample sample;
        el_triangle_sample(&triangle, columns[1], 200, &sample);
        /* U is rounded to its fraction at the corners, W there is `far`, and the range is 2^28. */
        const int32_t most = (int32_t)((1U << (26 - EL_PLANE_FRACTION_BITS)) / far) + 8;
        if (labs(sample.u_q16 - corners[1].u_q16) > most || labs(sample.v_q16 - corners[1].v_q16) > most) {
            fail_at(&s, "u, v are %ld, %ld, not %ld, %ld", (long)sample.u_q16, (long)sample.v_q16,
                    (long)corners[1].u_q16, (long)corners[1].v_q16);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(5000U), covered);
}

/* A value that is so much at a span's first and last pixel, but for its last bits. */
static el_plane plane_between(int64_t first, int64_t last, int32_t pixels)
{
    return (el_plane){.value = (uint64_t)first, .dx = (uint64_t)((last - first) / (pixels - 1))};
}

static int64_t at(const el_plane *plane, int32_t pixel)
{
    return (int64_t)(plane->value + plane->dx * (uint64_t)pixel);
}

/* U at an end of a span: anywhere within W, and often at its bound. */
static int64_t any_u(seeded *s, int64_t w)
{
    const int64_t u = any_below(s, 2) == 0 ? w : (int64_t)(any_u64(s) % (uint64_t)w);
    return any_below(s, 2) == 0 ? u : -u;
}

/* Whole walks against exact quotients at every pixel, from and to any W: also the lowest, whose fraction counts. */
static void test_walks_keep_to_the_error(void)
{
    seeded s = seeded_from(4);
    for (; s.round < PART_OF(40000U); s.round++) {
        const int32_t pixels = (int32_t)any_between(&s, 2, 200);
        const int64_t first = (1LL << 32) + (int64_t)any_of_bits(&s, 61);
        const int64_t last = (1LL << 32) + (int64_t)any_of_bits(&s, 61);
        el_triangle triangle = {.surface = {.uv_error_log2 = (uint8_t)any_between(&s, 1, 5)}};
        el_perspective *const p = &triangle.perspective;
        p->w = plane_between(first, last, pixels);
        p->u = plane_between(any_u(&s, first), any_u(&s, last), pixels);
        p->v = (el_plane){0};
        p->u_shift = any_below(&s, 2) == 0 ? 27 : any_shift(&s);
        p->v_shift = EL_PLANE_FRACTION_BITS;
        el_texture_walk walk;
        el_texture_walk_start(&walk, &triangle);
        el_texture_walk_begin(&walk, p, 0, (uint32_t)pixels);
        int32_t pixel = 0;
        while (pixel < pixels) {
            int32_t length = 1;
            if (pixel < pixels - 1) {
                length = (int32_t)el_texture_walk_piece(&walk, (uint32_t)pixel, (uint32_t)(pixels - 1 - pixel));
                if (length < 1 || length > EL_MAX_PIECE || length > pixels - 1 - pixel) {
                    fail_at(&s, "a piece of %ld pixels at %ld of %ld", (long)length, (long)pixel, (long)pixels);
                }
            } else {
                el_texture_walk_last(&walk);
            }
            for (int32_t i = 0; i < length; i++) {
                const int64_t w = at(&p->w, pixel + i) + EL_W_MARGIN_Q32;
                const int64_t exact_q24 =
                    (int64_t)wide_quotient(wide_left(wide_of(at(&p->u, pixel + i)), p->u_shift + 8U), w).low;
                const int64_t found_q16 = walk.u.q16 + i * walk.u.step_q16;
                const int64_t error_q24 = llabs(found_q16 * 256 - exact_q24);
                if (error_q24 > 1LL << (24 - triangle.surface.uv_error_log2)) {
                    fail_at(&s,
                            "pixel %ld of %ld, W from %016llx to %016llx, shift %u: off by %lld / 256 of 2^-16 texel",
                            (long)pixel + i, (long)pixels, (unsigned long long)first, (unsigned long long)last,
                            p->u_shift, (long long)error_q24);
                }
            }
            pixel += length;
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_walks_keep_to_the_error);
    RUN_TEST(test_knots_are_exact_to_3_units);
    RUN_TEST(test_knots_at_the_edge_of_the_range);
    RUN_TEST(test_a_covered_corner_has_its_texel);
    return UNITY_END();
}
