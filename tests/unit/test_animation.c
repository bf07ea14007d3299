/* Animations are exact at their keys, near the exact polynomials between them, and repeat as they are told to. */
#include "geometry/animation.h"

#include <math.h>
#include <string.h>

#include "seeded.h"

enum { ONE = EL_UNIT_Q30, KEYS = 6 };

void setUp(void)
{
}

void tearDown(void)
{
}

static const uint32_t times_ms[4] = {100, 200, 400, 1000};
static const int32_t places_q16[4][3] = {{0, 5, -100}, {1000, 5, 100}, {1000, 6, -700}, {-4000, 7, 0}};

static el_position_track places(el_between between)
{
    return (el_position_track){.keys = {.at_ms = times_ms, .count = 4, .between = (uint8_t)between},
                               .values_q16 = places_q16};
}

static void expect_place(const el_position_track *track, uint32_t time_ms, int32_t x, int32_t y, int32_t z)
{
    const int32_t expected[3] = {x, y, z};
    int32_t got[3];
    el_position_at(track, time_ms, got);
    TEST_ASSERT_EQUAL_INT32_ARRAY(expected, got, 3);
}

static void test_keys_are_exact_and_hold_at_the_ends(void)
{
    for (el_between between = EL_BETWEEN_STEP; between <= EL_BETWEEN_SMOOTH; between++) {
        const el_position_track track = places(between);
        for (unsigned i = 0; i < 4; i++) {
            expect_place(&track, times_ms[i], places_q16[i][0], places_q16[i][1], places_q16[i][2]);
        }
        expect_place(&track, 0, 0, 5, -100);
        expect_place(&track, UINT32_MAX, -4000, 7, 0);
    }
}

static void test_steps_and_lines(void)
{
    const el_position_track step = places(EL_BETWEEN_STEP);
    const el_position_track line = places(EL_BETWEEN_LINEAR);
    expect_place(&step, 399, 1000, 5, 100);
    expect_place(&step, 999, 1000, 6, -700);
    expect_place(&line, 150, 500, 5, 0);
    expect_place(&line, 250, 1000, 5, -100);
    expect_place(&line, 700, -1500, 7, -350); /* 6.5 to nearest, ties up */
}

/* By hand: speeds per ms at 200 and 400 are (1000 - 0) / 300 and (-4000 - 1000) / 800; half-way the cubic is the mean of
 * both values and an eighth of 200 ms of the difference in speed: 1000 + 25 (3.333 + 6.25) = 1239.58. */
static void test_smooth_by_hand(void)
{
    const el_position_track smooth = places(EL_BETWEEN_SMOOTH);
    int32_t got[3];
    el_position_at(&smooth, 300, got);
    TEST_ASSERT_INT32_WITHIN(1, 1240, got[0]);
    /* From the first key on at the speed to its neighbour: 10 per ms; it arrives with 1000 / 300. */
    el_position_at(&smooth, 150, got);
    TEST_ASSERT_INT32_WITHIN(1, 500 + 83, got[0]); /* 100 / 8 (10 - 3.333) */
}

typedef struct keys {
    uint32_t at_ms[KEYS];
    int32_t values[KEYS][3];
    uint32_t scales[KEYS];
    el_quaternion turns[KEYS];
    uint16_t count;
} keys;

static keys any_keys(seeded *s)
{
    keys k = {.count = (uint16_t)any_between(s, 1, KEYS)};
    const unsigned bits = 1 + any_below(s, 31);
    const unsigned time_bits = 1 + any_below(s, 29);
    uint32_t at_ms = (uint32_t)any_of_bits(s, time_bits);
    for (unsigned i = 0; i < k.count; i++) {
        k.at_ms[i] = at_ms;
        at_ms += 1 + (uint32_t)any_of_bits(s, time_bits);
        for (unsigned j = 0; j < 3; j++) {
            k.values[i][j] = (int32_t)any_signed_of_bits(s, bits);
        }
        k.scales[i] = (uint32_t)any_of_bits(s, 32) | 1U;
        k.turns[i] =
            el_quaternion_about((const int32_t[]){(int32_t)any_u64(s), (int32_t)any_u64(s), 1}, (el_angle)any_u64(s));
    }
    return k;
}

/* The exact value, of the formula in Hermite's four weights. *ways: the sum of the ways around. */
static double exact(const keys *k, bool smooth, uint32_t time_ms, const double value[KEYS], double *ways)
{
    unsigned i = 0;
    *ways = 0;
    while (i + 1U < k->count && k->at_ms[i + 1] <= time_ms) {
        i++;
    }
    if (i + 1U == k->count || time_ms <= k->at_ms[0]) {
        return value[i];
    }
    const double all = (double)k->at_ms[i + 1] - k->at_ms[i];
    const double t = ((double)time_ms - k->at_ms[i]) / all;
    const double way = value[i + 1] - value[i];
    const double before = i > 0 ? (value[i + 1] - value[i - 1]) : way;
    const double after = i + 2U < k->count ? value[i + 2] - value[i] : way;
    *ways = fabs(way) + fabs(before) + fabs(after);
    if (!smooth) {
        return value[i] + way * t;
    }
    const double leaving = i > 0 ? before * all / ((double)k->at_ms[i + 1] - k->at_ms[i - 1]) : way;
    const double arriving = i + 2U < k->count ? after * all / ((double)k->at_ms[i + 2] - k->at_ms[i]) : way;
    return (2 * t * t * t - 3 * t * t + 1) * value[i] + (t * t * t - 2 * t * t + t) * leaving +
           (3 * t * t - 2 * t * t * t) * value[i + 1] + (t * t * t - t * t) * arriving;
}

static void test_between_keys_seeded(void)
{
    for (seeded s = seeded_from(721); s.round < PART_OF(50000); s.round++) {
        const keys k = any_keys(&s);
        const bool smooth = any_below(&s, 2) == 0;
        const el_key_times times = {
            .at_ms = k.at_ms, .count = k.count, .between = smooth ? EL_BETWEEN_SMOOTH : EL_BETWEEN_LINEAR};
        const el_position_track track = {.keys = times, .values_q16 = (const int32_t(*)[3])k.values};
        const el_scale_track scale = {.keys = times, .values_q16 = k.scales};
        const uint32_t time_ms = k.at_ms[0] + (uint32_t)any_between(&s, 0, 2 + k.at_ms[k.count - 1] - k.at_ms[0]);
        int32_t got[3];
        double values[KEYS];
        double ways;
        el_position_at(&track, time_ms, got);
        for (unsigned i = 0; i < 3; i++) {
            for (unsigned j = 0; j < k.count; j++) {
                values[j] = k.values[j][i];
            }
            const double expected = fmax(fmin(exact(&k, smooth, time_ms, values, &ways), INT32_MAX), INT32_MIN);
            if (fabs(got[i] - expected) > 2 + ways / (1 << 28)) {
                fail_at(&s, "a coordinate is %ld, not %.3f", (long)got[i], expected);
            }
        }
        for (unsigned j = 0; j < k.count; j++) {
            values[j] = k.scales[j];
        }
        const double expected = fmax(fmin(exact(&k, smooth, time_ms, values, &ways), UINT32_MAX), 1);
        const uint32_t is = el_scale_at(&scale, time_ms);
        if (fabs(is - expected) > 2 + ways / (1 << 28)) {
            fail_at(&s, "a scale is %lu, not %.3f", (unsigned long)is, expected);
        }
    }
}

/* Half-way between a quarter turn and none is an eighth; smooth, likewise, since both ends have its speed. Their negatives
 * are the same turns, and the way to them no longer. */
static void test_rotations(void)
{
    const uint32_t at_ms[2] = {0, 1000};
    const el_quaternion quarter = el_quaternion_about((const int32_t[]){0, 0, 1}, EL_DEGREES(90, 1));
    el_quaternion turns[2] = {el_quaternion_identity(), quarter};
    const el_quaternion half = el_quaternion_about((const int32_t[]){0, 0, 1}, EL_DEGREES(45, 1));
    for (unsigned round = 0; round < 4; round++) {
        const el_between between = round < 2 ? EL_BETWEEN_LINEAR : EL_BETWEEN_SMOOTH;
        const el_rotation_track track = {.keys = {.at_ms = at_ms, .count = 2, .between = (uint8_t)between},
                                         .values = turns};
        const el_quaternion got = el_rotation_at(&track, 500);
        for (unsigned i = 0; i < 4; i++) {
            TEST_ASSERT_INT32_WITHIN(4, half.q30[i], got.q30[i]);
        }
        for (unsigned i = 0; i < 4; i++) {
            turns[1].q30[i] = -turns[1].q30[i];
        }
    }
}

/* Of length 1 everywhere, exact at the keys, and without jumps: near a key it is near the key's, from both sides. */
static void test_rotations_seeded(void)
{
    for (seeded s = seeded_from(722); s.round < PART_OF(20000); s.round++) {
        const keys k = any_keys(&s);
        const el_rotation_track track = {
            .keys = {.at_ms = k.at_ms, .count = k.count, .between = (uint8_t)any_between(&s, 0, 2)}, .values = k.turns};
        const unsigned i = any_below(&s, k.count);
        el_quaternion got = el_rotation_at(&track, k.at_ms[i]);
        TEST_ASSERT_EQUAL_INT32_ARRAY(k.turns[i].q30, got.q30, 4);
        got = el_rotation_at(&track, (uint32_t)any_between(&s, 0, UINT32_MAX));
        double sum = 0;
        for (unsigned j = 0; j < 4; j++) {
            sum += got.q30[j] / 1073741824.0 * got.q30[j] / 1073741824.0;
        }
        if (fabs(sqrt(sum) - 1) > 2 / 1073741824.0) {
            fail_at(&s, "its length is off by %.2g", sqrt(sum) - 1);
        }
        if (track.keys.between == EL_BETWEEN_STEP || i == 0 || k.at_ms[i] - k.at_ms[i - 1] < 1000000) {
            continue;
        }
        /* A millionth of the way before, at a speed of 2 at most; lengths are within 2^-29. */
        got = el_rotation_at(&track, k.at_ms[i] - 1);
        double dot = 0;
        for (unsigned j = 0; j < 4; j++) {
            dot += got.q30[j] / 1073741824.0 * k.turns[i].q30[j] / 1073741824.0;
        }
        if (fabs(dot) < 1 - 4e-9) {
            fail_at(&s, "it jumps at key %u: %.3g", i, 1 - fabs(dot));
        }
    }
}

static void test_repeats(void)
{
    el_animation a = {.length_ms = 1000};
    TEST_ASSERT_EQUAL_UINT32(0, el_animation_time(&(el_animation){.repeat = EL_REPEAT_LOOP}, 77));
    TEST_ASSERT_EQUAL_UINT32(999, el_animation_time(&a, 999));
    TEST_ASSERT_EQUAL_UINT32(1000, el_animation_time(&a, 1000));
    TEST_ASSERT_EQUAL_UINT32(1000, el_animation_time(&a, UINT32_MAX));
    a.repeat = EL_REPEAT_LOOP;
    TEST_ASSERT_EQUAL_UINT32(999, el_animation_time(&a, 999));
    TEST_ASSERT_EQUAL_UINT32(0, el_animation_time(&a, 1000));
    TEST_ASSERT_EQUAL_UINT32(1, el_animation_time(&a, 3001));
    a.repeat = EL_REPEAT_PING_PONG;
    TEST_ASSERT_EQUAL_UINT32(1000, el_animation_time(&a, 1000));
    TEST_ASSERT_EQUAL_UINT32(999, el_animation_time(&a, 1001));
    TEST_ASSERT_EQUAL_UINT32(0, el_animation_time(&a, 2000));
    TEST_ASSERT_EQUAL_UINT32(1, el_animation_time(&a, 2001));
    a.length_ms = UINT32_MAX;
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, el_animation_time(&a, UINT32_MAX));
}

static void test_what_has_no_track_stays(void)
{
    static const uint32_t at_ms[1] = {0};
    static const uint32_t scales_q16[1] = {99};
    const el_position_track position = places(EL_BETWEEN_LINEAR);
    el_animation a = {.position = position, .length_ms = 1000, .repeat = EL_REPEAT_PING_PONG};
    el_pose pose = el_pose_identity();
    el_pose expected = pose;
    pose.scale_q16 = expected.scale_q16 = 55;
    memcpy(expected.position_q16, (const int32_t[]){500, 5, 0}, sizeof expected.position_q16);
    el_animation_pose(&a, 2000 - 150, &pose);
    TEST_ASSERT_EQUAL_MEMORY(&expected, &pose, sizeof pose);
    a = (el_animation){.scale = {.keys = {.at_ms = at_ms, .count = 1}, .values_q16 = scales_q16}};
    el_animation_pose(&a, 12345, &pose);
    expected.scale_q16 = 99;
    TEST_ASSERT_EQUAL_MEMORY(&expected, &pose, sizeof pose);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_keys_are_exact_and_hold_at_the_ends);
    RUN_TEST(test_steps_and_lines);
    RUN_TEST(test_smooth_by_hand);
    RUN_TEST(test_between_keys_seeded);
    RUN_TEST(test_rotations);
    RUN_TEST(test_rotations_seeded);
    RUN_TEST(test_repeats);
    RUN_TEST(test_what_has_no_track_stays);
    return UNITY_END();
}
