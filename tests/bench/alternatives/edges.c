/* Which pixels a triangle covers: rows between two edges, walked exactly or with rounded slopes, or an edge test for
 * each pixel of the bounding box. */
#include "alternatives.h"
#include "exact_walk.h"
#include "platform.h"

static void fill(uint16_t *row, int32_t x, int32_t x_end)
{
    for (; x < x_end; x++) {
        row[x] = 1;
    }
}

/* ceil of 16.16. */
static int32_t pixel_of(int32_t x_q16)
{
    return (x_q16 + 0xFFFF) >> 16;
}

typedef struct rounded_edge {
    int32_t x_q16; /* crossing with the row of centres, less half a pixel */
    int32_t step_q16;
} rounded_edge;

/* One division per edge; its rest is thrown away, so that the crossing drifts by up to 2^-16 px per row. */
static rounded_edge rounded_edge_make(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t row)
{
    rounded_edge edge;
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): y0 < y1. */
    edge.step_q16 = ((x1 - x0) << 16) / (y1 - y0); /* |dx| < 2^13 here: on the screen */
    const int32_t down = row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - y0;
    edge.x_q16 = (x0 - EL_SUBPIXELS / 2) * (1 << (16 - EL_SUBPIXEL_BITS)) +
                 (int32_t)(((int64_t)edge.step_q16 * down) >> EL_SUBPIXEL_BITS);
    return edge;
}

static void rounded_triangle(const bench_triangle *triangle, uint16_t *picture)
{
    int32_t x[3] = {triangle->corners[0].x, triangle->corners[1].x, triangle->corners[2].x};
    int32_t y[3] = {triangle->corners[0].y, triangle->corners[1].y, triangle->corners[2].y};
    bench_sort(x, y);
    const int64_t area = el_doubled_area(x, y);
    int32_t row = el_first_centre(y[0]);
    const int32_t end = el_first_centre(y[2]);
    if (area == 0 || row >= end) {
        return;
    }
    rounded_edge edges[2]; /* the long one, and the one that bends */
    edges[0] = rounded_edge_make(x[0], y[0], x[2], y[2], row);
    for (unsigned part = 0; part < 2; part++) {
        const int32_t part_end = el_first_centre(y[part + 1]);
        if (row >= part_end) {
            continue;
        }
        edges[1] = rounded_edge_make(x[part], y[part], x[part + 1], y[part + 1], row);
        for (; row < part_end; row++) {
            const rounded_edge *const left = &edges[area < 0 ? 1 : 0];
            const rounded_edge *const right = &edges[area < 0 ? 0 : 1];
            fill(picture + row * WIDTH, pixel_of(left->x_q16), pixel_of(right->x_q16));
            edges[0].x_q16 += edges[0].step_q16;
            edges[1].x_q16 += edges[1].step_q16;
        }
    }
}

/* E(i, j) at the first centre of the bounding box and its steps. Pixels where all three are not negative are inside; the
 * fill rule is 1 taken off where an edge is neither a top nor a left one. */
typedef struct edge_function {
    int32_t value, step_x, step_y;
} edge_function;

/* On the screen |dx|, |dy| < 2^13, so that E < 2^27. */
static edge_function edge_function_make(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t column, int32_t row)
{
    const int32_t dx = x1 - x0;
    const int32_t dy = y1 - y0;
    const int32_t top_or_left = dy < 0 || (dy == 0 && dx > 0);
    const int32_t centre_x = column * EL_SUBPIXELS + EL_SUBPIXELS / 2;
    const int32_t centre_y = row * EL_SUBPIXELS + EL_SUBPIXELS / 2;
    return (edge_function){
        .value = dx * (centre_y - y0) - dy * (centre_x - x0) - (top_or_left ? 0 : 1),
        .step_x = -dy * EL_SUBPIXELS,
        .step_y = dx * EL_SUBPIXELS,
    };
}

static void tested_triangle(const bench_triangle *triangle, uint16_t *picture)
{
    int32_t x[3] = {triangle->corners[0].x, triangle->corners[1].x, triangle->corners[2].x};
    int32_t y[3] = {triangle->corners[0].y, triangle->corners[1].y, triangle->corners[2].y};
    const int64_t area = el_doubled_area(x, y);
    if (area == 0) {
        return;
    }
    if (area < 0) {
        const int32_t swap_x = x[1], swap_y = y[1];
        x[1] = x[2];
        y[1] = y[2];
        x[2] = swap_x;
        y[2] = swap_y;
    }
    int32_t least_x = x[0], most_x = x[0], least_y = y[0], most_y = y[0];
    for (unsigned i = 1; i < 3; i++) {
        least_x = x[i] < least_x ? x[i] : least_x;
        most_x = x[i] > most_x ? x[i] : most_x;
        least_y = y[i] < least_y ? y[i] : least_y;
        most_y = y[i] > most_y ? y[i] : most_y;
    }
    const int32_t column_begin = el_first_centre(least_x);
    const int32_t column_end = el_first_centre(most_x + 1);
    const int32_t row_begin = el_first_centre(least_y);
    const int32_t row_end = el_first_centre(most_y + 1);
    edge_function e[3];
    for (unsigned i = 0; i < 3; i++) {
        const unsigned next = (i + 1) % 3;
        e[i] = edge_function_make(x[i], y[i], x[next], y[next], column_begin, row_begin);
    }
    for (int32_t row = row_begin; row < row_end; row++) {
        int32_t a = e[0].value, b = e[1].value, c = e[2].value;
        uint16_t *const pixels = picture + row * WIDTH;
        for (int32_t column = column_begin; column < column_end; column++) {
            if ((a | b | c) >= 0) {
                pixels[column] = 1;
            }
            a += e[0].step_x;
            b += e[1].step_x;
            c += e[2].step_x;
        }
        for (unsigned i = 0; i < 3; i++) {
            e[i].value += e[i].step_y;
        }
    }
}

static void run_exact(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    bench_start();
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        const el_corner *const corners = bench_triangles[i].corners;
        int32_t x[3] = {corners[0].x, corners[1].x, corners[2].x};
        int32_t y[3] = {corners[0].y, corners[1].y, corners[2].y};
        exact_walk(x, y, bench_colour[bench_triangles[i].picture]);
    }
    bench_stop();
}

static void run_rounded(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    bench_start();
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        rounded_triangle(&bench_triangles[i], bench_colour[bench_triangles[i].picture]);
    }
    bench_stop();
}

static void run_tested(const bench_case *self, int32_t *record)
{
    (void)self;
    (void)record;
    bench_start();
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        tested_triangle(&bench_triangles[i], bench_colour[bench_triangles[i].picture]);
    }
    bench_stop();
}

const bench_case edge_cases[] = {
    {"edges", "exact", run_exact, bench_colour, sizeof bench_colour, 0, {0, TRIANGLES}, 0},
    {"edges", "rounded", run_rounded, bench_colour, sizeof bench_colour, 0, {0, TRIANGLES}, 0},
    {"edges", "tests", run_tested, bench_colour, sizeof bench_colour, 0, {0, TRIANGLES}, 0},
    {0},
};
