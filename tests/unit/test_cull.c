/* The tests before a record: the fast way, for triangles in the view, answers what the general one answers, and that is
 * what a plain search of the pixel centres answers. */
#include <string.h>

#include "frame/cull.h"
#include "seeded.h"

enum { WIDTH = 64, HEIGHT = 48, ROUNDS = PART_OF(60000) };

void setUp(void)
{
}

void tearDown(void)
{
}

static el_culling any_culling(seeded *s)
{
    const int32_t begin = (int32_t)any_below(s, HEIGHT);
    return (el_culling){.facing = any_below(s, 2) == 0 ? 1 : -1,
                        .two_sided = any_below(s, 4) == 0,
                        .width = EL_MAX_WIDTH,
                        .height = EL_MAX_HEIGHT,
                        .row_begin = any_below(s, 2) == 0 ? 0 : begin,
                        .row_end = any_below(s, 2) == 0 ? EL_MAX_HEIGHT : begin + 1};
}

/* Of a triangle as el_cull has it, by the definition of each verdict. */
static el_verdict plain_verdict(const el_culling *culling, const el_screen_vertex v[3])
{
    const int64_t area =
        (int64_t)(v[1].x - v[0].x) * (v[2].y - v[0].y) - (int64_t)(v[2].x - v[0].x) * (v[1].y - v[0].y);
    bool has_column = false;
    bool has_row = false;
    bool has_row_in_pass = false;
    for (int32_t i = 0; i < EL_MAX_WIDTH; i++) {
        const int32_t centre = i * EL_SUBPIXELS + EL_SUBPIXELS / 2;
        bool x_before = false;
        bool x_behind = false;
        bool y_before = false;
        bool y_behind = false;
        for (unsigned k = 0; k < 3; k++) {
            x_before = x_before || v[k].x <= centre;
            x_behind = x_behind || v[k].x > centre;
            y_before = y_before || v[k].y <= centre;
            y_behind = y_behind || v[k].y > centre;
        }
        has_column = has_column || (x_before && x_behind);
        has_row = has_row || (y_before && y_behind);
        has_row_in_pass = has_row_in_pass || (y_before && y_behind && i >= culling->row_begin && i < culling->row_end);
    }
    if (area == 0) {
        return EL_VERDICT_EMPTY;
    }
    if (area * culling->facing > 0 && !culling->two_sided) {
        return EL_VERDICT_BACK;
    }
    return !has_column || !has_row ? EL_VERDICT_EMPTY : (has_row_in_pass ? EL_VERDICT_SEEN : EL_VERDICT_OTHER);
}

/* Coordinates in the view: small triangles, ones as large as the view may be, and its very corners. */
static void any_vertices(seeded *s, el_screen_vertex v[3])
{
    static const uint32_t spans[] = {EL_SUBPIXELS, 4 * EL_SUBPIXELS, WIDTH * EL_SUBPIXELS, EL_GUARD_SUB};
    const uint32_t span = spans[any_below(s, 4)];
    const uint32_t x = any_below(s, EL_GUARD_SUB - span + 1);
    const uint32_t y = any_below(s, any_below(s, 2) == 0 ? 1 : EL_GUARD_SUB - span + 1);
    for (unsigned i = 0; i < 3; i++) {
        v[i].x = (el_coordinate)(any_below(s, 8) == 0 ? x + span : x + any_below(s, span + 1));
        v[i].y = (el_coordinate)(any_below(s, 8) == 0 ? y + span : y + any_below(s, span + 1));
    }
}

static void test_verdicts_are_what_they_say(void)
{
    unsigned met[EL_VERDICTS] = {0};
    for (seeded s = seeded_from(61); s.round < ROUNDS / 20; s.round++) {
        el_screen_vertex v[3] = {0};
        const el_culling culling = any_culling(&s);
        any_vertices(&s, v);
        el_cull_rows rows;
        const el_verdict verdict = el_cull(&culling, (const el_screen_vertex *const[]){&v[0], &v[1], &v[2]}, &rows);
        if (verdict != plain_verdict(&culling, v)) {
            fail_at(&s, "verdict %d, not %d", (int)verdict, (int)plain_verdict(&culling, v));
        }
        met[verdict]++;
    }
    TEST_ASSERT_GREATER_THAN_UINT(0, met[EL_VERDICT_EMPTY]);
    TEST_ASSERT_GREATER_THAN_UINT(0, met[EL_VERDICT_BACK]);
    TEST_ASSERT_GREATER_THAN_UINT(0, met[EL_VERDICT_OTHER]);
    TEST_ASSERT_GREATER_THAN_UINT(0, met[EL_VERDICT_SEEN]);
}

#if EL_CULLS_IN_VIEW
static void test_the_fast_way_answers_the_same(void)
{
    for (seeded s = seeded_from(62); s.round < ROUNDS; s.round++) {
        el_screen_vertex v[3] = {0};
        const el_culling culling = any_culling(&s);
        any_vertices(&s, v);
        el_cull_rows rows = {0};
        el_cull_rows fast_rows = {0};
        const el_verdict verdict = el_cull(&culling, (const el_screen_vertex *const[]){&v[0], &v[1], &v[2]}, &rows);
        const el_verdict fast = el_cull_in_view(&culling, &v[0], &v[1], &v[2], (uint32_t)culling.reach, &fast_rows);
        if (fast != verdict) {
            fail_at(&s, "verdict %d, not %d", (int)fast, (int)verdict);
        }
        if (verdict == EL_VERDICT_SEEN && memcmp(&rows, &fast_rows, sizeof rows) != 0) {
            fail_at(&s, "rows %d to %d", (int)fast_rows.begin, (int)fast_rows.end);
        }
    }
}
#endif

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_verdicts_are_what_they_say);
#if EL_CULLS_IN_VIEW
    RUN_TEST(test_the_fast_way_answers_the_same);
#endif
    return UNITY_END();
}
