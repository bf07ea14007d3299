/* What is called hidden is: no depth of its columns is beyond. Seeded bands that fill up from far to near, as bands do, with
 * holes that only a search finds; and in the plain cases the answer is yes, at the price of one search. */
#include <string.h>

#include "raster/hidden.h"
#include "seeded.h"

enum { WIDTH = 150, LINES = 8, ROUNDS = PART_OF(2000), QUESTIONS = 60 };

static uint16_t depth[WIDTH * LINES];
static el_target target;
static el_hidden hidden;

void setUp(void)
{
    static const el_stats none;
    target = (el_target){.depth = depth, .width = WIDTH, .y = 40, .y_end = 40 + LINES};
    el_hidden_begin(&hidden, &none, 0);
}

void tearDown(void)
{
}

static uint32_t farthest(int32_t x, int32_t x_end)
{
    uint32_t most = 0;
    for (int32_t row = 0; row < target.y_end - target.y; row++) {
        for (int32_t column = x < 0 ? 0 : x; column < x_end && column < WIDTH; column++) {
            most = depth[row * WIDTH + column] > most ? depth[row * WIDTH + column] : most;
        }
    }
    return most;
}

/* Something is drawn, nearer than what was there. */
static void draw_something(seeded *s)
{
    const int32_t x = (int32_t)any_below(s, WIDTH);
    const int32_t x_end = any_below(s, 4) == 0 ? WIDTH : x + (int32_t)any_below(s, (uint32_t)(WIDTH - x));
    const uint16_t z = (uint16_t)any_u64(s);
    const uint32_t first = any_below(s, 4) == 0 ? 0 : any_below(s, LINES);
    for (uint32_t row = first; row < LINES; row++) {
        for (int32_t column = any_below(s, 3) == 0 ? 0 : x; column < x_end; column++) {
            uint16_t *const at = &depth[(int32_t)row * WIDTH + column];
            *at = z < *at ? z : *at;
        }
    }
}

static void test_only_what_is_hidden_is_called_so(void)
{
    uint32_t yes = 0;
    uint32_t could_be = 0;
    for (seeded s = seeded_from(70); s.round < ROUNDS; s.round++) {
        setUp();
        target.y_end = 40 + (int32_t)(s.round % LINES) + 1;
        memset(depth, 0xFF, sizeof depth);
        for (unsigned i = 0; i < QUESTIONS; i++) {
            draw_something(&s);
            const int32_t x = (int32_t)any_between(&s, -20, WIDTH - 1);
            const int32_t x_end = x + (int32_t)any_between(&s, 1, WIDTH);
            const uint16_t z = (uint16_t)any_u64(&s);
            const bool found = el_hidden_is(&hidden, &target, x, x_end, z);
            const bool is = x_end <= 0 || farthest(x, x_end) <= z;
            if (found && farthest(x, x_end) > z) {
                fail_at(&s, "columns %ld to %ld are called hidden at %u, and one is at %lu", (long)x, (long)x_end, z,
                        (unsigned long)farthest(x, x_end));
            }
            yes += found;
            could_be += is;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(could_be / 2, yes);
}

/* The block's one pixel that is beyond is where nothing but a search looks. */
static void test_a_hole_of_one_pixel_is_seen(void)
{
    for (int32_t at = 0; at < WIDTH * LINES; at++) {
        setUp();
        memset(depth, 0, sizeof depth);
        depth[at] = 1001;
        const int32_t column = at % WIDTH;
        TEST_ASSERT_FALSE(el_hidden_is(&hidden, &target, column, column + 1, 1000));
        TEST_ASSERT_TRUE(el_hidden_is(&hidden, &target, column, column + 1, 1001));
        TEST_ASSERT_TRUE(el_hidden_is(&hidden, &target, 0, WIDTH, 1001));
        TEST_ASSERT_FALSE(el_hidden_is(&hidden, &target, column, column + 1, 1000));
    }
}

/* Found once, a bound stays: the memory may even be gone. And a block is not searched for ever. */
static void test_a_bound_is_found_once(void)
{
    memset(depth, 0, sizeof depth);
    TEST_ASSERT_TRUE(el_hidden_is(&hidden, &target, 0, WIDTH, 7));
    memset(depth, 0xFF, sizeof depth);
    TEST_ASSERT_TRUE(el_hidden_is(&hidden, &target, 0, WIDTH, 7));
    setUp();
    memset(depth, 0, sizeof depth);
    depth[WIDTH + 5] = 100;
    for (unsigned i = 0; i < 100; i++) {
        TEST_ASSERT_FALSE(el_hidden_is(&hidden, &target, 0, 32, 50));
    }
    depth[WIDTH + 5] = 0;
    TEST_ASSERT_FALSE(el_hidden_is(&hidden, &target, 0, 32, 50));
    TEST_ASSERT_TRUE(el_hidden_is(&hidden, &target, 32, 64, 50));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_only_what_is_hidden_is_called_so);
    RUN_TEST(test_a_hole_of_one_pixel_is_seen);
    RUN_TEST(test_a_bound_is_found_once);
    return UNITY_END();
}
