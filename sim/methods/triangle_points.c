/* Triangles by asking of one pixel after the other whether its centre is inside.
 *
 * The loop is the same for all; the question is a function that the compiler puts into it, so that what is timed is the
 * question and not a call. */
#include <math.h>

#include "methods/triangles.h"

typedef bool inside_test(const el_spot corners[3], el_spot p);

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* `corners` reach the question in clockwise order. */
ALWAYS_INLINE uint32_t ask(const el_spot corners[3], el_box box, el_hits *hits, inside_test *inside)
{
    el_spot turned[3];
    if (!el_turn_clockwise(corners, turned)) {
        return 0;
    }
    uint32_t asked = 0;
    for (int32_t row = box.y; row < box.y_end; row++) {
        for (int32_t column = box.x; column < box.x_end; column++) {
            asked++;
            if (inside(turned, el_centre_of(column, row))) {
                el_hit(hits, column, row);
            }
        }
    }
    return asked;
}

ALWAYS_INLINE uint32_t ask_in_box(const el_spot corners[3], el_hits *hits, inside_test *inside)
{
    return ask(corners, el_box_of_spots(corners, 3, hits), hits, inside);
}

/* --- Cross products ----------------------------------------------------------------------------------------------- */

ALWAYS_INLINE bool right_of_all(const el_spot c[3], el_spot p)
{
    return el_side(c[0], c[1], p) >= 0 && el_side(c[1], c[2], p) >= 0 && el_side(c[2], c[0], p) >= 0;
}

uint32_t el_triangle_cross_everywhere(const el_spot corners[3], el_hits *hits)
{
    return ask(corners, el_box_of_picture(hits), hits, right_of_all);
}

uint32_t el_triangle_cross_in_box(const el_spot corners[3], el_hits *hits)
{
    return ask_in_box(corners, hits, right_of_all);
}

/* --- Area sum ----------------------------------------------------------------------------------------------------- */

static inline int64_t doubled_area(el_spot a, el_spot b, el_spot c)
{
    const int64_t side = el_side(a, b, c);
    return side < 0 ? -side : side;
}

ALWAYS_INLINE bool areas_add_up(const el_spot c[3], el_spot p)
{
    return doubled_area(c[0], c[1], p) + doubled_area(c[1], c[2], p) + doubled_area(c[2], c[0], p) ==
           doubled_area(c[0], c[1], c[2]);
}

uint32_t el_triangle_area_sum(const el_spot corners[3], el_hits *hits)
{
    return ask_in_box(corners, hits, areas_add_up);
}

/* --- Angle sum ---------------------------------------------------------------------------------------------------- */

/* The angle a-p-b, 0..pi. A point on a corner sees nothing of its two edges: acos(0 / 0). */
static inline double angle_at(el_spot p, el_spot a, el_spot b)
{
    const double ax = a.x - p.x;
    const double ay = a.y - p.y;
    const double bx = b.x - p.x;
    const double by = b.y - p.y;
    const double cosine = (ax * bx + ay * by) / (sqrt(ax * ax + ay * ay) * sqrt(bx * bx + by * by));
    return acos(fmin(fmax(cosine, -1.0), 1.0));
}

ALWAYS_INLINE bool angles_make_a_turn(const el_spot c[3], el_spot p)
{
    static const double turn = 6.283185307179586;
    static const double tolerance = 1e-6;
    for (unsigned i = 0; i < 3; i++) {
        if (p.x == c[i].x && p.y == c[i].y) {
            return true;
        }
    }
    return angle_at(p, c[0], c[1]) + angle_at(p, c[1], c[2]) + angle_at(p, c[2], c[0]) >= turn - tolerance;
}

uint32_t el_triangle_angle_sum(const el_spot corners[3], el_hits *hits)
{
    return ask_in_box(corners, hits, angles_make_a_turn);
}

/* --- Same side ---------------------------------------------------------------------------------------------------- */

/* The textbook multiplies the two sides and asks for the product's sign; comparing signs cannot overflow. */
static inline bool same_side(el_spot a, el_spot b, el_spot p, el_spot q)
{
    const int64_t side = el_side(a, b, p);
    return side == 0 || (side > 0) == (el_side(a, b, q) > 0);
}

ALWAYS_INLINE bool same_side_of_all(const el_spot c[3], el_spot p)
{
    return same_side(c[0], c[1], p, c[2]) && same_side(c[1], c[2], p, c[0]) && same_side(c[2], c[0], p, c[1]);
}

uint32_t el_triangle_same_side(const el_spot corners[3], el_hits *hits)
{
    return ask_in_box(corners, hits, same_side_of_all);
}

/* --- Barycentric coordinates -------------------------------------------------------------------------------------- */

ALWAYS_INLINE bool weights_by_areas(const el_spot c[3], el_spot p)
{
    const float area = (float)el_side(c[0], c[1], c[2]);
    const float a = (float)el_side(c[1], c[2], p) / area;
    const float b = (float)el_side(c[2], c[0], p) / area;
    const float w = (float)el_side(c[0], c[1], p) / area;
    return a >= 0.0F && b >= 0.0F && w >= 0.0F;
}

uint32_t el_triangle_barycentric_areas(const el_spot corners[3], el_hits *hits)
{
    return ask_in_box(corners, hits, weights_by_areas);
}

static inline float dot(el_spot origin, el_spot a, el_spot b)
{
    return (float)(a.x - origin.x) * (float)(b.x - origin.x) + (float)(a.y - origin.y) * (float)(b.y - origin.y);
}

ALWAYS_INLINE bool weights_by_solving(const el_spot c[3], el_spot p)
{
    const float d00 = dot(c[0], c[1], c[1]);
    const float d01 = dot(c[0], c[1], c[2]);
    const float d11 = dot(c[0], c[2], c[2]);
    const float d20 = dot(c[0], p, c[1]);
    const float d21 = dot(c[0], p, c[2]);
    const float determinant = d00 * d11 - d01 * d01;
    const float v = (d11 * d20 - d01 * d21) / determinant;
    const float w = (d00 * d21 - d01 * d20) / determinant;
    return v >= 0.0F && w >= 0.0F && v + w <= 1.0F;
}

uint32_t el_triangle_barycentric_solve(const el_spot corners[3], el_hits *hits)
{
    return ask_in_box(corners, hits, weights_by_solving);
}

/* --- Edge equations ----------------------------------------------------------------------------------------------- */

/* A x + B y + C is el_side(a, b, (x, y)) less what is not inside, so that the inside is "not negative" for any rule. */
typedef struct expression {
    int64_t a, b, c;
} expression;

static expression expression_of(el_spot a, el_spot b, el_edge_rule rule)
{
    const int64_t along_x = a.y - b.y;
    const int64_t along_y = b.x - a.x;
    return (expression){along_x, along_y, -along_x * a.x - along_y * a.y - el_least_inside(a, b, rule)};
}

ALWAYS_INLINE int64_t value_at(const expression *e, el_spot p)
{
    return e->a * p.x + e->b * p.y + e->c;
}

static uint32_t evaluate_edges(const el_spot corners[3], el_edge_rule rule, el_hits *hits)
{
    el_spot c[3];
    if (!el_turn_clockwise(corners, c)) {
        return 0;
    }
    const expression e0 = expression_of(c[0], c[1], rule);
    const expression e1 = expression_of(c[1], c[2], rule);
    const expression e2 = expression_of(c[2], c[0], rule);
    const el_box box = el_box_of_spots(c, 3, hits);
    uint32_t asked = 0;
    for (int32_t row = box.y; row < box.y_end; row++) {
        for (int32_t column = box.x; column < box.x_end; column++) {
            const el_spot p = el_centre_of(column, row);
            asked++;
            /* One sign for three: the bitwise or is negative when one of them is. */
            if ((value_at(&e0, p) | value_at(&e1, p) | value_at(&e2, p)) >= 0) {
                el_hit(hits, column, row);
            }
        }
    }
    return asked;
}

uint32_t el_triangle_edges_all(const el_spot corners[3], el_hits *hits)
{
    return evaluate_edges(corners, EL_EDGES_ALL, hits);
}

uint32_t el_triangle_edges_none(const el_spot corners[3], el_hits *hits)
{
    return evaluate_edges(corners, EL_EDGES_NONE, hits);
}

uint32_t el_triangle_edges_left_top(const el_spot corners[3], el_hits *hits)
{
    return evaluate_edges(corners, EL_EDGES_LEFT_TOP, hits);
}
