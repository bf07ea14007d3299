"""The nearest point of a set of triangles, for many points at once; exact, in any number of dimensions.

Triangles lie along a Morton curve, eight to a box, eight boxes to the next. All points go down that tree together, each
with the boxes that may still hold its nearest triangle: those no farther than a triangle that is known.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from edgeline.convert.mesh import Floats, Ints

FAN_OUT = 8
POINTS_AT_ONCE = 4096
ROUNDING = 1e-9


def _keys(points: Floats, low: Floats, high: Floats) -> Ints:
    """Places along a Morton curve through a box, of points (k, d); the nearest place for those outside."""
    dimensions = points.shape[1]
    bits = 60 // dimensions
    cells = ((points - low) / np.maximum(high - low, 1e-300)).clip(0.0, 1.0) * ((1 << bits) - 1)
    whole = cells.astype(np.int64)
    keys = np.zeros(len(points), dtype=np.int64)
    for bit in range(bits):
        for axis in range(dimensions):
            keys |= ((whole[:, axis] >> bit) & 1) << (dimensions * bit + axis)
    return keys


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray((a * b).sum(axis=-1))


def nearest_on_triangle(points: Floats, triangles: Floats) -> tuple[Floats, Floats]:
    """For pairs of points (k, d) and triangles (k, 3, d): squared distance (k,) and weights of the corners (k, 3)."""
    weights = np.zeros((len(points), 3))
    best = np.full(len(points), np.inf)
    for i in range(3):
        begin, along = triangles[:, i], triangles[:, (i + 1) % 3] - triangles[:, i]
        length = _dot(along, along)
        t = np.clip(_dot(points - begin, along) / np.where(length > 0, length, 1.0), 0.0, 1.0)
        offset = begin + along * t[:, None] - points
        squared = _dot(offset, offset)
        closer = squared < best
        best = np.where(closer, squared, best)
        candidate = np.zeros_like(weights)
        candidate[:, i], candidate[:, (i + 1) % 3] = 1.0 - t, t
        weights = np.where(closer[:, None], candidate, weights)
    a, u, v = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    p = points - a
    uu, uv, vv, pu, pv = _dot(u, u), _dot(u, v), _dot(v, v), _dot(p, u), _dot(p, v)
    area = uu * vv - uv * uv
    safe = np.where(area > 0, area, 1.0)
    s, t = (pu * vv - pv * uv) / safe, (pv * uu - pu * uv) / safe
    offset = a + u * s[:, None] + v * t[:, None] - points
    squared = _dot(offset, offset)
    inside = (area > 0) & (s >= 0) & (t >= 0) & (s + t <= 1) & (squared < best)
    face = np.stack([1.0 - s - t, s, t], axis=1)
    return np.where(inside, squared, best), np.where(inside[:, None], face, weights)


class Surface:
    """Triangles (m, 3, d) to measure distances to."""

    def __init__(self, triangles: Floats) -> None:
        middles = triangles.mean(axis=1)
        self.low, self.high = middles.min(axis=0), middles.max(axis=0)
        keys = _keys(middles, self.low, self.high)
        self.order = np.argsort(keys, kind="stable").astype(np.int64)
        self.keys = keys[self.order]
        self.triangles = triangles[self.order]
        boxes = [(self.triangles.min(axis=1), self.triangles.max(axis=1))]
        while len(boxes[0][0]) > FAN_OUT:
            low, high = boxes[0]
            starts = np.arange(0, len(low), FAN_OUT)
            boxes.insert(0, (np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)))
        self.boxes = boxes
        """Lower and upper corners of boxes, level by level, those of the triangles last."""

    def nearest(self, points: Floats, tick: Callable[[int], None] = lambda count: None) -> tuple[Floats, Ints, Floats]:
        """For points (k, d): the distance (k,), the triangle's number (k,), the weights of its corners (k, 3).

        `tick` is told how many points are done, some at a time.
        """
        parts = []
        for first in range(0, len(points), POINTS_AT_ONCE):
            group = points[first : first + POINTS_AT_ONCE]
            parts.append(self._nearest(group))
            tick(len(group))
        squared, numbers, weights = (np.concatenate(column) for column in zip(*parts, strict=True))
        return np.sqrt(squared), numbers, weights

    def _nearest(self, points: Floats) -> tuple[Floats, Ints, Floats]:
        who = np.repeat(np.arange(len(points)), len(self.boxes[0][0]))
        box = np.tile(np.arange(len(self.boxes[0][0])), len(points))
        # What lies beside a point on the curve is mostly near, and nothing farther has to be looked at.
        beside = np.searchsorted(self.keys, _keys(points, self.low, self.high)).clip(0, len(self.keys) - 1)
        known = nearest_on_triangle(points, self.triangles[beside])[0]
        reach = known * (1 + ROUNDING) + (ROUNDING * float(np.abs(points).max())) ** 2
        for level, (low, high) in enumerate(self.boxes):
            if level > 0:
                who = np.repeat(who, FAN_OUT)
                box = (box[:, None] * FAN_OUT + np.arange(FAN_OUT)).reshape(-1)
                there = box < len(low)
                who, box = who[there], box[there]
            p = points[who]
            below, above = low[box] - p, p - high[box]
            near = np.maximum(np.maximum(below, above), 0.0)
            kept = _dot(near, near) <= reach[who]
            who, box = who[kept], box[kept]
        squared, weights = nearest_on_triangle(points[who], self.triangles[box])
        # The nearest of each point; the one that comes first in the file among equals.
        rows = np.lexsort((self.order[box], squared, who))
        first = rows[np.unique(who[rows], return_index=True)[1]]
        return squared[first], self.order[box[first]], weights[first]
