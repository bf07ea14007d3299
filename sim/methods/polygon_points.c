/* Polygons by asking of one pixel after the other whether its centre is inside, and the table of all polygon methods. */
#include <math.h>

#include "methods/polygons.h"

void el_polygon_add(el_polygon *polygon, const el_spot *spots, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        polygon->edges[polygon->edge_count++] = (struct el_polygon_edge){spots[i], spots[(i + 1) % count]};
    }
}

el_box el_box_of_polygon(const el_polygon *polygon, const el_hits *hits)
{
    _Static_assert(sizeof(polygon->edges[0]) == 2 * sizeof(el_spot), "edges are pairs of spots");
    return el_box_of_spots(&polygon->edges[0].a, 2 * polygon->edge_count, hits);
}

typedef bool inside_test(const el_polygon *polygon, el_fill_rule rule, el_spot p);

#define ALWAYS_INLINE static inline __attribute__((always_inline))

ALWAYS_INLINE uint32_t ask(const el_polygon *polygon, el_fill_rule rule, el_hits *hits, inside_test *inside)
{
    const el_box box = el_box_of_polygon(polygon, hits);
    uint32_t asked = 0;
    for (int32_t row = box.y; row < box.y_end; row++) {
        for (int32_t column = box.x; column < box.x_end; column++) {
            asked++;
            if (inside(polygon, rule, el_centre_of(column, row))) {
                el_hit(hits, column, row);
            }
        }
    }
    return asked;
}

/* The end that lies higher on the screen first. */
static inline struct el_polygon_edge downwards(struct el_polygon_edge edge)
{
    return edge.a.y < edge.b.y ? edge : (struct el_polygon_edge){edge.b, edge.a};
}

/* --- Ray crossing ------------------------------------------------------------------------------------------------- */

static inline bool reaches_ray(struct el_polygon_edge edge, el_spot p)
{
    const struct el_polygon_edge e = downwards(edge);
    return e.a.y != e.b.y && e.a.y <= p.y && p.y <= e.b.y && el_side(e.a, e.b, p) <= 0;
}

ALWAYS_INLINE bool odd_reaches(const el_polygon *polygon, el_fill_rule rule, el_spot p)
{
    (void)rule;
    bool inside = false;
    for (size_t i = 0; i < polygon->edge_count; i++) {
        inside ^= reaches_ray(polygon->edges[i], p);
    }
    return inside;
}

uint32_t el_polygon_ray_naive(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    return ask(polygon, rule, hits, odd_reaches);
}

static inline bool crosses_ray(struct el_polygon_edge edge, el_spot p)
{
    const struct el_polygon_edge e = downwards(edge);
    if (e.b.y <= p.y || e.a.y > p.y) {
        return false; /* above or below the ray, level with it, or its lower end touches the ray from above */
    }
    if (e.a.y == p.y) {
        return e.a.x <= p.x; /* the ray passes through the corner from which the edge goes down */
    }
    return el_side(e.a, e.b, p) <= 0;
}

ALWAYS_INLINE bool odd_crossings(const el_polygon *polygon, el_fill_rule rule, el_spot p)
{
    (void)rule;
    bool inside = false;
    for (size_t i = 0; i < polygon->edge_count; i++) {
        inside ^= crosses_ray(polygon->edges[i], p);
    }
    return inside;
}

uint32_t el_polygon_ray_cases(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    return ask(polygon, rule, hits, odd_crossings);
}

/* --- Winding ------------------------------------------------------------------------------------------------------ */

static inline bool is_inside(long turns, el_fill_rule rule)
{
    return rule == EL_FILL_EVEN_ODD ? (turns & 1) != 0 : turns != 0;
}

ALWAYS_INLINE bool angle_of_turns(const el_polygon *polygon, el_fill_rule rule, el_spot p)
{
    static const double turn = 6.283185307179586;
    double sum = 0.0;
    for (size_t i = 0; i < polygon->edge_count; i++) {
        const double ax = polygon->edges[i].a.x - p.x;
        const double ay = polygon->edges[i].a.y - p.y;
        const double bx = polygon->edges[i].b.x - p.x;
        const double by = polygon->edges[i].b.y - p.y;
        /* + 0.0 makes -0 a 0: the half turn of a point on the edge is one to the right, however the edge runs. */
        sum += atan2(ax * by - ay * bx + 0.0, ax * bx + ay * by);
    }
    return is_inside(lround(sum / turn), rule);
}

uint32_t el_polygon_winding_angle(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    return ask(polygon, rule, hits, angle_of_turns);
}

ALWAYS_INLINE bool number_of_turns(const el_polygon *polygon, el_fill_rule rule, el_spot p)
{
    long turns = 0;
    for (size_t i = 0; i < polygon->edge_count; i++) {
        const el_spot a = polygon->edges[i].a;
        const el_spot b = polygon->edges[i].b;
        if (a.y <= p.y && b.y > p.y) {
            turns += el_side(a, b, p) <= 0;
        } else if (b.y <= p.y && a.y > p.y) {
            turns -= el_side(b, a, p) <= 0;
        }
    }
    return is_inside(turns, rule);
}

uint32_t el_polygon_winding_number(const el_polygon *polygon, el_fill_rule rule, el_hits *hits)
{
    return ask(polygon, rule, hits, number_of_turns);
}

const el_polygon_method el_polygon_methods[EL_POLYGON_METHODS] = {
    {"ray-naive", "ray, corners ignored", "int64", EL_FILL_EVEN_ODD, false, el_polygon_ray_naive},
    {"ray-cases", "ray, corner cases", "int64", EL_FILL_EVEN_ODD, true, el_polygon_ray_cases},
    {"angle-even-odd", "winding angle", "double", EL_FILL_EVEN_ODD, false, el_polygon_winding_angle},
    {"angle-non-zero", "winding angle", "double", EL_FILL_NON_ZERO, false, el_polygon_winding_angle},
    {"number-even-odd", "winding number", "int64", EL_FILL_EVEN_ODD, true, el_polygon_winding_number},
    {"number-non-zero", "winding number", "int64", EL_FILL_NON_ZERO, true, el_polygon_winding_number},
    {"scanline-even-odd", "scanline over all edges", "int64", EL_FILL_EVEN_ODD, true, el_polygon_scanline},
    {"scanline-non-zero", "scanline over all edges", "int64", EL_FILL_NON_ZERO, true, el_polygon_scanline},
    {"active-even-odd", "active edge table", "int32", EL_FILL_EVEN_ODD, true, el_polygon_active_edges},
    {"active-non-zero", "active edge table", "int32", EL_FILL_NON_ZERO, true, el_polygon_active_edges},
    {"complement", "edge complement", "int64", EL_FILL_EVEN_ODD, true, el_polygon_complement},
    {"fence", "fence", "int64", EL_FILL_EVEN_ODD, true, el_polygon_fence},
    {"edge-flag", "edge flag", "int64", EL_FILL_EVEN_ODD, true, el_polygon_edge_flag},
};
