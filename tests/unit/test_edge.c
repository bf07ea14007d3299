/* An edge's first pixel on each row against the exact quotient, at any starting row, and stepping against starting. */
#include "raster/edge.h"

#include "seeded.h"

enum { HALF = EL_SUBPIXELS / 2, GUARD_BITS = 11 + EL_SUBPIXEL_BITS };

void setUp(void)
{
}

void tearDown(void)
{
}

/* ceil((X - half) / EL_SUBPIXELS) where X, in sub-pixels, is where the edge crosses the row's centre line. */
static int32_t reference_x(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row)
{
    const int64_t dy = y1 - y0;
    const int64_t crossing = (int64_t)x0 * dy + (int64_t)(row * EL_SUBPIXELS + HALF - y0) * (x1 - x0); /* times dy */
    const int64_t n = crossing - HALF * dy;
    const int64_t d = EL_SUBPIXELS * dy;
    return (int32_t)(n / d + (n % d > 0));
}

typedef void make_edge(el_edge *edge, int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row);

static void expect_made(const seeded *s, make_edge *make, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    const int32_t first = el_first_centre(y0);
    const int32_t end = el_first_centre(y1);
    if (first >= end) {
        return;
    }
    el_edge walked;
    make(&walked, x0, y0, x1, y1, first);
    const int32_t stride = (end - first) / 40 + 1; /* long edges are started anew on some of their rows */
    for (int32_t row = first; row < end; row++) {
        const int32_t expected = reference_x(x0, y0, x1, y1, row);
        if (el_edge_x(&walked) != expected) {
            fail_at(s, "(%d, %d) to (%d, %d): row %d begins at %d, not %d", (int)x0, (int)y0, (int)x1, (int)y1,
                    (int)row, (int)expected, (int)el_edge_x(&walked));
        }
        if (row % stride == 0) {
            el_edge direct;
            make(&direct, x0, y0, x1, y1, row);
            if (el_edge_x(&direct) != el_edge_x(&walked)) {
                fail_at(s, "(%d, %d) to (%d, %d): row %d differs from the walk", (int)x0, (int)y0, (int)x1, (int)y1,
                        (int)row);
            }
        }
        el_edge_next_row(&walked);
    }
}

static void expect_edge(const seeded *s, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    expect_made(s, el_edge_make, x0, y0, x1, y1);
#if EL_SUBPIXEL_BITS == 4 && !EL_SMALL_CODE
    if (y1 - y0 <= EL_EDGE_SHORT && x1 - x0 <= EL_EDGE_NARROW && x0 - x1 <= EL_EDGE_NARROW) {
        expect_made(s, el_edge_make_short, x0, y0, x1, y1);
    }
#endif
}

static void test_first_centres(void)
{
    TEST_ASSERT_EQUAL_INT32(0, el_first_centre(0));
    TEST_ASSERT_EQUAL_INT32(0, el_first_centre(HALF));
    TEST_ASSERT_EQUAL_INT32(1, el_first_centre(HALF + 1));
    TEST_ASSERT_EQUAL_INT32(1, el_first_centre(HALF + EL_SUBPIXELS));
    TEST_ASSERT_EQUAL_INT32(0, el_first_centre(1 - HALF));
    TEST_ASSERT_EQUAL_INT32(-1, el_first_centre(-HALF));
    TEST_ASSERT_EQUAL_INT32(-EL_GUARD_PX, el_first_centre(-EL_GUARD_SUB));
    TEST_ASSERT_EQUAL_INT32(EL_GUARD_PX, el_first_centre(EL_GUARD_SUB));
}

/* 45 degrees through centres: each row's own centre is not left of the edge. */
static void test_a_diagonal(void)
{
    el_edge edge;
    el_edge_make(&edge, HALF, HALF, HALF + 5 * EL_SUBPIXELS, HALF + 5 * EL_SUBPIXELS, 0);
    for (int32_t row = 0; row < 5; row++) {
        TEST_ASSERT_EQUAL_INT32(row, el_edge_x(&edge));
        el_edge_next_row(&edge);
    }
}

static void test_edges_in_the_guard_band_seeded(void)
{
    for (seeded s = seeded_from(40); s.round < 3000; s.round++) {
        const unsigned bits = (unsigned)any_between(&s, 3, GUARD_BITS);
        int32_t c[4];
        for (unsigned i = 0; i < 4; i++) {
            const int64_t any = any_signed_of_bits(&s, bits);
            c[i] = (int32_t)(any > EL_GUARD_SUB ? EL_GUARD_SUB : (any < -EL_GUARD_SUB ? -EL_GUARD_SUB : any));
        }
        expect_edge(&s, c[0], c[1] < c[3] ? c[1] : c[3], c[2], c[1] < c[3] ? c[3] : c[1]);
    }
}

/* Up to where edges are short (with 4 bits), and a little beyond. */
static void test_short_edges(void)
{
    enum { SHORT = 32 * EL_SUBPIXELS, NARROW = 64 * EL_SUBPIXELS };
    for (seeded s = seeded_from(41); s.round < PART_OF(20000); s.round++) {
        const int32_t x = (int32_t)any_between(&s, -EL_GUARD_SUB / 2, EL_GUARD_SUB / 2);
        const int32_t y = (int32_t)any_between(&s, -EL_GUARD_SUB / 2, EL_GUARD_SUB / 2);
        const int32_t beside = (int32_t)any_between(&s, -2, 2);
        const int32_t dx =
            any_below(&s, 2) == 0 ? NARROW - beside : (int32_t)any_signed_of_bits(&s, 6 + EL_SUBPIXEL_BITS);
        const int32_t dy = any_below(&s, 2) == 0 ? SHORT - beside : (int32_t)any_of_bits(&s, 5 + EL_SUBPIXEL_BITS) + 1;
        expect_edge(&s, x, y, x + dx, y + dy);
        expect_edge(&s, x, y, x - dx, y + dy);
    }
}

static void test_longest_edges(void)
{
    static const int32_t ends[] = {-EL_GUARD_SUB, -EL_GUARD_SUB + 1, 0, EL_GUARD_SUB - 1, EL_GUARD_SUB};
    seeded s = seeded_from(0);
    for (unsigned i = 0; i < 25; i++) {
        for (unsigned k = 0; k < 25; k++, s.round++) {
            if (ends[i / 5] < ends[k / 5]) {
                expect_edge(&s, ends[i % 5], ends[i / 5], ends[k % 5], ends[k / 5]);
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_first_centres);
    RUN_TEST(test_a_diagonal);
    RUN_TEST(test_edges_in_the_guard_band_seeded);
    RUN_TEST(test_short_edges);
    RUN_TEST(test_longest_edges);
    return UNITY_END();
}
