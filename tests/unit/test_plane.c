/* A plane's value at every covered pixel against exact rational arithmetic, modulo 2^64 as its header says. */
#include "raster/small_plane.h"

#include "any_triangle.h"
#include "wide.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* The value at a pixel's centre times the doubled area, exactly: barycentric weights. */
static wide exact_times_area(const el_corner corners[3], const int64_t values[3], int32_t column, int32_t row)
{
    const int64_t x = (int64_t)column * EL_SUBPIXELS + EL_SUBPIXELS / 2;
    const int64_t y = (int64_t)row * EL_SUBPIXELS + EL_SUBPIXELS / 2;
    wide sum = wide_of(0);
    for (unsigned i = 0; i < 3; i++) {
        const int64_t weight = reference_side(&corners[(i + 1) % 3], &corners[(i + 2) % 3], x, y);
        sum = wide_sum(sum, wide_product(weight, values[i]));
    }
    return sum;
}

/* Within 2^-19 of the exact value, in Q32; the plane's value is that of column `at`. */
static void expect_value(const seeded *s, const el_corner corners[3], const int64_t values[3], unsigned fraction_bits,
                         const el_plane *plane, int32_t at, int32_t column, int32_t row)
{
    const int64_t area = reference_side(&corners[0], &corners[1], corners[2].x, corners[2].y);
    const wide exact = exact_times_area(corners, values, column, row);
    const wide exact_q32 = wide_quotient(wide_left(exact, 32 - fraction_bits), area);
    const int64_t got_q32 = (int64_t)(plane->value + el_plane_times(plane->dx, column - at));
    const int64_t error_q32 = (int64_t)((uint64_t)got_q32 - exact_q32.low);
    if (error_q32 > 1 << 13 || error_q32 < -(1 << 13)) {
        fail_at(s, "pixel (%d, %d) is off by %lld * 2^-32", (int)column, (int)row, (long long)error_q32);
    }
}

static el_plane_frame frame_at(const int32_t x[3], const int32_t y[3], int32_t column, int32_t row)
{
    el_plane_frame frame;
    el_plane_frame_make(&frame, x, y);
    frame.x = column;
    frame.row = row;
    return frame;
}

static void expect_plane(const seeded *s, const el_corner corners[3], const int64_t values[3], unsigned fraction_bits,
                         int32_t first_row, int32_t last_row, int32_t first_column, int32_t last_column)
{
    const int32_t x[3] = {corners[0].x, corners[1].x, corners[2].x};
    const int32_t y[3] = {corners[0].y, corners[1].y, corners[2].y};
    const int32_t at = first_column - (int32_t)(s->round % 7);
    el_plane_frame frame = frame_at(x, y, at, first_row);
    el_plane walked;
    el_plane_make(&walked, &frame, values, fraction_bits);
    for (int32_t row = first_row; row <= last_row; row++) {
        el_plane direct;
        frame = frame_at(x, y, at, row);
        el_plane_make(&direct, &frame, values, fraction_bits);
        if (direct.value != walked.value || direct.dx != walked.dx || direct.dy != walked.dy) {
            fail_at(s, "row %d differs from the walk", (int)row);
        }
        for (int32_t column = first_column; column <= last_column; column++) {
            if (reference_covers(corners, column, row)) {
                expect_value(s, corners, values, fraction_bits, &walked, at, column, row);
            }
        }
        walked.value += walked.dy;
    }
}

static void test_areas_and_their_sign(void)
{
    static const int32_t x[3] = {0, 16, 0};
    static const int32_t y[3] = {0, 0, 16};
    static const int32_t far_x[3] = {-EL_GUARD_SUB, EL_GUARD_SUB, -EL_GUARD_SUB};
    static const int32_t far_y[3] = {-EL_GUARD_SUB, -EL_GUARD_SUB, EL_GUARD_SUB};
    TEST_ASSERT_EQUAL_INT64(256, el_doubled_area(x, y)); /* right, then down: clockwise with y down */
    TEST_ASSERT_EQUAL_INT64(-256, el_doubled_area(y, x));
    TEST_ASSERT_EQUAL_INT64(4LL * EL_GUARD_SUB * EL_GUARD_SUB, el_doubled_area(far_x, far_y));
}

/* 16 px wide, from 0 at the left side to 16: a pixel's value is its centre's column. */
static void test_a_ramp(void)
{
    static const int32_t x[3] = {0, 16 * EL_SUBPIXELS, 0};
    static const int32_t y[3] = {0, 0, 16 * EL_SUBPIXELS};
    static const int64_t values[3] = {0, 16, 0};
    const el_plane_frame frame = frame_at(x, y, 0, 3);
    el_plane plane;
    el_plane_make(&plane, &frame, values, 0);
    TEST_ASSERT_EQUAL_HEX64(1ULL << 32, plane.dx);
    TEST_ASSERT_EQUAL_HEX64(0, plane.dy);
    TEST_ASSERT_EQUAL_HEX64(1ULL << 31, plane.value);
}

static void test_planes_seeded(void)
{
    for (seeded s = seeded_from(50); s.round < 4000; s.round++) {
        el_corner corners[3];
        int64_t values[3];
        const unsigned fraction_bits = s.round % 2 == 0 ? 0 : EL_PLANE_FRACTION_BITS;
        const int32_t reach = ((int32_t)any_of_bits(&s, 14) + 8) * SIXTEENTH;
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_corner(&s, 8 * EL_SUBPIXELS, reach);
            values[i] = any_signed_of_bits(&s, 31 + fraction_bits);
        }
        if (reference_side(&corners[0], &corners[1], corners[2].x, corners[2].y) != 0) {
            expect_plane(&s, corners, values, fraction_bits, 0, 15, 0, 15);
        }
    }
}

static int64_t magnitude_of(int64_t value)
{
    return value < 0 ? -value : value;
}

static uint64_t value_at(const el_plane *plane, int32_t rows, int32_t columns)
{
    return plane->value + plane->dy * (uint64_t)(int64_t)rows + plane->dx * (uint64_t)(int64_t)columns;
}

/* Depth and colours take a short way for small triangles: depth is within 2^-20 of the long way's, a channel within 2^-12,
 * and has its half. */
static void expect_short_ways(const seeded *s, const el_corner corners[3], const uint16_t depths[3],
                              const uint16_t colours[3])
{
    const int32_t x[3] = {corners[0].x, corners[1].x, corners[2].x};
    const int32_t y[3] = {corners[0].y, corners[1].y, corners[2].y};
    const el_plane_frame frame = frame_at(x, y, 3, 5);
    const int64_t wide_depths[3] = {depths[0], depths[1], depths[2]};
    const int64_t wide_colours[3] = {colours[0], colours[1], colours[2]};
    el_plane expected;
    el_plane got;
    el_plane_make(&expected, &frame, wide_depths, 0);
    el_plane_make_u16(&got, &frame, depths);
    el_plane plane;
    el_channel channel;
    el_plane_make(&plane, &frame, wide_colours, 0);
    el_channel_make(&channel, &frame, colours);
    for (int32_t row = 5; row < 13; row++) {
        for (int32_t column = 0; column < 8; column++) {
            const int32_t aside = column - 3;
            const uint64_t exact = value_at(&plane, row - 5, aside);
            const int64_t depth_error = (int64_t)(value_at(&got, row - 5, aside) - value_at(&expected, row - 5, aside));
            if (magnitude_of(depth_error) >= 1 << 12) {
                fail_at(s, "depth (%d, %d) is off by %lld * 2^-32", (int)column, (int)row, (long long)depth_error);
            }
            const uint32_t value =
                channel.value + channel.dy * (uint32_t)(row - 5) + channel.dx * (uint32_t)aside - EL_CHANNEL_HALF;
            const int32_t error = (int32_t)(value - (uint32_t)(exact >> 16));
            if (magnitude_of(error) > 4080) {
                fail_at(s, "pixel (%d, %d) is off by %d * 2^-24", (int)column, (int)row, (int)error);
            }
        }
    }
}

static void test_depth_and_colours_of_small_triangles(void)
{
    static const uint16_t ends[] = {0, 255 * 256, 65535};
    for (seeded s = seeded_from(51); s.round < PART_OF(50000); s.round++) {
        el_corner corners[3];
        uint16_t depths[3];
        uint16_t colours[3];
        const bool extreme = any_below(&s, 2) == 0;
        for (unsigned i = 0; i < 3; i++) {
            const int32_t reach = 64 * EL_SUBPIXELS - 2 + (int32_t)any_below(&s, 4);
            corners[i] = any_corner(&s, 8 * EL_SUBPIXELS, 32 * EL_SUBPIXELS);
            if (extreme && i > 0) {
                corners[i].x = corners[0].x + (any_below(&s, 2) == 0 ? reach : -reach);
                corners[i].y = corners[0].y + (any_below(&s, 2) == 0 ? reach : -reach);
            }
            depths[i] = any_below(&s, 2) == 0 ? ends[2 * any_below(&s, 2)] : (uint16_t)any_u64(&s);
            colours[i] = any_below(&s, 2) == 0 ? ends[any_below(&s, 2)] : (uint16_t)any_between(&s, 0, 255 * 256);
        }
        if (reference_side(&corners[0], &corners[1], corners[2].x, corners[2].y) != 0) {
            expect_short_ways(&s, corners, depths, colours);
        }
    }
}

#if EL_WITH_SMALL_PLANES
/* The short way to a small triangle's planes has the bits of the other, whichever row they start at. */
static void expect_small_planes(const seeded *s, const el_corner c[3], int32_t row)
{
    const int32_t x[3] = {c[0].x, c[1].x, c[2].x};
    const int32_t y[3] = {c[0].y, c[1].y, c[2].y};
    const el_plane_frame frame = frame_at(x, y, 0, row);
    const el_small_frame small = {
        .shape = {.dx1 = x[1] - x[0], .dy1 = y[1] - y[0], .dx2 = x[2] - x[0], .dy2 = y[2] - y[0]},
        .x0 = x[0],
        .y0 = y[0],
        .row = row,
        .area = el_small_divisor_make((int32_t)el_doubled_area(x, y)),
    };
    const uint16_t z[3] = {c[0].z, c[1].z, c[2].z};
    el_plane expected;
    el_plane got;
    el_plane_make_u16(&expected, &frame, z);
    el_small_plane_make(&got, &small, z[0], z[1], z[2]);
    if (got.value != expected.value || got.dx != expected.dx || got.dy != expected.dy) {
        fail_at(s, "depth from row %d on", (int)row);
    }
    for (unsigned i = 0; i < 3; i++) {
        const uint16_t values[3] = {c[0].rgb_q8[i], c[1].rgb_q8[i], c[2].rgb_q8[i]};
        el_channel plain;
        el_channel quick;
        el_channel_make(&plain, &frame, values);
        el_small_channel_make(&quick, &small, values[0], values[1], values[2]);
        if (quick.value != plain.value || quick.dx != plain.dx || quick.dy != plain.dy) {
            fail_at(s, "channel %u from row %d on", i, (int)row);
        }
    }
}

static void test_small_planes(void)
{
    for (seeded s = seeded_from(52); s.round < PART_OF(50000); s.round++) {
        const int32_t reach_x = s.round % 4 == 0 ? EL_EDGE_NARROW : 8 << s.round % 7;
        const int32_t reach_y = s.round % 4 == 0 ? EL_EDGE_SHORT : 8 << s.round % 6;
        const int32_t x = (int32_t)any_between(&s, -EL_GUARD_SUB, EL_GUARD_SUB - reach_x);
        const int32_t y = (int32_t)any_between(&s, -EL_GUARD_SUB, EL_GUARD_SUB - reach_y);
        el_corner c[3];
        for (unsigned i = 0; i < 3; i++) {
            c[i] = any_corner(&s, 0, 1);
            c[i].x = x + (int32_t)(any_below(&s, 4) == 0 ? reach_x * (int32_t)any_below(&s, 2)
                                                         : any_between(&s, 0, reach_x));
            c[i].y = y + (int32_t)(any_below(&s, 4) == 0 ? reach_y * (int32_t)any_below(&s, 2)
                                                         : any_between(&s, 0, reach_y));
        }
        const el_small_shape shape = {
            .dx1 = c[1].x - c[0].x, .dy1 = c[1].y - c[0].y, .dx2 = c[2].x - c[0].x, .dy2 = c[2].y - c[0].y};
        if (c[1].y >= c[0].y && c[2].y >= c[1].y && el_shape_is_small(&shape) && el_small_area(&shape) != 0) {
            expect_small_planes(&s, c, el_first_centre(c[0].y) + (int32_t)any_below(&s, 4));
        }
    }
}
#endif

/* The whole guard band and the whole range of values, at its far corners. */
static void test_largest_planes(void)
{
    static const int32_t ends[] = {-EL_GUARD_SUB, EL_GUARD_SUB};
    static const int64_t limits[] = {-INT32_MAX, INT32_MAX};
    seeded s = seeded_from(0);
    for (; s.round < 1024; s.round++) {
        const unsigned fraction_bits = s.round < 512 ? 0 : EL_PLANE_FRACTION_BITS;
        el_corner corners[3] = {0};
        int64_t values[3];
        for (unsigned i = 0; i < 3; i++) {
            corners[i].x = ends[s.round >> i & 1];
            corners[i].y = ends[s.round >> (3 + i) & 1];
            values[i] = limits[s.round >> (6 + i) & 1] * (1 << fraction_bits);
        }
        if (reference_side(&corners[0], &corners[1], corners[2].x, corners[2].y) != 0) {
            expect_plane(&s, corners, values, fraction_bits, EL_GUARD_PX - 3, EL_GUARD_PX - 1, EL_GUARD_PX - 4,
                         EL_GUARD_PX - 1);
            expect_plane(&s, corners, values, fraction_bits, -EL_GUARD_PX, 3 - EL_GUARD_PX, -EL_GUARD_PX,
                         3 - EL_GUARD_PX);
            expect_plane(&s, corners, values, fraction_bits, 0, 3, 0, 3);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_areas_and_their_sign);
    RUN_TEST(test_a_ramp);
    RUN_TEST(test_planes_seeded);
    RUN_TEST(test_depth_and_colours_of_small_triangles);
#if EL_WITH_SMALL_PLANES
    RUN_TEST(test_small_planes);
#endif
    RUN_TEST(test_largest_planes);
    return UNITY_END();
}
