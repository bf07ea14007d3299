#include "shapes.h"

static int64_t clamped(int64_t value)
{
    const int64_t most = EL_GUARD_SUB;
    return value > most ? most : (value < -most ? -most : value);
}

static point plus(point a, point b, int64_t times)
{
    return (point){a.x + b.x * times, a.y + b.y * times};
}

/* On the screen and up to `margin` pixels around it. */
static point any_point(dice *r, int64_t width, int64_t height, int64_t margin)
{
    return (point){any_between(r, -margin * EL_SUBPIXELS, (width + margin) * EL_SUBPIXELS),
                   any_between(r, -margin * EL_SUBPIXELS, (height + margin) * EL_SUBPIXELS)};
}

static point any_centre(dice *r, int64_t width, int64_t height)
{
    return centre_of(any_between(r, 0, width - 1), any_between(r, 0, height - 1));
}

static point any_step(dice *r, int64_t reach)
{
    return (point){any_between(r, -reach, reach), any_between(r, -reach, reach)};
}

/* A direction without a common factor, and a vector with direction x vector = 1 (extended Euclid). */
static point any_primitive(dice *r, int64_t reach, point *beside)
{
    const point d = any_step(r, reach);
    int64_t a = d.x;
    int64_t b = d.y;
    point at_a = {1, 0};
    point at_b = {0, 1};
    while (b != 0) {
        const int64_t quotient = a / b;
        const point next = plus(at_a, at_b, -quotient);
        at_a = at_b;
        at_b = next;
        const int64_t rest = a - quotient * b;
        a = b;
        b = rest;
    }
    if (a == 0) {
        *beside = (point){0, 1};
        return (point){1, 0};
    }
    /* d.x at_a.x + d.y at_a.y = a = +-gcd */
    const point primitive = {d.x / a, d.y / a};
    *beside = (point){-at_a.y, at_a.x};
    return primitive;
}

/* The pixel's centre is the centroid, or lies on an edge, or is a corner: a sliver has no room for it elsewhere. */
static void make_sliver(dice *r, int64_t width, int64_t height, point corners[3])
{
    const int64_t reaches[] = {8, 100, 1000, 20000};
    const point centre = any_centre(r, width, height);
    point beside;
    const point along = any_primitive(r, reaches[any_below(r, 4)] * EL_SUBPIXELS / 16, &beside);
    const int64_t thickness = any_between(r, 1, 4);
    switch (any_below(r, 4)) {
    case 0: {
        const point second = plus((point){beside.x * thickness, beside.y * thickness}, along, any_between(r, -2, 1));
        corners[0] = plus(centre, along, 1);
        corners[1] = plus(centre, second, 1);
        corners[2] = plus(plus(centre, along, -1), second, -1);
        break;
    }
    case 1:
        corners[0] = plus(centre, along, -any_between(r, 0, 2));
        corners[1] = plus(centre, along, any_between(r, 1, 2));
        corners[2] = plus(plus(centre, beside, thickness), along, any_between(r, -1, 1));
        break;
    case 2: { /* along a line through many centres */
        const point step = any_step(r, 6);
        const int64_t times = any_between(r, 1, 12);
        corners[0] = centre;
        corners[1] = plus(centre, step, EL_SUBPIXELS * times);
        corners[2] = plus(plus(centre, step, EL_SUBPIXELS * any_between(r, 0, times)), any_step(r, 2), 1);
        break;
    }
    default: { /* longer ones, whose third corner is anywhere beside the line */
        corners[0] = any_point(r, width, height, 8);
        corners[1] = any_point(r, width, height, 8);
        const double t = any_fraction(r);
        const point off = any_step(r, 3);
        corners[2].x = corners[0].x + (int64_t)((double)(corners[1].x - corners[0].x) * t) + off.x;
        corners[2].y = corners[0].y + (int64_t)((double)(corners[1].y - corners[0].y) * t) + off.y;
        break;
    }
    }
}

static void make_near_miss(dice *r, int64_t width, int64_t height, point corners[3])
{
    const int64_t reaches[] = {40, 400, 4000, 30000};
    const point centre = any_centre(r, width, height);
    point beside;
    const point along = any_primitive(r, reaches[any_below(r, 4)] * EL_SUBPIXELS / 16, &beside);
    /* along x (centre - through) = value */
    const point through = plus(centre, beside, -any_between(r, -1, 1));
    corners[0] = plus(through, along, -any_between(r, 0, 2));
    corners[1] = plus(through, along, any_between(r, 1, 2));
    corners[2] = any_point(r, width, height, 16);
}

static int64_t any_guard(dice *r)
{
    const int64_t value = any_between(r, -EL_GUARD_SUB, EL_GUARD_SUB);
    const int64_t extreme = value < 0 ? -EL_GUARD_SUB : EL_GUARD_SUB;
    return once_in(r, 3) ? extreme : value;
}

static int64_t on_centre(dice *r, int64_t value)
{
    return once_in(r, 2) ? value / EL_SUBPIXELS * EL_SUBPIXELS + EL_SUBPIXELS / 2 : value;
}

static void make_axis_aligned(dice *r, int64_t width, int64_t height, point corners[3])
{
    for (unsigned i = 0; i < 3; i += 2) {
        const point p = any_point(r, width, height, 4);
        corners[i] = (point){on_centre(r, p.x), on_centre(r, p.y)};
    }
    corners[1] = (point){corners[2].x, corners[0].y};
}

static void make_touching(dice *r, int64_t width, int64_t height, point corners[3])
{
    const bool vertical = once_in(r, 2);
    const int64_t border = once_in(r, 2) ? 0 : (vertical ? height : width) * EL_SUBPIXELS;
    const int64_t depth = once_in(r, 2) ? 1 : 60;
    for (unsigned i = 0; i < 3; i++) {
        const point p = any_point(r, width, height, 16);
        const int64_t beyond = any_between(r, -EL_SUBPIXELS, EL_SUBPIXELS * depth);
        const int64_t across = border == 0 ? -beyond : border + beyond;
        corners[i] = vertical ? (point){p.x, across} : (point){across, p.y};
    }
}

void shape_make(shape_kind kind, dice *r, int64_t width, int64_t height, point corners[3])
{
    switch (kind) {
    case SHAPE_ON_SCREEN:
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = any_point(r, width, height, 20);
        }
        break;
    case SHAPE_SMALL:
    case SHAPE_TINY: {
        const point around = any_point(r, width, height, 0);
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = plus(around, any_step(r, kind == SHAPE_TINY ? EL_SUBPIXELS : 6 * EL_SUBPIXELS), 1);
        }
        break;
    }
    case SHAPE_SLIVER:
        make_sliver(r, width, height, corners);
        break;
    case SHAPE_GUARD:
        for (unsigned i = 0; i < 3; i++) {
            corners[i] = (point){any_guard(r), any_guard(r)};
        }
        if (once_in(r, 2)) {
            corners[0] = any_point(r, width, height, 0);
        }
        break;
    case SHAPE_NEAR_MISS:
        make_near_miss(r, width, height, corners);
        break;
    case SHAPE_CENTRED: {
        const int64_t reach = once_in(r, 2) ? 8 : width;
        corners[0] = any_centre(r, width, height);
        for (unsigned i = 1; i < 3; i++) {
            corners[i] = plus(corners[0], any_step(r, reach), EL_SUBPIXELS);
        }
        break;
    }
    case SHAPE_AXIS_ALIGNED:
        make_axis_aligned(r, width, height, corners);
        break;
    case SHAPE_LONG_PRESTEP:
        corners[0] = (point){-any_between(r, EL_GUARD_SUB / 2, EL_GUARD_SUB), -any_between(r, 0, EL_GUARD_SUB)};
        corners[1] = once_in(r, 2) ? any_point(r, width, height, 8)
                                   : (point){any_between(r, 0, EL_GUARD_SUB), any_between(r, 0, EL_GUARD_SUB)};
        corners[2] = once_in(r, 2) ? any_point(r, width, height, 8)
                                   : (point){-any_between(r, 0, EL_GUARD_SUB), any_between(r, 0, EL_GUARD_SUB)};
        break;
    case SHAPE_TOUCHING:
        make_touching(r, width, height, corners);
        break;
    default:
        shape_make((shape_kind)any_below(r, SHAPE_ANY), r, width, height, corners);
        break;
    }
    for (unsigned i = 0; i < 3; i++) {
        corners[i] = (point){clamped(corners[i].x), clamped(corners[i].y)};
    }
}
