/* Texels that are fetched and lit in the fastest way, against one at a time: triangles whose u and v are as
 * el_triangle_sample has them, with textures of every shape. Those of up to 2^14 texels are packed (raster/texel_row.h),
 * unless v moves too fast; here its steps lie on both sides of that bound, and pieces are as long as they get. */
#include <string.h>

#include "any_triangle.h"
#include "base/dither.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

enum { SIZE = 160, ROWS = 4, TEXELS_LOG2 = 15, BEHIND = 0x5555 };

static uint16_t texels[1 << TEXELS_LOG2];
static uint16_t colour[ROWS * SIZE];
static uint16_t depth[ROWS * SIZE];
static uint16_t before[ROWS * SIZE];

static el_texture any_texture(seeded *s)
{
    const unsigned width_log2 = (unsigned)any_below(s, 11);
    const unsigned most = TEXELS_LOG2 - width_log2 < 10 ? TEXELS_LOG2 - width_log2 : 10;
    return (el_texture){
        .texels = texels, .width_log2 = (uint8_t)width_log2, .height_log2 = (uint8_t)any_below(s, most + 1)};
}

/* Texels that the whole picture's width has: around what a packed step may have most, or any. */
static int32_t any_range_q16(seeded *s, const el_texture *texture)
{
    const int64_t bound = ((int64_t)1 << (24 - texture->width_log2)) * SIZE;
    const int64_t range =
        any_below(s, 2) == 0 ? any_between(s, bound - bound / 32, bound + bound / 32) : (int64_t)any_of_bits(s, 27);
    const int64_t most = (int64_t)2047 << 16;
    const int32_t half = (int32_t)(range / 2 < most ? range / 2 : most);
    return any_below(s, 2) == 0 ? half : -half;
}

/* Wider than the picture, so that v goes through its range along a row; in perspective, or flat. u is often the same
 * everywhere and at a texel's edge, where the least that v carried into it would show. */
static void any_corners(seeded *s, const el_texture *texture, el_corner corners[3])
{
    const bool is_flat = any_below(s, 2) == 0;
    const bool has_columns = any_below(s, 2) == 0;
    const int32_t u_q16 = (int32_t)any_between(s, -1000, 1000) * 65536 - (int32_t)any_below(s, 4);
    const int32_t v_half = any_range_q16(s, texture);
    for (unsigned i = 0; i < 3; i++) {
        corners[i] = any_corner(s, SIZE * EL_SUBPIXELS / 2, 40 * SIXTEENTH);
        corners[i].w = is_flat ? 1U << 30 : corners[i].w;
        corners[i].u_q16 = has_columns ? (int32_t)any_signed_of_bits(s, 26) : u_q16;
    }
    corners[0].x = 0;
    corners[1].x = SIZE * EL_SUBPIXELS;
    corners[0].y = -(int32_t)any_below(s, 100 * EL_SUBPIXELS);
    corners[1].y = -(int32_t)any_below(s, 100 * EL_SUBPIXELS);
    corners[2].y = (int32_t)any_between(s, 1, 20) * EL_SUBPIXELS;
    corners[0].v_q16 = v_half;
    corners[1].v_q16 = -v_half;
    corners[2].v_q16 = (int32_t)any_signed_of_bits(s, 26);
}

/* Depth as earlier triangles may have left it: empty, or stretches that are in front of anything. */
static void any_depth(seeded *s)
{
    memset(before, 0xFF, sizeof before);
    uint32_t at = any_below(s, 40);
    while (any_below(s, 8) != 0 && at < ROWS * SIZE) {
        const uint32_t end = at + 1U + any_below(s, 40);
        for (; at < end && at < ROWS * SIZE; at++) {
            before[at] = 0;
        }
        at += any_below(s, 80);
    }
}

static uint16_t texel_at(const el_texture *texture, const el_sample *sample)
{
    const uint32_t column = ((uint32_t)sample->u_q16 >> 16) & ((1U << texture->width_log2) - 1U);
    const uint32_t row = ((uint32_t)sample->v_q16 >> 16) & ((1U << texture->height_log2) - 1U);
    return texture->texels[(row << texture->width_log2) + column];
}

/* A channel of a texel, 0 to `levels`, in light from 0 to 255 in 8.24 with its half added. */
static uint32_t lit(uint32_t channel, uint32_t light_q24, const el_surface *surface, uint32_t x, uint32_t y)
{
    const int32_t light_q16 = (((int32_t)(light_q24 >> 16) - 0x80) * 257) >> 8;
    if ((surface->finish & EL_FINISH_DITHER) != 0) {
        return (uint32_t)((int32_t)channel * light_q16 + (int32_t)el_dither_threshold_q16(x, y)) >> 16;
    }
    return (channel * ((light_q24 >> 24) + 1U)) >> 8;
}

static uint16_t pixel_at(const el_surface *surface, const el_sample *sample, uint32_t x, uint32_t y)
{
    const uint32_t texel = texel_at(surface->texture, sample);
    const uint32_t *const light = sample->rgb_plus_half_q24;
    if (surface->shading == EL_SHADE_TEXTURED) {
        return (uint16_t)texel;
    }
    return (uint16_t)(lit(texel >> 11, light[0], surface, x, y) << 11 |
                      lit((texel >> 5) & 63U, light[1], surface, x, y) << 5 |
                      lit(texel & 31U, light[2], surface, x, y));
}

/* Light that is different everywhere, or the same; often as dark or as bright as it gets. */
static void any_light(seeded *s, el_corner corners[3])
{
    const bool is_even = any_below(s, 2) == 0;
    const bool is_extreme = any_below(s, 2) == 0;
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = 0; k < 3; k++) {
            const uint32_t any = is_extreme ? any_below(s, 2) * 0xFF00U : any_below(s, 0xFF01);
            corners[i].rgb_q8[k] = is_even && i > 0 ? corners[0].rgb_q8[k] : (uint16_t)any;
        }
    }
}

static uint8_t any_finish(seeded *s, el_shading shading)
{
    return any_below(s, 2) == 0 && el_has_colours(shading) ? EL_FINISH_DITHER : 0;
}

static void expect_texels(uint64_t seed, el_shading shading, bool with_depth)
{
    uint32_t compared = 0;
    for (seeded s = seeded_from(seed); s.round < PART_OF(4000U); s.round++) {
        const el_texture texture = any_texture(&s);
        const el_surface surface = {.shading = shading,
                                    .depth = with_depth,
                                    .finish = any_finish(&s, shading),
                                    .uv_error_log2 = (uint8_t)any_between(&s, 1, 5),
                                    .texture = &texture};
        el_corner corners[3];
        any_corners(&s, &texture, corners);
        any_light(&s, corners);
        any_depth(&s);
        memcpy(depth, before, sizeof depth);
        for (uint32_t i = 0; i < ROWS * SIZE; i++) {
            colour[i] = BEHIND;
        }
        el_triangle triangle;
        if (!el_triangle_setup(&triangle, corners, &surface, 0)) {
            continue;
        }
        el_stats stats = {0};
        el_triangle walked = triangle;
        el_triangle_draw(&triangle, &(el_target){.colour = colour, .depth = depth, .width = SIZE, .y_end = ROWS},
                         &stats);
        for (; walked.y < ROWS && walked.y < walked.y_end; el_triangle_next_row(&walked)) {
            /* Each is looked for from its row's beginning on: some of them. */
            for (int32_t x = (int32_t)any_below(&s, 7); x < SIZE; x += 7) {
                const uint32_t at = (uint32_t)(walked.y * SIZE + x);
                uint16_t expected = BEHIND;
                if (reference_covers(corners, x, walked.y) && (!with_depth || before[at] != 0)) {
                    el_sample sample;
                    el_triangle_sample(&walked, x, SIZE, &sample);
                    expected = pixel_at(&surface, &sample, (uint32_t)x, (uint32_t)walked.y);
                    compared++;
                }
                if (colour[at] != expected) {
                    fail_at(&s, "pixel (%ld, %ld) of %u x %u texels is %04x, not %04x", (long)x, (long)walked.y,
                            1U << texture.width_log2, 1U << texture.height_log2, colour[at], expected);
                }
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(50000U), compared);
}

static void test_texels_are_as_one_at_a_time(void)
{
    expect_texels(1, EL_SHADE_TEXTURED, false);
}

static void test_texels_that_are_seen_are_as_one_at_a_time(void)
{
    expect_texels(2, EL_SHADE_TEXTURED, true);
}

static void test_lit_texels_are_as_one_at_a_time(void)
{
    expect_texels(4, EL_SHADE_TEXTURED_GOURAUD, false);
}

static void test_lit_texels_that_are_seen_are_as_one_at_a_time(void)
{
    expect_texels(5, EL_SHADE_TEXTURED_GOURAUD, true);
}

int main(void)
{
    seeded s = seeded_from(3);
    for (uint32_t i = 0; i < 1U << TEXELS_LOG2; i++) {
        texels[i] = (uint16_t)any_u64(&s);
    }
    UNITY_BEGIN();
    RUN_TEST(test_texels_are_as_one_at_a_time);
    RUN_TEST(test_texels_that_are_seen_are_as_one_at_a_time);
    RUN_TEST(test_lit_texels_are_as_one_at_a_time);
    RUN_TEST(test_lit_texels_that_are_seen_are_as_one_at_a_time);
    return UNITY_END();
}
