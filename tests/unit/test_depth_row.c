/* A row's depth test against its plain twin, one pixel at a time: which pixels are seen, and what is there afterwards. */
#include "raster/depth_row.h"
#include "seeded.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

enum { MOST = 100 };

typedef struct row_case {
    uint64_t z, step;
    uint32_t offset, count;
    uint16_t before[MOST + 2];
} row_case;

/* Spans of any slope that stay within 0 to 65535, at either end of it often, before rows that are empty, drawn, or both: what
 * is drawn has any depths, or nearly the same ones, often about as far as the span's begin. */
static row_case any_row(seeded *s)
{
    row_case c = {.offset = any_below(s, 2), .count = 1 + any_below(s, MOST)};
    uint32_t ends[2];
    for (unsigned i = 0; i < 2; i++) {
        ends[i] = any_below(s, 4) == 0 ? 65535 : any_below(s, 65536);
    }
    const int64_t difference = ((int64_t)ends[1] - (int64_t)ends[0]) * (1LL << 32);
    c.step = c.count > 1 ? (uint64_t)(difference / (int64_t)(c.count - 1)) : 0U;
    c.z = ((uint64_t)ends[0] << 32) + (1ULL << 31);
    uint32_t left = 0;
    bool empty = false;
    uint32_t base = 0;
    uint32_t range = 65536;
    for (uint32_t i = 0; i < MOST + 2; i++, left--) {
        if (left == 0) {
            left = 1 + any_below(s, 40);
            empty = !empty;
            range = 1U << any_below(s, 17);
            base = any_below(s, 2) == 0 ? ends[0] : any_below(s, 65536);
        }
        c.before[i] = empty ? EL_DEPTH_EMPTY : (uint16_t)((base + any_below(s, range)) & 0xFFFFU);
    }
    return c;
}

static void test_rows_are_as_pixel_by_pixel(void)
{
    seeded s = seeded_from(1);
    for (; s.round < PART_OF(100000U); s.round++) {
        const row_case c = any_row(&s);
        _Alignas(4) uint16_t depth[MOST + 2];
        uint16_t expected[MOST + 2];
        bool seen[MOST];
        for (uint32_t i = 0; i < MOST + 2; i++) {
            depth[i] = c.before[i];
            expected[i] = c.before[i];
        }
        for (uint32_t i = 0; i < c.count; i++) {
            const uint16_t z = (uint16_t)((c.z + c.step * i) >> 32);
            seen[i] = z < expected[c.offset + i];
            if (seen[i]) {
                expected[c.offset + i] = z;
            }
        }
        const bool takes = any_below(&s, 4) != 0;
        el_depth_row row;
        el_depth_row_begin(&row, depth + c.offset, c.count, c.z, c.step);
        bool nearer = true;
        for (uint32_t i = 0; i < c.count; nearer = !nearer) {
            uint32_t end = i;
            if (!nearer) {
                end += el_depth_row_skip(&row);
            } else {
                end += takes ? el_depth_row_take(&row) : el_depth_row_pass(&row);
            }
            if (end > c.count || (end == i && i > 0)) {
                fail_at(&s, "from pixel %lu to %lu of %lu", (unsigned long)i, (unsigned long)end,
                        (unsigned long)c.count);
            }
            for (; i < end; i++) {
                if (seen[i] != nearer) {
                    fail_at(&s, "pixel %lu of %lu", (unsigned long)i, (unsigned long)c.count);
                }
            }
        }
        TEST_ASSERT_EQUAL_UINT16_ARRAY(takes ? expected : c.before, depth, MOST + 2);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rows_are_as_pixel_by_pixel);
    return UNITY_END();
}
