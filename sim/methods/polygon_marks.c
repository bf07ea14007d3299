/* Polygons without any order of their edges: each edge leaves marks in the picture, and marks made twice cancel. That is
 * the even-odd rule, and all that these methods can do. */
#include "base/fixed.h"
#include "methods/polygons.h"

static uint32_t complement_span(el_hits *hits, int32_t row, int32_t x, int32_t x_end)
{
    for (int32_t column = x; column < x_end; column++) {
        hits->counts[row * hits->width + column] ^= 1;
    }
    return x < x_end ? (uint32_t)(x_end - x) : 0;
}

/* Complements each row between the edges and the column `fence`. A row has an even number of crossings, so where the
 * other end of all these spans lies makes no difference to the picture, only to the work. */
static uint32_t complement_to(const el_polygon *polygon, int32_t fence, el_hits *hits)
{
    uint32_t touched = 0;
    fence = el_min_i32(el_max_i32(fence, 0), hits->width);
    for (size_t i = 0; i < polygon->edge_count; i++) {
        const el_spot a = polygon->edges[i].a;
        const el_spot b = polygon->edges[i].b;
        const el_rows rows = el_rows_of_edge(a, b, hits->height);
        for (int32_t row = rows.y; row < rows.y_end; row++) {
            const int32_t column = el_min_i32(el_max_i32(el_crossing_column(a, b, row), 0), hits->width);
            touched += complement_span(hits, row, el_min_i32(column, fence), el_max_i32(column, fence));
        }
    }
    return touched;
}

uint32_t el_polygon_complement(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    (void)rule;
    return complement_to(polygon, el_box_of_polygon(polygon, hits).x_end, hits);
}

/* The column of the corner next to the middle of the box. */
static int32_t fence_of(const el_polygon *polygon, const el_hits *hits)
{
    const el_box box = el_box_of_polygon(polygon, hits);
    const int32_t middle = (box.x + box.x_end) / 2;
    int32_t nearest = box.x_end;
    for (size_t i = 0; i < polygon->edge_count; i++) {
        const int32_t column = el_first_centre(polygon->edges[i].a.x);
        if (el_max_i32(column - middle, middle - column) < el_max_i32(nearest - middle, middle - nearest)) {
            nearest = column;
        }
    }
    return nearest;
}

uint32_t el_polygon_fence(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    (void)rule;
    return complement_to(polygon, fence_of(polygon, hits), hits);
}

uint32_t el_polygon_edge_flag(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    (void)rule;
    uint32_t touched = 0;
    for (size_t i = 0; i < polygon->edge_count; i++) {
        const el_spot a = polygon->edges[i].a;
        const el_spot b = polygon->edges[i].b;
        const el_rows rows = el_rows_of_edge(a, b, hits->height);
        for (int32_t row = rows.y; row < rows.y_end; row++) {
            const int32_t column = el_max_i32(el_crossing_column(a, b, row), 0);
            if (column < hits->width) {
                hits->counts[row * hits->width + column] ^= 1;
                touched++;
            }
        }
    }
    /* The last flag of a row lies on the first column behind the box. */
    const el_box box = el_box_of_polygon(polygon, hits);
    const int32_t x_end = el_min_i32(box.x_end + 1, hits->width);
    for (int32_t row = box.y; row < box.y_end; row++) {
        uint16_t inside = 0;
        for (int32_t column = box.x; column < x_end; column++) {
            uint16_t *const pixel = &hits->counts[row * hits->width + column];
            inside ^= *pixel;
            *pixel = inside;
            touched++;
        }
    }
    return touched;
}
