#include "methods/reference.h"

bool el_reference_in_triangle(const el_spot corners[3], el_spot centre, el_edge_rule rule)
{
    el_spot c[3];
    if (!el_turn_clockwise(corners, c)) {
        return false;
    }
    for (unsigned i = 0; i < 3; i++) {
        const el_spot a = c[i];
        const el_spot b = c[(i + 1) % 3];
        const int64_t side = el_side(a, b, centre);
        const bool edge_counts = rule == EL_EDGES_ALL || (rule == EL_EDGES_LEFT_TOP && el_is_left_or_top(a, b));
        if (side < 0 || (side == 0 && !edge_counts)) {
            return false;
        }
    }
    return true;
}

int32_t el_reference_turns(const el_polygon *polygon, el_spot centre)
{
    int32_t turns = 0;
    for (size_t i = 0; i < polygon->edge_count; i++) {
        const el_spot a = polygon->edges[i].a;
        const el_spot b = polygon->edges[i].b;
        /* The step down takes the point off the row of corners, the step to the right off the edges. */
        const bool starts_below = a.y > centre.y;
        const bool ends_below = b.y > centre.y;
        if (starts_below != ends_below) {
            const int64_t side = el_side(a, b, centre);
            const bool is_left_of_point = ends_below ? side <= 0 : side >= 0;
            if (is_left_of_point) {
                turns += ends_below ? -1 : 1;
            }
        }
    }
    return turns;
}

void el_reference_triangle(const el_spot corners[3], el_edge_rule rule, el_hits *hits)
{
    for (int32_t row = 0; row < hits->height; row++) {
        for (int32_t column = 0; column < hits->width; column++) {
            hits->counts[row * hits->width + column] =
                el_reference_in_triangle(corners, el_centre_of(column, row), rule);
        }
    }
}

void el_reference_polygon(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    for (int32_t row = 0; row < hits->height; row++) {
        for (int32_t column = 0; column < hits->width; column++) {
            const int32_t turns = el_reference_turns(polygon, el_centre_of(column, row));
            hits->counts[row * hits->width + column] = rule == EL_FILL_EVEN_ODD ? (turns & 1) != 0 : turns != 0;
        }
    }
}

int32_t el_reference_value(const el_spot corners[3], const int32_t values[3], el_spot centre)
{
    int64_t area = el_side(corners[0], corners[1], corners[2]);
    int64_t sum = 0;
    for (unsigned i = 0; i < 3; i++) {
        sum += el_side(corners[(i + 1) % 3], corners[(i + 2) % 3], centre) * values[i];
    }
    if (area < 0) {
        area = -area;
        sum = -sum;
    }
    /* floor((2 sum + area) / (2 area)) */
    const int64_t numerator = 2 * sum + area;
    const int64_t quotient = numerator / (2 * area);
    return (int32_t)(quotient - (numerator % (2 * area) < 0 ? 1 : 0));
}
