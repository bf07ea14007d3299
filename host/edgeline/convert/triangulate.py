"""Polygons, concave ones too, into triangles: ear clipping (Meisters, "Polygons have ears", 1975), in the plane of two
axes that shows the polygon best.

Of the possible ears the one with the shortest new edge goes first, which gives convex polygons, quads above all, the
better-shaped triangles. A polygon that crosses itself has no good answer; it still ends, with as many triangles.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import Floats

Triangle = tuple[int, int, int]


def newell_normal(points: Floats) -> Floats:
    """The normal of a polygon (n, 3), its length twice the area; exact for planes, the mean for others (Newell)."""
    following = np.roll(points, -1, axis=0)
    return np.asarray(np.cross(points, following).sum(axis=0))


def flatten(points: Floats) -> Floats:
    """The polygon (n, 3) without the axis its normal is longest on, (n, 2), such that it runs counter-clockwise."""
    normal = newell_normal(points - points[0])
    axis = int(np.argmax(np.abs(normal)))
    kept = [(axis + 1) % 3, (axis + 2) % 3]
    return points[:, kept if normal[axis] >= 0 else kept[::-1]]


def turn(a: Floats, b: Floats, c: Floats) -> Floats:
    """Twice the signed area of the triangles a, b, c (..., 2): above 0 is counter-clockwise."""
    ab, ac = b - a, c - a
    return np.asarray(ab[..., 0] * ac[..., 1] - ab[..., 1] * ac[..., 0])


def holds_a_point(a: Floats, b: Floats, c: Floats, points: Floats) -> bool:
    """Whether one of `points` lies in the counter-clockwise triangle, edges included, its corners not."""
    inside: npt.NDArray[np.bool_] = (turn(a, b, points) >= 0) & (turn(b, c, points) >= 0) & (turn(c, a, points) >= 0)
    for corner in (a, b, c):
        inside &= np.any(points != corner, axis=1)
    return bool(inside.any())


def next_ear(points: Floats) -> int:
    """The corner of the polygon (n, 2) to cut off: an ear if there is one, the flattest corner otherwise."""
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    turns = turn(before, points, after)
    lengths = ((after - before) ** 2).sum(axis=1)
    for i in np.argsort(lengths, kind="stable"):
        if turns[i] > 0 and not holds_a_point(before[i], points[i], after[i], points):
            return int(i)
    return int(np.argmin(np.abs(turns)))


def triangulate(points: Floats) -> list[Triangle]:
    """n - 2 triangles, as indices of `points` (n, 3), with the polygon's winding."""
    left = list(range(len(points)))
    if len(left) == 3:
        return [(0, 1, 2)]
    flat = flatten(points)
    triangles: list[Triangle] = []
    while len(left) > 3:
        ear = next_ear(flat[left])
        triangles.append((left[ear - 1], left[ear], left[(ear + 1) % len(left)]))
        del left[ear]
    triangles.append((left[0], left[1], left[2]))
    return triangles
