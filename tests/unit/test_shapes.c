/* Round shapes and strokes against circles, capsules and rectangles in exact arithmetic; and as pictures. */
#include "canvas_picture.h"
#include "seeded.h"

enum { SIDE = 40, INK = 0xFFFF, EDGES = 400 };

void setUp(void)
{
}
void tearDown(void)
{
}

static _Alignas(8) uint8_t memory[EL_POLYGON_BYTES(EDGES, CANVAS_SIDE)];

typedef struct shape {
    void (*build)(el_polygon *polygon, const struct shape *shape);
    int32_t x, y, a, b, c; /* what `build` makes of them */
    el_angle from, sweep;
    el_rule rule;
    el_stroke stroke;
    int32_t points[4][2];
    uint32_t count;
    bool closed;
} shape;

static void draw_shape(void *context, el_band *band)
{
    const shape *const s = context;
    const el_canvas canvas = el_canvas_of(band);
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    s->build(&p, s);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_polygon_fill(&p, &canvas, s->rule, EL_SHARP, el_solid(INK)));
}

static canvas_picture picture_of(const shape *s, uint16_t side)
{
    static canvas_picture p;
    p = canvas_picture_of(side, side);
    paint_any_bands(&p, draw_shape, (void *)(uintptr_t)s);
    return p;
}

static void build_ellipse(el_polygon *p, const shape *s)
{
    el_polygon_ellipse(p, s->x, s->y, s->a, s->b);
}

static void build_ring(el_polygon *p, const shape *s)
{
    el_polygon_ellipse(p, s->x, s->y, s->a, s->a);
    el_polygon_ellipse(p, s->x, s->y, s->b, s->b);
}

static void build_sector(el_polygon *p, const shape *s)
{
    el_polygon_sector(p, s->x, s->y, s->a, s->b, s->from, s->sweep);
}

static void build_rectangle(el_polygon *p, const shape *s)
{
    el_polygon_rectangle(p, s->x, s->y, s->x + s->a, s->y + s->b, s->c);
}

static void build_stroke(el_polygon *p, const shape *s)
{
    el_polygon_stroke(p, (const int32_t(*)[2])s->points, s->count, s->closed, &s->stroke);
}

/* Twice a pixel's centre, in 1/EL_SUBPIXELS px. */
static int64_t centre(int32_t pixel)
{
    return 2LL * pixel * EL_SUBPIXELS + EL_SUBPIXELS;
}

/* What a shape may be off by: 1/16 px of its chords, 1/EL_SUBPIXELS px of its points, as twice 1/EL_SUBPIXELS px. */
enum { OFF = 2 * (EL_SUBPIXELS / 16 + 1) };

/* Pixels within a radius that is less by that are drawn, pixels beyond one that is more are not. Doubled numbers. */
static void check_between(const seeded *s, bool drawn, int64_t square, int64_t radius, int32_t x, int32_t y)
{
    const int64_t inner = radius > OFF ? radius - OFF : 0;
    if ((!drawn && square < inner * inner) || (drawn && square > (radius + OFF) * (radius + OFF))) {
        fail_at(s, "pixel (%d, %d) is %s", (int)x, (int)y, drawn ? "drawn" : "left out");
    }
}

static void test_circles_and_rings_are_round(void)
{
    seeded s = seeded_from(1);
    for (s.round = 0; s.round < PART_OF(400); s.round++) {
        const bool ring = any_below(&s, 2) != 0;
        shape c = {.build = ring ? build_ring : build_ellipse,
                   .x = (int32_t)any_between(&s, 0, EL_SUB(SIDE)),
                   .y = (int32_t)any_between(&s, 0, EL_SUB(SIDE)),
                   .a = (int32_t)any_of_bits(&s, 5 + EL_SUBPIXEL_BITS),
                   .rule = EL_EVEN_ODD};
        c.b = ring ? (int32_t)any_between(&s, 0, c.a) : c.a;
        const canvas_picture p = picture_of(&c, SIDE);
        for (int32_t y = 0; y < SIDE; y++) {
            for (int32_t x = 0; x < SIDE; x++) {
                const int64_t dx = centre(x) - 2LL * c.x;
                const int64_t dy = centre(y) - 2LL * c.y;
                const int64_t square = dx * dx + dy * dy;
                const bool drawn = p.pixels[y * SIDE + x] != 0;
                if (!ring || square > (2LL * c.b + OFF) * (2LL * c.b + OFF)) {
                    check_between(&s, drawn, square, 2LL * c.a, x, y);
                } else if (2LL * c.b > OFF && square < (2LL * c.b - OFF) * (2LL * c.b - OFF)) {
                    check_between(&s, !drawn, square, 2LL * c.b, x, y); /* the hole */
                }
            }
        }
    }
}

static void test_ellipses_sectors_and_rectangles_look_so(void)
{
    shape s = {.build = build_ellipse, .x = EL_SUB(8), .y = EL_SUB(4), .a = EL_SUB(8), .b = EL_SUB(4)};
    canvas_picture p = canvas_picture_of(16, 8);
    paint_any_bands(&p, draw_shape, &s);
    EXPECT_CANVAS(&p, "....########....", "..############..", ".##############.", "################",
                  "################", ".##############.", "..############..", "....########....");
    s = (shape){
        .build = build_rectangle, .x = EL_SUB(1), .y = EL_SUB(1), .a = EL_SUB(14), .b = EL_SUB(6), .c = EL_SUB(3)};
    p = canvas_picture_of(16, 8);
    paint_any_bands(&p, draw_shape, &s);
    EXPECT_CANVAS(&p, "................", "..############..", ".##############.", ".##############.",
                  ".##############.", ".##############.", "..############..", "................");
    /* A quarter of a ring, to the lower right. */
    s = (shape){.build = build_sector, .a = EL_SUB(8), .b = EL_SUB(4), .sweep = EL_DEGREES(90, 1)};
    p = canvas_picture_of(10, 9);
    paint_any_bands(&p, draw_shape, &s);
    EXPECT_CANVAS(&p, "....####..", "....####..", "...#####..", "..#####...", "#######...", "######....", "#####.....",
                  "###.......", "..........");
    /* A piece of pie over three quarters, without the upper right one. */
    s = (shape){.build = build_sector, .x = EL_SUB(4), .y = EL_SUB(4), .a = EL_SUB(4), .sweep = EL_DEGREES(270, 1)};
    p = canvas_picture_of(8, 8);
    paint_any_bands(&p, draw_shape, &s);
    EXPECT_CANVAS(&p, "..##....", ".###....", "####....", "####....", "########", "########", ".######.", "..####..");
}

/* The square of twice the distance from a pixel's centre to a segment, times the segment's length's square; exact. */
static bool is_within(const int32_t a[2], const int32_t b[2], int64_t x, int64_t y, int64_t radius)
{
    const int64_t dx = 2LL * (b[0] - a[0]);
    const int64_t dy = 2LL * (b[1] - a[1]);
    const int64_t px = x - 2LL * a[0];
    const int64_t py = y - 2LL * a[1];
    const int64_t along = px * dx + py * dy;
    const int64_t length = dx * dx + dy * dy;
    if (along <= 0 || length == 0) {
        return px * px + py * py <= radius * radius;
    }
    if (along >= length) {
        return (px - dx) * (px - dx) + (py - dy) * (py - dy) <= radius * radius;
    }
    const int64_t aside = px * dy - py * dx;
    return aside * aside <= radius * radius * length; /* 2^(2 * 25), 2^(18 + 25) with 8 sub-pixel bits */
}

/* A stroke with round caps and joins is what lies within half its width of its points' line. */
static void test_round_strokes_are_as_wide_as_they_say(void)
{
    seeded s = seeded_from(2);
    for (s.round = 0; s.round < PART_OF(400); s.round++) {
        shape t = {.build = build_stroke, .count = 1U + any_below(&s, 4), .closed = any_below(&s, 2) != 0};
        t.stroke = (el_stroke){
            .width = (uint16_t)(1U + any_below(&s, 8 * EL_SUBPIXELS)), .cap = EL_CAP_ROUND, .join = EL_JOIN_ROUND};
        for (unsigned i = 0; i < t.count; i++) {
            for (unsigned k = 0; k < 2; k++) {
                t.points[i][k] = (int32_t)any_between(&s, 0, EL_SUB(SIDE));
                t.points[i][k] = i > 0 && any_below(&s, 5) == 0 ? t.points[i - 1][k] : t.points[i][k];
            }
        }
        const canvas_picture p = picture_of(&t, SIDE);
        for (int32_t y = 0; y < SIDE; y++) {
            for (int32_t x = 0; x < SIDE; x++) {
                bool inner = false;
                bool outer = false;
                for (unsigned i = 0; i < t.count + (t.closed ? 1U : 0U); i++) {
                    const int32_t *const from = t.points[i == 0 ? 0 : i - 1];
                    const int32_t *const to = t.points[i % t.count];
                    if (t.stroke.width > OFF) {
                        inner |= is_within(from, to, centre(x), centre(y), t.stroke.width - OFF);
                    }
                    outer |= is_within(from, to, centre(x), centre(y), t.stroke.width + OFF);
                }
                const bool drawn = p.pixels[y * SIDE + x] != 0;
                if ((inner && !drawn) || (drawn && !outer)) {
                    fail_at(&s, "pixel (%d, %d) is %s", (int)x, (int)y, drawn ? "drawn" : "left out");
                }
            }
        }
    }
}

static void test_caps_and_joins_look_so(void)
{
    shape s = {.build = build_stroke, .count = 2, .stroke = {.width = EL_SUB(4)}};
    s.points[0][0] = EL_SUB(4);
    s.points[1][0] = EL_SUB(10);
    s.points[0][1] = s.points[1][1] = EL_SUB(3);
    canvas_picture p = canvas_picture_of(14, 6);
    paint_any_bands(&p, draw_shape, &s);
    EXPECT_CANVAS(&p, "..............", "....######....", "....######....", "....######....", "....######....",
                  "..............");
    s.stroke.cap = EL_CAP_SQUARE;
    p = canvas_picture_of(14, 6);
    paint_any_bands(&p, draw_shape, &s);
    EXPECT_CANVAS(&p, "..............", "..##########..", "..##########..", "..##########..", "..##########..",
                  "..............");
    /* An angle, its corner at the upper left: mitred, cut off, and mitred beyond the limit, which is cut off. */
    static const int32_t angle[3][2] = {{EL_SUB(3), EL_SUB(8)}, {EL_SUB(3), EL_SUB(3)}, {EL_SUB(8), EL_SUB(3)}};
    s = (shape){.build = build_stroke, .count = 3, .stroke = {.width = EL_SUB(4)}};
    memcpy(s.points, angle, sizeof angle);
    p = canvas_picture_of(9, 9);
    paint_any_bands(&p, draw_shape, &s);
    EXPECT_CANVAS(&p, ".........", ".#######.", ".#######.", ".#######.", ".#######.", ".####....", ".####....",
                  ".####....", ".........");
    for (unsigned i = 0; i < 2; i++) {
        s.stroke.join = i == 0 ? EL_JOIN_BEVEL : EL_JOIN_MITER;
        s.stroke.miter = 1;
        p = canvas_picture_of(9, 9);
        paint_any_bands(&p, draw_shape, &s);
        EXPECT_CANVAS(&p, ".........", "..######.", ".#######.", ".#######.", ".#######.", ".####....", ".####....",
                      ".####....", ".........");
    }
    /* Closed, it has three corners and no ends. */
    s.stroke = (el_stroke){.width = EL_SUB(2)};
    s.closed = true;
    p = canvas_picture_of(14, 14);
    paint_any_bands(&p, draw_shape, &s);
    EXPECT_CANVAS(&p, "..............", "..............", "..########....", "..#######.....", "..##.###......",
                  "..#####.......", "..####........", "..###.........", "..##..........", "..#...........",
                  "..............", "..............", "..............", "..............");
}

/* As many points as are said to be enough are enough. */
static void test_edges_are_as_many_as_the_header_says(void)
{
    for (int32_t radius = 0; radius <= EL_GUARD_PX; radius++) {
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(EL_ROUND_EDGES(radius), el_round_points(EL_SUB(radius), 0));
        TEST_ASSERT_EQUAL_UINT32(0, el_round_points(EL_SUB(radius), 0) % 4U);
    }
    el_polygon p;
    el_polygon_begin(&p, memory, sizeof memory);
    static const int32_t points[4][2] = {{10, 10}, {500, 20}, {30, 400}, {600, 500}};
    el_polygon_stroke(&p, points, 4, true, &(el_stroke){.width = 40, .miter = 255});
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(EL_STROKE_EDGES(4), p.count);
}

/* Whatever is given, nothing breaks: what is too far away is refused by the fill. */
static void test_any_numbers_are_survived(void)
{
    seeded s = seeded_from(3);
    uint16_t pixels[64];
    el_band band = {.pixels = pixels, .width = 8, .lines = 8};
    const el_canvas canvas = el_canvas_of(&band);
    for (s.round = 0; s.round < PART_OF(20000); s.round++) {
        shape t = {.x = (int32_t)any_signed_of_bits(&s, 31), .y = (int32_t)any_signed_of_bits(&s, 31)};
        t.a = (int32_t)any_signed_of_bits(&s, 30);
        t.b = (int32_t)any_signed_of_bits(&s, 30);
        t.c = (int32_t)any_signed_of_bits(&s, 31);
        t.x = any_below(&s, 2) == 0 ? t.x >> 12 : t.x / 4;
        t.y = any_below(&s, 2) == 0 ? t.y >> 12 : t.y / 4;
        t.from = (el_angle)any_u64(&s);
        t.sweep = (el_angle)any_u64(&s);
        t.count = any_below(&s, 5);
        t.closed = any_below(&s, 2) != 0;
        t.stroke = (el_stroke){.width = (uint16_t)any_u64(&s), .cap = (uint8_t)any_below(&s, 4)};
        t.stroke.join = (uint8_t)any_below(&s, 4);
        t.stroke.miter = (uint8_t)any_u64(&s);
        for (unsigned i = 0; i < 8; i++) {
            t.points[i / 2][i % 2] = (int32_t)any_signed_of_bits(&s, 31);
        }
        static void (*const builds[])(el_polygon *, const shape *) = {build_ellipse, build_ring, build_sector,
                                                                      build_rectangle, build_stroke};
        el_polygon p;
        el_polygon_begin(&p, memory, sizeof memory);
        builds[any_below(&s, 5)](&p, &t);
        const el_status status = el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SMOOTH_4, el_solid(INK));
        if (status != EL_OK && status != EL_ERROR_RANGE && status != EL_ERROR_MEMORY) {
            fail_at(&s, "status %d", (int)status);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_circles_and_rings_are_round);
    RUN_TEST(test_ellipses_sectors_and_rectangles_look_so);
    RUN_TEST(test_round_strokes_are_as_wide_as_they_say);
    RUN_TEST(test_caps_and_joins_look_so);
    RUN_TEST(test_edges_are_as_many_as_the_header_says);
    RUN_TEST(test_any_numbers_are_survived);
    return UNITY_END();
}
