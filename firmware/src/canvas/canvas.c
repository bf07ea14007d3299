/* Runs of pixels, and what is made of whole runs: rectangles, frames and thin lines. */
#include "canvas/canvas.h"

#include "base/fill.h"
#include "base/fixed.h"
#include "base/rgb565.h"
#include "canvas/floor.h"

el_rect el_rect_shared(el_rect a, el_rect b)
{
    return (el_rect){el_max_i32(a.x, b.x), el_max_i32(a.y, b.y), el_min_i32(a.x_end, b.x_end),
                     el_min_i32(a.y_end, b.y_end)};
}

el_canvas el_canvas_clipped(const el_canvas *canvas, el_rect clip)
{
    el_canvas clipped = *canvas;
    clipped.clip = el_rect_shared(canvas->clip, clip);
    if (el_rect_is_empty(clipped.clip)) {
        /* Whatever was given: what is left stays near the pixels. */
        clipped.clip = (el_rect){canvas->clip.x, canvas->clip.y, canvas->clip.x, canvas->clip.y};
    }
    return clipped;
}

/* Half words of any alignment; long runs by words. */
static void set_pixels(uint16_t *at, uint16_t colour, uint32_t count)
{
    if (count > 0 && ((uintptr_t)at & 2U) != 0) {
        *at++ = colour;
        count--;
    }
    el_fill_u16(at, colour, count);
}

void el_canvas_run(const el_canvas *canvas, int32_t y, int32_t x, int32_t x_end, const el_paint *paint,
                   uint32_t coverage)
{
    uint16_t *const line = el_canvas_line_at(canvas, y);
    const uint32_t alpha = (coverage * el_alpha_256(paint->alpha) + 128U) >> 8;
    if (paint->pattern == NULL && alpha == 256) {
        set_pixels(line + x, paint->colour, (uint32_t)(x_end - x));
        return;
    }
    if (alpha == 0) {
        return;
    }
    const uint32_t mask = paint->pattern == NULL ? 0xFFU : paint->pattern[(uint32_t)y & 7U];
    for (int32_t i = x; i < x_end; i++) {
        if ((mask >> (7U - ((uint32_t)i & 7U)) & 1U) != 0) {
            line[i] = el_rgb565_blend(line[i], paint->colour, alpha);
        }
    }
}

void el_canvas_fill(const el_canvas *canvas, el_rect rect, el_paint paint)
{
    const el_rect part = el_rect_shared(rect, canvas->clip);
    if (el_rect_is_empty(part)) {
        return;
    }
    for (int32_t y = part.y; y < part.y_end; y++) {
        el_canvas_run(canvas, y, part.x, part.x_end, &paint, 256);
    }
}

void el_canvas_frame(const el_canvas *canvas, el_rect rect, int32_t thickness, el_paint paint)
{
    if (thickness < 1 || el_rect_is_empty(rect)) {
        return;
    }
    /* The inner rectangle, in 64 bits where a side may be any; none where the frame meets itself. */
    const int64_t width = (int64_t)rect.x_end - rect.x;
    const int64_t height = (int64_t)rect.y_end - rect.y;
    if (width <= 2 * (int64_t)thickness || height <= 2 * (int64_t)thickness) {
        el_canvas_fill(canvas, rect, paint);
        return;
    }
    const int32_t top = rect.y + thickness;
    const int32_t bottom = rect.y_end - thickness;
    el_canvas_fill(canvas, (el_rect){rect.x, rect.y, rect.x_end, top}, paint);
    el_canvas_fill(canvas, (el_rect){rect.x, top, rect.x + thickness, bottom}, paint);
    el_canvas_fill(canvas, (el_rect){rect.x_end - thickness, top, rect.x_end, bottom}, paint);
    el_canvas_fill(canvas, (el_rect){rect.x, bottom, rect.x_end, rect.y_end}, paint);
}

/* Position i of a line along its longer direction, which has `length` steps: how far it is along the shorter one, which has
 * `rise`, rounded to nearest, ties up: floor((2 i rise + length) / (2 length)). */
typedef struct slope {
    int32_t aside;
    uint32_t rest; /* of the division by 2 length */
} slope;

static slope slope_at(uint32_t i, int32_t rise, uint32_t length)
{
    /* |2 i rise + length| < 2^34 */
    int64_t rest;
    const int64_t aside = el_floor_divide(2 * (int64_t)i * rise + length, 2 * (int64_t)length, &rest);
    return (slope){(int32_t)aside, (uint32_t)rest};
}

/* Draws `i` of [first, last], which lie within the clip along the longer direction. */
static void draw_slope(const el_canvas *canvas, int32_t along, int32_t across, int32_t rise, uint32_t length,
                       bool steep, int32_t first, int32_t last, const el_paint *paint)
{
    const el_rect *const clip = &canvas->clip;
    const int32_t least = steep ? clip->x : clip->y;
    const int32_t end = steep ? clip->x_end : clip->y_end;
    slope s = slope_at((uint32_t)(first - along), rise, length);
    for (int32_t i = first; i <= last; i++) {
        const int32_t j = across + s.aside;
        if (j >= least && j < end) {
            const int32_t x = steep ? j : i;
            el_canvas_run(canvas, steep ? i : j, x, x + 1, paint, 256);
        }
        /* |2 rise| <= 2 length, so that one step is at most one pixel. */
        const uint32_t move = 2U * (uint32_t)(rise < 0 ? -rise : rise);
        if (rise < 0) {
            s.aside -= s.rest < move;
            s.rest += s.rest < move ? 2U * length - move : 0U - move;
        } else {
            s.rest += move;
            s.aside += s.rest >= 2U * length;
            s.rest -= s.rest >= 2U * length ? 2U * length : 0U;
        }
    }
}

void el_canvas_line(const el_canvas *canvas, int16_t x0, int16_t y0, int16_t x1, int16_t y1, el_paint paint)
{
    const int32_t dx = x1 - x0;
    const int32_t dy = y1 - y0;
    const bool steep = el_abs_u64(dy) > el_abs_u64(dx);
    /* From the left, or from the top where it is steep: from both ends the same. */
    const bool turned = (steep ? dy : dx) < 0;
    const int32_t along = steep ? (turned ? y1 : y0) : (turned ? x1 : x0);
    const int32_t across = steep ? (turned ? x1 : x0) : (turned ? y1 : y0);
    const int32_t length = steep ? (turned ? -dy : dy) : (turned ? -dx : dx);
    const int32_t rise = steep ? (turned ? -dx : dx) : (turned ? -dy : dy);
    const int32_t first = el_max_i32(along, steep ? canvas->clip.y : canvas->clip.x);
    const int32_t last = el_min_i32(along + length, (steep ? canvas->clip.y_end : canvas->clip.x_end) - 1);
    if (first > last || el_rect_is_empty(canvas->clip)) {
        return;
    }
    if (length == 0) {
        if (y0 >= canvas->clip.y && y0 < canvas->clip.y_end) {
            el_canvas_run(canvas, y0, x0, x0 + 1, &paint, 256);
        }
        return;
    }
    draw_slope(canvas, along, across, rise, (uint32_t)length, steep, first, last, &paint);
}
