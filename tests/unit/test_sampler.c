/* Texels of textures of any size, format and border, nearest and smooth, against what one finds by remainders and by the four
 * centres around a place; and which texture of a chain a triangle gets. */
#include <string.h>

#include "any_triangle.h"
#include "raster/sampler.h"
#include "raster/texel_line.h"
#include "raster/texture.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

#if EL_WITH_MIXED

enum { SIDE = 24, TEXELS = SIDE * SIDE };

/* A picture in its format, and what it shows: `shown` of 0 to 256. */
typedef struct picture {
    el_image image;
    uint16_t words[TEXELS];
    uint8_t bytes[TEXELS];
    uint16_t palette[256];
    uint8_t alpha[TEXELS];
    uint16_t colour[TEXELS];
    uint32_t shown[TEXELS];
} picture;

static picture p;

static void put_value(uint32_t x, uint32_t y, uint32_t value, el_image_format format, uint32_t width)
{
    if (format == EL_IMAGE_RGB565) {
        p.words[y * width + x] = (uint16_t)value;
    } else if (format == EL_IMAGE_INDEX8) {
        p.bytes[y * width + x] = (uint8_t)value;
    } else if (format == EL_IMAGE_INDEX4) {
        p.bytes[y * ((width + 1) / 2) + x / 2] |= (uint8_t)(value << (x % 2 == 0 ? 4 : 0));
    } else {
        p.bytes[y * ((width + 7) / 8) + x / 8] |= (uint8_t)(value << (7 - x % 8));
    }
}

/* Often a power of two, of which there are ways of their own. */
static uint16_t any_side(seeded *s)
{
    return (uint16_t)(any_below(s, 2) == 0 ? 1U << any_below(s, 5) : (uint32_t)any_between(s, 1, SIDE));
}

static void any_picture(seeded *s)
{
    static const uint32_t values[] = {65536, 256, 16, 2};
    memset(&p, 0, sizeof p);
    const el_image_format format = (el_image_format)any_below(s, EL_IMAGE_MASK + 1);
    const bool few = any_below(s, 2) == 0;
    p.image = (el_image){.width = any_side(s),
                         .height = any_side(s),
                         .format = (uint8_t)format,
                         .has_key = any_below(s, 2) == 0,
                         .key = (uint16_t)any_below(s, 2),
                         .pixels = format == EL_IMAGE_RGB565 ? (const void *)p.words : (const void *)p.bytes,
                         .palette = p.palette,
                         .alpha = any_below(s, 3) == 0 ? p.alpha : NULL};
    for (unsigned i = 0; i < 256; i++) {
        p.palette[i] = (uint16_t)any_u64(s);
    }
    for (uint32_t i = 0; i < (uint32_t)p.image.width * p.image.height; i++) {
        const uint32_t value = any_below(s, few ? 2 : values[format]);
        const uint8_t alpha = (uint8_t)any_u64(s);
        p.alpha[i] = alpha;
        put_value(i % p.image.width, i / p.image.width, value, format, p.image.width);
        p.colour[i] = format == EL_IMAGE_RGB565 ? (uint16_t)value : p.palette[format == EL_IMAGE_MASK ? 0 : value];
        const bool is_there = !(p.image.has_key && value == p.image.key) && !(format == EL_IMAGE_MASK && value == 0);
        p.shown[i] = !is_there ? 0 : (p.image.alpha == NULL ? 256U : alpha + (alpha >= 128 ? 1U : 0U));
    }
}

static int32_t place(int32_t at, int32_t size, el_wrap wrap)
{
    if (wrap == EL_WRAP_CLAMP) {
        return at < 0 ? 0 : (at >= size ? size - 1 : at);
    }
    const int32_t period = wrap == EL_WRAP_MIRROR ? 2 * size : size;
    const int32_t rest = (at % period + period) % period;
    return rest < size ? rest : period - 1 - rest;
}

static void test_what_is_beyond_the_borders(void)
{
    static const uint16_t texel = 0;
    for (int32_t size = 1; size <= EL_TEXTURE_MAX_SIDE; size += size < 40 || size > 1010 ? 1 : 37) {
        for (unsigned wrap = 0; wrap <= EL_WRAP_MIRROR; wrap++) {
            const el_image image = {.width = (uint16_t)size, .height = 1, .pixels = &texel};
            el_sampler sampler;
            el_sampler_make(&sampler, &(el_texture){.image = &image, .wrap_u = (uint8_t)wrap});
            for (int32_t at = -2056; at <= 2056; at++) {
                const uint32_t found = el_sampler_place(&sampler.u, at);
                if (found != (uint32_t)place(at, size, (el_wrap)wrap)) {
                    seeded none = {0};
                    fail_at(&none, "texel %ld of %ld, wrap %u: %lu", (long)at, (long)size, wrap, (unsigned long)found);
                }
            }
        }
    }
}

/* Any coordinate at all leads to some texel. */
static void test_nothing_leads_out_of_the_texture(void)
{
    for (seeded s = seeded_from(901); s.round < PART_OF(20000U); s.round++) {
        any_picture(&s);
        const el_texture texture = {.image = &p.image, .wrap_u = (uint8_t)any_below(&s, 3)};
        el_sampler sampler;
        el_sampler_make(&sampler, &texture);
        TEST_ASSERT_LESS_THAN_UINT32(p.image.width, el_sampler_place(&sampler.u, (int32_t)any_u64(&s)));
    }
}

/* The mean of four by distance, and by what they show. */
static uint32_t smooth_at(const el_texture *texture, int32_t u_q16, int32_t v_q16, uint16_t *colour)
{
    const int32_t u = (u_q16 - 0x8000) >> 12;
    const int32_t v = (v_q16 - 0x8000) >> 12;
    uint64_t sums[4] = {0};
    for (int32_t i = 0; i < 4; i++) {
        const int32_t x = place((u >> 4) + i % 2, p.image.width, (el_wrap)texture->wrap_u);
        const int32_t y = place((v >> 4) + i / 2, p.image.height, (el_wrap)texture->wrap_v);
        const int32_t across = i % 2 == 0 ? 16 - (u & 15) : u & 15;
        const int32_t down = i / 2 == 0 ? 16 - (v & 15) : v & 15;
        const uint64_t weight = (uint64_t)(across * down) * p.shown[y * p.image.width + x];
        const uint16_t texel = p.colour[y * p.image.width + x];
        sums[0] += weight * (texel >> 11);
        sums[1] += weight * (texel >> 5 & 63U);
        sums[2] += weight * (texel & 31U);
        sums[3] += weight;
    }
    if (sums[3] != 0) {
        for (unsigned i = 0; i < 3; i++) {
            sums[i] = (2 * sums[i] + sums[3]) / (2 * sums[3]);
        }
        *colour = (uint16_t)(sums[0] << 11 | sums[1] << 5 | sums[2]);
    }
    return (uint32_t)((sums[3] + 128) / 256);
}

/* Of the picture. */
static el_texture any_texture(seeded *s)
{
    return (el_texture){.image = &p.image,
                        .wrap_u = (uint8_t)any_below(s, 3),
                        .wrap_v = (uint8_t)any_below(s, 3),
                        .smooth = any_below(s, 2) == 0};
}

static void test_texels_of_every_kind(void)
{
    uint32_t hidden = 0;
    for (seeded s = seeded_from(902); s.round < PART_OF(4000U); s.round++) {
        any_picture(&s);
        const el_texture texture = any_texture(&s);
        el_sampler sampler;
        el_sampler_make(&sampler, &texture);
        for (unsigned i = 0; i < 40; i++) {
            const int32_t u_q16 = (int32_t)any_signed_of_bits(&s, 27);
            const int32_t v_q16 = (int32_t)any_signed_of_bits(&s, 27);
            uint16_t expected = 0;
            uint32_t shown;
            if (texture.smooth) {
                shown = smooth_at(&texture, u_q16, v_q16, &expected);
            } else {
                const int32_t at = place(v_q16 >> 16, p.image.height, (el_wrap)texture.wrap_v) * p.image.width +
                                   place(u_q16 >> 16, p.image.width, (el_wrap)texture.wrap_u);
                expected = p.colour[at];
                shown = p.shown[at];
            }
            uint16_t colour = 0;
            const uint32_t found = el_sampler_at(&sampler, (uint32_t)u_q16, (uint32_t)v_q16, &colour);
            hidden += shown == 0;
            if (found != shown || (shown != 0 && colour != expected)) {
                fail_at(&s, "at (%ld, %ld) is %04x, %lu shown, not %04x, %lu", (long)u_q16, (long)v_q16, colour,
                        (unsigned long)found, expected, (unsigned long)shown);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(10000U), hidden);
}

#if !EL_SMALL_CODE
enum { TEXEL = 1 << 16, ROWS = 6 };

/* Anywhere; or on a border of a picture, one of which is where it lies, or between two texels, or next to that. */
static uint32_t any_place(seeded *s, uint32_t side)
{
    if (any_below(s, 3) == 0) {
        return (uint32_t)any_signed_of_bits(s, 26);
    }
    const uint32_t border = (uint32_t)any_between(s, -3, 3) * side * TEXEL;
    return border + any_below(s, 3) * (TEXEL / 2) - TEXEL / 2 + (uint32_t)any_between(s, -1, 1);
}

static uint32_t any_step(seeded *s)
{
    static const unsigned bits[] = {12, 17, 20, 32};
    return any_below(s, 3) == 0 ? (uint32_t)any_between(s, -2, 2) * (TEXEL / 2)
                                : (uint32_t)any_signed_of_bits(s, bits[any_below(s, 16) == 0 ? 3 : any_below(s, 3)]);
}

/* A row that begins or ends somewhere. A step that leads out of all coordinates is not one of those that there are: such rows
 * have one pixel. */
static el_texel_row any_row(seeded *s, uint16_t *colour)
{
    el_texel_row row = {.u_q16 = any_place(s, p.image.width),
                        .v_q16 = any_place(s, p.image.height),
                        .u_step_q16 = any_step(s),
                        .v_step_q16 = any_step(s),
                        .colour = colour,
                        .count = (uint32_t)any_between(s, 1, EL_MAX_PIECE)};
    if (row.u_step_q16 + (1U << 20) > 2U << 20 || row.v_step_q16 + (1U << 20) > 2U << 20) {
        row.count = 1;
    }
    if (any_below(s, 2) == 0) {
        row.u_q16 -= (row.count - 1) * row.u_step_q16;
        row.v_q16 -= (row.count - 1) * row.v_step_q16;
    }
    return row;
}

static void check_row(const seeded *s, el_texel_line *line, const el_texel_row *row)
{
    const el_sampler *const sampler = line->sampler;
    uint16_t shown[EL_MAX_PIECE] = {0};
    el_texel_line_draw(line, row, shown);
    for (uint32_t i = 0; i < row->count; i++) {
        uint16_t expected = 0;
        const uint32_t parts =
            el_sampler_at(sampler, row->u_q16 + i * row->u_step_q16, row->v_q16 + i * row->v_step_q16, &expected);
        const uint32_t found = sampler->is_open ? shown[i] : 256U;
        if (found != parts || (parts != 0 && row->colour[i] != expected)) {
            fail_at(s, "texel %lu by way %d is %04x, %lu shown, not %04x, %lu", (unsigned long)i, (int)line->way,
                    row->colour[i], (unsigned long)found, expected, (unsigned long)parts);
        }
    }
}

/* Whatever its coordinates, a row has texels of the picture alone, which are of one colour; around them is another. */
static void test_rows_stay_within_the_picture(void)
{
    enum { INSIDE = 0x1234, OUTSIDE = 0xFFFF };
    static uint16_t memory[3 * TEXELS];
    for (seeded s = seeded_from(905); s.round < PART_OF(20000U); s.round++) {
        p.image = (el_image){.width = any_side(&s),
                             .height = any_side(&s),
                             .has_key = any_below(&s, 2) == 0,
                             .key = OUTSIDE,
                             .pixels = &memory[TEXELS]};
        for (uint32_t i = 0; i < 3 * TEXELS; i++) {
            const bool is_inside = i >= TEXELS && i < TEXELS + (uint32_t)p.image.width * p.image.height;
            memory[i] = is_inside ? INSIDE : OUTSIDE;
        }
        const el_texture texture = any_texture(&s);
        el_sampler sampler;
        el_sampler_make(&sampler, &texture);
        el_texel_line line;
        el_texel_line_make(&line, &sampler);
        for (unsigned i = 0; i < ROWS; i++) {
            uint16_t colour[EL_MAX_PIECE];
            uint16_t shown[EL_MAX_PIECE] = {0};
            el_texel_row row = any_row(&s, colour);
            if (any_below(&s, 2) == 0) {
                row.u_q16 = (uint32_t)any_u64(&s);
                row.v_q16 = (uint32_t)any_u64(&s);
                row.u_step_q16 = (uint32_t)any_u64(&s);
                row.v_step_q16 = (uint32_t)any_u64(&s);
                row.count = EL_MAX_PIECE;
            }
            el_texel_line_draw(&line, &row, shown);
            for (uint32_t j = 0; j < row.count; j++) {
                if ((sampler.is_open && shown[j] != 256) || colour[j] != INSIDE) {
                    fail_at(&s, "texel %lu by way %d is %04x", (unsigned long)j, (int)line.way, colour[j]);
                }
            }
        }
    }
}

/* Rows of texels, found in the way of their texture, are those of the sampler: several in turn, as the next one begins where
 * the last one has been. */
static void test_rows_are_as_one_at_a_time(void)
{
    uint32_t times[EL_TEXELS_REPEATED + 1] = {0};
    for (seeded s = seeded_from(904); s.round < PART_OF(20000U); s.round++) {
        any_picture(&s);
        if (any_below(&s, 2) == 0) { /* for which there are ways that others have not */
            p.image.width = (uint16_t)(1U << (el_bit_length_u32(p.image.width) - 1));
            p.image.height = (uint16_t)(1U << (el_bit_length_u32(p.image.height) - 1));
        }
        const el_texture texture = {.image = &p.image,
                                    .wrap_u = (uint8_t)(any_below(&s, 2) * any_below(&s, 3)),
                                    .wrap_v = (uint8_t)(any_below(&s, 2) * any_below(&s, 3)),
                                    .smooth = any_below(&s, 2) == 0};
        el_sampler sampler;
        el_sampler_make(&sampler, &texture);
        el_texel_line line;
        el_texel_line_make(&line, &sampler);
        times[line.way < EL_TEXELS_REPEATED ? line.way : EL_TEXELS_REPEATED]++;
        for (unsigned i = 0; i < ROWS; i++) {
            uint16_t colour[EL_MAX_PIECE];
            const el_texel_row row = any_row(&s, colour);
            check_row(&s, &line, &row);
        }
    }
    for (unsigned i = 0; i <= EL_TEXELS_REPEATED; i++) {
        TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(100U), times[i]);
    }
}
#endif
#endif

#if EL_WITH_MIPMAPS
enum { LEVELS = 5 };
static const uint16_t black[256];
static const el_texture chain[LEVELS] = {
    {.texels = black, .width_log2 = 4, .height_log2 = 3, .smaller = &chain[1]},
    {.texels = black, .width_log2 = 3, .height_log2 = 2, .smaller = &chain[2]},
    {.texels = black, .width_log2 = 2, .height_log2 = 1, .smaller = &chain[3]},
    {.texels = black, .width_log2 = 1, .height_log2 = 0, .smaller = &chain[4]},
    {.texels = black, .width_log2 = 0, .height_log2 = 0},
};

/* Doubled, of three points: numbers that a double holds. */
static double area(const int64_t x[3], const int64_t y[3])
{
    const int64_t doubled = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    return (double)(doubled < 0 ? -doubled : doubled);
}

/* The first level with less than two texels per pixel. Often exactly two. */
static void test_a_triangles_level(void)
{
    uint32_t times[LEVELS] = {0};
    for (seeded s = seeded_from(903); s.round < PART_OF(100000U); s.round++) {
        el_corner corners[3];
        int64_t x[3];
        int64_t y[3];
        int64_t u[3];
        int64_t v[3];
        const bool is_exact = any_below(&s, 2) == 0;
        const unsigned more = (unsigned)any_below(&s, 18);
        const int64_t reach = is_exact ? 10 : 200;
        for (unsigned i = 0; i < 3; i++) {
            x[i] = any_between(&s, -reach, reach) * EL_SUBPIXELS;
            y[i] = any_between(&s, -reach, reach) * EL_SUBPIXELS;
            /* Of the same shape, and 2^more times as large; or of any. */
            u[i] = is_exact ? x[i] / EL_SUBPIXELS * 128 * (1 << more) : any_signed_of_bits(&s, 26);
            v[i] = is_exact ? y[i] / EL_SUBPIXELS * 65536 : any_signed_of_bits(&s, 26);
            corners[i] =
                (el_corner){.x = (int32_t)x[i], .y = (int32_t)y[i], .u_q16 = (int32_t)u[i], .v_q16 = (int32_t)v[i]};
        }
        const double on_screen = area(x, y) / EL_SUBPIXELS / EL_SUBPIXELS;
        if (on_screen == 0) {
            continue;
        }
        double in_texels = area(u, v) / 65536 / 65536;
        unsigned expected = 0;
        while (expected < LEVELS - 1 && in_texels >= 2 * on_screen) {
            in_texels /= 4;
            expected++;
        }
        times[expected]++;
        if (el_mip_level(chain, corners) != expected) {
            fail_at(&s, "level %u, not %u", el_mip_level(chain, corners), expected);
        }
    }
    for (unsigned i = 0; i < LEVELS; i++) {
        TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(1000U), times[i]);
    }
}

static void test_chains_that_are_refused(void)
{
    TEST_ASSERT_TRUE(el_texture_is_good(chain));
    static const uint8_t sizes[][2] = {{4, 2}, {3, 3}, {2, 2}, {3, 1}};
    for (unsigned i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const el_texture other = {.texels = black, .width_log2 = sizes[i][0], .height_log2 = sizes[i][1]};
        el_texture first = chain[0];
        first.smaller = &other;
        TEST_ASSERT_FALSE(el_texture_is_good(&first));
    }
    /* One that has itself behind it. */
    el_texture ring = {.texels = black};
    ring.smaller = &ring;
    TEST_ASSERT_FALSE(el_texture_is_good(&ring));
    el_texture empty = chain[3];
    el_texture last = chain[4];
    empty.smaller = &last;
    TEST_ASSERT_TRUE(el_texture_is_good(&empty));
    last.texels = NULL;
    TEST_ASSERT_FALSE(el_texture_is_good(&empty));
}
#endif

int main(void)
{
    UNITY_BEGIN();
#if EL_WITH_MIXED
    RUN_TEST(test_what_is_beyond_the_borders);
    RUN_TEST(test_nothing_leads_out_of_the_texture);
    RUN_TEST(test_texels_of_every_kind);
#if !EL_SMALL_CODE
    RUN_TEST(test_rows_stay_within_the_picture);
    RUN_TEST(test_rows_are_as_one_at_a_time);
#endif
#endif
#if EL_WITH_MIPMAPS
    RUN_TEST(test_a_triangles_level);
    RUN_TEST(test_chains_that_are_refused);
#endif
    return UNITY_END();
}
