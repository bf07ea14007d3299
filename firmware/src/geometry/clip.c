#include "geometry/clip.h"

#include "base/fixed.h"

typedef enum plane { PLANE_NEAR, PLANE_FAR, PLANE_LEFT, PLANE_RIGHT, PLANE_BELOW, PLANE_ABOVE, PLANE_COUNT } plane;

/* How far inside a vertex is; outside where negative. At most 2^30 * 2^12. */
static int64_t inside(const el_transform *transform, const el_clip_vertex *v, plane which)
{
    const int64_t x_limit = (int64_t)v->w * (1 << transform->guard_shift[0]);
    const int64_t y_limit = (int64_t)v->w * (1 << transform->guard_shift[1]);
    switch (which) {
    case PLANE_NEAR:
        return (int64_t)v->d - transform->near;
    case PLANE_FAR:
        return (int64_t)transform->far - v->d;
    case PLANE_LEFT:
        return x_limit + v->x;
    case PLANE_RIGHT:
        return x_limit - v->x;
    case PLANE_BELOW:
        return y_limit + v->y;
    default:
        return y_limit - v->y;
    }
}

/* from + (to - from) * t / 2^31, to the nearest. */
static int32_t mix(int32_t from, int32_t to, int64_t t_q31)
{
    const int64_t difference = (int64_t)to - from; /* below 2^32, t at most 2^31 */
    return (int32_t)(from + ((difference * t_q31 + (1LL << 30)) >> 31));
}

/* The vertex where the edge from `a` (inside by da >= 0) to `b` (outside by db < 0) meets the plane. It is moved onto
 * the plane exactly, so that no later test sees rounding. */
static el_clip_corner cut(const el_transform *transform, const el_clip_corner *a, int64_t da, const el_clip_corner *b,
                          int64_t db, plane which)
{
    const uint64_t whole = (uint64_t)(da - db);
    const int excess = el_bit_length_u64(whole) - 32;
    const int shift = excess > 0 ? excess : 0;
    const int64_t t_q31 = (int64_t)((((uint64_t)da >> shift) << 31) / (whole >> shift));

    el_clip_corner corner;
    corner.position.x = mix(a->position.x, b->position.x, t_q31);
    corner.position.y = mix(a->position.y, b->position.y, t_q31);
    corner.position.d = mix(a->position.d, b->position.d, t_q31);
    if (which == PLANE_NEAR) {
        corner.position.d = transform->near;
    } else if (which == PLANE_FAR) {
        corner.position.d = transform->far;
    }
    corner.position.w = transform->orthographic ? transform->constant_w : corner.position.d;
    const int64_t x_limit = (int64_t)corner.position.w * (1 << transform->guard_shift[0]);
    const int64_t y_limit = (int64_t)corner.position.w * (1 << transform->guard_shift[1]);
    if (which == PLANE_LEFT || which == PLANE_RIGHT) {
        corner.position.x = (int32_t)(which == PLANE_LEFT ? -x_limit : x_limit);
    } else if (which == PLANE_BELOW || which == PLANE_ABOVE) {
        corner.position.y = (int32_t)(which == PLANE_BELOW ? -y_limit : y_limit);
    }
    for (unsigned i = 0; i < EL_CLIP_ATTRIBUTES; i++) {
        corner.attributes[i] = mix(a->attributes[i], b->attributes[i], t_q31);
    }
    return corner;
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
                       plane which)
{
    el_clip_corner kept[EL_CLIP_MAX_VERTICES];
    unsigned n = 0;
    const el_clip_corner *previous = &corners[count - 1];
    int64_t previous_inside = inside(transform, &previous->position, which);
    for (unsigned i = 0; i < count; i++) {
        const el_clip_corner *current = &corners[i];
        const int64_t current_inside = inside(transform, &current->position, which);
        if (previous_inside >= 0 && current_inside < 0) {
            const el_clip_corner corner = cut(transform, previous, previous_inside, current, current_inside, which);
            n = push(kept, n, &corner);
        } else if (previous_inside < 0 && current_inside >= 0) {
            const el_clip_corner corner = cut(transform, current, current_inside, previous, previous_inside, which);
            n = push(kept, n, &corner);
        }
        if (current_inside >= 0) {
            n = push(kept, n, current);
        }
        previous = current;
        previous_inside = current_inside;
    }
    for (unsigned i = 0; i < n; i++) {
        corners[i] = kept[i];
    }
    return n;
}

static int32_t clamp_to(int32_t value, int64_t limit)
{
    if (value > limit) {
        return (int32_t)limit;
    }
    return value < -limit ? (int32_t)-limit : value;
}

unsigned el_clip_polygon(const el_transform *transform, el_clip_corner corners[EL_CLIP_MAX_VERTICES], unsigned count,
                         uint8_t codes)
{
    for (unsigned which = 0; which < PLANE_COUNT && count >= 3; which++) {
        /* The near plane can bring vertices beyond the guard band that no original vertex was. */
        const bool wanted = which == PLANE_NEAR  ? (codes & EL_CODE_NEAR) != 0
                            : which == PLANE_FAR ? (codes & EL_CODE_FAR) != 0
                                                 : (codes & (EL_CODE_NEAR | EL_CODE_GUARD)) != 0;
        if (wanted) {
            count = cut_at(transform, corners, count, (plane)which);
        }
    }
    /* A corner on one side plane that was then cut at another may have left the first by a unit. Where w is small that
     * is far on the screen, so it is put back, alike in both triangles of its edge. */
    for (unsigned i = 0; i < count; i++) {
        el_clip_vertex *v = &corners[i].position;
        v->x = clamp_to(v->x, (int64_t)v->w * (1 << transform->guard_shift[0]));
        v->y = clamp_to(v->y, (int64_t)v->w * (1 << transform->guard_shift[1]));
    }
    return count >= 3 ? count : 0;
}
