/* Segments, joins and caps, each a convex contour, all clockwise on the screen: under the non-zero rule they are the union
 * of what they cover, whatever lies over what. */
#include "canvas/stroke.h"

#include "base/fixed.h"
#include "canvas/shapes.h"

typedef struct vector {
    int32_t x, y;
} vector;

/* What points and what is made of them stay within: products below are of 23 bits and 24. */
enum { FAR = 4 * EL_GUARD_SUB };

static vector point_at(const int32_t (*points)[2], uint32_t i)
{
    return (vector){el_max_i32(-FAR, el_min_i32(points[i][0], FAR)), el_max_i32(-FAR, el_min_i32(points[i][1], FAR))};
}

static vector sum(vector a, vector b)
{
    return (vector){a.x + b.x, a.y + b.y};
}

static vector negative(vector a)
{
    return (vector){-a.x, -a.y};
}

/* Clockwise on the screen, if b is to the right of a: above 0. */
static int64_t cross(vector a, vector b)
{
    return (int64_t)a.x * b.y - (int64_t)a.y * b.x;
}

/* A convex contour, turned clockwise: rounding may have turned a sliver. */
static void add_convex(el_polygon *polygon, const vector *corners, uint32_t count)
{
    int64_t area = 0;
    for (uint32_t i = 2; i < count; i++) {
        area += cross(sum(corners[i - 1], negative(corners[0])), sum(corners[i], negative(corners[0])));
    }
    for (uint32_t i = 0; i < count && area != 0; i++) {
        const vector corner = corners[area > 0 ? i : count - 1U - i];
        if (i == 0) {
            el_polygon_move(polygon, corner.x, corner.y);
        } else {
            el_polygon_line(polygon, corner.x, corner.y);
        }
    }
}

/* n / d, rounded to nearest, d > 0. */
static int32_t rounded(int64_t n, int64_t d)
{
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): d > 0. */
    return (int32_t)(n >= 0 ? (n + d / 2) / d : -((-n + d / 2) / d));
}

/* From the middle of the line to its left side: half the width, at a right angle to `along`, which is not 0. */
static vector side_of(vector along, uint32_t width)
{
    const uint64_t square = (uint64_t)((int64_t)along.x * along.x) + (uint64_t)((int64_t)along.y * along.y); /* 2^47 */
    const int64_t length_q8 = el_sqrt_u64(square << 16);
    /* 2^23 * 2^16 * 2^7 */
    return (vector){rounded((int64_t)along.y * width * 128, length_q8),
                    rounded((int64_t)-along.x * width * 128, length_q8)};
}

static void add_circle(el_polygon *polygon, vector at, uint32_t width)
{
    el_polygon_ellipse(polygon, at.x, at.y, (int32_t)((width + 1U) / 2U), (int32_t)((width + 1U) / 2U));
}

/* What is missing between two segments that meet at `at`, on the outer side of the bend. */
static void add_join(el_polygon *polygon, vector at, vector before, vector after, const el_stroke *stroke)
{
    if (stroke->join == EL_JOIN_ROUND) {
        add_circle(polygon, at, stroke->width);
        return;
    }
    const int64_t bend = cross(before, after);
    const vector a = bend > 0 ? before : negative(before);
    const vector b = bend > 0 ? after : negative(after);
    const int64_t square = (int64_t)a.x * a.x + (int64_t)a.y * a.y;
    const int64_t cosine = (int64_t)a.x * b.x + (int64_t)a.y * b.y;
    const int64_t limit = stroke->miter == 0 ? 4 : stroke->miter;
    /* The tip is (a + b) square / (square + cosine) away, and the miter sqrt(2 square / (square + cosine)) widths long;
     * with `square` up to 2^31. */
    const int64_t both = square + cosine;
    if (stroke->join == EL_JOIN_MITER && both > 0 && 2 * square <= limit * limit * both) {
        const vector tip = {rounded((a.x + b.x) * square, both), rounded((a.y + b.y) * square, both)};
        add_convex(polygon, (const vector[]){at, sum(at, a), sum(at, tip), sum(at, b)}, 4);
    } else {
        add_convex(polygon, (const vector[]){at, sum(at, a), sum(at, b)}, 3);
    }
}

/* The end of a line at `at`; `side` is that of the segment which it ends, or begins. */
static void add_cap(el_polygon *polygon, vector at, vector side, bool is_end, const el_stroke *stroke)
{
    if (stroke->cap == EL_CAP_ROUND) {
        add_circle(polygon, at, stroke->width);
    } else if (stroke->cap == EL_CAP_SQUARE) {
        const vector forward = {-side.y, side.x};
        const vector beyond = sum(at, is_end ? forward : negative(forward));
        add_convex(
            polygon,
            (const vector[]){sum(at, side), sum(beyond, side), sum(beyond, negative(side)), sum(at, negative(side))},
            4);
    }
}

void el_polygon_stroke(el_polygon *polygon, const int32_t (*points)[2], uint32_t count, bool closed,
                       const el_stroke *stroke)
{
    if (count == 0 || stroke->width == 0) {
        return;
    }
    const vector start = point_at(points, 0);
    vector at = start;
    vector first_side = {0, 0};
    vector side = {0, 0};
    bool has_segment = false;
    for (uint32_t i = 1; i < count + (closed ? 1U : 0U); i++) {
        const vector to = i < count ? point_at(points, i) : start;
        const vector along = sum(to, negative(at));
        if (along.x == 0 && along.y == 0) {
            continue;
        }
        const vector next_side = side_of(along, stroke->width);
        if (!has_segment) {
            first_side = next_side;
        } else {
            add_join(polygon, at, side, next_side, stroke);
        }
        add_convex(polygon,
                   (const vector[]){sum(at, next_side), sum(to, next_side), sum(to, negative(next_side)),
                                    sum(at, negative(next_side))},
                   4);
        side = next_side;
        at = to;
        has_segment = true;
    }
    if (!has_segment) {
        side = first_side = (vector){0, -(int32_t)((stroke->width + 1U) / 2U)};
    }
    if (closed && has_segment) {
        add_join(polygon, start, side, first_side, stroke);
    } else {
        add_cap(polygon, start, first_side, false, stroke);
        add_cap(polygon, at, side, true, stroke);
    }
}
