"""A truncated icosahedron, the solid of the football: 12 pentagons and 20 hexagons, each in a colour of its own."""

from __future__ import annotations

import colorsys
import math
from itertools import product

import numpy as np

from edgeline.convert.header import NamedMesh
from edgeline.convert.mesh import Floats, Soup, quantise
from edgeline.convert.normals import unit
from edgeline.convert.triangulate import triangulate

GOLDEN = (1 + math.sqrt(5)) / 2


def all_signs_and_turns(x: float, y: float, z: float) -> Floats:
    """The points (+-x, +-y, +-z) and their cyclic permutations, each once, (n, 3)."""
    points = set()
    for sx, sy, sz in product((1, -1), repeat=3):
        a, b, c = sx * x + 0.0, sy * y + 0.0, sz * z + 0.0  # -0.0 becomes 0.0
        points |= {(a, b, c), (c, a, b), (b, c, a)}
    return np.array(sorted(points))


def vertices() -> Floats:
    """The 60 corners on the unit sphere."""
    g = GOLDEN
    orbits = (0.0, 1.0, 3 * g), (1.0, 2 + g, 2 * g), (g, 2.0, 2 * g + 1)
    return unit(np.concatenate([all_signs_and_turns(*orbit) for orbit in orbits]))


def face_directions() -> tuple[Floats, Floats]:
    """Directions of the pentagons (12, 3) and of the hexagons (20, 3): corners of an icosahedron, of a dodecahedron."""
    pentagons = all_signs_and_turns(0, 1, GOLDEN)
    hexagons = np.concatenate([all_signs_and_turns(1, 1, 1), all_signs_and_turns(0, GOLDEN, 1 / GOLDEN)])
    return unit(pentagons), unit(hexagons)


def face(corners: Floats, direction: Floats) -> Floats:
    """The corners farthest in `direction`, counter-clockwise as seen from there, (5 or 6, 3)."""
    depth = corners @ direction
    own = corners[depth > depth.max() - 1e-6]
    right = unit(own[0] - own.mean(axis=0))
    up = np.cross(direction, right)
    angles = np.round(np.arctan2(own @ up, own @ right), 6)
    return np.asarray(own[np.argsort(angles, kind="stable")])


def colour(direction: Floats, sides: int) -> tuple[int, int, int]:
    """A hue around the vertical axis; pentagons deep, hexagons light."""
    hue = math.atan2(direction[2], direction[0]) / (2 * math.pi) + 0.18 * direction[1]
    saturation, value = (0.85, 0.75) if sides == 5 else (0.45, 0.98)
    red, green, blue = colorsys.hsv_to_rgb(round(hue % 1.0, 6), saturation, value)
    return round(red * 255), round(green * 255), round(blue * 255)


def solid() -> NamedMesh:
    corners = vertices()
    positions, normals, colours = [], [], []
    for direction in np.concatenate(face_directions()):
        polygon = face(corners, direction)
        for triangle in triangulate(polygon):
            positions.append(polygon[list(triangle)])
            normals.append([direction] * 3)
            colours.append(colour(direction, len(polygon)))
    soup = Soup(np.array(positions), np.array(normals), triangle_colours=np.array(colours, dtype=np.uint8))
    return NamedMesh("solid", quantise(soup).mesh)
