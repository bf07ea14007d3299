"""An island: a height field of many small triangles, with colours from its height and slope."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from edgeline.convert.header import NamedMesh
from edgeline.convert.mesh import Floats, Soup, quantise
from edgeline.convert.normals import unit
from mesh_sources.noise import fractal
from mesh_sources.teapot import grid_triangles

CELLS = 36
SIZE = 10.0
"""Side of the island's square in world units."""
SUMMIT = 3.1
SEED = 13
COLOURS = (  # height, and the ground's colour there; in between, a blend
    (0.00, (38, 84, 140)),
    (0.04, (196, 178, 120)),
    (0.22, (104, 150, 62)),
    (0.75, (56, 104, 48)),
    (1.20, (120, 112, 104)),
    (1.45, (236, 240, 244)),
)
CLIFF_COLOUR = 104, 94, 84
CLIFF_FROM = 0.3
CLIFF_SLOPE = 0.62
"""Upward part of the normal below which the ground is bare rock, above CLIFF_FROM."""


def height(x: Floats, z: Floats) -> Floats:
    """Of the ground over (x, z); the sea, at 0, covers what would be lower."""
    falloff = 1 - (x * x + z * z) / (SIZE * SIZE / 4)
    ground = fractal(x * 0.45 + 7, z * 0.45 + 3, 4, SEED)
    return np.asarray(np.maximum((ground * 1.5 - 0.42) * SUMMIT * np.clip(falloff, 0, 1), 0))


def grid() -> tuple[Floats, Floats]:
    """Positions and unit normals on the grid, (CELLS + 1, CELLS + 1, 3) each."""
    side = (np.arange(CELLS + 1) / CELLS - 0.5) * SIZE
    z, x = np.meshgrid(side, side, indexing="ij")
    step = SIZE / CELLS / 2
    slope_x = (height(x + step, z) - height(x - step, z)) / (2 * step)
    slope_z = (height(x, z + step) - height(x, z - step)) / (2 * step)
    positions = np.stack([x, height(x, z), z], axis=2)
    return positions, unit(np.stack([-slope_x, np.ones_like(x), -slope_z], axis=2))


def colours(positions: Floats, normals: Floats) -> npt.NDArray[np.uint8]:
    heights = positions[..., 1]
    knots = [height for height, _ in COLOURS]
    channels = [np.interp(heights, knots, [colour[i] for _, colour in COLOURS]) for i in range(3)]
    result = np.rint(np.stack(channels, axis=2)).astype(np.uint8)
    result[(normals[..., 1] < CLIFF_SLOPE) & (heights > CLIFF_FROM)] = CLIFF_COLOUR
    return result


def field() -> NamedMesh:
    positions, normals = grid()
    corners = grid_triangles(np.concatenate([positions, normals, colours(positions, normals)], axis=2))
    soup = Soup(
        positions=corners[..., 0:3],
        normals=np.round(corners[..., 3:6], 6),
        colours=corners[..., 6:9].astype(np.uint8),
    )
    return NamedMesh("field", quantise(soup).mesh)
