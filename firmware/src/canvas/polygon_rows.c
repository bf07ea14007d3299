/* The edge table and the active edge table: from a polygon's edges to runs of pixels.
 *
 * Samples lie on a grid: one at each pixel's centre, or, smooth, 4, 8 or 16 rows of 16. A row of samples meets the edges
 * that are active there, from left to right, and is filled between those where the rule says so. The first sample that is
 * not left of an edge is a rational number rounded up; its whole part and its rest are stepped from row to row, so it is
 * exact on every row, for edges of any length, and the same from whichever row a band begins: an edge that reaches into a
 * band is set up for the band's first row by one division. An edge has the samples not left of it, and a row of samples
 * that is level with an edge's upper end belongs to it, one level with the lower end does not: the top-left rule.
 *
 * Crossings come in almost the right order from the row above, so they are kept sorted by insertion.
 *
 * Smooth rows add to how much of each pixel is covered: each run adds what changes at its two ends, and the sum from the
 * left is the coverage. So a row costs its crossings, not its width, and a line of pixels is written once, in runs of equal
 * coverage. */
#include "canvas/polygon_rows.h"

#include <string.h>

#include "base/fill.h"
#include "base/fixed.h"
#include "canvas/floor.h"

_Static_assert(sizeof(el_polygon_edge) % sizeof(el_word) == 0, "steps, which lie behind edges, are read by pairs");

enum { COLUMNS_LOG2 = 4 }; /* of a pixel, where it is smooth */

typedef struct filling {
    el_polygon_edge *edges;
    uint32_t count;
    uint32_t begun;  /* edges before this one have begun */
    uint32_t active; /* as many are active */
    const el_canvas *canvas;
    const el_paint *paint;
    el_rule rule;
    uint8_t rows_log2, columns_log2; /* of a pixel */
    int16_t *steps;                  /* of coverage, for each pixel of the clip's width and one more; NULL: sharp */
    int32_t least, most;             /* pixels of the line that have steps */
} filling;

/* The first row of samples that is not above `y`. In halves of a unit, in which a row's middle is a whole number: there
 * are 2 EL_SUBPIXELS in a pixel, and at least 2 from row to row. */
static inline int32_t first_row(const filling *f, int32_t y)
{
    const int32_t pitch_log2 = EL_SUBPIXEL_BITS + 1 - f->rows_log2;
    return (2 * y + (1 << pitch_log2) / 2 - 1) >> pitch_log2;
}

/* Puts an edge's crossing in its place among the active ones. */
static inline void insert(filling *f, uint32_t number)
{
    const int32_t column = f->edges[number].column;
    uint32_t at = f->active++;
    for (; at > 0 && f->edges[f->edges[at - 1].active].column > column; at--) {
        f->edges[at].active = f->edges[at - 1].active;
    }
    f->edges[at].active = (uint16_t)number;
}

/* Where an edge crosses a row of samples, and how that moves from row to row. With G = EL_GUARD_SUB, dx and dy up to 2 G,
 * S = EL_SUBPIXELS: a sample's place is (2 column + 1) S / columns in halves of a unit, so the first one not left of the
 * edge is
 *
 *     ceil(n / divisor)    with n = (2 x0 - pitch / 2) dy + down dx, |n| < (2 G + S) 2 G + (4 G + S) 2 G < 2^43,
 *                               divisor = pitch dy <= 2 S 2 G < 2^30 */
static void begin_edge(const filling *f, el_polygon_edge *edge, int32_t row)
{
    const int32_t row_log2 = EL_SUBPIXEL_BITS + 1 - f->rows_log2;
    const int32_t column_log2 = EL_SUBPIXEL_BITS + 1 - f->columns_log2;
    const int32_t dx = edge->x1 - edge->x0;
    const int32_t dy = edge->y1 - edge->y0;
    const int32_t down = row * (1 << row_log2) + (1 << row_log2) / 2 - 2 * edge->y0; /* 0 to 2 dy */
    const int64_t divisor = (int64_t)dy << column_log2;
    const int64_t n = (int64_t)(2 * edge->x0 - (1 << column_log2) / 2) * dy + (int64_t)down * dx;
    int64_t rest;
    edge->column = (int32_t)el_floor_divide(n + divisor - 1, divisor, &rest);
    edge->rest = (uint32_t)rest;
    edge->step = (int32_t)el_floor_divide((int64_t)dx * (1 << row_log2), divisor, &rest); /* below 2^31 */
    edge->step_rest = (uint32_t)rest;
}

/* Edges that begin at this row of samples, or above it. */
static void admit(filling *f, int32_t row)
{
    for (; f->begun < f->count && first_row(f, f->edges[f->begun].y0) <= row; f->begun++) {
        el_polygon_edge *const edge = &f->edges[f->begun];
        if (first_row(f, edge->y1) > row) {
            begin_edge(f, edge, row);
            insert(f, f->begun);
        }
    }
}

/* To the row of samples `row`, one below: what ends above it is active no longer. */
static void advance(filling *f, int32_t row)
{
    const uint32_t before = f->active;
    f->active = 0; /* at most i below, so that no number is lost */
    for (uint32_t i = 0; i < before; i++) {
        const uint32_t number = f->edges[i].active;
        el_polygon_edge *const edge = &f->edges[number];
        if (first_row(f, edge->y1) <= row) {
            continue;
        }
        const uint32_t divisor = (uint32_t)(edge->y1 - edge->y0) << (EL_SUBPIXEL_BITS + 1 - f->columns_log2);
        edge->column += edge->step;
        edge->rest += edge->step_rest; /* below 2^31 */
        if (edge->rest >= divisor) {
            edge->rest -= divisor;
            edge->column++;
        }
        insert(f, number);
    }
}

/* What the coverage of a line changes by at `column`. A pixel has at most 8 runs per row of samples, 16 rows, and 16 per
 * end: 4096. */
static inline void add_step(const filling *f, int32_t column, int32_t sign)
{
    int16_t *const step = f->steps + ((column >> COLUMNS_LOG2) - f->canvas->clip.x);
    const int32_t part = column & ((1 << COLUMNS_LOG2) - 1);
    step[0] = (int16_t)(step[0] + sign * ((1 << COLUMNS_LOG2) - part));
    step[1] = (int16_t)(step[1] + sign * part);
}

/* Samples [begin, end) of a row of samples in line y. */
static void take_run(filling *f, int32_t y, int32_t begin, int32_t end)
{
    const el_rect *const clip = &f->canvas->clip;
    begin = el_max_i32(begin, clip->x * (1 << f->columns_log2));
    end = el_min_i32(end, clip->x_end * (1 << f->columns_log2));
    if (begin >= end) {
        return;
    }
    if (f->steps == NULL) {
        el_canvas_run(f->canvas, y, begin, end, f->paint, 256);
        return;
    }
    add_step(f, begin, 1);
    add_step(f, end, -1);
    f->least = el_min_i32(f->least, begin >> COLUMNS_LOG2);
    f->most = el_max_i32(f->most, end >> COLUMNS_LOG2);
}

static void take_row(filling *f, int32_t y)
{
    int32_t winding = 0;
    int32_t begin = 0;
    for (uint32_t i = 0; i < f->active; i++) {
        const el_polygon_edge *const edge = &f->edges[f->edges[i].active];
        const bool was_inside = winding != 0;
        winding = f->rule == EL_EVEN_ODD ? winding ^ 1 : winding + edge->winding;
        if (!was_inside) {
            begin = edge->column;
        } else if (winding == 0) {
            take_run(f, y, begin, edge->column);
        }
    }
}

/* The first of steps [at, end) that is not 0, or `end`: by pairs, since most are. */
static int32_t next_step(const int16_t *steps, int32_t at, int32_t end)
{
    while (at < end && steps[at] == 0) {
        at++;
        if ((at & 1) == 0) {
            const el_word *pair = (const el_word *)(const void *)(steps + at);
            const el_word *const last = pair + (end - at) / 2;
            while (pair < last && *pair == 0) {
                pair++;
            }
            at = (int32_t)((const int16_t *)(const void *)pair - steps);
        }
    }
    return at < end ? at : end;
}

/* Draws line y as it is covered, and clears its steps. */
static void draw_line(filling *f, int32_t y)
{
    const el_rect *const clip = &f->canvas->clip;
    const int32_t end = el_min_i32(f->most + 1, clip->x_end);
    int32_t covered = 0;
    for (int32_t x = f->least; x < end;) {
        const int32_t begin = x;
        covered += f->steps[x - clip->x];
        f->steps[x - clip->x] = 0;
        x = next_step(f->steps, x + 1 - clip->x, end - clip->x) + clip->x;
        if (covered != 0) {
            el_canvas_run(f->canvas, y, begin, x, f->paint,
                          (uint32_t)covered << (8 - COLUMNS_LOG2 - f->rows_log2)); /* all of a pixel is 256 */
        }
    }
    /* Steps at the end of the last pixel are beyond it. */
    for (int32_t x = end; x <= f->most + 1; x++) {
        f->steps[x - clip->x] = 0;
    }
    f->least = INT32_MAX;
    f->most = INT32_MIN;
}

static void fill_lines(filling *f)
{
    const el_rect *const clip = &f->canvas->clip;
    admit(f, clip->y * (1 << f->rows_log2));
    for (int32_t y = clip->y; y < clip->y_end; y++) {
        if (f->active == 0) {
            if (f->begun == f->count) {
                return;
            }
            y = el_max_i32(y, first_row(f, f->edges[f->begun].y0) >> f->rows_log2);
            if (y >= clip->y_end) {
                return;
            }
        }
        const int32_t row = y * (1 << f->rows_log2);
        for (int32_t i = 0; i < 1 << f->rows_log2; i++) {
            admit(f, row + i);
            take_row(f, y);
            advance(f, row + i + 1);
        }
        if (f->least <= f->most) {
            draw_line(f, y);
        }
    }
}

el_status el_polygon_fill_rows(el_polygon *polygon, const el_canvas *canvas, el_rule rule, el_smooth smooth,
                               const el_paint *paint)
{
    if (el_rect_is_empty(canvas->clip)) {
        return EL_OK;
    }
    filling f = {
        .edges = polygon->edges,
        .count = polygon->count,
        .canvas = canvas,
        .paint = paint,
        .rule = rule,
        .rows_log2 = (uint8_t)smooth,
        .columns_log2 = smooth == EL_SHARP ? 0 : COLUMNS_LOG2,
        .least = INT32_MAX,
        .most = INT32_MIN,
    };
    if (smooth != EL_SHARP) {
        const uint32_t used = polygon->count * (uint32_t)sizeof polygon->edges[0];
        const uint32_t bytes = ((uint32_t)(canvas->clip.x_end - canvas->clip.x) + 2U) * (uint32_t)sizeof f.steps[0];
        if (bytes > polygon->bytes - used) {
            return EL_ERROR_MEMORY;
        }
        f.steps = (int16_t *)(void *)(polygon->edges + polygon->count);
        memset(f.steps, 0, bytes);
    }
    fill_lines(&f);
    return EL_OK;
}
