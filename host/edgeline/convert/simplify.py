"""Fewer triangles: edge collapses by fast-simplification, what triangles carry brought over, the error measured.

The library moves bare positions. So the model is simplified whole, without cracks between its parts; each new triangle
then takes part and colour from the old one nearest to its middle, and each of its corners what lies nearest on the same
piece of the old surface: texture coordinates do not mix across a seam. Where a piece ends at itself, as around a pipe,
they go on by whole repetitions of the texture.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from edgeline.convert.extra import fast_simplification
from edgeline.convert.mesh import Floats, Ints, weld
from edgeline.convert.nearest import Surface
from edgeline.convert.progress import Steps
from edgeline.convert.source import Source
from edgeline.errors import EdgelineError

SAMPLES = 4000
"""Points per surface by which distances are measured, its corners beside them."""
SAMPLES_TO_CHOOSE = 1000
SEED = 1
SEARCH_STEPS = 12
AGGRESSIVE = (3.0, 4.0, 5.0, 6.0, 7.0)
"""How fast the library lets its limit of an edge's error grow, gently first. Gentle is mostly nearer, but may not get
there; which is nearest differs by up to six times, and no rule tells it but measuring."""
FEWEST = 4


@dataclass(frozen=True)
class Simplified:
    """What became of the triangles. Distances are between the surfaces, both ways, in units after --scale."""

    source: Source
    triangles_before: int
    largest_distance: float
    mean_distance: float
    size: float
    """The diagonal of the model's box."""


def _indexed(positions: Floats) -> tuple[Floats, Ints]:
    """Vertices (n, 3), and triangles (m, 3) of those that have three different ones."""
    first, vertex_of = weld(positions.reshape(-1, 3) + 0.0)  # -0.0 becomes 0.0
    triangles = vertex_of.reshape(-1, 3)
    a, b, c = triangles.T
    return positions.reshape(-1, 3)[first], triangles[(a != b) & (b != c) & (c != a)]


def _fewer(vertices: Floats, triangles: Ints, target: int, agg: float) -> Floats:
    """About `target` triangles (m, 3, 3), or more where so aggressive a search collapses no more edges."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    size = float((high - low).max()) or 1.0
    points, faces = fast_simplification().simplify(
        np.ascontiguousarray((vertices - low) / size), triangles.astype(np.int32), target_count=target, agg=agg
    )
    return np.asarray(np.asarray(points, dtype=np.float64)[np.asarray(faces, dtype=np.int64)] * size + low)


def samples(positions: Floats, count: int = SAMPLES) -> Floats:
    """Corners of the triangles (m, 3, 3), `count` of them at most, and as many points spread evenly over their area."""
    numbers = np.random.default_rng(SEED)
    corners = np.unique(positions.reshape(-1, 3), axis=0)
    if len(corners) > count:
        corners = corners[np.sort(numbers.choice(len(corners), count, replace=False))]
    u, v = positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0]
    areas = np.cumsum(np.linalg.norm(np.cross(u, v), axis=1))
    if areas[-1] == 0.0:
        return corners
    rows = np.minimum(np.searchsorted(areas, numbers.random(count) * areas[-1]), len(areas) - 1)
    s, t = numbers.random((2, count, 1))
    s, t = np.where(s + t > 1, 1 - s, s), np.where(s + t > 1, 1 - t, t)
    return np.concatenate([corners, positions[rows, 0] + u[rows] * s + v[rows] * t])


def distance(a: Floats, b: Floats, steps: Steps, count: int = SAMPLES) -> tuple[float, float]:
    """Largest and mean distance between two surfaces (m, 3, 3), from samples of each to the whole of the other."""
    there, back = samples(a, count), samples(b, count)
    with steps.bar("measuring", len(there) + len(back)) as tick:
        found = [Surface(b).nearest(there, tick)[0], Surface(a).nearest(back, tick)[0]]
    return float(max(d.max() for d in found)), float(max(d.mean() for d in found))


def _pieces(source: Source) -> Ints:
    """The piece of each triangle (m,): pieces hang together by corners that are equal in all that is brought over."""
    columns = [source.positions, np.repeat(source.part_of[:, None, None], 3, axis=1)]
    columns += [np.nan_to_num(array) for array in (source.uvs, source.colours) if array is not None]
    table = np.concatenate([column.astype(np.float64) for column in columns], axis=2)
    _, vertex_of = weld(table.reshape(-1, table.shape[2]) + 0.0)
    triangles = vertex_of.reshape(-1, 3)
    label = np.arange(int(triangles.max()) + 1)
    while True:
        least = label[triangles].min(axis=1)
        lower = label.copy()
        np.minimum.at(lower, triangles.reshape(-1), np.repeat(least, 3))
        lower = lower[lower]
        if np.array_equal(lower, label):
            return np.asarray(np.unique(least, return_inverse=True)[1]).reshape(-1).astype(np.int64)
        label = lower


def _continued(triangles: Floats, uvs: Floats, corners: Floats) -> Floats:
    """What the texture coordinates of triangles (m, 3, 3) come to at other points (m, 3, 3), were their planes endless;
    NaN where there is no plane."""
    a, u, v = triangles[:, :1], triangles[:, 1:2] - triangles[:, :1], triangles[:, 2:] - triangles[:, :1]
    p = corners - a
    uu, uv, vv = (u * u).sum(axis=2), (u * v).sum(axis=2), (v * v).sum(axis=2)
    pu, pv = (p * u).sum(axis=2), (p * v).sum(axis=2)
    area = uu * vv - uv * uv
    safe = np.where(area > 0, area, np.nan)
    s, t = (pu * vv - pv * uv) / safe, (pv * uu - pu * uv) / safe
    along, across = uvs[:, 1:2] - uvs[:, :1], uvs[:, 2:] - uvs[:, :1]
    return np.asarray(uvs[:, :1] + s[:, :, None] * along + t[:, :, None] * across)


def _brought_over(source: Source, positions: Floats, steps: Steps) -> Source:
    """`source` with other positions (m, 3, 3), which lie near."""
    size = float(np.ptp(source.positions, axis=(0, 1)).max()) or 1.0
    with steps.bar("bringing colours and textures over", 4 * len(positions)) as tick:
        _, old, _ = Surface(source.positions).nearest(positions.mean(axis=1), tick)
        fewer = replace(source.chosen(old), positions=positions, normals=None)
        if source.uvs is None and source.colours is None:
            return fewer
        # A dimension more keeps the pieces apart.
        piece = _pieces(source) * (4.0 * size)
        flat = np.concatenate([source.positions, np.repeat(piece[:, None, None], 3, axis=1)], axis=2)
        corners = np.concatenate([positions, np.repeat(piece[old][:, None, None], 3, axis=1)], axis=2)
        _, at, weights = Surface(flat).nearest(corners.reshape(-1, 4), tick)
    uvs = colours = None
    if source.uvs is not None:
        uvs = (source.uvs[at] * weights[:, :, None]).sum(axis=1).reshape(-1, 3, 2)
        uvs += np.nan_to_num(np.rint(_continued(source.positions[old], source.uvs[old], positions) - uvs))
    if source.colours is not None:
        mixed = (source.colours[at] * weights[:, :, None]).sum(axis=1).reshape(-1, 3, 3)
        colours = np.rint(np.clip(mixed, 0, 255)).astype(np.uint8)
    return replace(fewer, uvs=uvs, colours=colours)


def simplified(source: Source, budget: int | None, tolerance: float | None, steps: Steps) -> Simplified:
    """`source` with `budget` triangles at most, or with as few as stay within `tolerance` of it.

    With both, the budget decides. Raises EdgelineError when they cannot be met.
    """
    before = len(source.positions)
    if budget is not None and before <= budget:
        return Simplified(source, before, 0.0, 0.0, _size(source))
    vertices, triangles = _indexed(source.positions)
    if len(triangles) == 0:
        raise EdgelineError(f"{source.name}: no triangle with an area: there is nothing to draw in this model")
    if budget is not None:
        positions = _nearest_within(source, vertices, triangles, budget, steps)
    else:
        assert tolerance is not None
        positions = _within(source.positions, vertices, triangles, tolerance, steps)
    largest, mean = distance(source.positions, positions, steps)
    if tolerance is not None and largest > tolerance:
        raise EdgelineError(
            f"{source.name}: with {len(positions)} triangles it is off by {largest:.3g}, more than --tolerance "
            f"{tolerance:g}; give more triangles or a larger tolerance"
        )
    return Simplified(_brought_over(source, positions, steps), before, largest, mean, _size(source))


def _size(source: Source) -> float:
    return float(np.linalg.norm(np.ptp(source.positions, axis=(0, 1))))


def _nearest_within(source: Source, vertices: Floats, triangles: Ints, budget: int, steps: Steps) -> Floats:
    """`budget` triangles at most: of all ways to get there, the one that stays nearest."""
    with steps.bar("simplifying", len(AGGRESSIVE)) as tick:
        choices = []
        for agg in AGGRESSIVE:
            choices.append(_fewer(vertices, triangles, budget, agg))
            tick(1)
    fitting = [choice for choice in choices if 0 < len(choice) <= budget]
    if not fitting:
        least = min(len(choice) for choice in choices)
        why = f"its loose parts leave {least} at least" if least else "nothing is left of it"
        raise EdgelineError(
            f"{source.name}: --triangles {budget}: {why}; give more, or remove small parts in a modelling program"
        )
    return min(fitting, key=lambda choice: distance(source.positions, choice, steps, SAMPLES_TO_CHOOSE))


def _gentlest(vertices: Floats, triangles: Ints, target: int) -> Floats:
    """`target` triangles at most, as gently as that can be had; or as few as there are."""
    for agg in AGGRESSIVE:
        fewer = _fewer(vertices, triangles, target, agg)
        if len(fewer) <= target:
            break
    return fewer


def _within(positions: Floats, vertices: Floats, triangles: Ints, tolerance: float, steps: Steps) -> Floats:
    """As few triangles as a search by halves finds whose surface is within `tolerance` of `positions`."""
    best = positions
    too_few, enough = min(FEWEST, len(triangles)) - 1, len(triangles)
    for _ in range(SEARCH_STEPS):
        if enough - too_few <= max(1, enough // 100):
            break
        target = max(too_few + 1, int((max(too_few, 1) * enough) ** 0.5))
        fewer = _gentlest(vertices, triangles, target)
        # A few points mostly tell already that it is too far off.
        counts = (SAMPLES_TO_CHOOSE, SAMPLES) if 0 < len(fewer) <= len(best) else ()
        if counts and all(distance(positions, fewer, steps, count)[0] <= tolerance for count in counts):
            best, enough = fewer, target
        else:
            too_few = target
    return best
