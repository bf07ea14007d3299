/* The textbooks' polygon methods: each as a picture for both fill rules, the corner cases of ray crossing one by one,
 * the exact ones against the reference, and the reference against triangles. */
#include "any_triangle.h"
#include "methods/cases.h"
#include "methods/polygons.h"
#include "methods/reference.h"
#include "test_methods_hits.h"

void setUp(void)
{
}

void tearDown(void)
{
}

#define EACH_METHOD(method)                                                                                            \
    (const el_polygon_method *method = el_polygon_methods; method < el_polygon_methods + EL_POLYGON_METHODS; method++)

#define OUTLINE(...) (const el_spot[]){__VA_ARGS__}, sizeof((const el_spot[]){__VA_ARGS__}) / sizeof(el_spot)

static hits_picture picture;

static void draw(const el_polygon_method *method, const el_polygon *polygon)
{
    el_hits hits = hits_clear(&picture);
    method->draw(polygon, method->rule, &hits);
}

/* --- Pictures ----------------------------------------------------------------------------------------------------- */

/* No centre on the outline, and the rows of corners lie between those of centres: all methods agree. */
static void test_a_concave_outline(void)
{
    el_polygon polygon = {0};
    el_polygon_add(&polygon, OUTLINE(HALF(2, 2), HALF(8, 10), HALF(14, 2), HALF(21, 16), HALF(2, 16)));
    for
        EACH_METHOD(method)
        {
            draw(method, &polygon);
            EXPECT_HITS(&picture, method->id, "............", "............", ".1....11....", ".11..111....",
                        ".11111111...", ".11111111...", ".111111111..", ".111111111..");
        }
}

/* A hole turned against the outline is one by both rules, one turned with it only by even-odd. */
static void test_holes(void)
{
    for (unsigned same_way = 0; same_way < 2; same_way++) {
        el_polygon polygon = {0};
        el_polygon_add(&polygon, OUTLINE(HALF(2, 2), HALF(18, 2), HALF(18, 16), HALF(2, 16)));
        if (same_way != 0) {
            el_polygon_add(&polygon, OUTLINE(HALF(6, 6), HALF(14, 6), HALF(14, 12), HALF(6, 12)));
        } else {
            el_polygon_add(&polygon, OUTLINE(HALF(6, 6), HALF(6, 12), HALF(14, 12), HALF(14, 6)));
        }
        for
            EACH_METHOD(method)
            {
                draw(method, &polygon);
                if (same_way != 0 && method->rule == EL_FILL_NON_ZERO) {
                    EXPECT_HITS(&picture, method->id, "............", ".11111111...", ".11111111...", ".11111111...",
                                ".11111111...", ".11111111...", ".11111111...", ".11111111...");
                } else {
                    EXPECT_HITS(&picture, method->id, "............", ".11111111...", ".11111111...", ".11....11...",
                                ".11....11...", ".11....11...", ".11111111...", ".11111111...");
                }
            }
    }
}

/* Two squares that overlap in one outline: the overlap is wound around twice. */
static void test_an_outline_that_crosses_itself(void)
{
    el_polygon polygon = {0};
    el_polygon_add(&polygon, OUTLINE(HALF(2, 2), HALF(14, 2), HALF(14, 10), HALF(6, 10), HALF(6, 6), HALF(20, 6),
                                     HALF(20, 16), HALF(2, 16)));
    for
        EACH_METHOD(method)
        {
            draw(method, &polygon);
            if (method->rule == EL_FILL_NON_ZERO) {
                EXPECT_HITS(&picture, method->id, "............", ".111111.....", ".111111.....", ".111111111..",
                            ".111111111..", ".111111111..", ".111111111..", ".111111111..");
            } else {
                EXPECT_HITS(&picture, method->id, "............", ".111111.....", ".111111.....", ".11....111..",
                            ".11....111..", ".111111111..", ".111111111..", ".111111111..");
            }
        }
}

/* --- The corner cases of ray crossing ----------------------------------------------------------------------------- */

/* The rows of the corners on the left and on the right: the outline passes the ray there. */
static void test_ray_through_a_corner_that_passes(void)
{
    el_polygon polygon = {0};
    el_polygon_add(&polygon, OUTLINE(HALF(9, 1), HALF(17, 9), HALF(9, 17), HALF(1, 9)));
    el_hits hits = hits_clear(&picture);
    el_polygon_ray_cases(&polygon, EL_FILL_EVEN_ODD, &hits);
    EXPECT_HITS(&picture, "cases", "............", "...11.......", "..1111......", ".111111.....", "11111111....",
                ".111111.....", "..1111......", "...11.......");
    hits = hits_clear(&picture);
    el_polygon_ray_naive(&polygon, EL_FILL_EVEN_ODD, &hits);
    EXPECT_HITS(&picture, "naive", "............", "...11.......", "..1111......", ".111111.....", "............",
                ".111111.....", "..1111......", "...11.......");
}

/* The corner in the middle points up, its row is full on both sides: the outline turns back at the ray. */
static void test_ray_through_a_corner_that_turns_back(void)
{
    el_polygon polygon = {0};
    el_polygon_add(&polygon, OUTLINE(HALF(2, 2), HALF(18, 2), HALF(18, 16), HALF(9, 9), HALF(2, 16)));
    el_hits hits = hits_clear(&picture);
    el_polygon_ray_cases(&polygon, EL_FILL_EVEN_ODD, &hits);
    EXPECT_HITS(&picture, "cases, up", "............", ".11111111...", ".11111111...", ".11111111...", ".11111111...",
                ".11...111...", ".1.....11...", "........1...");
    el_polygon turned = {0};
    el_polygon_add(&turned, OUTLINE(HALF(2, 2), HALF(9, 9), HALF(18, 2), HALF(18, 16), HALF(2, 16)));
    hits = hits_clear(&picture);
    el_polygon_ray_cases(&turned, EL_FILL_EVEN_ODD, &hits);
    EXPECT_HITS(&picture, "cases, down", "............", "........1...", ".1.....11...", ".11...111...", ".11111111...",
                ".11111111...", ".11111111...", ".11111111...");
}

/* Level edges on rows of centres: two steps up on the left, one on the right. */
static void test_ray_along_level_edges(void)
{
    el_polygon polygon = {0};
    el_polygon_add(&polygon, OUTLINE(HALF(7, 3), HALF(13, 3), HALF(13, 7), HALF(19, 7), HALF(19, 15), HALF(1, 15),
                                     HALF(1, 11), HALF(3, 11), HALF(3, 7), HALF(7, 7)));
    el_hits hits = hits_clear(&picture);
    el_polygon_ray_cases(&polygon, EL_FILL_EVEN_ODD, &hits);
    EXPECT_HITS(&picture, "cases", "............", "...111......", "...111......", ".11111111...", ".11111111...",
                "111111111...", "111111111...");
    hits = hits_clear(&picture);
    el_polygon_ray_naive(&polygon, EL_FILL_EVEN_ODD, &hits);
    EXPECT_HITS(&picture, "naive", "............", "...111......", "...111......", ".11...111...", ".11111111...",
                "1........1..", "111111111...", "111111111...");
}

/* The same square turned both ways: its outline counts in one, but for the corners, which see a quarter of a turn. */
static void test_winding_angle_on_the_outline(void)
{
    el_polygon clockwise = {0};
    el_polygon_add(&clockwise, OUTLINE(HALF(3, 3), HALF(13, 3), HALF(13, 13), HALF(3, 13)));
    el_hits hits = hits_clear(&picture);
    el_polygon_winding_angle(&clockwise, EL_FILL_NON_ZERO, &hits);
    EXPECT_HITS(&picture, "clockwise", "............", "..1111......", ".111111.....", ".111111.....", ".111111.....",
                ".111111.....", "..1111......");
    el_polygon other = {0};
    el_polygon_add(&other, OUTLINE(HALF(3, 3), HALF(3, 13), HALF(13, 13), HALF(13, 3)));
    hits = hits_clear(&picture);
    el_polygon_winding_angle(&other, EL_FILL_NON_ZERO, &hits);
    EXPECT_HITS(&picture, "counter-clockwise", "............", "............", "..1111......", "..1111......",
                "..1111......", "..1111......");
}

/* --- Against references ------------------------------------------------------------------------------------------- */

/* An outline is its triangles to any point, with their signs: their exact pixels add up to its turns. */
static int32_t turns_by_triangles(const el_polygon *polygon, int32_t column, int32_t row)
{
    const el_corner apex = {.x = 3, .y = -5};
    int32_t turns = 0;
    for (size_t i = 0; i < polygon->edge_count; i++) {
        const el_corner corners[3] = {apex,
                                      {.x = polygon->edges[i].a.x, .y = polygon->edges[i].a.y},
                                      {.x = polygon->edges[i].b.x, .y = polygon->edges[i].b.y}};
        const int64_t area = reference_side(&corners[0], &corners[1], corners[2].x, corners[2].y);
        turns += reference_covers(corners, column, row) ? (area > 0 ? 1 : -1) : 0;
    }
    return turns;
}

/* One or two outlines of any spots, every second polygon on the lattice of half pixels, some of it beside the picture. */
static void any_outlines(seeded *s, el_polygon *polygon)
{
    const int32_t step = (s->round & 1U) != 0 ? EL_SUBPIXELS / 2 : 1;
    const int32_t most = 26 * EL_SUBPIXELS / 2 / step;
    const unsigned outlines = 1 + any_below(s, 2);
    polygon->edge_count = 0;
    for (unsigned i = 0; i < outlines; i++) {
        el_spot spots[9];
        const size_t count = (size_t)any_between(s, 3, 9);
        for (size_t k = 0; k < count; k++) {
            spots[k].x = (int32_t)any_between(s, -most / 8, most) * step;
            spots[k].y = (int32_t)any_between(s, -most / 8, most) * step;
        }
        el_polygon_add(polygon, spots, count);
    }
}

static void test_the_reference_is_the_sum_of_triangles(void)
{
    seeded s = seeded_from(21);
    for (; s.round < PART_OF(500); s.round++) {
        el_polygon polygon;
        any_outlines(&s, &polygon);
        for (int32_t row = 0; row < HITS_DOWN; row++) {
            for (int32_t column = 0; column < HITS_ACROSS; column++) {
                const int32_t turns = el_reference_turns(&polygon, el_centre_of(column, row));
                if (turns != turns_by_triangles(&polygon, column, row)) {
                    fail_at(&s, "pixel (%d, %d): %d turns", (int)column, (int)row, (int)turns);
                }
            }
        }
    }
}

static void test_exact_methods_are_exact(void)
{
    seeded s = seeded_from(22);
    for (; s.round < PART_OF(3000); s.round++) {
        el_polygon polygon;
        any_outlines(&s, &polygon);
        for
            EACH_METHOD(method)
            {
                if (method->exact) {
                    hits_picture expected;
                    el_hits hits = hits_clear(&expected);
                    el_reference_polygon(&polygon, method->rule, &hits);
                    draw(method, &polygon);
                    char message[80];
                    snprintf(message, sizeof message, "%s, seed %u, round %u", method->id, (unsigned)s.seed,
                             (unsigned)s.round);
                    expect_same_hits(&expected, &picture, message);
                }
            }
    }
}

/* Those that complement would cancel what they write beside the picture, so their work tells. */
static void test_polygons_beside_the_picture(void)
{
    static const int32_t aside[][2] = {{-60, 0}, {60, 0}, {0, -60}, {0, 60}};
    for (unsigned i = 0; i < sizeof aside / sizeof aside[0]; i++) {
        const int32_t x = aside[i][0];
        const int32_t y = aside[i][1];
        el_polygon polygon = {0};
        el_polygon_add(&polygon, OUTLINE(HALF(x + 1, y + 1), HALF(x + 20, y + 3), HALF(x + 9, y + 17)));
        for
            EACH_METHOD(method)
            {
                draw(method, &polygon);
                EXPECT_HITS(&picture, method->id, "............");
            }
        el_hits hits = hits_clear(&picture);
        TEST_ASSERT_EQUAL_UINT32(0, el_polygon_complement(&polygon, EL_FILL_EVEN_ODD, &hits));
        TEST_ASSERT_EQUAL_UINT32(0, el_polygon_fence(&polygon, EL_FILL_EVEN_ODD, &hits));
    }
}

/* --- The seeded cases --------------------------------------------------------------------------------------------- */

/* The fans of the measurements are what their header says: inside no pixel twice. */
static void test_fans_do_not_overlap(void)
{
    el_random random = el_random_of(5, EL_TRIANGLES_FAN);
    for (uint32_t i = 0; i < 300; i++) {
        el_fan fan;
        el_any_fan(&random, i, &fan);
        TEST_ASSERT_TRUE(fan.count >= EL_FAN_LEAST && fan.count <= EL_FAN_MOST);
        for (size_t k = 0; k < fan.count; k++) {
            TEST_ASSERT_TRUE(el_side(fan.triangles[k][0], fan.triangles[k][1], fan.triangles[k][2]) > 0);
            TEST_ASSERT_EQUAL_MEMORY(&fan.triangles[k][2], &fan.triangles[(k + 1) % fan.count][1], sizeof(el_spot));
        }
    }
}

/* All shapes lie in the picture, so that no method gains by clipping. */
static void test_cases_lie_in_the_picture(void)
{
    for (unsigned kind = 0; kind < EL_POLYGON_KINDS; kind++) {
        el_random random = el_random_of(6, kind);
        for (uint32_t i = 0; i < 500; i++) {
            el_polygon polygon;
            el_any_polygon(&random, (el_polygon_kind)kind, i, &polygon);
            TEST_ASSERT_TRUE(polygon.edge_count >= 3 && polygon.edge_count <= EL_POLYGON_EDGES);
            for (size_t k = 0; k < polygon.edge_count; k++) {
                const el_spot spot = polygon.edges[k].a;
                TEST_ASSERT_TRUE(spot.x >= 0 && spot.x <= EL_CASES_WIDTH * EL_SUBPIXELS);
                TEST_ASSERT_TRUE(spot.y >= 0 && spot.y <= EL_CASES_HEIGHT * EL_SUBPIXELS);
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_concave_outline);
    RUN_TEST(test_holes);
    RUN_TEST(test_an_outline_that_crosses_itself);
    RUN_TEST(test_ray_through_a_corner_that_passes);
    RUN_TEST(test_ray_through_a_corner_that_turns_back);
    RUN_TEST(test_ray_along_level_edges);
    RUN_TEST(test_winding_angle_on_the_outline);
    RUN_TEST(test_the_reference_is_the_sum_of_triangles);
    RUN_TEST(test_exact_methods_are_exact);
    RUN_TEST(test_polygons_beside_the_picture);
    RUN_TEST(test_fans_do_not_overlap);
    RUN_TEST(test_cases_lie_in_the_picture);
    return UNITY_END();
}
