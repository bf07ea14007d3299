/* Building polygons: contours to a table of edges, each from its upper to its lower end. */
#include "canvas/polygon.h"

#include "base/fixed.h"
#include "canvas/polygon_rows.h"

void el_polygon_begin(el_polygon *polygon, void *memory, size_t bytes)
{
    const size_t skipped = (size_t)(-(uintptr_t)memory & 7U);
    const size_t left = bytes > skipped ? bytes - skipped : 0;
    const size_t used = left < 0x7FFFFFFFU ? left : 0x7FFFFFFFU;
    const size_t edges = used / sizeof(el_polygon_edge);
    *polygon = (el_polygon){
        .edges = (el_polygon_edge *)(void *)((uint8_t *)memory + skipped),
        .bytes = (uint32_t)used,
        .capacity = (uint16_t)(edges < UINT16_MAX ? edges : UINT16_MAX),
        .least = {INT32_MAX, INT32_MAX},
        .most = {INT32_MIN, INT32_MIN},
    };
}

static void add_edge(el_polygon *polygon, const int32_t from[2], const int32_t to[2])
{
    if (from[1] == to[1] || polygon->status != EL_OK) {
        return; /* a level edge crosses no row */
    }
    if (polygon->count == polygon->capacity) {
        polygon->status = EL_ERROR_MEMORY;
        return;
    }
    const bool down = from[1] < to[1];
    const int32_t *const top = down ? from : to;
    const int32_t *const bottom = down ? to : from;
    el_polygon_edge *const edge = &polygon->edges[polygon->count++];
    edge->x0 = (el_coordinate)top[0];
    edge->y0 = (el_coordinate)top[1];
    edge->x1 = (el_coordinate)bottom[0];
    edge->y1 = (el_coordinate)bottom[1];
    edge->winding = down ? 1 : -1;
    polygon->is_sorted = false;
}

static void take_point(el_polygon *polygon, const int32_t point[2])
{
    for (unsigned i = 0; i < 2; i++) {
        if (point[i] < -EL_GUARD_SUB || point[i] > EL_GUARD_SUB) {
            polygon->status = polygon->status == EL_OK ? EL_ERROR_RANGE : polygon->status;
        }
        polygon->least[i] = el_min_i32(polygon->least[i], point[i]);
        polygon->most[i] = el_max_i32(polygon->most[i], point[i]);
    }
}

void el_polygon_add_edge(el_polygon *polygon, const int32_t from[2], const int32_t to[2])
{
    take_point(polygon, from);
    take_point(polygon, to);
    add_edge(polygon, from, to);
}

void el_polygon_close(el_polygon *polygon)
{
    if (polygon->is_open) {
        add_edge(polygon, polygon->last, polygon->first);
        polygon->is_open = false;
    }
}

void el_polygon_move(el_polygon *polygon, int32_t x, int32_t y)
{
    el_polygon_close(polygon);
    polygon->first[0] = polygon->last[0] = x;
    polygon->first[1] = polygon->last[1] = y;
    take_point(polygon, polygon->first);
    polygon->is_open = true;
}

void el_polygon_line(el_polygon *polygon, int32_t x, int32_t y)
{
    if (!polygon->is_open) {
        el_polygon_move(polygon, x, y);
        return;
    }
    const int32_t from[2] = {polygon->last[0], polygon->last[1]};
    polygon->last[0] = x;
    polygon->last[1] = y;
    take_point(polygon, polygon->last);
    add_edge(polygon, from, polygon->last);
}

/* By their upper ends (Shell, Communications of the ACM 2(7), 1959, with Ciura's gaps): in place, without recursion, and
 * little work where they are in order already. */
static void sort_edges(el_polygon *polygon)
{
    static const uint16_t gaps[] = {1750, 701, 301, 132, 57, 23, 10, 4, 1};
    el_polygon_edge *const edges = polygon->edges;
    for (unsigned g = 0; g < sizeof gaps / sizeof gaps[0]; g++) {
        const uint32_t gap = gaps[g];
        for (uint32_t i = gap; i < polygon->count; i++) {
            const el_polygon_edge moved = edges[i];
            uint32_t j = i;
            for (; j >= gap && edges[j - gap].y0 > moved.y0; j -= gap) {
                edges[j] = edges[j - gap];
            }
            edges[j] = moved;
        }
    }
    polygon->is_sorted = true;
}

el_status el_polygon_fill(el_polygon *polygon, const el_canvas *canvas, el_rule rule, el_smooth smooth, el_paint paint)
{
    if (smooth != EL_SHARP && (smooth < EL_SMOOTH_4 || smooth > EL_SMOOTH_16)) {
        return EL_ERROR_ARGUMENT;
    }
    el_polygon_close(polygon);
    if (polygon->status != EL_OK) {
        return polygon->status;
    }
    if (polygon->count == 0) {
        return EL_OK;
    }
    if (!polygon->is_sorted) {
        sort_edges(polygon);
    }
    /* All pixels that it may touch. */
    const el_rect box = {polygon->least[0] >> EL_SUBPIXEL_BITS, polygon->least[1] >> EL_SUBPIXEL_BITS,
                         (polygon->most[0] >> EL_SUBPIXEL_BITS) + 1, (polygon->most[1] >> EL_SUBPIXEL_BITS) + 1};
    const el_canvas part = el_canvas_clipped(canvas, box);
    return el_polygon_fill_rows(polygon, &part, rule, smooth, &paint);
}
