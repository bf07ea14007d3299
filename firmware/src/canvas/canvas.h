/* Drawing in two dimensions into a band, or into any buffer of whole lines: what all of canvas/ draws on.
 *
 *     static void draw(void *context, el_band *band)          an el_layer's, or called for bands of one's own
 *     {
 *         const el_canvas canvas = el_canvas_of(band);
 *         el_canvas_fill(&canvas, (el_rect){10, 10, 60, 20}, el_solid(0xF800));
 *     }
 *
 * Nothing is kept: each call draws at once what of it lies in the canvas, and what lies there does not depend on where the
 * band begins or ends, so bands of any height make the same picture. All coordinates are the screen's, y down; pixel (i, j)
 * has its centre at (i + 0.5, j + 0.5), as for triangles. Ranges are half-open. Pixels and points of any value may be
 * given; none beside the clip rectangle is written. */
#ifndef EL_CANVAS_CANVAS_H
#define EL_CANVAS_CANVAS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/sink.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Pixels [x, x_end) of lines [y, y_end); empty where an end is not beyond its beginning. */
typedef struct el_rect {
    int32_t x, y, x_end, y_end;
} el_rect;

/* Small enough to be copied: a clip rectangle lasts as long as the copy that has it (el_canvas_clipped). */
typedef struct el_canvas {
    uint16_t *pixels; /* RGB565, line by line; the caller's */
    int32_t stride;   /* pixels from a line to the next */
    int32_t y;        /* the screen's line that `pixels` begins with */
    el_rect clip;     /* what may be drawn; lies within the buffer */
} el_canvas;

/* How something is filled. */
typedef struct el_paint {
    uint16_t colour;        /* RGB565 */
    uint8_t alpha;          /* 255 hides what is below it, 0 draws nothing: (alpha + alpha / 128) / 256 of it shows */
    const uint8_t *pattern; /* 8 rows of 8 pixels, the left one in the highest bit, that lie over the screen again and
                               again: 0 is not drawn. NULL: all is */
} el_paint;

/* Alpha 255 is solid. C++ takes these functions too, and knows no compound literals. */
static inline el_paint el_glaze(uint16_t colour, uint8_t alpha)
{
    const el_paint paint = {colour, alpha, NULL};
    return paint;
}

static inline el_paint el_solid(uint16_t colour)
{
    return el_glaze(colour, 255);
}

/* All of a band. */
static inline el_canvas el_canvas_of(const el_band *band)
{
    const el_canvas canvas = {band->pixels, band->width, band->y, {0, band->y, band->width, band->y + band->lines}};
    return canvas;
}

/* What `a` and `b` share. */
el_rect el_rect_shared(el_rect a, el_rect b);

static inline bool el_rect_is_empty(el_rect rect)
{
    return rect.x >= rect.x_end || rect.y >= rect.y_end;
}

/* The canvas as far as it lies in `clip`; the one given is as it was. */
el_canvas el_canvas_clipped(const el_canvas *canvas, el_rect clip);

/* Whether anything of `rect` lies in the canvas: what does not need not be built for this band. */
static inline bool el_canvas_sees(const el_canvas *canvas, el_rect rect)
{
    return !el_rect_is_empty(el_rect_shared(rect, canvas->clip));
}

/* What of `rect` lies in the canvas. */
void el_canvas_fill(const el_canvas *canvas, el_rect rect, el_paint paint);

/* The outermost `thickness` pixels of `rect`; nothing if that is below 1. */
void el_canvas_frame(const el_canvas *canvas, el_rect rect, int32_t thickness, el_paint paint);

/* A line of single pixels from the centre of (x0, y0) to that of (x1, y1), both drawn (Bresenham, IBM Systems Journal 4(1),
 * 1965): of each column, or of each row where it is steep, the pixel that is nearest; of two equally near ones the lower or
 * the right one, from whichever end it is drawn. */
void el_canvas_line(const el_canvas *canvas, int16_t x0, int16_t y0, int16_t x1, int16_t y1, el_paint paint);

/* --- For the other files of canvas/ ------------------------------------------------------------------------------------ */

/* Pixels [x, x_end) of line y, of each of which coverage / 256 is to be drawn, 0..256. Pre: they lie within the clip. */
void el_canvas_run(const el_canvas *canvas, int32_t y, int32_t x, int32_t x_end, const el_paint *paint,
                   uint32_t coverage);

static inline uint16_t *el_canvas_line_at(const el_canvas *canvas, int32_t y)
{
    return canvas->pixels + (y - canvas->y) * canvas->stride;
}

#ifdef __cplusplus
}
#endif

#endif
