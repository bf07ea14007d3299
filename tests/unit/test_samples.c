/* Several samples per pixel: which are covered, with which depth and colour, and what becomes of a pixel. */
#include <stdlib.h>
#include <string.h>

#include "any_triangle.h"
#include "raster/samples.h"
#include "raster/small_sampled.h"

void setUp(void)
{
}

void tearDown(void)
{
}

#if EL_WITH_SAMPLES

enum { WIDTH = 40, TOP = 3, ROWS = 12, PIXELS = WIDTH * ROWS, EMPTY = 0xFFFF };

static uint16_t colours[PIXELS];
static uint16_t depths[PIXELS];
static uint32_t mixed[EL_MIXED_WORDS(WIDTH) * ROWS];
static uint32_t samples[PIXELS * EL_MAX_SAMPLES];

static el_sampled_target empty_target(unsigned count)
{
    memset(colours, 0, sizeof colours);
    memset(depths, 0xFF, sizeof depths);
    memset(mixed, 0, sizeof mixed);
    return (el_sampled_target){
        .target = {.colour = colours, .depth = depths, .width = WIDTH, .y = TOP, .y_end = TOP + ROWS},
        .mixed = mixed,
        .samples = samples,
        .count = count,
    };
}

static el_sampled_rest draw_sampled(const el_corner corners[3], const el_surface *surface,
                                    const el_sampled_target *target)
{
    el_stats stats = {0};
#if EL_WITH_SMALL_SAMPLED
    el_small_sampled place;
    return el_sampled_draw(corners, surface, target, &stats, &place);
#else
    return el_sampled_draw(corners, surface, target, &stats, NULL);
#endif
}

/* Depth and colour of a sample, wherever they are. */
static uint32_t sample_at(const el_sampled_target *target, int32_t x, int32_t y, unsigned k)
{
    const uint32_t pixel = (uint32_t)((y - TOP) * WIDTH + x);
    if ((mixed[pixel / 32U] << (pixel % 32U) & 0x80000000U) != 0) {
        const uint32_t mask = colours[pixel];
        return samples[pixel * target->count + (mask == 0 ? k : (mask >> k & 1U) ^ 1U)];
    }
    return (uint32_t)depths[pixel] << 16 | colours[pixel];
}

static bool covers_sample(const el_corner corners[3], unsigned count, int32_t x, int32_t y, unsigned k)
{
    const el_sample_point *const point = &el_sample_points(count)[k];
    return reference_covers_point(corners, x * EL_SUBPIXELS + EL_SUBPIXELS / 2 + point->x,
                                  y * EL_SUBPIXELS + EL_SUBPIXELS / 2 + point->y);
}

/* The plane through the corners' values at a point, and 2^-more_log2, rounded, halves up: exact. */
static int64_t exact_value(const el_corner c[3], const int32_t values[3], int64_t x, int64_t y, unsigned more_log2)
{
    const int64_t area = reference_side(&c[0], &c[1], c[2].x, c[2].y);
    int64_t sum = 0;
    for (unsigned i = 0; i < 3; i++) {
        sum += values[i] * reference_side(&c[(i + 1) % 3], &c[(i + 2) % 3], x, y);
    }
    const int64_t d = 2 * (area < 0 ? -area : area);
    const int64_t n = (2 * sum + area) * (area < 0 ? -1 : 1) + (d >> more_log2);
    return n >= 0 ? n / d : -((-n + d - 1) / d);
}

static int32_t snapped(seeded *s, int32_t a)
{
    /* Some corners on samples and centres, some on pixel corners. */
    static const int32_t places[] = {0, 1, 2, 5, 6, 8, 10, 11, 14, 15};
    const int32_t pixel = a / EL_SUBPIXELS * EL_SUBPIXELS;
    return any_below(s, 3) != 0 ? a : pixel + places[any_below(s, 10)] * SIXTEENTH;
}

static void any_corners(seeded *s, el_corner c[3])
{
    static const int32_t reaches[] = {1, 2, 4, 9, 20, 60, 1500};
    const int32_t reach = reaches[any_below(s, 7)] * EL_SUBPIXELS;
    const int32_t middle_x = (int32_t)any_between(s, 0, WIDTH * EL_SUBPIXELS);
    const int32_t middle_y = (int32_t)any_between(s, TOP * EL_SUBPIXELS, (TOP + ROWS) * EL_SUBPIXELS);
    for (unsigned i = 0; i < 3; i++) {
        c[i] = any_corner(s, 0, reach);
        c[i].x = snapped(s, c[i].x + middle_x);
        c[i].y = snapped(s, c[i].y + middle_y);
    }
    if (any_below(s, 8) == 0) { /* a sliver */
        c[1].x = c[0].x + (int32_t)any_between(s, -3, 3);
        c[1].y = c[0].y + (int32_t)any_between(s, -3, 3);
    }
}

/* Whether all of a pixel's samples are covered, and else the first that is; `count`: none is. */
static unsigned first_covered(const el_corner c[3], unsigned count, int32_t x, int32_t y, bool *all)
{
    unsigned first = count;
    *all = true;
    for (unsigned k = count; k-- > 0;) {
        if (covers_sample(c, count, x, y, k)) {
            first = k;
        } else {
            *all = false;
        }
    }
    return first;
}

static void check_pixel(const seeded *s, const el_sampled_target *target, const el_corner c[3], int32_t x, int32_t y)
{
    const unsigned count = target->count;
    bool all;
    const unsigned first = first_covered(c, count, x, y, &all);
    const el_sample_point centre = {0, 0};
    const el_sample_point *const where = all || first == count ? &centre : &el_sample_points(count)[first];
    const int64_t at_x = x * EL_SUBPIXELS + EL_SUBPIXELS / 2 + where->x;
    const int64_t at_y = y * EL_SUBPIXELS + EL_SUBPIXELS / 2 + where->y;
    const int32_t z[3] = {c[0].z, c[1].z, c[2].z};
    for (unsigned k = 0; k < count; k++) {
        const uint32_t found = sample_at(target, x, y, k);
        const bool covered = covers_sample(c, count, x, y, k);
        if (!covered && found != (uint32_t)EMPTY << 16) {
            fail_at(s, "sample %u of %u, pixel %d, %d is drawn as %08x", k, count, (int)x, (int)y, (unsigned)found);
        }
        if (!covered) {
            continue;
        }
        /* What is less than 2^-18 below a half may be rounded up. */
        const int64_t depth = exact_value(c, z, at_x, at_y, 62);
        if (found >> 16 != depth && found >> 16 != exact_value(c, z, at_x, at_y, 18)) {
            fail_at(s, "sample %u of %u, pixel %d, %d has depth %u, not %d", k, count, (int)x, (int)y,
                    (unsigned)(found >> 16), (int)depth);
        }
        for (unsigned channel = 0; channel < 3; channel++) {
            static const unsigned downs[] = {11, 5, 0};
            static const unsigned bits[] = {5, 6, 5};
            const int32_t values[3] = {c[0].rgb_q8[channel], c[1].rgb_q8[channel], c[2].rgb_q8[channel]};
            /* 8.8: within 2^-12 of it before the last rounding, which a level's border may lie in. */
            const int64_t value = exact_value(c, values, at_x, at_y, 62);
            const int64_t level = (int64_t)(found >> downs[channel] & ((1U << bits[channel]) - 1U));
            const int64_t least = ((value + 127) >> 8) >> (8U - bits[channel]);
            const int64_t most = ((value + 129) >> 8) >> (8U - bits[channel]);
            if (level < least || level > most) {
                fail_at(s, "sample %u of %u, pixel %d, %d: channel %u is %d, not %d", k, count, (int)x, (int)y, channel,
                        (int)level, (int)least);
            }
        }
    }
}

/* Every sample of every pixel, and whether the triangle goes on below. */
static void check_triangle(const seeded *s, const el_corner c[3], const el_surface *surface, unsigned count)
{
    const el_sampled_target target = empty_target(count);
    const bool goes_on = draw_sampled(c, surface, &target) != EL_SAMPLED_DONE;
    bool any_below_band = false;
    for (int32_t x = 0; x < WIDTH; x++) {
        for (int32_t y = TOP; y < TOP + ROWS; y++) {
            check_pixel(s, &target, c, x, y);
        }
        for (unsigned k = 0; k < count; k++) {
            any_below_band = any_below_band || covers_sample(c, count, x, TOP + ROWS, k);
        }
    }
    if (any_below_band && !goes_on) {
        fail_at(s, "the triangle ends before the next band, where it has samples");
    }
}

/* Coordinates of both sides of zero are in the range of exact_value: |value| < 2^16, area < 2^(2 * 13 + 2 * 4). */
static void test_every_sample_is_exact(void)
{
    seeded s = seeded_from(71);
    const el_surface coloured = {.shading = EL_SHADE_GOURAUD, .depth = true};
    for (s.round = 0; s.round < PART_OF(12000); s.round++) {
        el_corner c[3];
        any_corners(&s, c);
        check_triangle(&s, c, &coloured, s.round % 2 == 0 ? 4 : 8);
    }
}

/* Of two triangles with a common edge, each sample beside it belongs to one: the second finds what the first left. */
static void test_shared_edges_leave_and_repeat_nothing(void)
{
    seeded s = seeded_from(72);
    const el_surface first = {.depth = true, .colour = 0xF800};
    const el_surface second = {.depth = true, .colour = 0x001F};
    uint32_t split = 0;
    for (s.round = 0; s.round < PART_OF(4000); s.round++) {
        el_corner a[3];
        any_corners(&s, a);
        el_corner b[3] = {a[1], a[0], a[2]};
        /* On the other side of the edge from corner 0 to corner 1. */
        b[2].x = a[0].x + a[1].x - a[2].x;
        b[2].y = a[0].y + a[1].y - a[2].y;
        for (unsigned i = 0; i < 3; i++) {
            a[i].z = 7;
            b[i].z = 7;
        }
        const unsigned count = s.round % 2 == 0 ? 4 : 8;
        const el_sampled_target target = empty_target(count);
        (void)draw_sampled(a, &first, &target);
        (void)draw_sampled(b, &second, &target);
        for (int32_t i = 0; i < PIXELS; i++) {
            const int32_t x = i % WIDTH;
            const int32_t y = TOP + i / WIDTH;
            uint32_t seen = 0;
            for (unsigned k = 0; k < count; k++) {
                const bool in_a = covers_sample(a, count, x, y, k);
                const bool in_b = covers_sample(b, count, x, y, k);
                const uint32_t wanted = in_a ? 0x0007F800U : in_b ? 0x0007001FU : 0xFFFF0000U;
                if (sample_at(&target, x, y, k) != wanted || (in_a && in_b)) {
                    fail_at(&s, "sample %u of %u of pixel %d, %d", k, count, (int)x, (int)y);
                }
                seen |= in_a ? 1U : in_b ? 2U : 0U;
            }
            split += seen == 3U;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(4000), split);
}

/* Many triangles over each other, against samples that are kept one by one: nearer ones win, of equal depths the first; those
 * without depth always. */
static void test_triangles_over_each_other(void)
{
    static uint32_t plain[PIXELS * EL_MAX_SAMPLES];
    seeded s = seeded_from(73);
    for (s.round = 0; s.round < PART_OF(400); s.round++) {
        const unsigned count = s.round % 2 == 0 ? 4 : 8;
        const el_sampled_target target = empty_target(count);
        for (uint32_t i = 0; i < PIXELS * count; i++) {
            plain[i] = (uint32_t)EMPTY << 16;
        }
        for (unsigned n = 0; n < 12; n++) {
            el_corner c[3];
            any_corners(&s, c);
            const uint16_t z = (uint16_t)any_below(&s, 6);
            c[0].z = c[1].z = c[2].z = z;
            const el_surface surface = {.depth = any_below(&s, 4) != 0, .colour = (uint16_t)any_u64(&s)};
            (void)draw_sampled(c, &surface, &target);
            for (int32_t i = 0; i < PIXELS; i++) {
                for (unsigned k = 0; k < count; k++) {
                    uint32_t *const sample = &plain[(uint32_t)i * count + k];
                    if (!covers_sample(c, count, i % WIDTH, TOP + i / WIDTH, k)) {
                        continue;
                    }
                    if (!surface.depth) {
                        *sample = (*sample & 0xFFFF0000U) | surface.colour;
                    } else if (z < *sample >> 16) {
                        *sample = (uint32_t)z << 16 | surface.colour;
                    }
                }
            }
        }
        for (int32_t i = 0; i < PIXELS; i++) {
            for (unsigned k = 0; k < count; k++) {
                if (sample_at(&target, i % WIDTH, TOP + i / WIDTH, k) != plain[(uint32_t)i * count + k]) {
                    fail_at(&s, "sample %u of %u of pixel %d", k, count, (int)i);
                }
            }
        }
        el_samples_resolve(&target);
        for (int32_t i = 0; i < PIXELS; i++) {
            static const unsigned downs[] = {11, 5, 0};
            uint32_t nearest = UINT32_MAX;
            uint32_t sums[3] = {0, 0, 0};
            for (unsigned k = 0; k < count; k++) {
                const uint32_t sample = plain[(uint32_t)i * count + k];
                nearest = sample >> 16 < nearest ? sample >> 16 : nearest;
                for (unsigned channel = 0; channel < 3; channel++) {
                    sums[channel] += sample >> downs[channel] & (channel == 1 ? 63U : 31U);
                }
            }
            uint32_t mean = 0;
            for (unsigned channel = 0; channel < 3; channel++) {
                mean |= (sums[channel] + count / 2U) / count << downs[channel];
            }
            if (colours[i] != mean || depths[i] != nearest) {
                fail_at(&s, "pixel %d is %04x at %u, not %04x at %u", (int)i, colours[i], depths[i], (unsigned)mean,
                        (unsigned)nearest);
            }
        }
        for (uint32_t i = 0; i < sizeof mixed / sizeof mixed[0]; i++) {
            TEST_ASSERT_EQUAL_HEX32(0, mixed[i]);
        }
    }
}

/* One sample in each column and each row of the pixel, and the centre in the middle between two of them. */
static void test_patterns(void)
{
    for (unsigned count = 4; count <= EL_MAX_SAMPLES; count += 4) {
        const el_sample_point *const points = el_sample_points(count);
        uint32_t columns = 0;
        uint32_t rows = 0;
        bool has_middle = false;
        for (unsigned k = 0; k < count; k++) {
            columns |= 1U << ((unsigned)(points[k].x / SIXTEENTH + 8) * count / 16U);
            rows |= 1U << ((unsigned)(points[k].y / SIXTEENTH + 8) * count / 16U);
            TEST_ASSERT_LESS_OR_EQUAL_INT32(el_samples_reach(count), abs(points[k].x));
            TEST_ASSERT_LESS_OR_EQUAL_INT32(el_samples_reach(count), abs(points[k].y));
            for (unsigned i = 0; i < k; i++) {
                has_middle = has_middle || (points[i].x == -points[k].x && points[i].y == -points[k].y);
            }
        }
        TEST_ASSERT_EQUAL_HEX32((1U << count) - 1U, columns);
        TEST_ASSERT_EQUAL_HEX32((1U << count) - 1U, rows);
        TEST_ASSERT_TRUE(has_middle);
    }
    TEST_ASSERT_EQUAL_UINT8(0, el_samples_reach(1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_sample_is_exact);
    RUN_TEST(test_shared_edges_leave_and_repeat_nothing);
    RUN_TEST(test_triangles_over_each_other);
    RUN_TEST(test_patterns);
    return UNITY_END();
}

#else

static void test_samples_are_left_out(void)
{
    TEST_ASSERT_EQUAL_INT(0, EL_WITH_SAMPLES);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_samples_are_left_out);
    return UNITY_END();
}

#endif
