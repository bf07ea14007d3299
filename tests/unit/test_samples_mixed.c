/* What is mixed with what is there, where pixels have several samples: each sample against a picture of its own, which is
 * drawn without samples and shifted; and where nothing is mixed, the loops that know of nothing. */
#include <string.h>

#include "any_triangle.h"
#include "raster/samples.h"
#include "raster/small_sampled.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

#if EL_WITH_SAMPLES && EL_WITH_MIXED

enum { SIZE = 40, PIXELS = SIZE * SIZE, MOST_TRIANGLES = 6, TEXELS = 64 };

typedef struct samples_picture {
    uint16_t colours[PIXELS], depths[PIXELS];
    uint32_t mixed[EL_MIXED_WORDS(SIZE) * SIZE];
    uint32_t samples[PIXELS * EL_MAX_SAMPLES];
} samples_picture;

static samples_picture drawn, other;
static uint16_t reference_colours[EL_MAX_SAMPLES][PIXELS];
static uint16_t reference_depths[EL_MAX_SAMPLES][PIXELS];

static void clear(samples_picture *picture)
{
    memset(picture, 0, sizeof *picture);
    memset(picture->depths, 0xFF, sizeof picture->depths);
}

static void draw(samples_picture *picture, unsigned count, const el_corner corners[3], const el_surface *surface)
{
    const el_sampled_target target = {
        .target = {.colour = picture->colours, .depth = picture->depths, .width = SIZE, .y_end = SIZE},
        .mixed = picture->mixed,
        .samples = picture->samples,
        .count = count,
    };
    el_stats stats = {0};
#if EL_WITH_SMALL_SAMPLED
    el_small_sampled place;
    (void)el_sampled_draw(corners, surface, &target, &stats, &place);
#else
    (void)el_sampled_draw(corners, surface, &target, &stats, NULL);
#endif
}

/* Depth and colour of a sample, wherever they are. */
static uint32_t sample_at(const samples_picture *picture, unsigned count, uint32_t pixel, unsigned k)
{
    if ((picture->mixed[pixel / 32U] << (pixel % 32U) & 0x80000000U) != 0) {
        const uint32_t mask = picture->colours[pixel];
        return picture->samples[pixel * count + (mask == 0 ? k : (mask >> k & 1U) ^ 1U)];
    }
    return (uint32_t)picture->depths[pixel] << 16 | picture->colours[pixel];
}

static void draw_reference(unsigned k, const el_sample_point *point, const el_corner corners[3],
                           const el_surface *surface)
{
    el_corner shifted[3];
    for (unsigned i = 0; i < 3; i++) {
        shifted[i] = corners[i];
        shifted[i].x -= point->x;
        shifted[i].y -= point->y;
    }
    el_triangle triangle;
    el_stats stats = {0};
    if (el_triangle_setup(&triangle, shifted, surface, 0)) {
        el_triangle_draw(
            &triangle,
            &(el_target){.colour = reference_colours[k], .depth = reference_depths[k], .width = SIZE, .y_end = SIZE},
            &stats);
    }
}

/* Flat, at one depth: the same at every place. */
static void test_each_sample_is_blended_with_what_it_has(void)
{
    uint32_t apart = 0;
    for (uint64_t round = 0; round < 400; round++) {
        seeded s = seeded_from(round);
        const unsigned count = any_below(&s, 2) == 0 ? 4 : 8;
        clear(&drawn);
        memset(reference_colours, 0, sizeof reference_colours);
        memset(reference_depths, 0xFF, sizeof reference_depths);
        const unsigned triangles = 1 + any_below(&s, MOST_TRIANGLES);
        for (unsigned i = 0; i < triangles; i++) {
            const el_material material = {
                .alpha = any_below(&s, 4) == 0 ? 0 : (uint8_t)any_u64(&s),
                .flags = any_below(&s, 2) == 0 ? EL_MATERIAL_BLEND_DEPTH : 0,
            };
            const el_surface surface = {
                .depth = any_below(&s, 4) != 0,
                .finish = any_below(&s, 2) == 0 ? EL_FINISH_MIXED : 0,
                .colour = (uint16_t)any_u64(&s),
                .material = &material,
            };
            const uint16_t z = (uint16_t)any_u64(&s);
            const int32_t middle = (int32_t)any_below(&s, SIZE * EL_SUBPIXELS);
            const int32_t reach =
                (any_below(&s, 2) == 0 ? 6 : 30) * EL_SUBPIXELS; /* small ones have a way of their own */
            el_corner corners[3];
            for (unsigned c = 0; c < 3; c++) {
                corners[c] = any_corner(&s, middle, reach);
                corners[c].z = z;
            }
            draw(&drawn, count, corners, &surface);
            for (unsigned k = 0; k < count; k++) {
                draw_reference(k, &el_sample_points(count)[k], corners, &surface);
            }
        }
        for (uint32_t pixel = 0; pixel < PIXELS; pixel++) {
            for (unsigned k = 0; k < count; k++) {
                const uint32_t expected = (uint32_t)reference_depths[k][pixel] << 16 | reference_colours[k][pixel];
                if (sample_at(&drawn, count, pixel, k) != expected) {
                    fail_at(&s, "pixel (%u, %u), sample %u of %u: %08X, not %08X", (unsigned)(pixel % SIZE),
                            (unsigned)(pixel / SIZE), k, count, (unsigned)sample_at(&drawn, count, pixel, k),
                            (unsigned)expected);
                }
                apart += expected != ((uint32_t)reference_depths[0][pixel] << 16 | reference_colours[0][pixel]);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(10000, apart);
}

/* Of a texture, in light or without, that hides what is below it. */
static void test_what_is_opaque_is_drawn_as_if_it_were_not_mixed(void)
{
    static uint16_t texels[TEXELS];
    uint32_t filled = 0;
    for (uint64_t round = 0; round < 400; round++) {
        seeded s = seeded_from(round);
        const unsigned count = any_below(&s, 2) == 0 ? 4 : 8;
        for (unsigned i = 0; i < TEXELS; i++) {
            texels[i] = (uint16_t)any_u64(&s);
        }
        const el_texture texture = {.texels = texels, .width_log2 = 3, .height_log2 = 3};
        clear(&drawn);
        clear(&other);
        const unsigned triangles = 1 + any_below(&s, MOST_TRIANGLES);
        for (unsigned i = 0; i < triangles; i++) {
            const el_shading shading = (el_shading)any_below(&s, EL_SHADE_OVERDRAW);
            const el_material material = {.shading = (uint8_t)shading, .texture = &texture};
            const uint8_t dither = el_has_colours(shading) && any_below(&s, 2) == 0 ? EL_FINISH_DITHER : 0;
            el_surface surface = {
                .shading = shading,
                .depth = any_below(&s, 4) != 0,
                .finish = dither,
                .colour = (uint16_t)any_u64(&s),
                .uv_error_log2 = (uint8_t)any_between(&s, 1, 5),
                .texture = &texture,
            };
            el_corner corners[3];
            for (unsigned c = 0; c < 3; c++) {
                corners[c] = any_corner(&s, SIZE * EL_SUBPIXELS / 2, 30 * EL_SUBPIXELS);
            }
            draw(&drawn, count, corners, &surface);
            surface.finish = (uint8_t)(dither | EL_FINISH_MIXED);
            surface.material = &material;
            draw(&other, count, corners, &surface);
        }
        for (uint32_t pixel = 0; pixel < PIXELS; pixel++) {
            for (unsigned k = 0; k < count; k++) {
                const uint32_t expected = sample_at(&drawn, count, pixel, k);
                if (sample_at(&other, count, pixel, k) != expected) {
                    fail_at(&s, "pixel (%u, %u), sample %u of %u: %08X, not %08X", (unsigned)(pixel % SIZE),
                            (unsigned)(pixel / SIZE), k, count, (unsigned)sample_at(&other, count, pixel, k),
                            (unsigned)expected);
                }
                filled += expected != 0xFFFF0000U;
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(100000, filled);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_sample_is_blended_with_what_it_has);
    RUN_TEST(test_what_is_opaque_is_drawn_as_if_it_were_not_mixed);
    return UNITY_END();
}

#else

static void test_samples_or_mixing_are_left_out(void)
{
    TEST_ASSERT_FALSE(EL_WITH_SAMPLES && EL_WITH_MIXED);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_samples_or_mixing_are_left_out);
    return UNITY_END();
}

#endif
