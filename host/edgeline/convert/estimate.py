"""An estimate of a frame's time: what the model shows of itself, at the prices that the benchmark has measured.

The model is looked at as `edgeline-sim render --mesh` shows it, at 320 x 240. Hidden pixels count like drawn ones, and
the prices are laws of plain scenes, so this is a guess to choose a core by, not a promise: of the benchmark's own
scenes S1, S2 and S3 it gives between two thirds and all of what they take.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from edgeline import budget_facts as facts
from edgeline.convert.mesh import Floats, Mesh

WIDTH, HEIGHT = 320, 240
FIELD_OF_VIEW = math.radians(45)
VIEW = np.array([0.48, 0.36, 0.8])
"""From the model to the eye; of length 1."""
MARGIN = 1.02
CLOCKS_HZ = {"cortex-m0plus": 125_000_000, "cortex-m4f": 168_000_000}
"""Of an RP2040 and of an STM32F405."""
CORES = tuple(CLOCKS_HZ)


@dataclass(frozen=True)
class View:
    """What a look at the model counts: triangles that face the eye, their rows and pixels."""

    triangles: int
    facing: int
    rows: int
    pixels: int


def positions_of(meshes: Sequence[Mesh]) -> list[Floats]:
    """Of each, the corners of its triangles (m, 3, 3) in world units."""
    return [np.ldexp(m.positions.astype(np.float64), m.scale_log2)[m.triangles.astype(np.int64)] for m in meshes]


def sphere_around(meshes: Sequence[Mesh]) -> tuple[Floats, float]:
    """Centre and radius, in world units, of a sphere around the spheres of all meshes."""
    centres = np.array([np.ldexp(np.array(m.centre, dtype=np.float64), m.scale_log2) for m in meshes])
    radii = np.array([math.ldexp(max(m.radius, 1), m.scale_log2) for m in meshes])
    low, high = (centres - radii[:, None]).min(axis=0), (centres + radii[:, None]).max(axis=0)
    centre = (low + high) / 2
    return centre, float((np.linalg.norm(centres - centre, axis=1) + radii).max())


def look_at(meshes: Sequence[Mesh]) -> View:
    """The model from the upper right, filling the picture's height."""
    centre, radius = sphere_around(meshes)
    half = math.tan(FIELD_OF_VIEW / 2)
    eye = centre + VIEW * (radius / math.sin(math.atan(half)) * MARGIN)
    right = np.cross([0.0, 1.0, 0.0], VIEW)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(VIEW, right), -VIEW])
    corners = (np.concatenate(positions_of(meshes)) - eye) @ axes.T
    screen = corners[..., :2] / corners[..., 2:] * (HEIGHT / 2 / half)
    u, v = screen[:, 1] - screen[:, 0], screen[:, 2] - screen[:, 0]
    areas = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    facing = areas > 0
    y = screen[facing, :, 1]
    rows = np.rint(y.max(axis=1)) - np.rint(y.min(axis=1))
    return View(len(areas), int(facing.sum()), int(rows.sum()), int(areas[facing].sum()))


def instructions(view: View, shading: str, core: str) -> int:
    """For a frame of it in one pass."""
    frame, pixel, row, triangle = facts.LAWS[shading][core]
    return round(frame + pixel * view.pixels + row * view.rows + triangle * view.triangles)
