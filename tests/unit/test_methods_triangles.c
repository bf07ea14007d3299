/* The textbooks' triangle methods: each as a picture for each rule of edges, the exact ones against the reference on a
 * lattice where corners and edges hit pixel centres all the time, the others where they are known to fail. */
#include "any_triangle.h"
#include "methods/reference.h"
#include "methods/triangles.h"
#include "methods/values.h"
#include "test_methods_hits.h"

void setUp(void)
{
}

void tearDown(void)
{
}

#define EACH_METHOD(method)                                                                                            \
    (const el_triangle_method *method = el_triangle_methods; method < el_triangle_methods + EL_TRIANGLE_METHODS;       \
     method++)

static hits_picture picture;

/* All six orders of the corners give the same pixels. */
static void draw_any_order(const el_triangle_method *method, const el_spot corners[3])
{
    static const unsigned orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    hits_picture first = {0};
    for (unsigned i = 0; i < 6; i++) {
        const el_spot turned[3] = {corners[orders[i][0]], corners[orders[i][1]], corners[orders[i][2]]};
        el_hits hits = hits_clear(&picture);
        method->draw(turned, &hits);
        first = i == 0 ? picture : first;
        expect_same_hits(&first, &picture, method->id);
    }
}

/* --- Pictures ----------------------------------------------------------------------------------------------------- */

/* All three edges run through centres: the rule decides the whole outline. */
static void test_edges_through_centres(void)
{
    static const el_spot corners[3] = {HALF(3, 3), HALF(13, 3), HALF(3, 13)};
    for
        EACH_METHOD(method)
        {
            draw_any_order(method, corners);
            switch (method->rule) {
            case EL_EDGES_ALL:
                EXPECT_HITS(&picture, method->id, "............", ".111111.....", ".11111......", ".1111.......",
                            ".111........", ".11.........", ".1..........");
                break;
            case EL_EDGES_NONE:
                EXPECT_HITS(&picture, method->id, "............", "............", "..111.......", "..11........",
                            "..1.........");
                break;
            case EL_EDGES_LEFT_TOP:
                EXPECT_HITS(&picture, method->id, "............", ".11111......", ".1111.......", ".111........",
                            ".11.........", ".1..........");
                break;
            }
        }
}

/* No centre on an edge: all methods agree. */
static void test_edges_beside_centres(void)
{
    static const el_spot corners[3] = {HALF(2, 2), HALF(22, 8), HALF(9, 18)};
    for
        EACH_METHOD(method)
        {
            draw_any_order(method, corners);
            EXPECT_HITS(&picture, method->id, "............", ".11.........", "..1111......", "..1111111...",
                        "...1111111..", "...111111...", "...11111....", "....11......", "....1.......");
        }
}

/* Two triangles share a diagonal through centres: twice, never, or once each. */
static void test_a_shared_edge(void)
{
    static const el_spot upper[3] = {HALF(2, 2), HALF(12, 2), HALF(12, 12)};
    static const el_spot lower[3] = {HALF(2, 2), HALF(12, 12), HALF(2, 12)};
    for
        EACH_METHOD(method)
        {
            el_hits hits = hits_clear(&picture);
            method->draw(upper, &hits);
            method->draw(lower, &hits);
            switch (method->rule) {
            case EL_EDGES_ALL:
                EXPECT_HITS(&picture, method->id, "............", ".21111......", ".12111......", ".11211......",
                            ".11121......", ".11112......");
                break;
            case EL_EDGES_NONE:
                EXPECT_HITS(&picture, method->id, "............", "..1111......", ".1.111......", ".11.11......",
                            ".111.1......", ".1111.......");
                break;
            case EL_EDGES_LEFT_TOP:
                EXPECT_HITS(&picture, method->id, "............", ".11111......", ".11111......", ".11111......",
                            ".11111......", ".11111......");
                break;
            }
        }
}

static void test_no_area_covers_nothing(void)
{
    static const el_spot flat[][3] = {
        {HALF(3, 3), HALF(3, 3), HALF(3, 3)},
        {HALF(1, 5), HALF(9, 5), HALF(17, 5)},
        {HALF(5, 1), HALF(5, 9), HALF(5, 17)},
        {HALF(1, 1), HALF(9, 9), HALF(17, 17)},
    };
    for
        EACH_METHOD(method)
        {
            for (unsigned i = 0; i < sizeof flat / sizeof flat[0]; i++) {
                draw_any_order(method, flat[i]);
                EXPECT_HITS(&picture, method->id, "............");
            }
        }
}

/* Larger than the picture on all sides, and beside it. */
static void test_triangles_are_clipped(void)
{
    static const el_spot around[3] = {HALF(-200, -150), HALF(300, -110), HALF(10, 400)};
    static const el_spot beside[][3] = {
        {HALF(-60, 0), HALF(-10, 2), HALF(-20, 22)},
        {HALF(60, 0), HALF(30, 2), HALF(40, 22)},
        {HALF(0, -60), HALF(9, -10), HALF(22, -20)},
        {HALF(0, 60), HALF(9, 30), HALF(22, 40)},
    };
    for
        EACH_METHOD(method)
        {
            draw_any_order(method, around);
            TEST_ASSERT_EACH_EQUAL_UINT16_MESSAGE(1, picture.counts, HITS_ACROSS * HITS_DOWN, method->id);
            for (unsigned i = 0; i < sizeof beside / sizeof beside[0]; i++) {
                draw_any_order(method, beside[i]);
                EXPECT_HITS(&picture, method->id, "............");
            }
        }
}

/* --- Against the reference ---------------------------------------------------------------------------------------- */

static void test_the_reference_is_the_rasterizer_tests_reference(void)
{
    seeded s = seeded_from(11);
    for (; s.round < PART_OF(20000); s.round++) {
        el_spot corners[3];
        el_corner same[3] = {0};
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = (el_spot)HALF((int32_t)any_between(&s, -3, 27), (int32_t)any_between(&s, -3, 27));
            same[i].x = corners[i].x;
            same[i].y = corners[i].y;
        }
        const int32_t column = (int32_t)any_between(&s, 0, 11);
        const int32_t row = (int32_t)any_between(&s, 0, 9);
        if (el_reference_in_triangle(corners, el_centre_of(column, row), EL_EDGES_LEFT_TOP) !=
            reference_covers(same, column, row)) {
            fail_at(&s, "pixel (%d, %d)", (int)column, (int)row);
        }
    }
}

static void test_exact_methods_are_exact(void)
{
    static const int32_t steps[] = {EL_SUBPIXELS / 2, 1}; /* on a lattice of half pixels, and anywhere */
    seeded s = seeded_from(12);
    for (; s.round < PART_OF(6000); s.round++) {
        const int32_t step = steps[s.round & 1U];
        const int32_t most = 26 * EL_SUBPIXELS / 2 / step;
        el_spot corners[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i].x = (int32_t)any_between(&s, -most / 8, most) * step;
            corners[i].y = (int32_t)any_between(&s, -most / 8, most) * step;
        }
        for
            EACH_METHOD(method)
            {
                if (method->exact) {
                    hits_picture expected;
                    el_hits hits = hits_clear(&expected);
                    el_reference_triangle(corners, method->rule, &hits);
                    hits = hits_clear(&picture);
                    method->draw(corners, &hits);
                    char message[120];
                    snprintf(message, sizeof message, "%s, round %u: (%d, %d) (%d, %d) (%d, %d)", method->id,
                             (unsigned)s.round, (int)corners[0].x, (int)corners[0].y, (int)corners[1].x,
                             (int)corners[1].y, (int)corners[2].x, (int)corners[2].y);
                    expect_same_hits(&expected, &picture, message);
                }
            }
    }
}

/* --- Known failures of those that are not exact ------------------------------------------------------------------- */

/* A row of 2000 pixels and an edge that rises through it: exactly half of the centres are inside, but further ones see
 * the corners under almost half a turn. */
static void test_angle_sum_takes_what_is_almost_on_a_long_edge(void)
{
    enum { ACROSS = 2000 };
    static uint16_t row[ACROSS];
    static const el_spot corners[3] = {
        {0, EL_SUBPIXELS / 2 - 1}, {ACROSS * EL_SUBPIXELS, EL_SUBPIXELS / 2 + 1}, HALF(ACROSS, 60)};
    el_hits hits = {ACROSS, 1, row};
    el_reference_triangle(corners, EL_EDGES_ALL, &hits);
    TEST_ASSERT_EQUAL_UINT16(1, row[999]);
    TEST_ASSERT_EQUAL_UINT16(0, row[1000]);
    memset(row, 0, sizeof row);
    el_triangle_angle_sum(corners, &hits);
    TEST_ASSERT_EQUAL_UINT16(1, row[999]);
    TEST_ASSERT_EQUAL_UINT16(1, row[1000]);
}

/* A left edge with a slope of a third of a pixel, which float does not have: after three rows the crossing, which is on
 * a centre, has moved past it. */
static void test_slopes_drift(void)
{
    static const el_spot corners[3] = {HALF(1, 1), HALF(7, 19), HALF(19, 1)};
    hits_picture expected;
    el_hits hits = hits_clear(&expected);
    el_reference_triangle(corners, EL_EDGES_LEFT_TOP, &hits);
    hits = hits_clear(&picture);
    el_triangle_split(corners, &hits);
    EXPECT_HITS(&expected, "reference", "111111111...", ".11111111...", ".1111111....", ".111111.....", "..11111.....",
                "..1111......", "..111.......", "...11.......", "...1........");
    EXPECT_HITS(&picture, "split", "111111111...", ".11111111...", ".1111111....", "..11111.....", "..11111.....",
                "..1111......", "..111.......", "...11.......", "...1........");
}

/* --- Values ------------------------------------------------------------------------------------------------------- */

/* 3/4 per column and 1/4 per row, so with halves, which are rounded up. What is not covered stays 9. */
static void test_values_of_a_plane(void)
{
    el_valued_triangle triangle = {.corners = {HALF(1, 1), HALF(17, 1), HALF(1, 17)}, .values = {1, 7, 3}};
    for (const el_value_method *method = el_value_methods; method < el_value_methods + EL_VALUE_METHODS; method++) {
        uint16_t values[HITS_ACROSS * HITS_DOWN];
        uint16_t scratch[HITS_ACROSS * HITS_DOWN];
        el_value_picture target = {HITS_ACROSS, HITS_DOWN, values, scratch};
        el_hits hits = hits_clear(&picture);
        memset(values, 0xFF, sizeof values);
        el_valued_triangle_cover(&triangle, &hits);
        method->fill(&triangle, &target);
        for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
            picture.counts[i] = values[i] == 0xFFFF ? 9 : values[i];
        }
        if (method->fill == el_value_of_first) {
            EXPECT_HITS(&picture, method->id, "111111119999", "111111199999", "111111999999", "111119999999",
                        "111199999999", "111999999999", "119999999999", "199999999999", "999999999999", "999999999999");
        } else if (method->fill == el_value_mean) {
            EXPECT_HITS(&picture, method->id, "444444449999", "444444499999", "444444999999", "444449999999",
                        "444499999999", "444999999999", "449999999999", "499999999999", "999999999999", "999999999999");
        } else {
            EXPECT_HITS(&picture, method->id, "123345669999", "123445699999", "223455999999", "233459999999",
                        "234499999999", "234999999999", "339999999999", "399999999999", "999999999999", "999999999999");
        }
    }
}

static void test_reference_values_round_halves_up(void)
{
    static const el_spot corners[3] = {HALF(1, 1), HALF(5, 1), HALF(1, 5)};
    static const el_spot turned[3] = {HALF(1, 1), HALF(1, 5), HALF(5, 1)};
    TEST_ASSERT_EQUAL_INT32(2, el_reference_value(corners, (const int32_t[]){0, 3, 0}, el_centre_of(1, 0)));
    TEST_ASSERT_EQUAL_INT32(1, el_reference_value(corners, (const int32_t[]){1, 0, 0}, el_centre_of(1, 0)));
    TEST_ASSERT_EQUAL_INT32(2, el_reference_value(turned, (const int32_t[]){0, 0, 3}, el_centre_of(1, 0)));
    TEST_ASSERT_EQUAL_INT32(65534, el_reference_value(corners, (const int32_t[]){65534, 0, 0}, el_centre_of(0, 0)));
    /* Outside of the triangle the plane goes on, below 0 too. */
    TEST_ASSERT_EQUAL_INT32(-1, el_reference_value(corners, (const int32_t[]){3, 0, 0}, el_centre_of(3, 0)));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_edges_through_centres);
    RUN_TEST(test_edges_beside_centres);
    RUN_TEST(test_a_shared_edge);
    RUN_TEST(test_no_area_covers_nothing);
    RUN_TEST(test_triangles_are_clipped);
    RUN_TEST(test_the_reference_is_the_rasterizer_tests_reference);
    RUN_TEST(test_exact_methods_are_exact);
    RUN_TEST(test_angle_sum_takes_what_is_almost_on_a_long_edge);
    RUN_TEST(test_slopes_drift);
    RUN_TEST(test_values_of_a_plane);
    RUN_TEST(test_reference_values_round_halves_up);
    return UNITY_END();
}
