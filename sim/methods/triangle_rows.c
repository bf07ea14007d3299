/* Triangles row by row, and the table of all triangle methods. */
#include <math.h>

#include "base/fixed.h"
#include "methods/triangles.h"
#include "raster/triangle.h"

/* --- Edge equations, stepped -------------------------------------------------------------------------------------- */

/* An edge equation at the pixel under way. */
typedef struct stepped_edge {
    int64_t row; /* at the first pixel of the row */
    int64_t value;
    int64_t right, down; /* what a pixel and a row add */
} stepped_edge;

static stepped_edge stepped_edge_at(el_spot a, el_spot b, el_spot first)
{
    return (stepped_edge){
        .row = el_side(a, b, first) - el_least_inside(a, b, EL_EDGES_LEFT_TOP),
        .right = (int64_t)(a.y - b.y) * EL_SUBPIXELS,
        .down = (int64_t)(b.x - a.x) * EL_SUBPIXELS,
    };
}

uint32_t el_triangle_edges_stepped(const el_spot corners[3], el_hits *hits)
{
    el_spot c[3];
    if (!el_turn_clockwise(corners, c)) {
        return 0;
    }
    const el_box box = el_box_of_spots(c, 3, hits);
    stepped_edge edges[3];
    for (unsigned i = 0; i < 3; i++) {
        edges[i] = stepped_edge_at(c[i], c[(i + 1) % 3], el_centre_of(box.x, box.y));
    }
    uint32_t asked = 0;
    for (int32_t row = box.y; row < box.y_end; row++) {
        for (unsigned i = 0; i < 3; i++) {
            edges[i].value = edges[i].row;
            edges[i].row += edges[i].down;
        }
        for (int32_t column = box.x; column < box.x_end; column++) {
            asked++;
            if ((edges[0].value | edges[1].value | edges[2].value) >= 0) {
                el_hit(hits, column, row);
            }
            for (unsigned i = 0; i < 3; i++) {
                edges[i].value += edges[i].right;
            }
        }
    }
    return asked;
}

/* --- Split at the middle corner ----------------------------------------------------------------------------------- */

/* In pixels. */
typedef struct place {
    float x, y;
} place;

/* The first column whose centre is not left of x, kept near the picture, where a conversion to int is defined. */
static int32_t column_of(float x)
{
    return (int32_t)fminf(fmaxf(ceilf(x - 0.5F), -1.0F), (float)EL_MAX_WIDTH);
}

/* The rows between two level lines, of which one has shrunk to a point for each half of a triangle. */
static uint32_t fill_between(place left_top, place left_bottom, place right_top, place right_bottom, el_hits *hits)
{
    const float height = left_bottom.y - left_top.y;
    if (!(height > 0.0F)) {
        return 0;
    }
    const float left_slope = (left_bottom.x - left_top.x) / height;
    const float right_slope = (right_bottom.x - right_top.x) / height;
    const int32_t first = (int32_t)fmaxf(ceilf(left_top.y - 0.5F), 0.0F);
    const int32_t end = (int32_t)fminf(ceilf(left_bottom.y - 0.5F), (float)hits->height);
    const float to_first_centre = (float)first + 0.5F - left_top.y;
    float left = left_top.x + left_slope * to_first_centre;
    float right = right_top.x + right_slope * to_first_centre;
    uint32_t written = 0;
    for (int32_t row = first; row < end; row++) {
        written += el_hit_span(hits, row, column_of(left), column_of(right));
        left += left_slope;
        right += right_slope;
    }
    return written;
}

static place place_of(el_spot spot)
{
    return (place){(float)spot.x / EL_SUBPIXELS, (float)spot.y / EL_SUBPIXELS};
}

uint32_t el_triangle_split(const el_spot corners[3], el_hits *hits)
{
    el_spot sorted[3] = {corners[0], corners[1], corners[2]};
    for (unsigned i = 1; i < 3; i++) {
        for (unsigned k = i; k > 0 && sorted[k].y < sorted[k - 1].y; k--) {
            const el_spot lower = sorted[k - 1];
            sorted[k - 1] = sorted[k];
            sorted[k] = lower;
        }
    }
    const int64_t doubled_area = el_side(sorted[0], sorted[1], sorted[2]);
    if (doubled_area == 0) {
        return 0;
    }
    const place top = place_of(sorted[0]);
    const place middle = place_of(sorted[1]);
    const place bottom = place_of(sorted[2]);
    /* Opposite the middle corner, on the long edge. */
    const place split = {top.x + (bottom.x - top.x) * ((middle.y - top.y) / (bottom.y - top.y)), middle.y};
    const bool middle_is_right = doubled_area > 0;
    const place left = middle_is_right ? split : middle;
    const place right = middle_is_right ? middle : split;
    return fill_between(top, left, top, right, hits) + fill_between(left, bottom, right, bottom, hits);
}

/* --- Row crossing ------------------------------------------------------------------------------------------------- */

uint32_t el_triangle_row_crossing(const el_spot corners[3], el_hits *hits)
{
    const el_box box = el_box_of_spots(corners, 3, hits);
    uint32_t written = 0;
    for (int32_t row = box.y; row < box.y_end; row++) {
        const int32_t y = el_centre_of(0, row).y;
        int32_t left = INT32_MAX;
        int32_t right = INT32_MIN;
        for (unsigned i = 0; i < 3; i++) {
            const el_spot a = corners[i];
            const el_spot b = corners[(i + 1) % 3];
            if ((a.y <= y) != (b.y <= y)) {
                const int32_t column = el_crossing_column(a, b, row);
                left = el_min_i32(left, column);
                right = el_max_i32(right, column);
            }
        }
        written += el_hit_span(hits, row, left, right);
    }
    return written;
}

/* --- Edgeline ----------------------------------------------------------------------------------------------------- */

uint32_t el_triangle_edgeline(const el_spot corners[3], el_hits *hits)
{
    el_corner placed[3] = {0};
    for (unsigned i = 0; i < 3; i++) {
        placed[i].x = corners[i].x;
        placed[i].y = corners[i].y;
    }
    const el_surface surface = {.shading = EL_SHADE_OVERDRAW};
    const el_target target = {.colour = hits->counts, .width = hits->width, .y = 0, .y_end = hits->height};
    el_triangle triangle;
    el_stats stats = {0};
    if (el_triangle_setup(&triangle, placed, &surface, 0)) {
        el_triangle_draw(&triangle, &target, &stats);
    }
    return stats.pixels;
}

const el_triangle_method el_triangle_methods[EL_TRIANGLE_METHODS] = {
    {"cross-everywhere", "cross, every pixel", "int64", EL_EDGES_ALL, true, el_triangle_cross_everywhere},
    {"cross-in-box", "cross, bounding box", "int64", EL_EDGES_ALL, true, el_triangle_cross_in_box},
    {"area-sum", "area sum", "int64", EL_EDGES_ALL, true, el_triangle_area_sum},
    {"angle-sum", "angle sum", "double", EL_EDGES_ALL, false, el_triangle_angle_sum},
    {"same-side", "same side", "int64", EL_EDGES_ALL, true, el_triangle_same_side},
    {"barycentric-areas", "barycentric, by areas", "int64/float", EL_EDGES_ALL, true, el_triangle_barycentric_areas},
    {"barycentric-solve", "barycentric, 2x2 system", "float", EL_EDGES_ALL, false, el_triangle_barycentric_solve},
    {"edges-all", "edges, evaluated", "int64", EL_EDGES_ALL, true, el_triangle_edges_all},
    {"edges-none", "edges, evaluated", "int64", EL_EDGES_NONE, true, el_triangle_edges_none},
    {"edges-left-top", "edges, evaluated", "int64", EL_EDGES_LEFT_TOP, true, el_triangle_edges_left_top},
    {"edges-stepped", "edges, stepped", "int64", EL_EDGES_LEFT_TOP, true, el_triangle_edges_stepped},
    {"split", "split in two, slopes", "float", EL_EDGES_LEFT_TOP, false, el_triangle_split},
    {"row-crossing", "left, right of each row", "int64", EL_EDGES_LEFT_TOP, true, el_triangle_row_crossing},
    {"edgeline", "Edgeline", "int32", EL_EDGES_LEFT_TOP, true, el_triangle_edgeline},
};
