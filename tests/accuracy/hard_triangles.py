"""Seeded triangles of the kinds that rasterizers get wrong, in 1/16 px.

`triangles_of` returns int64 of shape (n, 3, 2) within the guard band; windings are mixed by chance. The seed is made
of the kind, the test and the target, so every case is the same in every run and on every machine.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable

import numpy as np

from reference_coverage import GUARD
from sim_commands import SIXTEENTH, SUBPIXELS, Ints

Generator = Callable[[np.random.Generator, int, int, int], Ints]


def rng_for(*names: object) -> np.random.Generator:
    """A generator whose seed is the CRC-32 of the names."""
    return np.random.default_rng(zlib.crc32(" ".join(map(str, names)).encode()))


def _points(rng: np.random.Generator, count: int, width: int, height: int, margin: int) -> Ints:
    """Points on the target and up to `margin` (1/16 px) around it, shape (count, 2)."""
    size = np.array([width, height]) * SUBPIXELS
    return rng.integers(-margin, size + margin + 1, (count, 2))


def _centres(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """Pixel centres on the target, shape (count, 2)."""
    return rng.integers(0, [width, height], (count, 2)) * SUBPIXELS + SUBPIXELS // 2


def on_screen(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """Corners anywhere on the target or a little beside it."""
    return _points(rng, 3 * count, width, height, 20 * SUBPIXELS).reshape(count, 3, 2)


def small(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """The many small triangles of a mesh: up to 12 px."""
    return _points(rng, count, width, height, 0)[:, np.newaxis] + rng.integers(
        -96 * SIXTEENTH, 96 * SIXTEENTH + 1, (count, 3, 2)
    )


def tiny(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """Less than two pixels; many have no sample."""
    return _points(rng, count, width, height, 0)[:, np.newaxis] + rng.integers(
        -16 * SIXTEENTH, 16 * SIXTEENTH + 1, (count, 3, 2)
    )


def slivers(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """Long and at most a few 1/16 px wide: the third corner lies beside the line between the others."""
    ends = _points(rng, 2 * count, width, height, 8 * SUBPIXELS).reshape(count, 2, 2)
    along = rng.random((count, 1))
    third = np.rint(ends[:, 0] + (ends[:, 1] - ends[:, 0]) * along).astype(np.int64) + rng.integers(-3, 4, (count, 2))
    return np.concatenate([ends, third[:, np.newaxis]], axis=1)


def guard_band(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """Corners anywhere in the guard band, some in its very corners; every other one has a corner on the target."""
    corners = rng.integers(-GUARD, GUARD + 1, (count, 3, 2))
    extreme = rng.random((count, 3, 2)) < 0.3
    corners = np.where(extreme, np.where(corners < 0, -GUARD, GUARD), corners)
    corners[::2, 0] = _points(rng, (count + 1) // 2, width, height, 0)
    return corners


def guard_slivers(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """Slivers across the target whose ends lie far out in the guard band."""
    through = _points(rng, count, width, height, 0).astype(np.float64)
    angle = rng.random(count) * 2 * np.pi
    reach = rng.uniform(1000, GUARD // 2, (2, count))
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    first = through + direction * reach[0][:, np.newaxis]
    second = through - direction * reach[1][:, np.newaxis]
    corners: Ints = np.rint(np.stack([first, second, second], axis=1)).astype(np.int64)
    corners[:, 2] += rng.integers(-6, 7, (count, 2))
    return corners


def near_misses(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """One edge passes a pixel's centre with an edge value of exactly -1, 0 or 1, in 1/256 px^2."""
    made = []
    for centre in _centres(rng, count, width, height):
        reach = int(rng.choice([40, 400, 4000]) * SIXTEENTH)
        dx, dy = (int(v) for v in rng.integers(-reach, reach + 1, 2))
        divisor, s, t = _bezout(dx, dy)
        if divisor == 0:
            dx, dy, divisor, s, t = 1, 0, 1, 1, 0
        dx, dy = dx // divisor, dy // divisor
        direction = np.array([dx, dy])
        value = int(rng.integers(-1, 2))
        if value == 0:  # the centre lies on the edge, a few whole steps from both ends
            before, after = (int(v) for v in rng.integers(1, max(2, 3000 * SIXTEENTH // max(abs(dx), abs(dy))), 2))
            start, end = centre - before * direction, centre + after * direction
        else:  # start to centre is value * (-t, s) and a multiple of the edge: E = value * (dx s + dy t) = value
            beside = np.array([-t, s]) * value
            start = centre - beside + (beside @ direction) // (direction @ direction) * direction
            end = start + direction
        made.append([start, end, _points(rng, 1, width, height, 16 * SUBPIXELS)[0]])
    return np.array(made, np.int64)


def _bezout(a: int, b: int) -> tuple[int, int, int]:
    """g, s, t with a s + b t = g = gcd(a, b) >= 0."""
    s0, t0, s1, t1 = 1, 0, 0, 1
    while b:
        quotient = a // b
        a, b = b, a - quotient * b
        s0, t0, s1, t1 = s1, t1, s0 - quotient * s1, t0 - quotient * t1
    return (a, s0, t0) if a >= 0 else (-a, -s0, -t0)


def centred(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """All corners on pixel centres, near each other every other time: whole edges run through centres."""
    corners = np.stack([_centres(rng, count, width, height) for _ in range(3)], axis=1)
    corners[::2, 1:] = corners[::2, :1] + rng.integers(-8, 9, (len(corners[::2]), 2, 2)) * SUBPIXELS
    return corners


def axis_aligned(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """A horizontal and a vertical edge; each coordinate lies on a row or column of centres every other time."""
    corner, opposite = (_points(rng, count, width, height, 4 * SUBPIXELS) for _ in range(2))
    for points in (corner, opposite):
        snap = rng.random(points.shape) < 0.5
        points[snap] = points[snap] // SUBPIXELS * SUBPIXELS + SUBPIXELS // 2
    bend = np.stack([opposite[:, 0], corner[:, 1]], axis=1)
    triangles = np.stack([corner, bend, opposite], axis=1)
    order = rng.permuted(np.tile(np.arange(3), (count, 1)), axis=1)
    return np.take_along_axis(triangles, order[..., np.newaxis], axis=1)


def zero_area(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """Three corners on one line, or two or three of them the same; many pass through pixel centres."""
    start = _centres(rng, count, width, height)
    step = rng.integers(-40, 41, (count, 2)) * SIXTEENTH
    factors = rng.integers(-12, 13, (count, 3, 1))
    return np.asarray(start[:, np.newaxis] + step[:, np.newaxis] * factors)


def outside(rng: np.random.Generator, count: int, width: int, height: int) -> Ints:
    """Beside the target, or touching its border within half a pixel."""
    size = np.array([width, height]) * SUBPIXELS
    depth = np.where(rng.random((count, 1, 1)) < 0.5, 1000, 14)
    corners = (rng.integers(0, depth, (count, 3, 2)) - 10) * SIXTEENTH
    side = rng.integers(0, 4, count)
    axis = side // 2
    other = (np.arange(count), slice(None), 1 - axis)
    corners[other] = rng.integers(-400 * SIXTEENTH, size[1 - axis][:, np.newaxis] + 400 * SIXTEENTH, (count, 3))
    along = corners[np.arange(count), :, axis]
    beyond = size[axis][:, np.newaxis] + along
    corners[np.arange(count), :, axis] = np.where((side % 2 == 0)[:, np.newaxis], -along, beyond)
    return corners


_GENERATORS: dict[str, Generator] = {
    generator.__name__: generator
    for generator in (
        on_screen,
        small,
        tiny,
        slivers,
        guard_band,
        guard_slivers,
        near_misses,
        centred,
        axis_aligned,
        zero_area,
        outside,
    )
}


KINDS = tuple(_GENERATORS)


def triangles_of(kind: str, test: str, count: int, width: int, height: int) -> Ints:
    """`count` triangles of a kind for a target; `test` is part of the seed."""
    made = _GENERATORS[kind](rng_for(test, kind, width, height), count, width, height)
    return np.clip(made, -GUARD, GUARD)


def fan(rng: np.random.Generator, width: int, height: int, corners: int, radius: int) -> Ints:
    """A closed fan around a hub on the target: the rim's corners lie at strictly growing angles, up to `radius`
    (1/16 px) from the hub, every third one snapped to a pixel centre. Shape (corners, 3, 2)."""
    hub = _centres(rng, 1, width, height)[0] if rng.random() < 0.5 else _points(rng, 1, width, height, 0)[0]
    angles = (np.arange(corners) + rng.uniform(0.1, 0.9, corners)) * (2 * np.pi / corners)
    reach = rng.uniform(radius / 2, radius, corners)
    rim = hub + np.rint(np.stack([np.cos(angles), np.sin(angles)], axis=1) * reach[:, np.newaxis]).astype(np.int64)
    rim[::3] = rim[::3] // SUBPIXELS * SUBPIXELS + SUBPIXELS // 2
    rim = np.clip(rim, -GUARD, GUARD)
    return np.stack([np.broadcast_to(hub, rim.shape), rim, np.roll(rim, -1, axis=0)], axis=1)


def jittered_grid(rng: np.random.Generator, width: int, height: int, cells: int) -> Ints:
    """A mesh of cells x cells x 2 triangles that covers the whole target and more, inner corners moved by chance."""
    steps_x = np.linspace(-4 * SUBPIXELS, (width + 4) * SUBPIXELS, cells + 1)
    steps_y = np.linspace(-4 * SUBPIXELS, (height + 4) * SUBPIXELS, cells + 1)
    points = np.stack(np.meshgrid(steps_x, steps_y), axis=2)
    room = np.array([steps_x[1] - steps_x[0], steps_y[1] - steps_y[0]]) * 0.24
    points[1:-1, 1:-1] += rng.uniform(-1, 1, points[1:-1, 1:-1].shape) * room
    corners = np.rint(points).astype(np.int64)
    a, b, c, d = corners[:-1, :-1], corners[:-1, 1:], corners[1:, :-1], corners[1:, 1:]
    halves = np.stack([np.stack([a, b, d], axis=2), np.stack([a, d, c], axis=2)])
    return halves.reshape(-1, 3, 2)
