/* Spans against the exact edge functions: every row of any triangle, in targets of any place and width, walked in pieces of any
 * number of rows; and what is counted. */
#include <string.h>

#include "any_triangle.h"
#include "raster/spans.h"

static el_stats stats;

void setUp(void)
{
}

void tearDown(void)
{
}

/* What the spans of a row must be, and what they count. */
static void check_row(const seeded *s, const el_corner corners[3], int32_t row, int32_t width, int32_t x, int32_t x_end,
                      el_stats *expected)
{
    int32_t covered = 0;
    if (x < 0 || x > width || x_end < 0 || x_end > width) {
        fail_at(s, "row %d: [%d, %d) is not within [0, %d)", (int)row, (int)x, (int)x_end, (int)width);
    }
    for (int32_t column = 0; column < width; column++) {
        const bool inside = reference_covers(corners, column, row);
        covered += inside;
        if (inside != (x <= column && column < x_end)) {
            fail_at(s, "row %d: [%d, %d), but pixel %d is %s", (int)row, (int)x, (int)x_end, (int)column,
                    inside ? "inside" : "outside");
        }
    }
    expected->rows++;
    expected->spans++; /* whoever finds a row empty takes it back */
    expected->pixels += (uint32_t)covered;
}

static void test_spans_are_the_pixels_inside(void)
{
    enum { SCREEN = 48 };
    uint32_t walked = 0;
    for (seeded s = seeded_from(90); s.round < PART_OF(3000); s.round++) {
        const int32_t reach = ((int32_t)any_of_bits(&s, 11) + 64) * SIXTEENTH;
        el_corner corners[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_corner(&s, SCREEN * EL_SUBPIXELS / 2, reach);
        }
        const el_surface surface = {.shading = EL_SHADE_FLAT};
        el_triangle triangle;
        if (!el_triangle_setup(&triangle, corners, &surface, (int32_t)any_below(&s, SCREEN))) {
            continue;
        }
        el_stats expected = {0};
        memset(&stats, 0, sizeof stats);
        int32_t row = triangle.y;
        while (!el_triangle_is_done(&triangle) && row < SCREEN) {
            const el_target target = {
                .width = 1 + (int32_t)any_below(&s, SCREEN), .y = row, .y_end = row + 1 + (int32_t)any_below(&s, 30)};
            el_spans spans;
            const int32_t rows = el_spans_next(&triangle, &target, &stats, &spans);
            TEST_ASSERT_TRUE(rows >= 1 && rows <= EL_SPAN_ROWS && row + rows <= target.y_end);
            for (int32_t i = 0; i < rows; i++) {
                check_row(&s, corners, row + i, target.width, spans.x[i], spans.x_end[i], &expected);
            }
            row += rows;
            walked += (uint32_t)rows;
            TEST_ASSERT_EQUAL_INT32(row, triangle.y);
        }
        TEST_ASSERT_EQUAL_MEMORY(&expected, &stats, sizeof stats);
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(15000U), walked);
}

/* A triangle that begins below the target, or is done, has no rows, and is left as it is. */
static void test_no_rows_are_left_alone(void)
{
    const el_corner corners[3] = {{.x = 0, .y = 0}, {.x = 0, .y = 8 * EL_SUBPIXELS}, {.x = 8 * EL_SUBPIXELS, .y = 0}};
    const el_surface surface = {.shading = EL_SHADE_FLAT};
    const el_target above = {.width = 8, .y = 0, .y_end = 4};
    el_triangle triangle;
    el_spans spans;
    TEST_ASSERT_TRUE(el_triangle_setup(&triangle, corners, &surface, 4));
    memset(&stats, 0, sizeof stats);
    TEST_ASSERT_EQUAL_INT32(0, el_spans_next(&triangle, &above, &stats, &spans));
    TEST_ASSERT_EQUAL_INT16(4, triangle.y);
    const el_target whole = {.width = 8, .y = 0, .y_end = 8};
    TEST_ASSERT_EQUAL_INT32(4, el_spans_next(&triangle, &whole, &stats, &spans));
    TEST_ASSERT_EQUAL_INT32(0, el_spans_next(&triangle, &whole, &stats, &spans));
    TEST_ASSERT_EQUAL_UINT32(4, stats.rows);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_spans_are_the_pixels_inside);
    RUN_TEST(test_no_rows_are_left_alone);
    return UNITY_END();
}
