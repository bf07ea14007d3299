/* Reciprocals: floor(2^63 / d) for d in (2^31, 2^32), in as many bits as each way yields. */
#include "alternatives.h"
#include "base/divide.h"
#include "platform.h"

enum { COUNT = 4096, TABLE = 256 };

static uint32_t input[COUNT];
static uint32_t output[COUNT];
static uint16_t table[TABLE]; /* 2^31 / d in the middle of each 1/256, Q16 less its leading bit */

static uint32_t by_division(uint32_t d)
{
    return (uint32_t)((1ULL << 63) / d);
}

/* What a 32-bit divider gives in one go: 16 bits. */
static uint32_t by_short_division(uint32_t d)
{
    return (0xFFFFFFFFU / (d >> 16)) << 15;
}

static uint32_t by_table(uint32_t d)
{
    return 1U << 31 | (uint32_t)table[(d >> 23) & (TABLE - 1)] << 15;
}

/* Newton's iteration for 1/d: r + r (1 - d r), which squares the relative error. d r stays below 2^64, and its upper word
 * is 2^31 (1 - error). */
static uint32_t newton(uint32_t d, uint32_t r)
{
    const int32_t error_q31 = (int32_t)((1U << 31) - (uint32_t)(((uint64_t)d * r) >> 32));
    return r + (uint32_t)(((int64_t)r * error_q31) >> 31);
}

static uint32_t by_table_1(uint32_t d)
{
    return newton(d, by_table(d));
}

static uint32_t by_table_2(uint32_t d)
{
    return newton(d, by_table_1(d));
}

/* The renderer's: exact, for exact quotients. */
static uint32_t by_divisor(uint32_t d)
{
    return 1U << 31 | el_divisor_make(d).reciprocal >> 1;
}

static void prepare(void)
{
    uint32_t state = 88675123U;
    for (unsigned i = 0; i < COUNT; i++) {
        state = state * 1664525U + 1013904223U; /* Knuth's, as in Numerical Recipes: the upper bits will do */
        input[i] = 1U << 31 | state >> 1 | 1U;
    }
    for (uint32_t i = 0; i < TABLE; i++) {
        table[i] = (uint16_t)((1U << 26) / (2 * (TABLE + i) + 1) - (1U << 16));
    }
    bench_keep("input", "reciprocals", input, sizeof input);
}

/* Inlined with `reciprocal` known, as a renderer would have it. */
BENCH_INLINE void run(uint32_t (*reciprocal)(uint32_t d))
{
    prepare();
    bench_start();
    for (unsigned i = 0; i < COUNT; i++) {
        output[i] = reciprocal(input[i]);
    }
    bench_stop();
}

static void run_division(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    run(by_division);
}

static void run_short_division(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    run(by_short_division);
}

static void run_table(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    run(by_table);
}

static void run_table_1(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    run(by_table_1);
}

static void run_table_2(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    run(by_table_2);
}

static void run_divisor(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    run(by_divisor);
}

const bench_case reciprocal_cases[] = {
    {"reciprocal", "exact", run_divisor, output, sizeof output, 0, {0, 0}, 0},
    {"reciprocal", "division64", run_division, output, sizeof output, 0, {0, 0}, 0},
    {"reciprocal", "division32", run_short_division, output, sizeof output, 0, {0, 0}, 0},
    {"reciprocal", "table", run_table, output, sizeof output, 0, {0, 0}, 0},
    {"reciprocal", "table_newton1", run_table_1, output, sizeof output, 0, {0, 0}, 0},
    {"reciprocal", "table_newton2", run_table_2, output, sizeof output, 0, {0, 0}, 0},
    {0},
};
