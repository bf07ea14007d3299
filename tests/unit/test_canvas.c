/* Blending, rectangles, clip rectangles and thin lines, each against its definition, pixel by pixel. */
#include "canvas_picture.h"
#include "seeded.h"

enum { SIDE = 24, INK = 0xFFFF };

void setUp(void)
{
}
void tearDown(void)
{
}

static uint32_t channel(uint16_t colour, unsigned i)
{
    static const unsigned shifts[3] = {11, 5, 0};
    return (uint32_t)colour >> shifts[i] & (i == 1 ? 63U : 31U);
}

/* Every pair of values of each channel, the others being any, with every alpha: rounded to nearest, ties up. */
static void test_blending_rounds_each_channel(void)
{
    seeded s = seeded_from(1);
    for (s.round = 0; s.round < PART_OF(64 * 64); s.round++) {
        for (uint32_t alpha = 0; alpha <= 256; alpha++) {
            const uint32_t a = s.round * 64U / PART_OF(64);
            const uint16_t under = (uint16_t)((any_below(&s, 32) << 11) | (a % 64U) << 5 | any_below(&s, 32));
            const uint16_t over = (uint16_t)((any_below(&s, 32) << 11) | (a / 64U % 64U) << 5 | any_below(&s, 32));
            const uint16_t got = el_rgb565_blend(under, over, alpha);
            for (unsigned i = 0; i < 3; i++) {
                const uint32_t wanted = (channel(under, i) * (256U - alpha) + channel(over, i) * alpha + 128U) / 256U;
                if (channel(got, i) != wanted) {
                    fail_at(&s, "%04x over %04x at %u: %04x", over, under, (unsigned)alpha, got);
                }
            }
        }
    }
}

typedef struct drawing {
    el_rect rect, clip;
    int32_t thickness; /* 0: filled */
    int16_t line[4];
    el_paint paint;
} drawing;

static void draw_rect(void *context, el_band *band)
{
    const drawing *const d = context;
    const el_canvas whole = el_canvas_of(band);
    const el_canvas canvas = el_canvas_clipped(&whole, d->clip);
    if (d->thickness == 0) {
        el_canvas_fill(&canvas, d->rect, d->paint);
    } else {
        el_canvas_frame(&canvas, d->rect, d->thickness, d->paint);
    }
}

static bool holds(el_rect r, int64_t x, int64_t y)
{
    return x >= r.x && x < r.x_end && y >= r.y && y < r.y_end;
}

static int32_t any_coordinate(seeded *s)
{
    return any_below(s, 8) == 0 ? (int32_t)any_u64(s) : (int32_t)any_between(s, -6, SIDE + 6);
}

static el_rect any_rect(seeded *s)
{
    return (el_rect){any_coordinate(s), any_coordinate(s), any_coordinate(s), any_coordinate(s)};
}

static bool is_in_frame(const drawing *d, int64_t x, int64_t y)
{
    return holds(d->rect, x, y) &&
           (d->thickness == 0 || x < (int64_t)d->rect.x + d->thickness || x >= (int64_t)d->rect.x_end - d->thickness ||
            y < (int64_t)d->rect.y + d->thickness || y >= (int64_t)d->rect.y_end - d->thickness);
}

/* Each pixel once, which a glaze shows; within the clip rectangle alone, whatever numbers are given. */
static void test_rectangles_and_frames_cover_their_pixels_once(void)
{
    static const uint8_t pattern[8] = {0x80, 0x41, 0x22, 0x14, 0x08, 0xFF, 0x00, 0x55};
    static canvas_picture p;
    seeded s = seeded_from(2);
    for (s.round = 0; s.round < PART_OF(3000); s.round++) {
        drawing d = {.rect = any_rect(&s), .clip = any_rect(&s), .paint = el_glaze(INK, (uint8_t)any_below(&s, 256))};
        d.clip = any_below(&s, 2) == 0 ? (el_rect){0, 0, SIDE, SIDE} : d.clip;
        d.thickness = any_below(&s, 2) == 0 ? 0 : (int32_t)any_between(&s, 1, 5);
        d.paint.pattern = any_below(&s, 3) == 0 ? pattern : NULL;
        p = canvas_picture_of(SIDE, SIDE);
        paint_any_bands(&p, draw_rect, &d);
        for (int32_t y = 0; y < SIDE; y++) {
            for (int32_t x = 0; x < SIDE; x++) {
                const bool drawn = holds(d.clip, x, y) && is_in_frame(&d, x, y) &&
                                   (d.paint.pattern == NULL || (pattern[y % 8] >> (7 - x % 8) & 1) != 0);
                const uint16_t wanted = drawn ? el_rgb565_blend(0, INK, el_alpha_256(d.paint.alpha)) : 0;
                if (p.pixels[y * SIDE + x] != wanted) {
                    fail_at(&s, "pixel (%d, %d) is %04x, not %04x", (int)x, (int)y, p.pixels[y * SIDE + x], wanted);
                }
            }
        }
    }
}

static void draw_line(void *context, el_band *band)
{
    const drawing *const d = context;
    const el_canvas whole = el_canvas_of(band);
    const el_canvas canvas = el_canvas_clipped(&whole, d->clip);
    el_canvas_line(&canvas, d->line[0], d->line[1], d->line[2], d->line[3], d->paint);
}

/* Of each column, or row, the nearest pixel: floor(exact place + 1/2). */
static bool is_on_line(const int16_t line[4], int64_t x, int64_t y)
{
    const int64_t dx = line[2] - line[0];
    const int64_t dy = line[3] - line[1];
    const int64_t width = dx < 0 ? -dx : dx;
    const int64_t height = dy < 0 ? -dy : dy;
    if (x < (dx < 0 ? line[2] : line[0]) || x > (dx < 0 ? line[0] : line[2]) || y < (dy < 0 ? line[3] : line[1]) ||
        y > (dy < 0 ? line[1] : line[3])) {
        return false;
    }
    if (width == 0 && height == 0) {
        return true;
    }
    /* -1/2 < exact - place... : 2 length (place - across) in (2 along rise - length, 2 along rise + length] */
    const int64_t length = height > width ? height : width;
    const int64_t along =
        height > width ? (y - line[1]) * dx * (dy < 0 ? -1 : 1) : (x - line[0]) * dy * (dx < 0 ? -1 : 1);
    const int64_t place = height > width ? x - line[0] : y - line[1];
    return 2 * length * place > 2 * along - length && 2 * length * place <= 2 * along + length;
}

static void test_lines_take_the_nearest_pixels(void)
{
    static canvas_picture p;
    seeded s = seeded_from(3);
    for (s.round = 0; s.round < PART_OF(3000); s.round++) {
        drawing d = {.paint = el_solid(INK), .clip = {0, 0, SIDE, SIDE}};
        const bool far = any_below(&s, 3) == 0;
        for (unsigned i = 0; i < 4; i++) {
            d.line[i] = (int16_t)(far ? any_between(&s, INT16_MIN, INT16_MAX) : any_between(&s, -3, SIDE + 3));
        }
        if (any_below(&s, 4) == 0) {
            d.clip = any_rect(&s);
        }
        p = canvas_picture_of(SIDE, SIDE);
        paint_any_bands(&p, draw_line, &d);
        for (int32_t y = 0; y < SIDE; y++) {
            for (int32_t x = 0; x < SIDE; x++) {
                const bool wanted = holds(d.clip, x, y) && is_on_line(d.line, x, y);
                if ((p.pixels[y * SIDE + x] != 0) != wanted) {
                    fail_at(&s, "(%d, %d) to (%d, %d): pixel (%d, %d)", d.line[0], d.line[1], d.line[2], d.line[3],
                            (int)x, (int)y);
                }
            }
        }
    }
}

static void test_clips_nest_and_end_with_their_copy(void)
{
    uint16_t pixels[16 * 4] = {0};
    el_band band = {.pixels = pixels, .width = 16, .y = 2, .lines = 4};
    const el_canvas whole = el_canvas_of(&band);
    const el_canvas outer = el_canvas_clipped(&whole, (el_rect){2, 0, 12, 5});
    const el_canvas inner = el_canvas_clipped(&outer, (el_rect){8, 3, 20, 20});
    const el_canvas none = el_canvas_clipped(&inner, (el_rect){INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN});
    const el_rect all = {INT32_MIN, INT32_MIN, INT32_MAX, INT32_MAX};
    el_canvas_fill(&outer, all, el_solid(1));
    el_canvas_fill(&inner, all, el_solid(INK));
    el_canvas_fill(&none, all, el_solid(2));
    el_canvas_line(&none, 0, 0, 16, 6, el_solid(2));
    canvas_picture p = canvas_picture_of(16, 4);
    memcpy(p.pixels, pixels, sizeof pixels);
    EXPECT_CANVAS(&p, "..++++++++++....", "..++++++####....", "..++++++####....", "................");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_blending_rounds_each_channel);
    RUN_TEST(test_rectangles_and_frames_cover_their_pixels_once);
    RUN_TEST(test_lines_take_the_nearest_pixels);
    RUN_TEST(test_clips_nest_and_end_with_their_copy);
    return UNITY_END();
}
