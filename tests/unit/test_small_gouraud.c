/* Rows of small triangles in their vertices' colours against the loops that all others take: pixels, depth, what is counted, and
 * what is kept for the bands below. */
#include <string.h>

#include "any_triangle.h"
#include "raster/fill.h"
#include "raster/small_gouraud.h"

enum { WIDTH = 70, HEIGHT = 36, PIXELS = WIDTH * HEIGHT };

void setUp(void)
{
}

void tearDown(void)
{
}

#if EL_WITH_SMALL_GOURAUD

typedef struct picture {
    uint16_t colour[PIXELS];
    uint16_t depth[PIXELS];
    el_stats stats;
} picture;

static picture usual, quick;

/* Draws from the triangle's next row to the end of its band, in one of the two ways. */
static void draw_band(picture *p, el_triangle *triangle, int32_t lines, bool quickly)
{
    const int32_t y = triangle->y / lines * lines;
    const el_target target = {.colour = p->colour + y * WIDTH,
                              .depth = p->depth + y * WIDTH,
                              .width = WIDTH,
                              .y = y,
                              .y_end = el_min_i32(y + lines, HEIGHT)};
    if (quickly) {
        el_small_gouraud_draw(triangle, &target, &p->stats);
        return;
    }
    triangle->edges_are_short = false;
    el_triangle_draw(triangle, &target, &p->stats);
    triangle->edges_are_short = true;
}

static void draw(picture *p, const el_triangle *triangle, int32_t lines, uint64_t quick_bands)
{
    el_triangle t = *triangle;
    for (unsigned band = 0; t.y < HEIGHT && !el_triangle_is_done(&t); band++) {
        draw_band(p, &t, lines, (quick_bands >> band & 1U) != 0);
    }
}

static void test_rows_are_those_of_all_others(void)
{
    static const el_surface surface = {.shading = EL_SHADE_GOURAUD, .depth = true};
    uint32_t small = 0;
    for (seeded s = seeded_from(96); s.round < PART_OF(20000); s.round++) {
        el_corner corners[3];
        const int32_t reach = 1 + (int32_t)any_of_bits(&s, 9);
        const int32_t grid = any_below(&s, 4) == 0 ? EL_SUBPIXELS / 2 : 1;
        const int32_t aside = (int32_t)any_below(&s, (WIDTH - HEIGHT) * EL_SUBPIXELS);
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_corner(&s, HEIGHT * EL_SUBPIXELS / 2, reach);
            corners[i].x = (corners[i].x + aside) / grid * grid;
            corners[i].y = corners[i].y / grid * grid;
        }
        const int32_t lines = 1 + (int32_t)any_below(&s, HEIGHT);
        el_triangle triangle;
        if (!el_triangle_setup(&triangle, corners, &surface, (int32_t)any_below(&s, HEIGHT)) ||
            !triangle.edges_are_short || triangle.x_begin < 0 || triangle.x_end > WIDTH) {
            continue;
        }
        small++;
        memset(&usual, 0, sizeof usual);
        for (unsigned i = 0; i < PIXELS; i++) {
            usual.depth[i] = (uint16_t)any_of_bits(&s, 16);
        }
        quick = usual;
        draw(&usual, &triangle, lines, 0);
        /* All of it, or band by band in either way. */
        draw(&quick, &triangle, lines, any_below(&s, 2) == 0 ? UINT64_MAX : any_u64(&s));
        if (memcmp(&usual, &quick, sizeof usual) != 0) {
            fail_at(&s, "(%d, %d) (%d, %d) (%d, %d) in bands of %d", (int)corners[0].x, (int)corners[0].y,
                    (int)corners[1].x, (int)corners[1].y, (int)corners[2].x, (int)corners[2].y, (int)lines);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(4500U), small);
}
#else
static void test_the_short_way_is_for_four_bits(void)
{
    TEST_ASSERT_TRUE(EL_SUBPIXEL_BITS > 4 || EL_SMALL_CODE || !EL_WITH_GOURAUD);
}
#endif

int main(void)
{
    UNITY_BEGIN();
#if EL_WITH_SMALL_GOURAUD
    RUN_TEST(test_rows_are_those_of_all_others);
#else
    RUN_TEST(test_the_short_way_is_for_four_bits);
#endif
    return UNITY_END();
}
