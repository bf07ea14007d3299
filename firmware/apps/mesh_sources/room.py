"""Two rooms with a doorway between them, 10 x 10 units wide and 3 high, to walk through at eye height.

Every surface is laid in strips half a unit wide: across a strip the texture shows one of its four materials, along it
the texture repeats. Floor, walls and ceiling reach a little into each other, so that a strip's end needs no vertex in
its neighbour to be tight.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from edgeline.convert.header import NamedMesh
from edgeline.convert.mesh import Floats, Soup, quantise
from mesh_sources.room_texture import BRICKS, PLANKS, PLASTER, STRIP, TILES, room_texture

HALF = 5.0
HEIGHT = 3.0
OVERLAP = 0.125
STRIP_UNITS = 0.5
TEXELS_PER_UNIT = STRIP / STRIP_UNITS
INSET = 0.25
"""Texels by which a strip stays away from the neighbouring materials: twice the renderer's error in u and v."""
WALL = 0.25
"""Half the thickness of the wall between the rooms."""
DOOR = 1.0
"""Half the doorway's width."""
DOOR_HEIGHT = 2.0

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Side:
    """A rectangle seen from its front: `origin` at the lower left, `right` and `up` along its sides, in world units.

    Where `repeat` is not 0, the texture moves by that many texels from strip to strip.
    """

    origin: Vector
    right: Vector
    up: Vector
    material: int
    repeat: float = 0.0


def strips(side: Side) -> Iterator[tuple[Floats, Floats]]:
    """Positions (4, 3) and texture coordinates in texels (4, 2) of each strip, lower left first, counter-clockwise."""
    origin, right, up = (np.array(v, dtype=np.float64) for v in (side.origin, side.right, side.up))
    length, height = float(np.abs(right).sum()), float(np.abs(up).sum())
    count = int(np.ceil(height / STRIP_UNITS))
    for i in range(count):
        low, high = i * STRIP_UNITS, min((i + 1) * STRIP_UNITS, height)
        bottom, top = origin + up * (low / height), origin + up * (high / height)
        v_bottom = (side.material + 1) * STRIP - INSET
        v_top = v_bottom - (high - low) * TEXELS_PER_UNIT + 2 * INSET
        u_left = i * side.repeat
        u_right = u_left + length * TEXELS_PER_UNIT
        positions = np.array([bottom, bottom + right, top + right, top])
        yield positions, np.array([(u_left, v_bottom), (u_right, v_bottom), (u_right, v_top), (u_left, v_top)])


def box(low: Vector, high: Vector, material: int, *, top: bool) -> list[Side]:
    """The four walls of a box, seen from outside, and its top if asked for."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    up = (0.0, y1 - y0, 0.0)
    sides = [
        Side((x0, y0, z1), (x1 - x0, 0.0, 0.0), up, material),
        Side((x1, y0, z1), (0.0, 0.0, z0 - z1), up, material),
        Side((x1, y0, z0), (x0 - x1, 0.0, 0.0), up, material),
        Side((x0, y0, z0), (0.0, 0.0, z1 - z0), up, material),
    ]
    if top:
        sides.append(Side((x0, y1, z1), (x1 - x0, 0.0, 0.0), (0.0, 0.0, z0 - z1), material))
    return sides


def shell() -> list[Side]:
    """Floor, ceiling and the four outer walls, seen from inside."""
    reach, span = HALF + OVERLAP, 2 * (HALF + OVERLAP)
    foot, up = -OVERLAP, (0.0, HEIGHT + 2 * OVERLAP, 0.0)
    return [
        Side((-reach, 0.0, reach), (span, 0.0, 0.0), (0.0, 0.0, -span), TILES, repeat=STRIP),
        Side((-reach, HEIGHT, -reach), (span, 0.0, 0.0), (0.0, 0.0, span), PLASTER, repeat=2 * STRIP),
        Side((-HALF, foot, -HALF), (2 * HALF, 0.0, 0.0), up, BRICKS),
        Side((HALF, foot, -HALF), (0.0, 0.0, 2 * HALF), up, BRICKS),
        Side((HALF, foot, HALF), (-2 * HALF, 0.0, 0.0), up, BRICKS),
        Side((-HALF, foot, HALF), (0.0, 0.0, -2 * HALF), up, BRICKS),
    ]


def partition() -> list[Side]:
    """The wall between the rooms: left and right of the doorway, the lintel, and the lintel's underside."""
    reach = HALF + OVERLAP
    pieces = (-reach, -DOOR, 0.0), (DOOR, reach, 0.0), (-DOOR, DOOR, DOOR_HEIGHT)
    sides = []
    for x0, x1, y0 in pieces:
        up = (0.0, HEIGHT - y0, 0.0)
        sides.append(Side((x0, y0, WALL), (x1 - x0, 0.0, 0.0), up, BRICKS))
        sides.append(Side((x1, y0, -WALL), (x0 - x1, 0.0, 0.0), up, BRICKS))
    jamb_up = (0.0, DOOR_HEIGHT, 0.0)
    sides.append(Side((-DOOR, 0.0, WALL), (0.0, 0.0, -2 * WALL), jamb_up, PLASTER))
    sides.append(Side((DOOR, 0.0, -WALL), (0.0, 0.0, 2 * WALL), jamb_up, PLASTER))
    sides.append(Side((-DOOR, DOOR_HEIGHT, -WALL), (2 * DOOR, 0.0, 0.0), (0.0, 0.0, 2 * WALL), PLASTER))
    return sides


def furniture() -> list[Side]:
    """Pillars in both rooms, and crates, some of them stacked."""
    sides: list[Side] = []
    for x, z in ((-2.5, 2.5), (2.5, 2.5), (-2.5, -2.5), (2.5, -2.5)):
        sides += box((x - 0.25, 0.0, z - 0.25), (x + 0.25, HEIGHT, z + 0.25), PLASTER, top=False)
    for x, y, z, size in (
        (3.5, 0.0, 3.4, 1.0),
        (3.75, 0.0, 2.1, 1.0),
        (3.6, 1.0, 3.2, 0.5),
        (-4.4, 0.0, -4.3, 1.0),
        (-3.2, 0.0, -4.4, 1.0),
        (-3.9, 1.0, -4.4, 1.0),
        (3.9, 0.0, -1.4, 0.5),
        (-4.3, 0.0, 1.2, 0.5),
    ):
        sides += box((x, y, z), (x + size, y + size, z + size), PLANKS, top=True)
    return sides


def room() -> NamedMesh:
    positions, uvs = [], []
    sides: Sequence[Side] = [*shell(), *partition(), *furniture()]
    for side in sides:
        for quad, texels in strips(side):
            for corners in ([0, 1, 2], [0, 2, 3]):
                positions.append(quad[corners])
                uvs.append(texels[corners])
    soup = Soup(np.array(positions), uvs=np.array(uvs))
    return NamedMesh("room", quantise(soup).mesh, room_texture())
