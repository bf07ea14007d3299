#include "methods/shapes.h"

#include "base/fixed.h"

el_box el_box_of_spots(const el_spot *spots, size_t count, const el_hits *hits)
{
    el_spot least = spots[0];
    el_spot most = spots[0];
    for (size_t i = 1; i < count; i++) {
        least.x = el_min_i32(least.x, spots[i].x);
        least.y = el_min_i32(least.y, spots[i].y);
        most.x = el_max_i32(most.x, spots[i].x);
        most.y = el_max_i32(most.y, spots[i].y);
    }
    /* One unit further, so that a centre on the bound is in. */
    return (el_box){
        el_max_i32(0, el_first_centre(least.x)),
        el_max_i32(0, el_first_centre(least.y)),
        el_min_i32(hits->width, el_first_centre(most.x + 1)),
        el_min_i32(hits->height, el_first_centre(most.y + 1)),
    };
}

bool el_turn_clockwise(const el_spot corners[3], el_spot turned[3])
{
    const int64_t doubled_area = el_side(corners[0], corners[1], corners[2]);
    turned[0] = corners[0];
    turned[1] = corners[doubled_area < 0 ? 2 : 1];
    turned[2] = corners[doubled_area < 0 ? 1 : 2];
    return doubled_area != 0;
}

el_rows el_rows_of_edge(el_spot a, el_spot b, int32_t rows)
{
    const int32_t top = el_min_i32(a.y, b.y);
    const int32_t bottom = el_max_i32(a.y, b.y);
    return (el_rows){el_max_i32(0, el_first_centre(top)), el_min_i32(rows, el_first_centre(bottom))};
}

int32_t el_crossing_column(el_spot a, el_spot b, int32_t row)
{
    const el_spot top = a.y < b.y ? a : b;
    const el_spot bottom = a.y < b.y ? b : a;
    const el_spot centre = el_centre_of(0, row);
    const int64_t dx = bottom.x - top.x;
    const int64_t dy = bottom.y - top.y;
    /* The crossing lies at top.x + dx (centre.y - top.y) / dy; in pixels from the centre of column 0 that is n / d. */
    const int64_t n = (int64_t)(top.x - centre.x) * dy + dx * (centre.y - top.y);
    const int64_t d = (int64_t)EL_SUBPIXELS * dy;
    /* Division truncates towards 0, which is the ceiling of what is negative. */
    return (int32_t)(n / d + (n % d > 0 ? 1 : 0));
}

uint32_t el_hit_span(el_hits *hits, int32_t row, int32_t x, int32_t x_end)
{
    x = el_max_i32(x, 0);
    x_end = el_min_i32(x_end, hits->width);
    for (int32_t column = x; column < x_end; column++) {
        el_hit(hits, column, row);
    }
    return x < x_end ? (uint32_t)(x_end - x) : 0;
}
