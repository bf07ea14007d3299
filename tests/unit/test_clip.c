/* Clipping: each plane by example, both triangles of an edge alike, attributes where they belong, and vertices that no
 * picture can have: behind the camera, and in orthographic projection. */
#include <string.h>

#include "geometry/clip.h"
#include "seeded.h"

enum { NEAR = 1000, FAR = 500000, GUARD_X = 3, GUARD_Y = 4 };

static el_transform transform;

void setUp(void)
{
    transform = (el_transform){.near = NEAR, .far = FAR, .guard_shift = {GUARD_X, GUARD_Y}};
}

void tearDown(void)
{
}

static el_clip_corner corner(int32_t x, int32_t y, int32_t d)
{
    return (el_clip_corner){
        .position = {.x = x, .y = y, .d = d, .w = transform.orthographic ? transform.constant_w : d}};
}

static uint8_t codes_of(const el_clip_corner corners[3])
{
    uint8_t codes = 0;
    for (unsigned i = 0; i < 3; i++) {
        codes |= el_outcode(&transform, &corners[i].position);
    }
    return codes;
}

static void expect_position(int32_t x, int32_t y, int32_t d, const el_clip_corner *got)
{
    TEST_ASSERT_EQUAL_INT32(x, got->position.x);
    TEST_ASSERT_EQUAL_INT32(y, got->position.y);
    TEST_ASSERT_EQUAL_INT32(d, got->position.d);
    TEST_ASSERT_EQUAL_INT32(transform.orthographic ? transform.constant_w : d, got->position.w);
}

/* --- One plane at a time ------------------------------------------------------------------------------------------ */

/* One corner behind: a quad; half way in space is half way in every attribute. */
static void test_one_corner_before_near(void)
{
    el_clip_corner c[EL_CLIP_MAX_VERTICES] = {corner(0, 0, 3000), corner(400, 0, 3000), corner(0, 800, -1000)};
    for (unsigned i = 0; i < EL_CLIP_ATTRIBUTES; i++) {
        c[2].attributes[i] = 2000 * (int32_t)(i + 1);
    }
    TEST_ASSERT_EQUAL_UINT(4, el_clip_polygon(&transform, c, 3, codes_of(c)));
    expect_position(0, 400, NEAR, &c[0]);
    expect_position(0, 0, 3000, &c[1]);
    expect_position(400, 0, 3000, &c[2]);
    expect_position(200, 400, NEAR, &c[3]);
    for (unsigned i = 0; i < EL_CLIP_ATTRIBUTES; i++) {
        TEST_ASSERT_EQUAL_INT32(1000 * (int32_t)(i + 1), c[0].attributes[i]);
        TEST_ASSERT_EQUAL_INT32(0, c[1].attributes[i]);
        TEST_ASSERT_EQUAL_INT32(1000 * (int32_t)(i + 1), c[3].attributes[i]);
    }
}

static void test_two_corners_before_near(void)
{
    el_clip_corner c[EL_CLIP_MAX_VERTICES] = {corner(0, 0, 3000), corner(400, 0, -1000), corner(0, 800, -1000)};
    TEST_ASSERT_EQUAL_UINT(3, el_clip_polygon(&transform, c, 3, codes_of(c)));
    expect_position(0, 400, NEAR, &c[0]);
    expect_position(0, 0, 3000, &c[1]);
    expect_position(200, 0, NEAR, &c[2]);
}

static void test_beyond_far(void)
{
    el_clip_corner c[EL_CLIP_MAX_VERTICES] = {corner(0, 0, FAR - 1000), corner(4000, 0, FAR - 1000),
                                              corner(0, 6000, FAR + 1000)};
    TEST_ASSERT_EQUAL_UINT(4, el_clip_polygon(&transform, c, 3, codes_of(c)));
    expect_position(0, 3000, FAR, &c[0]);
    expect_position(2000, 3000, FAR, &c[3]);
}

/* Inside on one side of the guard band at w = 8000, outside by as much. */
static void test_each_side_of_the_guard_band(void)
{
    static const int signs[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    for (unsigned i = 0; i < 4; i++) {
        const int32_t x = signs[i][0] * (8000 << GUARD_X);
        const int32_t y = signs[i][1] * (8000 << GUARD_Y);
        el_clip_corner c[EL_CLIP_MAX_VERTICES] = {corner(x / 2, y / 2, 8000), corner(x / 2, y / 2, 8000),
                                                  corner(x / 2 * 3, y / 2 * 3, 8000)};
        TEST_ASSERT_EQUAL_UINT(4, el_clip_polygon(&transform, c, 3, codes_of(c)));
        expect_position(x, y, 8000, &c[0]);
        expect_position(x, y, 8000, &c[3]);
    }
}

/* Beside the screen, but not beyond the guard band: left alone. */
static void test_inside_the_guard_band_nothing_is_cut(void)
{
    el_clip_corner c[EL_CLIP_MAX_VERTICES] = {corner(-7 * 8000, 0, 8000), corner(7 * 8000, 0, 8000),
                                              corner(0, 15 * 8000, 8000)};
    el_clip_corner before[3];
    memcpy(before, c, sizeof before);
    TEST_ASSERT_EQUAL_HEX8(EL_CODE_LEFT | EL_CODE_RIGHT | EL_CODE_ABOVE, codes_of(c));
    TEST_ASSERT_EQUAL_UINT(3, el_clip_polygon(&transform, c, 3, codes_of(c)));
    TEST_ASSERT_EQUAL_MEMORY(before, c, sizeof before);
}

static void test_nothing_is_left(void)
{
    el_clip_corner before_near[EL_CLIP_MAX_VERTICES] = {corner(0, 0, 999), corner(5, 0, 0), corner(0, 5, -7)};
    TEST_ASSERT_EQUAL_UINT(0, el_clip_polygon(&transform, before_near, 3, codes_of(before_near)));
    el_clip_corner aside[EL_CLIP_MAX_VERTICES] = {corner(9 * 2000, 0, 2000), corner(9 * 3000, 0, 3000),
                                                  corner(99999, 99999, 2000)};
    TEST_ASSERT_EQUAL_UINT(0, el_clip_polygon(&transform, aside, 3, codes_of(aside)));
}

/* A triangle around everything becomes the view's own outline. */
static void test_a_triangle_around_the_guard_band(void)
{
    el_clip_corner c[EL_CLIP_MAX_VERTICES] = {corner(-400000, -200000, 2000), corner(400000, -200000, 2000),
                                              corner(0, 900000, 2000)};
    TEST_ASSERT_EQUAL_UINT(4, el_clip_polygon(&transform, c, 3, codes_of(c)));
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT64(2000 << GUARD_X, c[i].position.x < 0 ? -c[i].position.x : c[i].position.x);
        TEST_ASSERT_EQUAL_UINT64(2000 << GUARD_Y, c[i].position.y < 0 ? -c[i].position.y : c[i].position.y);
    }
}

static void test_orthographic(void)
{
    transform.orthographic = 1;
    transform.constant_w = 1 << 20;
    el_clip_corner c[EL_CLIP_MAX_VERTICES] = {corner(0, 0, 3000), corner(400, 0, 3000), corner(0, 800, -1000)};
    TEST_ASSERT_EQUAL_UINT(4, el_clip_polygon(&transform, c, 3, codes_of(c)));
    expect_position(0, 400, NEAR, &c[0]);
    expect_position(200, 400, NEAR, &c[3]);
    el_clip_corner side[EL_CLIP_MAX_VERTICES] = {corner(0, 0, 3000), corner(0, 500, 3000), corner(16 << 20, 0, 5000)};
    TEST_ASSERT_EQUAL_UINT(4, el_clip_polygon(&transform, side, 3, codes_of(side)));
    expect_position(8 << 20, 0, 4000, &side[0]);
    expect_position(8 << 20, 250, 4000, &side[3]);
}

/* --- Seeded ------------------------------------------------------------------------------------------------------- */

static el_clip_corner any_clip_corner(seeded *s)
{
    el_clip_corner c = corner((int32_t)any_signed_of_bits(s, 30), (int32_t)any_signed_of_bits(s, 30),
                              (int32_t)any_signed_of_bits(s, 30));
    for (unsigned i = 0; i < EL_CLIP_ATTRIBUTES; i++) {
        c.attributes[i] = (int32_t)any_signed_of_bits(s, 30);
    }
    return c;
}

static void any_view(seeded *s)
{
    transform.orthographic = any_below(s, 4) == 0;
    transform.near = (int32_t)any_of_bits(s, 29) + 1;
    transform.far = transform.near + (int32_t)any_of_bits(s, 30) + 1;
    transform.constant_w = 1 << any_below(s, 30);
    transform.guard_shift[0] = (uint8_t)any_below(s, 11);
    transform.guard_shift[1] = (uint8_t)any_below(s, 11);
}

/* What is left can be projected: no vertex needs cutting any more. */
static void test_results_are_inside_seeded(void)
{
    unsigned counts[EL_CLIP_MAX_VERTICES + 1] = {0};
    for (seeded s = seeded_from(80); s.round < PART_OF(200000); s.round++) {
        el_clip_corner c[EL_CLIP_MAX_VERTICES];
        any_view(&s);
        for (unsigned i = 0; i < 3; i++) {
            c[i] = any_clip_corner(&s);
        }
        const unsigned count = el_clip_polygon(&transform, c, 3, codes_of(c));
        TEST_ASSERT_TRUE(count == 0 || (count >= 3 && count <= EL_CLIP_MAX_VERTICES));
        counts[count]++;
        for (unsigned i = 0; i < count; i++) {
            const uint8_t code = el_outcode(&transform, &c[i].position);
            if ((code & EL_CODE_CLIP) != 0 || c[i].position.w <= 0) {
                fail_at(&s, "corner %u of %u has code %02X, w %ld", i, count, code, (long)c[i].position.w);
            }
        }
    }
    for (unsigned i = 3; i <= 6; i++) {
        TEST_ASSERT_GREATER_THAN_UINT(PART_OF(20), counts[i]);
    }
}

static bool has_vertex(const el_clip_corner *c, unsigned count, const el_clip_corner *wanted)
{
    for (unsigned i = 0; i < count; i++) {
        if (memcmp(&c[i], wanted, sizeof c[i]) == 0) {
            return true;
        }
    }
    return false;
}

/* Whether both ends are outside of one plane: then nothing of the edge is left. */
static bool is_gone(const el_clip_vertex *a, const el_clip_vertex *b)
{
    return (el_outcode(&transform, a) & el_outcode(&transform, b) & (EL_CODE_NEAR | EL_CODE_FAR)) != 0;
}

/* The edge a-b of the triangles (a, b, c) and (b, a, d), cut at the near or the far plane alone, has the same new vertex
 * in both, to the bit. */
static void test_both_triangles_of_an_edge_get_the_same_vertex(void)
{
    unsigned cut_edges = 0;
    for (seeded s = seeded_from(81); s.round < PART_OF(100000); s.round++) {
        any_view(&s);
        transform.orthographic = 1;
        transform.constant_w = 1 << 29; /* and a guard band that nothing leaves */
        transform.guard_shift[0] = transform.guard_shift[1] = 2;
        const el_clip_corner a = any_clip_corner(&s);
        const el_clip_corner b = any_clip_corner(&s);
        el_clip_corner left[EL_CLIP_MAX_VERTICES] = {a, b, any_clip_corner(&s)};
        el_clip_corner right[EL_CLIP_MAX_VERTICES] = {b, a, any_clip_corner(&s)};
        const unsigned n = el_clip_polygon(&transform, left, 3, codes_of(left));
        const unsigned m = el_clip_polygon(&transform, right, 3, codes_of(right));
        if (is_gone(&a.position, &b.position) || n == 0 || m == 0) {
            continue;
        }
        /* An edge there and back is cut where the edge is. */
        el_clip_corner alone[EL_CLIP_MAX_VERTICES] = {a, b, b};
        const unsigned k = el_clip_polygon(&transform, alone, 3, codes_of(alone));
        for (unsigned i = 0; i < k; i++) {
            cut_edges++;
            if (!has_vertex(left, n, &alone[i]) || !has_vertex(right, m, &alone[i])) {
                fail_at(&s, "a vertex of the edge at (%ld, %ld, %ld) is missing", (long)alone[i].position.x,
                        (long)alone[i].position.y, (long)alone[i].position.d);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(PART_OF(20000), cut_edges);
}

/* At every plane: the same, for edges of which one end is inside. */
static void test_edges_at_all_planes_seeded(void)
{
    unsigned cut_edges = 0;
    for (seeded s = seeded_from(82); s.round < PART_OF(200000); s.round++) {
        any_view(&s);
        const el_clip_corner a = any_clip_corner(&s);
        const el_clip_corner b = any_clip_corner(&s);
        const uint8_t a_code = el_outcode(&transform, &a.position);
        const uint8_t b_code = el_outcode(&transform, &b.position);
        if ((a_code & EL_CODE_CLIP) != 0 || (b_code & EL_CODE_CLIP) == 0) {
            continue;
        }
        el_clip_corner left[EL_CLIP_MAX_VERTICES] = {a, b, any_clip_corner(&s)};
        el_clip_corner right[EL_CLIP_MAX_VERTICES] = {b, a, any_clip_corner(&s)};
        el_clip_corner alone[EL_CLIP_MAX_VERTICES] = {a, b, a};
        const uint8_t codes = EL_CODE_NEAR | EL_CODE_FAR | EL_CODE_GUARD;
        const unsigned n = el_clip_polygon(&transform, left, 3, codes);
        const unsigned m = el_clip_polygon(&transform, right, 3, codes);
        const unsigned k = el_clip_polygon(&transform, alone, 3, codes);
        for (unsigned i = 0; i < k; i++) {
            cut_edges++;
            if (!has_vertex(left, n, &alone[i]) || !has_vertex(right, m, &alone[i])) {
                fail_at(&s, "codes %02X and %02X: a vertex is missing", a_code, b_code);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(PART_OF(5000), cut_edges);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_one_corner_before_near);
    RUN_TEST(test_two_corners_before_near);
    RUN_TEST(test_beyond_far);
    RUN_TEST(test_each_side_of_the_guard_band);
    RUN_TEST(test_inside_the_guard_band_nothing_is_cut);
    RUN_TEST(test_nothing_is_left);
    RUN_TEST(test_a_triangle_around_the_guard_band);
    RUN_TEST(test_orthographic);
    RUN_TEST(test_results_are_inside_seeded);
    RUN_TEST(test_both_triangles_of_an_edge_get_the_same_vertex);
    RUN_TEST(test_edges_at_all_planes_seeded);
    return UNITY_END();
}
