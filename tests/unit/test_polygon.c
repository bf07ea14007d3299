/* Polygons against their definition, sample by sample, and against the rasterizer's triangles. */
#include "canvas_picture.h"
#include "raster/triangle.h"
#include "seeded.h"

enum { WHITE = 0xFFFF, MAX_POINTS = 24, MAX_EDGES = 64 };

void setUp(void)
{
}
void tearDown(void)
{
}

typedef struct outline {
    unsigned count;
    int32_t points[MAX_POINTS][2];
    bool begins[MAX_POINTS]; /* a contour of its own */
    el_rule rule;
    el_smooth smooth;
} outline;

static _Alignas(8) uint8_t memory[EL_POLYGON_BYTES(MAX_EDGES, CANVAS_SIDE)];

static void build(el_polygon *p, const outline *o)
{
    el_polygon_begin(p, memory, sizeof memory);
    for (unsigned i = 0; i < o->count; i++) {
        (o->begins[i] ? el_polygon_move : el_polygon_line)(p, o->points[i][0], o->points[i][1]);
    }
}

static void draw_outline(void *context, el_band *band)
{
    const outline *const o = context;
    const el_canvas canvas = el_canvas_of(band);
    el_polygon p;
    build(&p, o);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_polygon_fill(&p, &canvas, o->rule, o->smooth, el_solid(WHITE)));
}

/* Whether a sample is inside: the windings of all edges that cross its row and that it is not left of. In halves of a
 * unit. */
static bool is_inside(const outline *o, int64_t x, int64_t y)
{
    int winding = 0;
    unsigned crossings = 0;
    unsigned first = 0;
    for (unsigned i = 0; i < o->count; i++) {
        first = o->begins[i] ? i : first;
        const unsigned next = i + 1 < o->count && !o->begins[i + 1] ? i + 1 : first;
        const int64_t ax = 2 * (int64_t)o->points[i][0];
        const int64_t ay = 2 * (int64_t)o->points[i][1];
        const int64_t bx = 2 * (int64_t)o->points[next][0];
        const int64_t by = 2 * (int64_t)o->points[next][1];
        const int down = ay < by ? 1 : -1;
        if ((down > 0 && ay <= y && y < by) || (down < 0 && by <= y && y < ay)) {
            /* (x - ax) >= (y - ay) (bx - ax) / (by - ay) */
            if (down * ((x - ax) * (by - ay) - (y - ay) * (bx - ax)) >= 0) {
                winding += down;
                crossings++;
            }
        }
    }
    return o->rule == EL_EVEN_ODD ? (crossings & 1U) != 0 : winding != 0;
}

/* How much of a pixel is covered, of 256, by samples on a grid of columns x rows. */
static uint32_t reference_coverage(const outline *o, int32_t x, int32_t y, int32_t columns, int32_t rows)
{
    uint32_t inside = 0;
    for (int32_t j = 0; j < rows; j++) {
        for (int32_t i = 0; i < columns; i++) {
            inside += is_inside(o, (int64_t)x * 2 * EL_SUBPIXELS + (2 * i + 1) * EL_SUBPIXELS / columns,
                                (int64_t)y * 2 * EL_SUBPIXELS + (2 * j + 1) * EL_SUBPIXELS / rows);
        }
    }
    return inside * 256U / (uint32_t)(columns * rows);
}

static void check(const outline *o, const seeded *s, uint16_t side)
{
    static canvas_picture p;
    p = canvas_picture_of(side, side);
    paint_any_bands(&p, draw_outline, (void *)(uintptr_t)o);
    const int32_t rows = 1 << o->smooth;
    const int32_t columns = o->smooth == EL_SHARP ? 1 : 16;
    for (int32_t y = 0; y < side; y++) {
        for (int32_t x = 0; x < side; x++) {
            const uint16_t wanted = el_rgb565_blend(0, WHITE, reference_coverage(o, x, y, columns, rows));
            const uint16_t got = p.pixels[y * side + x];
            if (got != wanted) {
                fail_at(s, "pixel (%d, %d) is %04x, not %04x", (int)x, (int)y, (unsigned)got, (unsigned)wanted);
            }
        }
    }
}

/* Corners anywhere near the picture, or, of some, far beyond it; on few different values, so that they meet and lie level. */
static outline any_outline(seeded *s, uint16_t side, bool smooth)
{
    static const el_smooth kinds[3] = {EL_SMOOTH_4, EL_SMOOTH_8, EL_SMOOTH_16};
    outline o = {.count = 3U + any_below(s, MAX_POINTS - 3U)};
    const uint32_t kind = any_below(s, 4);
    for (unsigned i = 0; i < o.count; i++) {
        for (unsigned k = 0; k < 2; k++) {
            const int64_t near = any_between(s, -2 * EL_SUBPIXELS, (side + 2) * EL_SUBPIXELS);
            o.points[i][k] = (int32_t)(kind == 0   ? near & ~(EL_SUBPIXELS - 1LL)
                                       : kind == 1 ? near & ~(EL_SUBPIXELS / 2 - 1LL)
                                       : kind == 2 ? near
                                                   : any_between(s, -EL_GUARD_SUB, EL_GUARD_SUB));
        }
        o.begins[i] = i == 0 || any_below(s, 6) == 0;
    }
    o.rule = any_below(s, 2) == 0 ? EL_NON_ZERO : EL_EVEN_ODD;
    o.smooth = smooth ? kinds[any_below(s, 3)] : EL_SHARP;
    return o;
}

static void test_sharp_polygons_are_what_the_definition_says(void)
{
    seeded s = seeded_from(1);
    for (s.round = 0; s.round < PART_OF(1500); s.round++) {
        const outline o = any_outline(&s, 24, false);
        check(&o, &s, 24);
    }
}

static void test_smooth_polygons_are_what_the_definition_says(void)
{
    seeded s = seeded_from(2);
    for (s.round = 0; s.round < PART_OF(160); s.round++) {
        const outline o = any_outline(&s, 12, true);
        check(&o, &s, 12);
    }
}

/* A five-pointed star: what winds twice is a hole for the one rule alone. */
static void test_rules_differ_where_contours_wind_twice(void)
{
    outline star = {.count = 5};
    static const int32_t points[5][2] = {{8, 0}, {13, 15}, {0, 6}, {16, 6}, {3, 15}};
    for (unsigned i = 0; i < 5; i++) {
        star.points[i][0] = EL_SUB(points[i][0]);
        star.points[i][1] = EL_SUB(points[i][1]);
        star.begins[i] = i == 0;
    }
    static canvas_picture p;
    p = canvas_picture_of(16, 15);
    paint_any_bands(&p, draw_outline, &star);
    EXPECT_CANVAS(&p, "................", ".......#........", ".......##.......", ".......##.......",
                  "......###.......", "......####......", ".##############.", "..############..", "....########....",
                  ".....######.....", "....#######.....", "....########....", "....###..###....", "...##......#....",
                  "...#........#...");
    p = canvas_picture_of(16, 15);
    star.rule = EL_EVEN_ODD;
    paint_any_bands(&p, draw_outline, &star);
    EXPECT_CANVAS(&p, "................", ".......#........", ".......##.......", ".......##.......",
                  "......###.......", "......####......", ".#####....#####.", "..###.....####..", "....#......#....",
                  "................", "....##...##.....", "....########....", "....###..###....", "...##......#....",
                  "...#........#...");
}

static void count_triangle(uint16_t *counts, int32_t side, const int32_t points[3][2])
{
    el_corner corners[3] = {0};
    for (unsigned i = 0; i < 3; i++) {
        corners[i].x = points[i][0];
        corners[i].y = points[i][1];
    }
    const el_surface surface = {.shading = EL_SHADE_OVERDRAW};
    const el_target target = {.colour = counts, .width = side, .y = 0, .y_end = side};
    el_triangle triangle;
    el_stats stats = {0};
    if (el_triangle_setup(&triangle, corners, &surface, 0)) {
        el_triangle_draw(&triangle, &target, &stats);
    }
}

/* A polygon of three points has the pixels of that triangle; one that lies beside triangles along a zigzag, neither leaves
 * a gap to them nor draws over them. */
static void test_polygons_and_triangles_share_edges(void)
{
    enum { SIDE = 32 };
    static uint16_t counts[SIDE * SIDE];
    static canvas_picture p;
    seeded s = seeded_from(3);
    for (s.round = 0; s.round < PART_OF(2000); s.round++) {
        /* A fan of triangles around the picture's middle, and the frame around it as a polygon with a hole. */
        int32_t fan[8][2];
        for (unsigned i = 0; i < 8; i++) {
            static const int32_t around[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
            for (unsigned k = 0; k < 2; k++) {
                const int64_t from = EL_SUB(SIDE / 2) + around[i][k] * EL_SUB(6);
                fan[i][k] = (int32_t)any_between(&s, from - EL_SUB(2), from + EL_SUB(2));
            }
        }
        memset(counts, 0, sizeof counts);
        outline frame = {.count = 12, .rule = EL_EVEN_ODD};
        static const int32_t corners[4][2] = {{0, 0}, {SIDE, 0}, {SIDE, SIDE}, {0, SIDE}};
        for (unsigned i = 0; i < 12; i++) {
            frame.begins[i] = i == 0 || i == 4;
            for (unsigned k = 0; k < 2; k++) {
                frame.points[i][k] = i < 4 ? EL_SUB(corners[i][k]) : fan[i - 4][k];
            }
        }
        for (unsigned i = 0; i < 8; i++) {
            const int32_t points[3][2] = {{EL_SUB(SIDE / 2), EL_SUB(SIDE / 2)},
                                          {fan[i][0], fan[i][1]},
                                          {fan[(i + 1) % 8][0], fan[(i + 1) % 8][1]}};
            count_triangle(counts, SIDE, points);
        }
        p = canvas_picture_of(SIDE, SIDE);
        paint_in_bands(&p, 8, draw_outline, &frame);
        for (unsigned i = 0; i < SIDE * SIDE; i++) {
            if (counts[i] + (p.pixels[i] != 0) != 1) {
                fail_at(&s, "pixel %u is drawn %u times", i, counts[i] + (unsigned)(p.pixels[i] != 0));
            }
        }
    }
}

static void test_a_polygon_of_three_points_is_that_triangle(void)
{
    enum { SIDE = 32 };
    static uint16_t counts[SIDE * SIDE];
    static canvas_picture p;
    seeded s = seeded_from(4);
    for (s.round = 0; s.round < PART_OF(4000); s.round++) {
        outline o = {.count = 3, .begins = {true}};
        const bool far = any_below(&s, 4) == 0;
        for (unsigned i = 0; i < 6; i++) {
            o.points[i / 2][i % 2] = (int32_t)(far ? any_between(&s, -EL_GUARD_SUB, EL_GUARD_SUB)
                                                   : any_between(&s, -EL_SUB(4), EL_SUB(SIDE + 4)));
        }
        memset(counts, 0, sizeof counts);
        count_triangle(counts, SIDE, (const int32_t(*)[2])o.points);
        p = canvas_picture_of(SIDE, SIDE);
        paint_in_bands(&p, SIDE, draw_outline, &o);
        for (unsigned i = 0; i < SIDE * SIDE; i++) {
            if ((counts[i] != 0) != (p.pixels[i] != 0)) {
                fail_at(&s, "pixel %u: the triangle has %u", i, (unsigned)counts[i]);
            }
        }
    }
}

/* What 4 and 8 rows of a pixel are off by against 16 x 16 samples: for each edge through a pixel half of a row, 32 and 16
 * of 256; slivers have two. */
static void test_smooth_edges_keep_their_error(void)
{
    seeded s = seeded_from(5);
    uint32_t worst[2] = {0};
    for (s.round = 0; s.round < PART_OF(300); s.round++) {
        outline o = {.count = 3, .begins = {true}};
        for (unsigned i = 0; i < 6; i++) {
            o.points[i / 2][i % 2] = (int32_t)any_between(&s, 0, EL_SUB(10));
        }
        for (int32_t i = 0; i < 100; i++) {
            const uint32_t exact = reference_coverage(&o, i % 10, i / 10, 16, 16);
            for (int32_t k = 0; k < 2; k++) {
                const uint32_t got = reference_coverage(&o, i % 10, i / 10, 16, 4 << k);
                const uint32_t off = got > exact ? got - exact : exact - got;
                worst[k] = off > worst[k] ? off : worst[k];
            }
        }
    }
    char message[80];
    snprintf(message, sizeof message, "4 rows are off by %u/256, 8 by %u/256", (unsigned)worst[0], (unsigned)worst[1]);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32_MESSAGE(64, worst[0], message);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32_MESSAGE(32, worst[1], message);
}

static void test_what_does_not_fit_is_refused_and_draws_nothing(void)
{
    uint16_t pixels[64] = {0};
    el_band band = {.pixels = pixels, .width = 8, .lines = 8};
    const el_canvas canvas = el_canvas_of(&band);
    _Alignas(8) uint8_t small[4 * sizeof(el_polygon_edge)];
    const struct {
        size_t bytes;
        int32_t x;
        el_smooth smooth;
        el_status wanted;
    } cases[] = {
        {sizeof small, 7, EL_SHARP, EL_OK},
        {3 * sizeof(el_polygon_edge) + 19, 7, EL_SMOOTH_4, EL_ERROR_MEMORY}, /* no room for the steps of 8 pixels */
        {3 * sizeof(el_polygon_edge) + 20, 7, EL_SMOOTH_4, EL_OK},
        {3 * sizeof(el_polygon_edge) - 1, 7, EL_SHARP, EL_ERROR_MEMORY},
        {0, 7, EL_SHARP, EL_ERROR_MEMORY},
        {sizeof small, EL_GUARD_PX, EL_SHARP, EL_OK},
        {sizeof small, EL_GUARD_PX + 1, EL_SHARP, EL_ERROR_RANGE},
        {sizeof small, -EL_GUARD_PX - 1, EL_SHARP, EL_ERROR_RANGE},
        {sizeof small, 7, (el_smooth)1, EL_ERROR_ARGUMENT},
        {sizeof small, 7, (el_smooth)5, EL_ERROR_ARGUMENT},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        el_polygon p;
        el_polygon_begin(&p, small, cases[i].bytes);
        el_polygon_move(&p, 0, 0);
        el_polygon_line(&p, EL_SUB(cases[i].x), EL_SUB(1));
        el_polygon_line(&p, EL_SUB(1), EL_SUB(8));
        memset(pixels, 0, sizeof pixels);
        TEST_ASSERT_EQUAL_INT(cases[i].wanted,
                              el_polygon_fill(&p, &canvas, EL_NON_ZERO, cases[i].smooth, el_solid(WHITE)));
        uint32_t drawn = 0;
        for (unsigned k = 0; k < 64; k++) {
            drawn += pixels[k] != 0;
        }
        TEST_ASSERT_EQUAL_INT(cases[i].wanted == EL_OK, drawn > 0);
    }
}

static void test_nothing_is_no_polygon(void)
{
    uint16_t pixels[64] = {0};
    el_band band = {.pixels = pixels, .width = 8, .lines = 8};
    const el_canvas canvas = el_canvas_of(&band);
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SHARP, el_solid(WHITE)));
    el_polygon_move(&p, 0, 0);
    el_polygon_line(&p, EL_SUB(8), 0); /* level, and back */
    TEST_ASSERT_EQUAL_INT(EL_OK, el_polygon_fill(&p, &canvas, EL_EVEN_ODD, EL_SMOOTH_16, el_solid(WHITE)));
    TEST_ASSERT_EACH_EQUAL_HEX16(0, pixels, 64);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_sharp_polygons_are_what_the_definition_says);
    RUN_TEST(test_smooth_polygons_are_what_the_definition_says);
    RUN_TEST(test_rules_differ_where_contours_wind_twice);
    RUN_TEST(test_polygons_and_triangles_share_edges);
    RUN_TEST(test_a_polygon_of_three_points_is_that_triangle);
    RUN_TEST(test_smooth_edges_keep_their_error);
    RUN_TEST(test_what_does_not_fit_is_refused_and_draws_nothing);
    RUN_TEST(test_nothing_is_no_polygon);
    return UNITY_END();
}
