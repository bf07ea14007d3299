#include "geometry/clip.h"

#include <string.h>

#include "base/divide.h"

/* Two planes for each coordinate that is cut, d first, then x and y: a lower one with an even number, an upper one. */
enum { PLANE_NEAR, PLANE_FAR, PLANE_COUNT = 6 };

static int32_t *coordinate(el_clip_vertex *v, unsigned plane)
{
    return plane <= PLANE_FAR ? &v->d : (plane < 4 ? &v->x : &v->y);
}

/* Where the plane cuts a vertex' coordinate: at most 2^30 * 2^12. */
static int64_t limit(const el_transform *transform, const el_clip_vertex *v, unsigned plane)
{
    if (plane <= PLANE_FAR) {
        return plane == PLANE_NEAR ? transform->near : transform->far;
    }
    const int64_t side = (int64_t)v->w * (1 << transform->guard_shift[plane / 2 - 1]);
    return (plane & 1U) == 0 ? -side : side;
}

/* How far inside a vertex is; outside where negative. */
static int64_t inside(const el_transform *transform, el_clip_vertex *v, unsigned plane)
{
    const int64_t beyond_lower = *coordinate(v, plane) - limit(transform, v, plane);
    return (plane & 1U) == 0 ? beyond_lower : -beyond_lower;
}

static void put_onto(const el_transform *transform, el_clip_vertex *v, unsigned plane)
{
    *coordinate(v, plane) = (int32_t)limit(transform, v, plane);
}

/* from + (to - from) * t / 2^31, to the nearest. */
static int32_t mix(int32_t from, int32_t to, int64_t t_q31)
{
    const int64_t difference = (int64_t)to - from; /* below 2^32, t at most 2^31 */
    return (int32_t)(from + ((difference * t_q31 + (1LL << 30)) >> 31));
}

/* The vertex where the edge from `a` (inside by da >= 0) to `b` (outside by db < 0) meets the plane. It is moved onto
 * the plane exactly, so that no later test sees rounding. */
static void cut(const el_transform *transform, const el_clip_corner *a, int64_t da, const el_clip_corner *b, int64_t db,
                unsigned plane, el_clip_corner *corner)
{
    const uint64_t whole = (uint64_t)(da - db);
    const int shift = el_max_i32(0, el_bit_length_u64(whole) - 32);
    const el_divisor divisor = el_divisor_make((uint32_t)(whole >> shift));
    const int64_t t_q31 = el_divide_u64((((uint64_t)da >> shift) << 31), &divisor); /* da <= whole: at most 2^31 */

    corner->position.x = mix(a->position.x, b->position.x, t_q31);
    corner->position.y = mix(a->position.y, b->position.y, t_q31);
    corner->position.d = mix(a->position.d, b->position.d, t_q31);
    corner->position.w = 0;
    if (plane <= PLANE_FAR) {
        put_onto(transform, &corner->position, plane);
    }
    corner->position.w = el_transform_is_orthographic(transform) ? transform->constant_w : corner->position.d;
    if (plane > PLANE_FAR) {
        put_onto(transform, &corner->position, plane);
    }
    for (int i = 0; i < EL_CLIP_ATTRIBUTES; i++) {
        corner->attributes[i] = mix(a->attributes[i], b->attributes[i], t_q31);
    }
}

/* A convex polygon gains at most one vertex at a plane. Rounding can make it concave by a unit, so the room is checked. */
static unsigned push(el_clip_corner corners[EL_CLIP_MAX_VERTICES], unsigned n, const el_clip_corner *corner)
{
    if (n == EL_CLIP_MAX_VERTICES) {
        return n;
    }
    corners[n] = *corner;
    return n + 1;
}

static unsigned cut_at(const el_transform *transform, el_clip_corner corners[EL_CLIP_MAX_VERTICES], unsigned count,
                       unsigned plane)
{
    el_clip_corner kept[EL_CLIP_MAX_VERTICES];
    unsigned n = 0;
    el_clip_corner *previous = &corners[count - 1];
    int64_t previous_inside = inside(transform, &previous->position, plane);
    for (unsigned i = 0; i < count; i++) {
        el_clip_corner *current = &corners[i];
        const int64_t current_inside = inside(transform, &current->position, plane);
        if ((previous_inside < 0) != (current_inside < 0)) {
            el_clip_corner corner;
            if (current_inside < 0) {
                cut(transform, previous, previous_inside, current, current_inside, plane, &corner);
            } else {
                cut(transform, current, current_inside, previous, previous_inside, plane, &corner);
            }
            n = push(kept, n, &corner);
        }
        if (current_inside >= 0) {
            n = push(kept, n, current);
        }
        previous = current;
        previous_inside = current_inside;
    }
    memcpy(corners, kept, n * sizeof kept[0]);
    return n;
}

unsigned el_clip_polygon(const el_transform *transform, el_clip_corner corners[EL_CLIP_MAX_VERTICES], unsigned count,
                         uint8_t codes)
{
    for (unsigned plane = 0; plane < PLANE_COUNT && count >= 3; plane++) {
        /* The near plane can bring vertices beyond the guard band that no original vertex was. */
        const unsigned cuts = plane == PLANE_NEAR  ? EL_CODE_NEAR
                              : plane == PLANE_FAR ? EL_CODE_FAR
                                                   : EL_CODE_NEAR | EL_CODE_GUARD;
        if ((codes & cuts) != 0) {
            count = cut_at(transform, corners, count, plane);
        }
    }
    /* A corner on one side plane that was then cut at another may have left the first by a unit. Where w is small that
     * is far on the screen, so it is put back, alike in both triangles of its edge. */
    for (unsigned i = 0; i < count; i++) {
        for (unsigned plane = PLANE_FAR + 1; plane < PLANE_COUNT; plane++) {
            if (inside(transform, &corners[i].position, plane) < 0) {
                put_onto(transform, &corners[i].position, plane);
            }
        }
    }
    return count >= 3 ? count : 0;
}
