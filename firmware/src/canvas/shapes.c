/* Curves by chords. */
#include "canvas/shapes.h"

#include "base/fixed.h"
#include "canvas/polygon_rows.h"

/* No polygon takes points that are further out: what is larger may be cut down to this without a change. */
enum { FAR = 4 * EL_GUARD_SUB };

static int32_t within(int32_t value, int32_t least, int32_t most)
{
    return el_max_i32(least, el_min_i32(value, most));
}

/* A chord over an angle of 2 pi / n is r (1 - cos(pi / n)) away from its arc, at most r pi^2 / (2 n^2): 1/16 px for
 * n^2 = 8 pi^2 r = 78.96 r, r in pixels. */
uint32_t el_round_points(int32_t rx, int32_t ry)
{
    const uint32_t radius = (uint32_t)within(el_max_i32(rx, ry), 0, EL_GUARD_SUB);
    const uint32_t points = el_sqrt_u64(((uint64_t)radius * 79U) >> EL_SUBPIXEL_BITS) + 1U;
    return points < 8 ? 8 : (points + 3U) / 4U * 4U;
}

/* radius * ratio, rounded to nearest; below 2^22 * 2^30. */
static int32_t scaled(int32_t radius, int32_t ratio_q30)
{
    return (int32_t)(((int64_t)radius * ratio_q30 + (1 << 29)) >> 30);
}

static void add_point(el_polygon *polygon, int32_t x, int32_t y, int32_t rx, int32_t ry, el_angle angle)
{
    el_polygon_line(polygon, x + scaled(rx, el_cos_q30(angle)), y + scaled(ry, el_sin_q30(angle)));
}

/* Points from `from` to from + sweep, both, `steps` apart; backwards if `back`. `sweep` may be a whole turn. */
static void add_arc(el_polygon *polygon, int32_t x, int32_t y, int32_t rx, int32_t ry, el_angle from, uint64_t sweep,
                    uint32_t steps, bool back)
{
    for (uint32_t i = 0; i <= steps; i++) {
        const uint32_t at = back ? steps - i : i;
        add_point(polygon, x, y, rx, ry, from + (el_angle)(sweep * at / steps)); /* below 2^32 * 408 */
    }
}

/* The next point begins a contour. */
static void begin_contour(el_polygon *polygon, int32_t x, int32_t y, int32_t rx, int32_t ry, el_angle angle)
{
    el_polygon_move(polygon, x + scaled(rx, el_cos_q30(angle)), y + scaled(ry, el_sin_q30(angle)));
}

/* Four edges at a time, one in each quarter: a sine and a cosine serve four points. The filler takes edges in any order. */
void el_polygon_ellipse(el_polygon *polygon, int32_t x, int32_t y, int32_t rx, int32_t ry)
{
    const int32_t radii[2] = {within(rx, 0, FAR), within(ry, 0, FAR)};
    const int32_t centre[2] = {within(x, -FAR, FAR), within(y, -FAR, FAR)};
    const uint32_t steps = el_round_points(radii[0], radii[1]) / 4U;
    int32_t cosine = 1 << 30;
    int32_t sine = 0;
    el_polygon_close(polygon);
    for (uint32_t i = 1; i <= steps; i++) {
        /* The quarter's end exactly, where the next one begins. */
        const el_angle angle = (el_angle)(((uint64_t)i << 30) / steps);
        const int32_t next_cosine = i < steps ? el_cos_q30(angle) : 0;
        const int32_t next_sine = i < steps ? el_sin_q30(angle) : 1 << 30;
        for (unsigned quarter = 0; quarter < 4; quarter++) {
            const int32_t ends[2][2] = {{cosine, sine}, {next_cosine, next_sine}};
            int32_t points[2][2];
            for (unsigned k = 0; k < 2; k++) {
                const bool odd = (quarter & 1U) != 0; /* a quarter of a turn: (x, y) to (-y, x) */
                const int32_t across = odd ? -ends[k][1] : ends[k][0];
                const int32_t down = odd ? ends[k][0] : ends[k][1];
                points[k][0] = centre[0] + scaled(radii[0], quarter < 2 ? across : -across);
                points[k][1] = centre[1] + scaled(radii[1], quarter < 2 ? down : -down);
            }
            el_polygon_add_edge(polygon, points[0], points[1]);
        }
        cosine = next_cosine;
        sine = next_sine;
    }
}

void el_polygon_sector(el_polygon *polygon, int32_t x, int32_t y, int32_t outer, int32_t inner, el_angle from,
                       el_angle sweep)
{
    const int32_t centre[2] = {within(x, -FAR, FAR), within(y, -FAR, FAR)};
    const int32_t radius = within(outer, 0, FAR);
    const int32_t hole = within(inner, 0, radius);
    const uint32_t steps = (uint32_t)(((uint64_t)el_round_points(radius, radius) * sweep) >> 32) + 1U;
    begin_contour(polygon, centre[0], centre[1], radius, radius, from);
    add_arc(polygon, centre[0], centre[1], radius, radius, from, sweep, steps, false);
    add_arc(polygon, centre[0], centre[1], hole, hole, from, sweep, hole > 0 ? steps : 1U, true);
}

void el_polygon_rectangle(el_polygon *polygon, int32_t x, int32_t y, int32_t x_end, int32_t y_end, int32_t radius)
{
    const int32_t left = within(x, -FAR, FAR);
    const int32_t top = within(y, -FAR, FAR);
    const int32_t right = within(x_end, -FAR, FAR);
    const int32_t bottom = within(y_end, -FAR, FAR);
    const int32_t r = within(radius, 0, el_min_i32(right - left, bottom - top) / 2);
    if (left >= right || top >= bottom) {
        return;
    }
    if (r == 0) {
        el_polygon_move(polygon, left, top);
        el_polygon_line(polygon, right, top);
        el_polygon_line(polygon, right, bottom);
        el_polygon_line(polygon, left, bottom);
        return;
    }
    const uint32_t steps = el_round_points(r, r) / 4U;
    begin_contour(polygon, right - r, bottom - r, r, r, 0);
    for (unsigned corner = 0; corner < 4; corner++) {
        const bool is_left = corner == 1 || corner == 2;
        add_arc(polygon, is_left ? left + r : right - r, corner >= 2 ? top + r : bottom - r, r, r, corner << 30,
                1U << 30, steps, false);
    }
}
