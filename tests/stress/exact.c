#include "exact.h"

#include <stdlib.h>

exact_triangle exact_triangle_of(const point corners[3])
{
    const int64_t area = exact_edge(corners[0], corners[1], corners[2]);
    const unsigned second = area < 0 ? 2 : 1;
    const unsigned third = 3 - second;
    return (exact_triangle){
        .corners = {corners[0], corners[second], corners[third]},
        .given = {0, second, third},
        .area = area < 0 ? -area : area,
    };
}

/* The least value of the edge function that counts: 0 on top and left edges, 1 on the others. Clockwise with y down, a
 * left edge runs up and a top edge runs to the right. */
static int64_t least_inside(point a, point b)
{
    const bool is_left = b.y < a.y;
    const bool is_top = b.y == a.y && b.x > a.x;
    return is_left || is_top ? 0 : 1;
}

bool exact_covers(const exact_triangle *triangle, int64_t column, int64_t row)
{
    const point p = centre_of(column, row);
    bool covers = triangle->area > 0;
    for (unsigned i = 0; i < 3; i++) {
        const point a = triangle->corners[i];
        const point b = triangle->corners[(i + 1) % 3];
        covers = covers && exact_edge(a, b, p) >= least_inside(a, b);
    }
    return covers;
}

static int64_t floor_divide(int64_t n, int64_t d)
{
    return n / d - (n % d != 0 && (n < 0) != (d < 0));
}

void exact_span(const exact_triangle *triangle, int64_t row, int64_t width, int64_t *begin, int64_t *end)
{
    int64_t first = 0;
    int64_t last = triangle->area > 0 ? width - 1 : -1;
    for (unsigned i = 0; i < 3; i++) {
        const point a = triangle->corners[i];
        const point b = triangle->corners[(i + 1) % 3];
        /* value + column * step >= least */
        const int64_t room = exact_edge(a, b, centre_of(0, row)) - least_inside(a, b);
        const int64_t step = (a.y - b.y) * EL_SUBPIXELS;
        if (step > 0) {
            const int64_t bound = -floor_divide(room, step);
            first = bound > first ? bound : first;
        } else if (step < 0) {
            const int64_t bound = floor_divide(room, -step);
            last = bound < last ? bound : last;
        } else if (room < 0) {
            last = -1;
        }
    }
    const bool any = first <= last;
    /* What the division found is held against the edge functions themselves; a triangle is convex, so its ends decide
     * the row. */
    if (any && (!exact_covers(triangle, first, row) || !exact_covers(triangle, last, row) ||
                (first > 0 && exact_covers(triangle, first - 1, row)) ||
                (last < width - 1 && exact_covers(triangle, last + 1, row)))) {
        abort();
    }
    *begin = any ? first : 0;
    *end = any ? last + 1 : 0;
}

/* The weight of corner i is the edge function of the edge opposite to it. */
static int64_t weight(const exact_triangle *triangle, unsigned i, point p)
{
    return exact_edge(triangle->corners[(i + 1) % 3], triangle->corners[(i + 2) % 3], p);
}

exact_row exact_plane(const exact_triangle *triangle, const int32_t values[3], int64_t column, int64_t row)
{
    exact_row plane = {0};
    for (unsigned i = 0; i < 3; i++) {
        const int64_t value = values[triangle->given[i]];
        const int64_t here = weight(triangle, i, centre_of(column, row));
        plane.sum += here * value;
        plane.step += (weight(triangle, i, centre_of(column + 1, row)) - here) * value;
    }
    return plane;
}

exact_ratio exact_coordinate(const exact_triangle *triangle, const uint32_t w[3], const int32_t u[3], int64_t column,
                             int64_t row)
{
    exact_ratio ratio = {0};
    for (unsigned i = 0; i < 3; i++) {
        const unsigned corner = triangle->given[i];
        const wide share = (wide)weight(triangle, i, centre_of(column, row)) * w[corner];
        ratio.denominator += share;           /* below 2^74 */
        ratio.numerator += share * u[corner]; /* below 2^102 */
    }
    return ratio;
}

static wide difference(exact_ratio exact, int64_t got)
{
    const wide d = exact.denominator * got - exact.numerator;
    return d < 0 ? -d : d;
}

double exact_error(exact_ratio exact, int64_t got)
{
    return (double)((long double)difference(exact, got) / (long double)exact.denominator);
}

bool exact_is_within(exact_ratio exact, int64_t got, unsigned bits)
{
    return difference(exact, got) << bits <= exact.denominator << 16;
}
