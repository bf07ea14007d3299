"""Which pixels a triangle covers, in exact integers, by the definition of the top-left rule and by nothing else.

Screen coordinates are integers of 1/16 px, y down; pixel (i, j) has its centre at (16 i + 8, 16 j + 8). A triangle
covers a pixel whose centre lies inside of it; a centre that lies on an edge counts when that edge is

* a left edge: from it, the inside is to the right, that is, E grows with x;
* a top edge: it is horizontal and the inside is below, that is, E does not change with x and grows with y;

where E is the edge function, positive inside. Both windings are drawn, zero area is nothing.

int64 is enough: with every coordinate within GUARD and every centre within the largest target, a difference of two
is below 2^17, a product below 2^34, E below 2^35. `check_domain` asserts just that.
"""

from __future__ import annotations

import zlib

import numpy as np
import numpy.typing as npt

from sim_commands import SUBPIXELS, Ints

GUARD = 2040 * SUBPIXELS
"""The guard band: vertices lie within +-GUARD."""

Mask = npt.NDArray[np.bool_]


def check_domain(triangles: Ints, width: int, height: int) -> None:
    """Raises AssertionError where the argument for int64 above would not hold."""
    assert triangles.ndim == 3 and triangles.shape[1:] == (3, 2)
    assert int(np.abs(triangles).max(initial=0)) <= GUARD
    assert 0 < width <= 2040 and 0 < height <= 2040


def box(triangle: Ints, width: int, height: int) -> tuple[int, int, int, int]:
    """The half-open pixel rectangle x0, y0, x1, y1 on the target outside of which no centre can be covered."""
    low = triangle.min(axis=0) // SUBPIXELS
    high = triangle.max(axis=0) // SUBPIXELS + 1
    x0, y0 = max(int(low[0]), 0), max(int(low[1]), 0)
    return x0, y0, max(min(int(high[0]), width), x0), max(min(int(high[1]), height), y0)


def mask_in_box(triangle: Ints, x0: int, y0: int, x1: int, y1: int) -> Mask:
    """The covered pixels of the rectangle, shape (y1 - y0, x1 - x0)."""
    corners = [(int(x), int(y)) for x, y in triangle]
    (ax, ay), (bx, by), (cx, cy) = corners
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if area == 0:
        return np.zeros((y1 - y0, x1 - x0), np.bool_)
    if area < 0:
        corners.reverse()
    centre_x = np.arange(x0, x1, dtype=np.int64) * SUBPIXELS + SUBPIXELS // 2
    centre_y = np.arange(y0, y1, dtype=np.int64) * SUBPIXELS + SUBPIXELS // 2
    mask = np.ones((y1 - y0, x1 - x0), np.bool_)
    for (px, py), (qx, qy) in zip(corners, corners[1:] + corners[:1], strict=True):
        growth_x, growth_y = py - qy, qx - px
        is_left = growth_x > 0
        is_top = growth_x == 0 and growth_y > 0
        least = 0 if is_left or is_top else 1
        mask &= growth_x * (centre_x - px) >= (least - growth_y * (centre_y - py))[:, np.newaxis]
    return mask


def mask(triangle: Ints, width: int, height: int) -> Mask:
    """The covered pixels of the whole target, shape (height, width)."""
    x0, y0, x1, y1 = box(triangle, width, height)
    picture = np.zeros((height, width), np.bool_)
    picture[y0:y1, x0:x1] = mask_in_box(triangle, x0, y0, x1, y1)
    return picture


def coverage(triangles: Ints, width: int, height: int) -> tuple[npt.NDArray[np.uint32], npt.NDArray[np.uint32]]:
    """For each triangle the number of covered pixels and the CRC-32 of their ascending indices y * width + x."""
    check_domain(triangles, width, height)
    counts = np.zeros(len(triangles), np.uint32)
    crcs = np.zeros(len(triangles), np.uint32)
    for k, triangle in enumerate(triangles):
        x0, y0, x1, y1 = box(triangle, width, height)
        rows, columns = np.nonzero(mask_in_box(triangle, x0, y0, x1, y1))
        counts[k] = len(rows)
        crcs[k] = zlib.crc32(((rows + y0) * width + (columns + x0)).astype("<u4").tobytes())
    return counts, crcs


def covers_by_definition(triangle: Ints, i: int, j: int) -> bool:
    """The same decision in another way, slowly: no edge function, no fill rule, no area.

    The top-left rule is what a sample point shifted by (e, e^2) sees for an infinitesimal e > 0: it leaves no point
    on an edge. e = 2^-18 of 1/16 px is small enough: with slopes A, B of at most 65280 the shift changes an edge
    function by |A e + B e^2| < 1, and by A's sign where A is not 0. Python's integers hold everything, in units of
    2^-36 of 1/16 px. The inside is where a ray to the right crosses the outline an odd number of times.
    """
    unit = 1 << 36
    x = (SUBPIXELS * i + SUBPIXELS // 2) * unit + (1 << 18)
    y = (SUBPIXELS * j + SUBPIXELS // 2) * unit + 1
    corners = [(int(vx) * unit, int(vy) * unit) for vx, vy in triangle]
    crossings = 0
    for (px, py), (qx, qy) in zip(corners, corners[1:] + corners[:1], strict=True):
        if (py > y) != (qy > y):
            right_of_x = (qx - px) * (y - py) - (x - px) * (qy - py)
            crossings += right_of_x > 0 if qy > py else right_of_x < 0
    return crossings % 2 == 1
