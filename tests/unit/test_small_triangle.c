/* Small and tiny triangles from their records to their pixels against the way that all others take: pixels, depth, what is
 * counted, and what is left for the bands below. */
#include <stddef.h>
#include <string.h>

#include "any_triangle.h"
#include "raster/fill.h"
#include "raster/small_triangle.h"
#include "raster/tiny_triangle.h"

enum { WIDTH = 40, HEIGHT = 40, PIXELS = WIDTH * HEIGHT };

void setUp(void)
{
}

void tearDown(void)
{
}

#if EL_WITH_SMALL_PLANES

typedef struct buffers {
    uint16_t colour[PIXELS];
    uint16_t depth[PIXELS];
} buffers;

static buffers expected, drawn;

static const uint8_t colours[1][3] = {{16, 68, 160}};
static const uint16_t colour = 0x1234; /* the same */
static const el_run_look look = {.colours = colours,
                                 .last_corner = (INT16_MAX << 16) + (uint32_t)(WIDTH * EL_SUBPIXELS)};

static el_target rows_of(buffers *b, int32_t y, int32_t y_end)
{
    return (el_target){
        .colour = b->colour + y * WIDTH, .depth = b->depth + y * WIDTH, .width = WIDTH, .y = y, .y_end = y_end};
}

/* The same in both, so that of every other triangle some of the pixels are hidden. */
static void fill_depth(seeded *s)
{
    const bool is_empty = any_below(s, 2) == 0;
    for (unsigned i = 0; i < PIXELS; i++) {
        expected.depth[i] = is_empty ? UINT16_MAX : (uint16_t)any_of_bits(s, 16);
    }
    memset(expected.colour, 0, sizeof expected.colour);
    drawn = expected;
}

/* In the order in which a record may have them; levels and columns are shared often. Coordinates and depths are within
 * so many bits. */
static void any_points(seeded *s, el_record *record, unsigned bits, unsigned depth_bits)
{
    el_point *const points = record->at.points;
    const int32_t reach = 1 + (int32_t)any_of_bits(s, bits);
    const int32_t depth = (int32_t)any_between(s, 0, EL_DEPTH_MAX - (1 << depth_bits) + 2);
    const int32_t x = (int32_t)any_below(s, WIDTH * EL_SUBPIXELS);
    const int32_t y = (int32_t)any_below(s, HEIGHT * EL_SUBPIXELS);
    const int32_t grid = any_below(s, 4) == 0 ? EL_SUBPIXELS / 2 : 1;
    for (unsigned i = 0; i < 3; i++) {
        points[i].x = (el_coordinate)((x + (int32_t)any_between(s, -reach, reach)) / grid * grid);
        points[i].y = (el_coordinate)((y + (int32_t)any_between(s, -reach, reach)) / grid * grid);
        points[i].z = (uint16_t)(depth + (int32_t)any_between(s, 0, (1 << depth_bits) - 2));
    }
}

/* Draws the triangle in the usual way, by loops of another kind: with what is made once for large ones. */
static void draw_expected(const el_corner corners[3], const el_surface *surface, int32_t y, int32_t lines,
                          el_stats *stats)
{
    el_triangle triangle;
    if (!el_triangle_setup(&triangle, corners, surface, y)) {
        return;
    }
    triangle.edges_are_short = false;
    while (!el_triangle_is_done(&triangle) && triangle.y < HEIGHT) {
        const int32_t begin = triangle.y / lines * lines;
        const el_target target = rows_of(&expected, begin, el_min_i32(begin + lines, HEIGHT));
        el_triangle_draw(&triangle, &target, stats);
    }
}

/* Draws it by one of the short ways, in bands of `lines` from row y on, and returns how many bands it is in; 0 when it
 * is refused. */
typedef uint32_t short_way(seeded *s, const el_record *record, int32_t y, int32_t lines, el_stats *stats);

static uint32_t draw_small(seeded *s, const el_record *record, int32_t y, int32_t lines, el_stats *stats)
{
    const el_point *const points = record->at.points;
    el_target target = rows_of(&drawn, y, el_min_i32(y + lines, HEIGHT));
    el_triangle rest = {.y = 0, .y_end = 0};
    const int32_t bottom = el_first_centre(el_max_i32(points[0].y, el_max_i32(points[1].y, points[2].y)));
    if (!el_small_triangle_draw(record, &look, &target, stats, bottom > target.y_end ? &rest : NULL)) {
        return 0;
    }
    uint32_t bands = 1;
    for (; !el_triangle_is_done(&rest) && rest.y < HEIGHT; bands++) {
        TEST_ASSERT_EQUAL_INT32(target.y_end, rest.y);
        target = rows_of(&drawn, target.y_end, el_min_i32(target.y_end + lines, HEIGHT));
        if (any_below(s, 4) == 0) {
            rest.edges_are_short = !rest.edges_are_short; /* either way may take over */
        }
        el_triangle_draw(&rest, &target, stats);
    }
    return bands;
}

static uint32_t draw_tiny(seeded *s, const el_record *record, int32_t y, int32_t lines, el_stats *stats)
{
    (void)s;
    el_tiny_triangle rest;
    el_target target = rows_of(&drawn, y, el_min_i32(y + lines, HEIGHT));
    const el_tiny_result result = el_tiny_triangle_draw(record, &look, &target, stats, &rest);
    if (result == EL_TINY_REFUSED) {
        return 0;
    }
    stats->setups--; /* which callers of the others count */
    uint32_t bands = 1;
    for (bool reaches_on = result == EL_TINY_REACHES_ON; reaches_on && target.y_end < HEIGHT; bands++) {
        target = rows_of(&drawn, target.y_end, el_min_i32(target.y_end + lines, HEIGHT));
        reaches_on = el_tiny_triangle_go_on(&rest, &target, stats);
    }
    return bands;
}

static void check_way(short_way *draw, unsigned seed, unsigned bits, unsigned depth_bits, uint32_t most_lines,
                      uint32_t least)
{
    uint32_t small = 0;
    uint32_t carried = 0;
    for (seeded s = seeded_from(seed); s.round < PART_OF(20000); s.round++) {
        el_record record = {.run = 1};
        const el_point *const points = record.at.points;
        el_corner corners[3] = {0};
        any_points(&s, &record, bits, depth_bits);
        for (unsigned i = 0; i < 3; i++) {
            corners[i].x = points[i].x;
            corners[i].y = points[i].y;
            corners[i].z = points[i].z;
        }
        fill_depth(&s);
        const int32_t lines = 1 + (int32_t)any_below(&s, most_lines);
        const int32_t top = el_first_centre(el_min_i32(points[0].y, el_min_i32(points[1].y, points[2].y)));
        int32_t y = el_max_i32(top, 0) / lines * lines;
        const bool begins_late = any_below(&s, 4) == 0; /* set up anew in a later band */
        y += begins_late ? lines : 0;
        if (y >= HEIGHT) {
            continue;
        }
        el_stats stats = {0};
        el_stats expected_stats = {0};
        const uint32_t bands = draw(&s, &record, y, lines, &stats);
        if (bands == 0) {
            continue;
        }
        small++;
        carried += bands > 1;
        draw_expected(corners, &(el_surface){.depth = true, .colour = colour}, y, lines, &expected_stats);
        if (memcmp(&expected, &drawn, sizeof drawn) != 0 || memcmp(&expected_stats, &stats, sizeof stats) != 0) {
            fail_at(&s, "(%d, %d) (%d, %d) (%d, %d) from row %d in bands of %d", points[0].x, points[0].y, points[1].x,
                    points[1].y, points[2].x, points[2].y, (int)y, (int)lines);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(least, small);
    TEST_ASSERT_GREATER_THAN_UINT32(least / 8, carried);
}

static void test_small_triangles_are_as_all_others(void)
{
    check_way(draw_small, 95, 9, 16, HEIGHT, PART_OF(5000U));
}

static void test_tiny_triangles_are_as_all_others(void)
{
    check_way(draw_tiny, 96, 8, 11, 16, PART_OF(2500U));
    check_way(draw_tiny, 97, 7, 12, 8, PART_OF(2500U));
}

/* What is not for it is left alone: large, without area or rows, beside the screen. */
static void test_others_are_refused(void)
{
    enum { PX = EL_SUBPIXELS };
    static const el_point refused[][3] = {
        {{0, 0, 0}, {8 * PX, 0, 0}, {0, 33 * PX, 0}},
        {{0, 0, 0}, {39 * PX, 4 * PX, 0}, {0, 512, 0}},
        {{PX, PX, 0}, {2 * PX, 2 * PX, 0}, {3 * PX, 3 * PX, 0}},
        {{0, 1, 0}, {8 * PX, 2, 0}, {8 * PX, 8, 0}},
        {{-1, 0, 0}, {8 * PX, 0, 0}, {0, 8 * PX, 0}},
        {{0, 41 * PX, 0}, {8 * PX, 41 * PX, 0}, {0, 45 * PX, 0}},
        {{0, 0, 0}, {WIDTH * PX + 1, 0, 0}, {30 * PX, 8 * PX, 0}},
    };
    memset(&expected, 0xFF, sizeof expected);
    drawn = expected;
    const el_target target = rows_of(&drawn, 0, HEIGHT);
    for (unsigned i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        const el_stats none = {0};
        el_stats stats = {0};
        el_triangle rest = {.y = 77};
        el_tiny_triangle tiny;
        el_record record = {.run = 1};
        memcpy(record.at.points, refused[i], sizeof refused[i]);
        TEST_ASSERT_EQUAL(EL_TINY_REFUSED, el_tiny_triangle_draw(&record, &look, &target, &stats, &tiny));
        TEST_ASSERT_FALSE(el_small_triangle_draw(&record, &look, &target, &stats, &rest));
        TEST_ASSERT_EQUAL_INT16(77, rest.y);
        TEST_ASSERT_EQUAL_MEMORY(&none, &stats, sizeof stats);
        TEST_ASSERT_EQUAL_MEMORY(&expected, &drawn, sizeof drawn);
    }
}

#else
/* What does not fit 32 bits, and small code, have the other way alone. */
static void test_the_short_way_is_for_four_bits(void)
{
    TEST_ASSERT_TRUE(EL_SUBPIXEL_BITS > 4 || EL_SMALL_CODE);
}
#endif

int main(void)
{
    UNITY_BEGIN();
#if EL_WITH_SMALL_PLANES
    RUN_TEST(test_small_triangles_are_as_all_others);
    RUN_TEST(test_tiny_triangles_are_as_all_others);
    RUN_TEST(test_others_are_refused);
#else
    RUN_TEST(test_the_short_way_is_for_four_bits);
#endif
    return UNITY_END();
}
