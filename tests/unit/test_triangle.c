/* What a triangle's pixels hold: depth and colour against exact rational planes, texture coordinates within the error asked for,
 * ties, wrapping, modulation; and that bands and set-up rows do not matter. Coverage is in test_coverage.c. */
#include <stddef.h>

#include <math.h>
#include <string.h>

#include "any_triangle.h"

enum { SIZE = 24, PIXELS = SIZE * SIZE };

typedef struct buffers {
    uint16_t colour[PIXELS];
    uint16_t depth[PIXELS];
} buffers;

static buffers screen;
static el_stats stats;

void setUp(void)
{
}

void tearDown(void)
{
}

static void clear(buffers *b)
{
    memset(b->colour, 0, sizeof b->colour);
    memset(b->depth, 0xFF, sizeof b->depth);
}

static el_target rows_of(buffers *b, int32_t y, int32_t y_end)
{
    return (el_target){
        .colour = b->colour + y * SIZE, .depth = b->depth + y * SIZE, .width = SIZE, .y = y, .y_end = y_end};
}

static void draw(buffers *b, const el_corner corners[3], const el_surface *surface)
{
    const el_target target = rows_of(b, 0, SIZE);
    el_triangle triangle;
    if (el_triangle_setup(&triangle, corners, surface, 0)) {
        el_triangle_draw(&triangle, &target, &stats);
    }
}

/* The left upper half of the screen, all corners alike but for their places. */
static void half_screen(el_corner corners[3], el_corner like)
{
    static const int32_t places[3][2] = {{0, 0}, {2 * SIZE * EL_SUBPIXELS, 0}, {0, 2 * SIZE * EL_SUBPIXELS}};
    for (unsigned i = 0; i < 3; i++) {
        corners[i] = like;
        corners[i].x = places[i][0];
        corners[i].y = places[i][1];
    }
}

/* --- Depth -------------------------------------------------------------------------------------------------------- */

static void test_on_equal_depth_the_first_one_stays(void)
{
    el_corner corners[3];
    clear(&screen);
    half_screen(corners, (el_corner){.z = 1000});
    draw(&screen, corners, &(el_surface){.depth = true, .colour = 1});
    draw(&screen, corners, &(el_surface){.depth = true, .colour = 2});
    TEST_ASSERT_EACH_EQUAL_HEX16(1, screen.colour, PIXELS);
    half_screen(corners, (el_corner){.z = 999});
    draw(&screen, corners, &(el_surface){.depth = true, .colour = 3});
    TEST_ASSERT_EACH_EQUAL_HEX16(3, screen.colour, PIXELS);
    half_screen(corners, (el_corner){.z = 1000});
    draw(&screen, corners, &(el_surface){.depth = true, .colour = 4});
    TEST_ASSERT_EACH_EQUAL_HEX16(3, screen.colour, PIXELS);
    TEST_ASSERT_EACH_EQUAL_HEX16(999, screen.depth, PIXELS);
}

static void test_the_far_plane_is_drawn(void)
{
    el_corner corners[3];
    clear(&screen);
    half_screen(corners, (el_corner){.z = EL_DEPTH_MAX});
    draw(&screen, corners, &(el_surface){.depth = true, .colour = 7});
    TEST_ASSERT_EACH_EQUAL_HEX16(7, screen.colour, PIXELS);
    TEST_ASSERT_EACH_EQUAL_UINT16(EL_DEPTH_MAX, screen.depth, PIXELS);
}

static void test_without_depth_nothing_is_tested_or_written(void)
{
    el_corner corners[3];
    clear(&screen);
    half_screen(corners, (el_corner){.z = 5});
    draw(&screen, corners, &(el_surface){.depth = true, .colour = 1});
    half_screen(corners, (el_corner){.z = 500});
    draw(&screen, corners, &(el_surface){.depth = false, .colour = 2});
    TEST_ASSERT_EACH_EQUAL_HEX16(2, screen.colour, PIXELS);
    TEST_ASSERT_EACH_EQUAL_UINT16(5, screen.depth, PIXELS);
}

static void test_overdraw_counts(void)
{
    el_corner corners[3];
    clear(&screen);
    half_screen(corners, (el_corner){.z = 5});
    for (unsigned i = 0; i < 3; i++) {
        draw(&screen, corners, &(el_surface){.shading = EL_SHADE_OVERDRAW});
    }
    TEST_ASSERT_EACH_EQUAL_UINT16(3, screen.colour, PIXELS);
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, screen.depth, PIXELS);
}

/* --- Values ------------------------------------------------------------------------------------------------------- */

/* The exact value at a pixel of what is linear on the screen. */
static long double exact_value(const el_corner corners[3], const long double values[3], int32_t column, int32_t row)
{
    const int64_t x = (int64_t)column * EL_SUBPIXELS + EL_SUBPIXELS / 2;
    const int64_t y = (int64_t)row * EL_SUBPIXELS + EL_SUBPIXELS / 2;
    long double sum = 0;
    for (unsigned i = 0; i < 3; i++) {
        sum += (long double)reference_side(&corners[(i + 1) % 3], &corners[(i + 2) % 3], x, y) * values[i];
    }
    return sum / (long double)reference_side(&corners[0], &corners[1], corners[2].x, corners[2].y);
}

static void expect_within(const seeded *s, const char *what, long double exact, long double got, long double tolerance)
{
    if (!(fabsl(exact - got) <= tolerance)) {
        fail_at(s, "%s is %.6Lf, not %.6Lf", what, got, exact);
    }
}

/* Depth within 2^-11 of a unit after at most SIZE steps of 2^-17, colour within 2^-12 of one (plane.h), u and v within what the
 * surface asks for. */
static void expect_sample(const seeded *s, const el_corner corners[3], const el_triangle *triangle, int32_t column,
                          bool textured)
{
    el_sample sample;
    el_triangle_sample(triangle, column, SIZE, &sample);
    const int32_t row = triangle->y;
    long double z[3], w[3], u[3], v[3];
    for (unsigned i = 0; i < 3; i++) {
        z[i] = corners[i].z;
        w[i] = corners[i].w;
        u[i] = (long double)corners[i].u_q16 / 65536 * corners[i].w;
        v[i] = (long double)corners[i].v_q16 / 65536 * corners[i].w;
    }
    expect_within(s, "depth", exact_value(corners, z, column, row), sample.z_plus_half_q16 / 65536.0L - 0.5L, 0x1p-11L);
    for (unsigned channel = 0; channel < 3; channel++) {
        const long double c[3] = {corners[0].rgb_q8[channel], corners[1].rgb_q8[channel], corners[2].rgb_q8[channel]};
        expect_within(s, "colour", exact_value(corners, c, column, row) / 256,
                      sample.rgb_plus_half_q24[channel] / 16777216.0L - 0.5L, 0x1p-12L);
    }
    if (textured) {
        const long double at_w = exact_value(corners, w, column, row);
        const long double allowed = ldexpl(1, -(int)triangle->surface.uv_error_log2);
        expect_within(s, "u", exact_value(corners, u, column, row) / at_w, sample.u_q16 / 65536.0L, allowed);
        expect_within(s, "v", exact_value(corners, v, column, row) / at_w, sample.v_q16 / 65536.0L, allowed);
    }
}

static void expect_samples(uint64_t seed, el_shading shading)
{
    static const uint16_t texel = 0;
    static const el_texture texture = {.texels = &texel};
    for (seeded s = seeded_from(seed); s.round < PART_OF(3000); s.round++) {
        const el_surface surface = {
            .shading = shading, .depth = true, .uv_error_log2 = (uint8_t)(1 + s.round % 5), .texture = &texture};
        const unsigned w_bits = (unsigned)any_between(&s, 16, 31); /* from steep to almost flat */
        const int32_t reach = ((int32_t)any_of_bits(&s, 13) + 32) * SIXTEENTH;
        el_corner corners[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_corner(&s, SIZE * EL_SUBPIXELS / 2, reach);
            corners[i].w = (uint32_t)any_between(&s, (1LL << w_bits) / 2, INT32_MAX);
        }
        for (int32_t row = 0; row < SIZE; row += 5) {
            el_triangle triangle;
            if (!el_triangle_setup(&triangle, corners, &surface, row) || triangle.y != row) {
                continue;
            }
            for (int32_t column = 0; column < SIZE; column++) {
                if (reference_covers(corners, column, row)) {
                    expect_sample(&s, corners, &triangle, column, shading != EL_SHADE_GOURAUD);
                }
            }
        }
    }
}

static void test_gouraud_samples_against_exact_planes(void)
{
    expect_samples(70, EL_SHADE_GOURAUD);
}

static void test_textured_samples_against_exact_planes(void)
{
    expect_samples(71, EL_SHADE_TEXTURED_GOURAUD);
}

/* What is drawn is what is sampled, rounded: depth to nearest, colours to nearest and then cut to RGB565. */
static void test_pixels_are_the_rounded_samples(void)
{
    const el_surface surface = {.shading = EL_SHADE_GOURAUD, .depth = true};
    for (seeded s = seeded_from(72); s.round < PART_OF(1000); s.round++) {
        el_corner corners[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_corner(&s, SIZE * EL_SUBPIXELS / 2, 400 * SIXTEENTH);
        }
        clear(&screen);
        draw(&screen, corners, &surface);
        for (int32_t row = 0; row < SIZE; row += 3) {
            el_triangle triangle;
            if (!el_triangle_setup(&triangle, corners, &surface, row) || triangle.y != row) {
                continue;
            }
            for (int32_t column = 0; column < SIZE; column++) {
                el_sample sample;
                if (!reference_covers(corners, column, row)) {
                    continue;
                }
                el_triangle_sample(&triangle, column, SIZE, &sample);
                const uint32_t *const rgb = sample.rgb_plus_half_q24;
                const uint32_t colour = rgb[0] >> 27 << 11 | rgb[1] >> 26 << 5 | rgb[2] >> 27;
                if (screen.depth[row * SIZE + column] != sample.z_plus_half_q16 >> 16 ||
                    screen.colour[row * SIZE + column] != colour) {
                    fail_at(&s, "pixel (%d, %d)", (int)column, (int)row);
                }
            }
        }
    }
}

/* --- Bands -------------------------------------------------------------------------------------------------------- */

static const uint16_t texels[8] = {0x0001, 0x0203, 0x4567, 0x89AB, 0xCDEF, 0xFFFF, 0x8410, 0xF81F};
static const el_texture checker = {.texels = texels, .width_log2 = 2, .height_log2 = 1};

static void draw_in_bands(buffers *b, const el_corner corners[3], const el_surface *surface, int32_t lines, bool anew)
{
    el_triangle triangle;
    bool is_set_up = false;
    for (int32_t y = 0; y < SIZE; y += lines) {
        const el_target target = rows_of(b, y, y + lines < SIZE ? y + lines : SIZE);
        if (!is_set_up || anew) {
            is_set_up = el_triangle_setup(&triangle, corners, surface, y);
        }
        if (is_set_up && !el_triangle_is_done(&triangle)) {
            el_triangle_draw(&triangle, &target, &stats);
        }
    }
}

/* A triangle that is walked through bands, one that is set up anew in each, and one that is drawn at once are alike; and
 * only as much of it is touched as el_triangle_bytes says. */
static void test_bands_and_first_rows_do_not_matter(void)
{
    static buffers walked, anew;
    for (seeded s = seeded_from(73); s.round < PART_OF(2000); s.round++) {
        const el_surface surface = {.shading = (el_shading)any_below(&s, EL_SHADE_OVERDRAW + 1),
                                    .depth = any_below(&s, 2) == 0,
                                    .colour = (uint16_t)any_u64(&s),
                                    .uv_error_log2 = 3,
                                    .texture = &checker};
        const int32_t reach = ((int32_t)any_of_bits(&s, 14) + 32) * SIXTEENTH;
        el_corner corners[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_corner(&s, SIZE * EL_SUBPIXELS / 2, reach);
        }
        const int32_t lines = 1 + (int32_t)any_below(&s, SIZE);
        clear(&screen);
        clear(&walked);
        clear(&anew);
        draw(&screen, corners, &surface);
        draw_in_bands(&walked, corners, &surface, lines, false);
        draw_in_bands(&anew, corners, &surface, lines, true);
        if (memcmp(&screen, &walked, sizeof screen) != 0 || memcmp(&screen, &anew, sizeof screen) != 0) {
            fail_at(&s, "shading %d in bands of %d", (int)surface.shading, (int)lines);
        }
    }
}

static bool has_same_planes(const el_corner a[3], const el_corner b[3], const el_surface *surface)
{
    el_triangle first = {0};
    el_triangle second = {0};
    if (!el_triangle_setup(&first, a, surface, 0)) {
        return !el_triangle_setup(&second, b, surface, 0);
    }
    return el_triangle_setup(&second, b, surface, 0) &&
           memcmp(&first.z, &second.z, el_triangle_bytes(surface->shading) - offsetof(el_triangle, z)) == 0;
}

static void test_corners_in_any_order_give_the_same_pixels(void)
{
    static buffers turned;
    for (seeded s = seeded_from(74); s.round < PART_OF(1000); s.round++) {
        const el_surface surface = {.shading = (el_shading)any_below(&s, EL_SHADE_OVERDRAW),
                                    .depth = true,
                                    .uv_error_log2 = 3,
                                    .texture = &checker};
        el_corner corners[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_corner(&s, SIZE * EL_SUBPIXELS / 2, 500 * SIXTEENTH);
        }
        if (any_below(&s, 2) == 0) {
            corners[1].y = corners[0].y; /* level ones have an order too */
        }
        const el_corner other[3] = {corners[1], corners[0], corners[2]};
        clear(&screen);
        clear(&turned);
        draw(&screen, corners, &surface);
        draw(&turned, other, &surface);
        if (memcmp(&screen, &turned, sizeof screen) != 0 || !has_same_planes(corners, other, &surface)) {
            fail_at(&s, "shading %d", (int)surface.shading);
        }
    }
}

/* --- Textures ----------------------------------------------------------------------------------------------------- */

/* One texel per pixel, starting at (u, v), seen without perspective. */
static void texture_corners(el_corner corners[3], int32_t u, int32_t v, uint16_t light_q8)
{
    half_screen(corners, (el_corner){.z = 1, .w = 1 << 30, .rgb_q8 = {light_q8, light_q8, light_q8}});
    for (unsigned i = 0; i < 3; i++) {
        corners[i].u_q16 = u * 65536 + corners[i].x * (65536 / EL_SUBPIXELS);
        corners[i].v_q16 = v * 65536 + corners[i].y * (65536 / EL_SUBPIXELS);
    }
}

/* Texel (i, j) covers [i, i + 1) x [j, j + 1), and the picture repeats to the left and upwards too. */
static void test_textures_repeat_in_all_directions(void)
{
    for (int32_t start = -37; start <= 37; start += 37) {
        el_corner corners[3];
        clear(&screen);
        texture_corners(corners, start, -start, 0);
        draw(&screen, corners,
             &(el_surface){.shading = EL_SHADE_TEXTURED, .depth = true, .uv_error_log2 = 3, .texture = &checker});
        for (int32_t i = 0; i < PIXELS; i++) {
            const uint32_t column = (uint32_t)(start + i % SIZE) % 4;
            const uint32_t line = (uint32_t)(-start + i / SIZE) % 2;
            TEST_ASSERT_EQUAL_HEX16(texels[line * 4 + column], screen.colour[i]);
        }
    }
}

static void test_full_light_leaves_the_texel(void)
{
    el_corner corners[3];
    clear(&screen);
    texture_corners(corners, 0, 0, 0xFF00);
    draw(&screen, corners,
         &(el_surface){.shading = EL_SHADE_TEXTURED_GOURAUD, .depth = true, .uv_error_log2 = 3, .texture = &checker});
    for (int32_t i = 0; i < PIXELS; i++) {
        TEST_ASSERT_EQUAL_HEX16(texels[i / SIZE % 2 * 4 + i % SIZE % 4], screen.colour[i]);
    }
}

/* A light of l leaves floor(channel * (l + 1) / 256) of each channel. */
static void test_each_light_of_each_texel(void)
{
    for (uint32_t light = 0; light < 256; light++) {
        el_corner corners[3];
        clear(&screen);
        texture_corners(corners, 0, 0, (uint16_t)(light << 8));
        draw(&screen, corners,
             &(el_surface){.shading = EL_SHADE_TEXTURED_GOURAUD, .uv_error_log2 = 3, .texture = &checker});
        for (uint32_t i = 0; i < 8; i++) {
            const uint32_t red = (texels[i] >> 11U) * (light + 1) / 256;
            const uint32_t green = (texels[i] >> 5U & 63U) * (light + 1) / 256;
            const uint32_t blue = (texels[i] & 31U) * (light + 1) / 256;
            TEST_ASSERT_EQUAL_HEX16(red << 11 | green << 5 | blue, screen.colour[i / 4 * SIZE + i % 4]);
        }
    }
}

static void test_state_sizes_cover_what_a_shading_uses(void)
{
    TEST_ASSERT_EQUAL_UINT32(offsetof(el_triangle, rgb), el_triangle_bytes(EL_SHADE_FLAT));
    TEST_ASSERT_EQUAL_UINT32(offsetof(el_triangle, rgb), el_triangle_bytes(EL_SHADE_OVERDRAW));
    TEST_ASSERT_EQUAL_UINT32(offsetof(el_triangle, perspective), el_triangle_bytes(EL_SHADE_GOURAUD));
    TEST_ASSERT_EQUAL_UINT32(sizeof(el_triangle), el_triangle_bytes(EL_SHADE_TEXTURED));
    TEST_ASSERT_EQUAL_UINT32(sizeof(el_triangle), el_triangle_bytes(EL_SHADE_TEXTURED_GOURAUD));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_on_equal_depth_the_first_one_stays);
    RUN_TEST(test_the_far_plane_is_drawn);
    RUN_TEST(test_without_depth_nothing_is_tested_or_written);
    RUN_TEST(test_overdraw_counts);
    RUN_TEST(test_gouraud_samples_against_exact_planes);
    RUN_TEST(test_textured_samples_against_exact_planes);
    RUN_TEST(test_pixels_are_the_rounded_samples);
    RUN_TEST(test_bands_and_first_rows_do_not_matter);
    RUN_TEST(test_corners_in_any_order_give_the_same_pixels);
    RUN_TEST(test_textures_repeat_in_all_directions);
    RUN_TEST(test_full_light_leaves_the_texel);
    RUN_TEST(test_each_light_of_each_texel);
    RUN_TEST(test_state_sizes_cover_what_a_shading_uses);
    return UNITY_END();
}
