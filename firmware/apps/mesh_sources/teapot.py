"""The teapot as triangles: every patch cut into a grid, normals from the patch's own derivatives.

Patches that meet share their border's control points, so the grids' borders are equal after quantisation. Where the
data leave the pot open - between lid and rim, and at the spout's tip - flat faces close it, so that nothing shows
through when back faces are culled.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from edgeline.convert.header import NamedMesh
from edgeline.convert.mesh import Floats, Soup, quantise
from edgeline.convert.normals import unit
from mesh_sources.teapot_patches import BODY, HANDLE, LID, SPOUT, Ring, Row

STEPS = 5
"""Segments along each side of a patch."""
MIDDLE_HEIGHT = 1.5
"""Of the data, at which the mesh has its origin."""


def bernstein(t: Floats) -> tuple[Floats, Floats]:
    """The cubic Bernstein polynomials at `t` (n,) and their derivatives, (n, 4) each."""
    s = 1.0 - t
    values = np.stack([s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t], axis=1)
    slopes = np.stack([-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t], axis=1)
    return values, slopes


def surface(patch: Floats, s: Floats, t: Floats) -> tuple[Floats, Floats]:
    """Points and normals (not of length 1) of a patch (4, 4, 3) on the grid s x t, (len(s), len(t), 3) each."""
    along, along_slope = bernstein(s)
    across, across_slope = bernstein(t)
    points = np.einsum("si,tj,ijk->stk", along, across, patch)
    derivative_s = np.einsum("si,tj,ijk->stk", along_slope, across, patch)
    derivative_t = np.einsum("si,tj,ijk->stk", along, across_slope, patch)
    return points, np.asarray(np.cross(derivative_s, derivative_t))


def patch_normals(patch: Floats, s: Floats, t: Floats) -> Floats:
    """Unit normals on the grid. At the poles of body and lid, where a side of the patch is a point, the axis."""
    points, normals = surface(patch, s, t)
    _, inside = surface(patch, np.clip(s, 1e-3, 1 - 1e-3), t)
    pole = np.all(np.abs(points[..., :2]) < 1e-12, axis=-1)
    axis = np.zeros_like(normals)
    axis[..., 2] = np.sign(inside[..., 2])
    return unit(np.where(pole[..., None], axis, normals))


def turned(rings: Sequence[Ring]) -> list[Floats]:
    """The patches (4, 4, 3) of a surface of revolution, rows along the rings, columns counter-clockwise from above."""
    patches = []
    for first in range(0, len(rings) - 1, 3):
        quarter = np.array([[(r, 0, z), (r, t, z), (t, r, z), (0, r, z)] for r, t, z in rings[first : first + 4]])
        for _ in range(4):
            patches.append(quarter)
            quarter = np.stack([-quarter[..., 1], quarter[..., 0], quarter[..., 2]], axis=-1)
    return patches


def mirrored(rows: Sequence[Row]) -> list[Floats]:
    """The patches (4, 4, 3) of handle or spout, columns turned to face outwards, and those of its mirror image."""
    patches = []
    for first in range(0, len(rows) - 1, 3):
        half = np.array(rows[first : first + 4], dtype=np.float64)
        patches += [half[:, ::-1], half * np.array([1.0, -1.0, 1.0])]
    return patches


def grid_triangles(points: Floats) -> Floats:
    """Two triangles per cell of a grid (n, m, k), (2 (n-1) (m-1), 3, k), turning from rows to columns."""
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    return np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2).reshape(-1, 3, points.shape[2])


def ring_of(rings: Sequence[Ring], which: int) -> Floats:
    """The circle of the ring `which` as the grids have it, (4 STEPS + 1, 3), closed."""
    t = np.arange(STEPS + 1) / STEPS
    r, tangent, z = rings[which]
    values, _ = bernstein(t)
    quarter = values @ np.array([(r, 0, z), (r, tangent, z), (tangent, r, z), (0, r, z)])
    parts = [quarter]
    for _ in range(3):
        last = parts[-1]
        parts.append(np.stack([-last[:, 1], last[:, 0], last[:, 2]], axis=1))
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:])])


def seam() -> Floats:
    """The level ring between the lid's edge and the rim's inner edge, with its normals: triangles (n, 3, 6)."""
    rows = np.stack([ring_of(LID, -1), ring_of(BODY, 0)])
    return grid_triangles(np.concatenate([rows, np.broadcast_to([0.0, 0.0, 1.0], rows.shape)], axis=2))


def spout_opening() -> Floats:
    """A face over the spout's tip, a fan around its middle, with its normals: triangles (n, 3, 6)."""
    values, _ = bernstein(np.arange(STEPS + 1) / STEPS)
    half = values @ np.array(SPOUT[-1])
    other = half[::-1] * np.array([1.0, -1.0, 1.0])
    loop = np.concatenate([half, other[1:]])
    middle = np.broadcast_to((half[0] + half[-1]) / 2, loop[1:].shape)
    fan = np.stack([middle, loop[:-1], loop[1:]], axis=1)
    return np.concatenate([fan, np.broadcast_to([0.0, 0.0, 1.0], fan.shape)], axis=2)


def y_up(vectors: Floats) -> Floats:
    return np.stack([vectors[..., 0], vectors[..., 2], -vectors[..., 1]], axis=-1)


def teapot() -> NamedMesh:
    t = np.arange(STEPS + 1) / STEPS
    parts = []
    for patch in [*turned(BODY), *turned(LID), *mirrored(HANDLE), *mirrored(SPOUT)]:
        points, _ = surface(patch, t, t)
        parts.append(grid_triangles(np.concatenate([points, patch_normals(patch, t, t)], axis=2)))
    corners = np.concatenate([*parts, seam(), spout_opening()])
    positions = y_up(corners[..., :3] - np.array([0.0, 0.0, MIDDLE_HEIGHT]))
    # Neighbouring patches compute the same normal in a different order; what they differ by must not split a vertex.
    normals = np.round(y_up(corners[..., 3:]), 6)
    return NamedMesh("teapot", quantise(Soup(positions, normals)).mesh)
