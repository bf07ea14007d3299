/* Pixels that are mixed of several things, against one at a time: what el_triangle_sample has there, a texel by
 * raster/sampler.h, light, and el_rgb565_blend with what was there. And where nothing is mixed, the loops that know of
 * nothing draw the same. */
#include <string.h>

#include "any_triangle.h"
#include "base/dither.h"
#include "geometry/pose.h"
#include "raster/fog.h"
#include "raster/sampler.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

#if EL_WITH_MIXED

/* Wider than what is gathered of a row before it is mixed (fill_mixed_line.c). */
enum { WIDTH = 176, HEIGHT = 24, PIXELS = WIDTH * HEIGHT, TEXELS = 64 };

static uint16_t texels[TEXELS];
static uint16_t palette[256];
static el_fog fog;
static uint8_t shown[TEXELS];
static uint16_t colour[PIXELS];
static uint16_t depth[PIXELS];
static uint16_t colour_before[PIXELS];
static uint16_t depth_before[PIXELS];
static uint16_t colour_plain[PIXELS];
static uint16_t depth_plain[PIXELS];

typedef struct look {
    el_image image;
    el_texture texture;
    el_material material;
    el_surface surface;
    el_corner corners[3];
} look;

static uint8_t any_finish(seeded *s, el_shading shading)
{
    const int dither = any_below(s, 2) == 0 && el_has_colours(shading) ? EL_FINISH_DITHER : 0;
    return (uint8_t)(dither | EL_FINISH_MIXED);
}

/* From within what is seen to within it, or beyond. */
static void any_fog(seeded *s)
{
    const el_camera camera = {.fov_y = EL_DEGREES(50, 1),
                              .near_q16 = (uint32_t)any_between(s, EL_UNIT_Q16 / 4, 8 * EL_UNIT_Q16),
                              .far_q16 = 64 * EL_UNIT_Q16,
                              .axes_q30 = {{1 << 30, 0, 0}, {0, 1 << 30, 0}, {0, 0, 1 << 30}}};
    const uint32_t begin_q16 = any_below(s, 30 * EL_UNIT_Q16);
    const uint32_t end_q16 = begin_q16 + camera.near_q16 + any_below(s, 60 * EL_UNIT_Q16);
    TEST_ASSERT_EQUAL(EL_OK, el_fog_linear(&fog, &camera, (uint16_t)any_u64(s), begin_q16, end_q16));
}

/* The surface as el_list_gather makes it. */
static void any_look(seeded *s, look *l)
{
    for (unsigned i = 0; i < TEXELS; i++) {
        texels[i] = (uint16_t)any_u64(s);
        shown[i] = (uint8_t)any_u64(s);
    }
    for (unsigned i = 0; i < 256; i++) {
        palette[i] = (uint16_t)any_u64(s);
    }
    const el_image_format format = (el_image_format)any_below(s, EL_IMAGE_MASK + 1);
    const bool is_power = any_below(s, 2) == 0;
    l->image = (el_image){.width = is_power ? 8 : 7,
                          .height = is_power ? 4 : 5,
                          .format = (uint8_t)format,
                          .has_key = any_below(s, 2) == 0,
                          .key = format == EL_IMAGE_RGB565 ? texels[any_below(s, 35)] : (uint16_t)any_below(s, 16),
                          .pixels = texels,
                          .palette = palette,
                          .alpha = any_below(s, 2) == 0 ? shown : NULL};
    l->texture = (el_texture){.texels = texels,
                              .width_log2 = 3,
                              .height_log2 = 3,
                              .wrap_u = (uint8_t)(any_below(s, 2) * any_below(s, 3)),
                              .wrap_v = (uint8_t)(any_below(s, 2) * any_below(s, 3)),
                              .smooth = any_below(s, 2) == 0,
                              .image = any_below(s, 3) != 0 ? &l->image : NULL};
    l->material = (el_material){.shading = (uint8_t)any_below(s, EL_SHADE_OVERDRAW),
                                .flags = any_below(s, 2) == 0 ? EL_MATERIAL_BLEND_DEPTH : 0,
                                .texture = &l->texture,
                                .alpha = any_below(s, 2) == 0 ? 0 : (uint8_t)any_u64(s)};
    l->surface = (el_surface){.shading = (el_shading)l->material.shading,
                              .depth = any_below(s, 4) != 0,
                              .finish = any_finish(s, (el_shading)l->material.shading),
                              .colour = (uint16_t)any_u64(s),
                              .uv_error_log2 = (uint8_t)any_between(s, 1, 5),
                              .material = &l->material};
    if (l->surface.depth && any_below(s, 2) == 0) {
        any_fog(s);
        l->material.fog = &fog;
    }
    const bool is_large = any_below(s, 2) == 0;
    for (unsigned i = 0; i < 3; i++) {
        l->corners[i] = any_corner(s, HEIGHT * EL_SUBPIXELS / 2, (is_large ? 150 : 30) * EL_SUBPIXELS);
        l->corners[i].x += (WIDTH - HEIGHT) * EL_SUBPIXELS / 2;
    }
}

static void any_ground(seeded *s)
{
    for (unsigned i = 0; i < PIXELS; i++) {
        colour_before[i] = (uint16_t)any_u64(s);
        depth_before[i] = any_below(s, 3) == 0 ? 0xFFFF : (uint16_t)any_u64(s);
    }
    memcpy(colour, colour_before, sizeof colour);
    memcpy(depth, depth_before, sizeof depth);
}

static void draw(el_triangle *triangle, uint16_t *to, uint16_t *to_depth)
{
    el_stats stats = {0};
    el_triangle_draw(triangle, &(el_target){.colour = to, .depth = to_depth, .width = WIDTH, .y_end = HEIGHT}, &stats);
}

/* A channel of 0 to `levels` in the light of 0 to 255. */
static uint32_t lit(uint32_t channel, uint32_t light_q24, const el_surface *surface, uint32_t threshold_q16)
{
    const int32_t light_q16 = (((int32_t)(light_q24 >> 16) - 0x80) * 257) >> 8;
    return (surface->finish & EL_FINISH_DITHER) != 0
               ? (uint32_t)((int32_t)channel * light_q16 + (int32_t)threshold_q16) >> 16
               : (channel * ((light_q24 >> 24) + 1U)) >> 8;
}

static void expect_pixel(const seeded *s, const look *l, const el_sample *sample, uint32_t x, uint32_t y)
{
    const uint32_t at = y * WIDTH + x;
    const uint32_t z = sample->z_plus_half_q16 >> 16;
    const bool is_blended = (l->material.alpha != 0 && l->material.alpha != 255) ||
                            ((l->surface.shading & 2U) != 0 && l->texture.image != NULL && l->image.alpha != NULL);
    uint16_t expected = colour_before[at];
    uint16_t expected_depth = depth_before[at];
    uint16_t own = l->surface.colour;
    uint32_t weight = 256;
    if ((l->surface.shading & 2U) != 0) {
        el_sampler sampler;
        el_sampler_make(&sampler, &l->texture);
        weight = el_sampler_at(&sampler, (uint32_t)sample->u_q16, (uint32_t)sample->v_q16, &own);
        weight = is_blended ? weight : (weight < 128 ? 0U : 256U);
    }
    if ((l->surface.shading & 1U) != 0) {
        const uint32_t *const rgb = sample->rgb_plus_half_q24;
        const uint32_t threshold_q16 = el_dither_threshold_q16(x, y);
        const bool is_alone = (l->surface.shading & 2U) == 0;
        const uint32_t base = is_alone ? 0xFFFFU : own;
        own = (uint16_t)(lit(base >> 11, rgb[0], &l->surface, threshold_q16) << 11 |
                         lit(base >> 5 & 63U, rgb[1], &l->surface, threshold_q16) << 5 |
                         lit(base & 31U, rgb[2], &l->surface, threshold_q16));
        if (is_alone && (l->surface.finish & EL_FINISH_DITHER) == 0) {
            own = (uint16_t)(rgb[0] >> 27 << 11 | rgb[1] >> 26 << 5 | rgb[2] >> 27);
        }
    }
    const uint8_t alpha = l->material.alpha == 0 ? 255 : l->material.alpha;
    const bool is_drawn = weight != 0 && (!l->surface.depth || z < depth_before[at]);
    if (is_drawn) {
        if (l->material.fog != NULL) {
            own = el_rgb565_blend(own, fog.colour, el_fog_at(&fog, z));
        }
        weight = (weight * (alpha + (alpha >= 128 ? 1U : 0U)) + 128) / 256;
        expected = el_rgb565_blend(expected, own, weight);
        if (l->surface.depth && (!is_blended || (l->material.flags & EL_MATERIAL_BLEND_DEPTH) != 0) && weight != 0) {
            expected_depth = (uint16_t)z;
        }
    }
    if (colour[at] != expected || depth[at] != expected_depth) {
        fail_at(s, "pixel (%u, %u) is %04x at depth %u, not %04x at %u", (unsigned)x, (unsigned)y, colour[at],
                depth[at], expected, expected_depth);
    }
}

static void test_pairs_are_blended_as_one_at_a_time(void)
{
    for (seeded s = seeded_from(913); s.round < PART_OF(300000U); s.round++) {
        const uint32_t under = (uint32_t)any_u64(&s);
        const uint32_t over = (uint32_t)any_u64(&s);
        const uint32_t alpha = any_below(&s, 257);
        const uint32_t left = el_rgb565_blend((uint16_t)under, (uint16_t)over, alpha);
        const uint32_t right = el_rgb565_blend((uint16_t)(under >> 16), (uint16_t)(over >> 16), alpha);
        TEST_ASSERT_EQUAL_HEX32(right << 16 | left, el_rgb565_blend_pair(under, over, alpha));
    }
}

static void test_pixels_are_as_one_at_a_time(void)
{
    uint32_t compared = 0;
    for (seeded s = seeded_from(911); s.round < PART_OF(3000U); s.round++) {
        look l;
        any_look(&s, &l);
        any_ground(&s);
        el_triangle triangle;
        if (!el_triangle_setup(&triangle, l.corners, &l.surface, 0)) {
            continue;
        }
        el_triangle walked = triangle;
        draw(&triangle, colour, depth);
        for (; walked.y < HEIGHT && walked.y < walked.y_end; el_triangle_next_row(&walked)) {
            for (uint32_t x = any_below(&s, 5); x < WIDTH; x += 5) {
                if (reference_covers(l.corners, (int32_t)x, walked.y)) {
                    el_sample sample;
                    el_triangle_sample(&walked, (int32_t)x, WIDTH, &sample);
                    expect_pixel(&s, &l, &sample, x, (uint32_t)walked.y);
                    compared++;
                } else {
                    TEST_ASSERT_EQUAL_HEX16(colour_before[walked.y * WIDTH + (int32_t)x],
                                            colour[walked.y * WIDTH + (int32_t)x]);
                }
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(100000U), compared);
}

/* Opaque, and with a texture that repeats: by either loop. */
static void test_what_is_not_mixed_is_as_by_the_other_loops(void)
{
    for (seeded s = seeded_from(912); s.round < PART_OF(3000U); s.round++) {
        look l;
        any_look(&s, &l);
        any_ground(&s);
        memcpy(colour_plain, colour, sizeof colour);
        memcpy(depth_plain, depth, sizeof depth);
        l.texture = (el_texture){.texels = texels, .width_log2 = 3, .height_log2 = 3};
        l.material.alpha = any_below(&s, 2) == 0 ? 0 : 255;
        l.material.fog = NULL;
        el_surface plain = l.surface;
        plain.finish = l.surface.finish & (uint8_t)~EL_FINISH_MIXED;
        plain.texture = &l.texture;
        el_triangle mixed;
        el_triangle other;
        if (el_triangle_setup(&mixed, l.corners, &l.surface, 0) && el_triangle_setup(&other, l.corners, &plain, 0)) {
            draw(&mixed, colour, depth);
            draw(&other, colour_plain, depth_plain);
            if (memcmp(colour, colour_plain, sizeof colour) != 0 || memcmp(depth, depth_plain, sizeof depth) != 0) {
                fail_at(&s, "shading %u is another picture", (unsigned)l.surface.shading);
            }
        }
    }
}
#endif

int main(void)
{
    UNITY_BEGIN();
#if EL_WITH_MIXED
    RUN_TEST(test_pairs_are_blended_as_one_at_a_time);
    RUN_TEST(test_pixels_are_as_one_at_a_time);
    RUN_TEST(test_what_is_not_mixed_is_as_by_the_other_loops);
#endif
    return UNITY_END();
}
