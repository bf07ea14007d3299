/* Which pixels a triangle covers: the top-left rule, as pictures for the cases that one wants to see, and exhaustively
 * against the exact edge functions on a small lattice. */
#include "any_triangle.h"
#include "ascii_picture.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static picture canvas;

static void add(char letter, int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t x2, int32_t y2)
{
    const int32_t points[3][2] = {{x0, y0}, {x1, y1}, {x2, y2}};
    picture_add_any_order(&canvas, points, letter);
}

/* --- Pictures ----------------------------------------------------------------------------------------------------- */

/* Corners on pixel corners: a square of two is full, its diagonal belongs to the one on the right or below. */
static void test_a_quad_split_both_ways(void)
{
    canvas = picture_of(6, 6);
    add('a', PX(1, 0), PX(1, 0), PX(5, 0), PX(1, 0), PX(1, 0), PX(5, 0));
    add('b', PX(5, 0), PX(1, 0), PX(5, 0), PX(5, 0), PX(1, 0), PX(5, 0));
    EXPECT_PICTURE(&canvas, "......", ".aaab.", ".aabb.", ".abbb.", ".bbbb.", "......");
    canvas = picture_of(6, 6);
    add('a', PX(1, 0), PX(1, 0), PX(5, 0), PX(1, 0), PX(5, 0), PX(5, 0));
    add('b', PX(1, 0), PX(1, 0), PX(5, 0), PX(5, 0), PX(1, 0), PX(5, 0));
    EXPECT_PICTURE(&canvas, "......", ".aaaa.", ".baaa.", ".bbaa.", ".bbba.", "......");
}

/* Sides through pixel centres: the left and the top side's pixels are in, the right and the bottom side's are not. */
static void test_sides_on_pixel_centres(void)
{
    canvas = picture_of(6, 6);
    add('a', PX(1, 8), PX(1, 8), PX(4, 8), PX(1, 8), PX(1, 8), PX(4, 8));
    add('b', PX(4, 8), PX(1, 8), PX(4, 8), PX(4, 8), PX(1, 8), PX(4, 8));
    EXPECT_PICTURE(&canvas, "......", ".aaa..", ".aab..", ".abb..", "......", "......");
}

/* One sixteenth before and after a centre. */
static void test_sides_beside_pixel_centres(void)
{
    canvas = picture_of(4, 4);
    add('a', PX(1, 7), PX(1, 7), PX(2, 9), PX(1, 7), PX(1, 7), PX(2, 9));
    add('b', PX(2, 9), PX(1, 7), PX(2, 9), PX(2, 9), PX(1, 7), PX(2, 9));
    EXPECT_PICTURE(&canvas, "....", ".ab.", ".bb.", "....");
    canvas = picture_of(4, 4);
    add('a', PX(1, 9), PX(1, 9), PX(2, 7), PX(1, 9), PX(1, 9), PX(2, 7));
    EXPECT_PICTURE(&canvas, "....", "....", "....", "....");
}

/* Around a vertex on a pixel centre: the centre belongs to one of them, and so does every other pixel. */
static void test_a_fan_about_a_centre(void)
{
    static const int32_t rim[8][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}; /* in 9/2 px */
    canvas = picture_of(9, 9);
    for (unsigned i = 0; i < 8; i++) {
        const int32_t *const p = rim[i];
        const int32_t *const q = rim[(i + 1) % 8];
        add((char)('a' + i), PX(4, 8), PX(4, 8), p[0] * PX(4, 8), p[1] * PX(4, 8), q[0] * PX(4, 8), q[1] * PX(4, 8));
    }
    EXPECT_PICTURE(&canvas, "aaaabbbbc", "haaabbbcc", "hhaabbccc", "hhhabcccc", "ggggddddd", "gggfedddd", "ggffeeddd",
                   "gfffeeedd", "ffffeeeed");
}

/* The tip of the second one is on a centre: on its left side, which counts, and on its right side, which does not. */
static void test_flat_tops_and_flat_bottoms(void)
{
    canvas = picture_of(7, 5);
    add('v', PX(0, 8), PX(0, 8), PX(6, 8), PX(0, 8), PX(3, 8), PX(3, 8));
    EXPECT_PICTURE(&canvas, "vvvvvv.", ".vvvv..", "..vv...", ".......", ".......");
    canvas = picture_of(7, 5);
    add('n', PX(3, 8), PX(0, 8), PX(6, 8), PX(3, 8), PX(0, 8), PX(3, 8));
    EXPECT_PICTURE(&canvas, ".......", "..nn...", ".nnnn..", ".......", ".......");
}

/* Thinner than a pixel, a sliver shows where a centre happens to be inside, and its twin takes all others. */
static void test_slivers(void)
{
    canvas = picture_of(10, 4);
    add('s', PX(0, 0), PX(0, 4), PX(10, 0), PX(3, 4), PX(10, 0), PX(4, 0));
    add('a', PX(0, 0), PX(0, 4), PX(10, 0), PX(0, 4), PX(10, 0), PX(3, 4));
    add('b', PX(0, 0), PX(0, 4), PX(10, 0), PX(4, 0), PX(0, 0), PX(4, 0));
    EXPECT_PICTURE(&canvas, "baaaaaaaaa", "bbbsaaaaaa", "bbbbbbsaaa", "bbbbbbbbbs");
}

static void test_no_area_no_pixels(void)
{
    canvas = picture_of(4, 4);
    add('x', PX(0, 8), PX(0, 8), PX(2, 8), PX(2, 8), PX(3, 8), PX(3, 8));
    add('x', PX(1, 8), PX(1, 8), PX(1, 8), PX(1, 8), PX(3, 8), PX(0, 8));
    add('x', PX(0, 0), PX(1, 8), PX(4, 0), PX(1, 8), PX(2, 0), PX(1, 8));
    EXPECT_PICTURE(&canvas, "....", "....", "....", "....");
}

/* Cut by all four sides of the screen, up to the guard band. */
static void test_clipping_at_the_screen(void)
{
    canvas = picture_of(5, 5);
    add('a', -EL_GUARD_SUB, -EL_GUARD_SUB, EL_GUARD_SUB, -EL_GUARD_SUB, -EL_GUARD_SUB, EL_GUARD_SUB);
    add('b', EL_GUARD_SUB, -EL_GUARD_SUB, EL_GUARD_SUB, EL_GUARD_SUB, -EL_GUARD_SUB, EL_GUARD_SUB);
    EXPECT_PICTURE(&canvas, "bbbbb", "bbbbb", "bbbbb", "bbbbb", "bbbbb");
    canvas = picture_of(5, 5);
    add('c', PX(-3, 0), PX(2, 0), PX(2, 0), PX(-3, 0), PX(2, 0), PX(7, 0));
    add('d', PX(8, 0), PX(2, 0), PX(2, 0), PX(-3, 0), PX(2, 0), PX(7, 0));
    EXPECT_PICTURE(&canvas, "ccddd", "ccddd", "ccddd", "ccddd", "ccddd");
    canvas = picture_of(5, 5);
    add('x', PX(-9, 0), PX(0, 0), PX(-1, 0), PX(0, 0), PX(-1, 0), PX(5, 0));
    add('x', PX(5, 8), PX(0, 0), PX(9, 0), PX(0, 0), PX(9, 0), PX(5, 0));
    add('x', PX(0, 0), PX(-7, 0), PX(5, 0), PX(-7, 0), PX(0, 0), PX(0, 8));
    add('x', PX(0, 0), PX(5, 0), PX(5, 0), PX(5, 0), PX(0, 0), PX(9, 0));
    EXPECT_PICTURE(&canvas, ".....", ".....", ".....", ".....", ".....");
}

/* --- Against the exact rule --------------------------------------------------------------------------------------- */

enum { GRID = 4 };

static void expect_exact(const seeded *s, const el_corner corners[3], int32_t size)
{
    uint16_t counts[PICTURE_MAX * PICTURE_MAX] = {0};
    const el_target target = {.colour = counts, .width = size, .y = 0, .y_end = size};
    const el_surface surface = {.shading = EL_SHADE_OVERDRAW};
    el_triangle triangle;
    el_stats stats = {0};
    if (el_triangle_setup(&triangle, corners, &surface, 0)) {
        el_triangle_draw(&triangle, &target, &stats);
    }
    for (int32_t i = 0; i < size * size; i++) {
        if (counts[i] != reference_covers(corners, i % size, i / size)) {
            fail_at(s, "pixel (%d, %d) of (%d, %d) (%d, %d) (%d, %d) is drawn %u times", (int)(i % size),
                    (int)(i / size), (int)corners[0].x, (int)corners[0].y, (int)corners[1].x, (int)corners[1].y,
                    (int)corners[2].x, (int)corners[2].y, counts[i]);
        }
    }
}

/* All triangles whose corners lie on a lattice that has pixel centres, the points beside them and points outside the
 * screen of 4 x 4 pixels. */
static void test_every_triangle_on_a_lattice(void)
{
    static const int32_t steps[] = {PX(-1, -8), PX(0, 0), PX(0, 7), PX(0, 8), PX(0, 9),
                                    PX(1, 8),   PX(2, 8), PX(3, 8), PX(4, 8)};
    enum { STEPS = sizeof steps / sizeof steps[0], POINTS = STEPS * STEPS };
    seeded s = seeded_from(0);
    for (unsigned a = 0; a < POINTS; a++) {
        for (unsigned b = 0; b < POINTS; b++) {
            for (unsigned c = (a + b) % EL_TEST_PART; c < POINTS; c += EL_TEST_PART, s.round++) {
                const el_corner corners[3] = {{.x = steps[a % STEPS], .y = steps[a / STEPS]},
                                              {.x = steps[b % STEPS], .y = steps[b / STEPS]},
                                              {.x = steps[c % STEPS], .y = steps[c / STEPS]}};
                expect_exact(&s, corners, GRID);
            }
        }
    }
}

static void test_triangles_of_all_sizes_seeded(void)
{
    for (seeded s = seeded_from(30); s.round < PART_OF(20000); s.round++) {
        const int32_t reach = ((int32_t)any_of_bits(&s, 14) + 8) * SIXTEENTH;
        el_corner corners[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_corner(&s, PX(8, 0), reach);
        }
        expect_exact(&s, corners, 16);
    }
}

/* Edges across the whole guard band, where products are largest. */
static void test_largest_triangles_seeded(void)
{
    static const int32_t ends[] = {-EL_GUARD_SUB, -EL_GUARD_SUB + 1, EL_GUARD_SUB - 1, EL_GUARD_SUB};
    for (seeded s = seeded_from(31); s.round < PART_OF(20000); s.round++) {
        el_corner corners[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_corner(&s, 0, EL_GUARD_SUB);
            if (any_below(&s, 3) != 0) {
                corners[i].x = ends[any_below(&s, 4)];
            }
            if (any_below(&s, 3) != 0) {
                corners[i].y = ends[any_below(&s, 4)];
            }
        }
        if (any_below(&s, 2) == 0) {
            corners[0] = any_corner(&s, PX(8, 0), PX(10, 0)); /* an edge through the picture */
        }
        expect_exact(&s, corners, 16);
    }
}

/* A fan of random wedges around a random point covers each pixel inside its rim once. */
static void test_fans_are_watertight_seeded(void)
{
    enum { SIZE = 16, WEDGES = 7 };
    for (seeded s = seeded_from(32); s.round < PART_OF(2000); s.round++) {
        static const int32_t rim[WEDGES][2] = {{-90, -50}, {120, -99}, {300, -30}, {340, 200},
                                               {260, 333}, {70, 310},  {-40, 222}};
        uint16_t counts[SIZE * SIZE] = {0};
        const el_target target = {.colour = counts, .width = SIZE, .y = 0, .y_end = SIZE};
        const el_surface surface = {.shading = EL_SHADE_OVERDRAW};
        el_corner corners[3] = {any_corner(&s, PX(8, 0), PX(6, 4))};
        for (unsigned i = 0; i < WEDGES; i++) {
            el_triangle triangle;
            el_stats stats = {0};
            corners[1] = (el_corner){.x = rim[i][0] * SIXTEENTH, .y = rim[i][1] * SIXTEENTH};
            corners[2] =
                (el_corner){.x = rim[(i + 1) % WEDGES][0] * SIXTEENTH, .y = rim[(i + 1) % WEDGES][1] * SIXTEENTH};
            if (el_triangle_setup(&triangle, corners, &surface, 0)) {
                el_triangle_draw(&triangle, &target, &stats);
            }
        }
        for (unsigned i = 0; i < SIZE * SIZE; i++) {
            if (counts[i] != 1) {
                fail_at(&s, "pixel (%u, %u) is drawn %u times", i % SIZE, i / SIZE, counts[i]);
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_quad_split_both_ways);
    RUN_TEST(test_sides_on_pixel_centres);
    RUN_TEST(test_sides_beside_pixel_centres);
    RUN_TEST(test_a_fan_about_a_centre);
    RUN_TEST(test_flat_tops_and_flat_bottoms);
    RUN_TEST(test_slivers);
    RUN_TEST(test_no_area_no_pixels);
    RUN_TEST(test_clipping_at_the_screen);
    RUN_TEST(test_every_triangle_on_a_lattice);
    RUN_TEST(test_triangles_of_all_sizes_seeded);
    RUN_TEST(test_largest_triangles_seeded);
    RUN_TEST(test_fans_are_watertight_seeded);
    return UNITY_END();
}
