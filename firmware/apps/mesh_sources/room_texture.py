"""The room's texture, 128x128: four strips of 32 lines that each repeat sideways, painted by arithmetic alone."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import Floats
from edgeline.convert.palette import rgb565
from edgeline.convert.texels import Texture
from mesh_sources.noise import hashed, smooth

SIDE = 128
STRIP = 32
BRICKS, TILES, PLANKS, PLASTER = range(4)
"""The strips, from top to bottom."""


def pixel_grid() -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """x and y of the texels of a strip, (STRIP, SIDE) each."""
    y, x = np.mgrid[0:STRIP, 0:SIDE]
    return x.astype(np.int64), y.astype(np.int64)


def speckle(seed: int, strength: float) -> Floats:
    """A factor around 1 per texel, (STRIP, SIDE, 1)."""
    x, y = pixel_grid()
    return np.asarray((1 + strength * (hashed(x, y, seed) / 32768 - 1))[..., None])


def bricks() -> Floats:
    """Four courses of bricks, 16x8 texels with their mortar, every other course moved by half a brick."""
    x, y = pixel_grid()
    course = y // 8
    along = (x + course % 2 * 8) % SIDE
    brick = along // 16
    mortar = (along % 16 == 15) | (y % 8 == 7)
    lit = (along % 16 == 0) | (y % 8 == 0)
    tint = hashed(brick, course, 5)[..., None] / 65535
    colour = np.array([138.0, 62.0, 44.0]) + tint * np.array([48.0, 26.0, 18.0])
    colour = np.where(lit[..., None], colour * 1.15, colour)
    return np.asarray(np.where(mortar[..., None], np.array([150.0, 142.0, 130.0]), colour) * speckle(11, 0.08))


def tiles() -> Floats:
    """A row of four floor tiles, 32x32 texels, dark and light in turn."""
    x, y = pixel_grid()
    dark = (x // 32 % 2 == 1)[..., None]
    joint = ((x % 32 == 31) | (y == 31))[..., None]
    bevel = ((x % 32 == 0) | (y == 0))[..., None]
    cloud = smooth(x / 9.0, y / 9.0, 3)[..., None] * 22
    colour = np.where(dark, np.array([64.0, 78.0, 92.0]), np.array([178.0, 176.0, 164.0])) + cloud
    colour = np.where(bevel, colour * 1.12, colour)
    return np.asarray(np.where(joint, np.array([44.0, 44.0, 46.0]), colour) * speckle(7, 0.04))


def planks() -> Floats:
    """Wood for crates: a frame of 64x32 texels around four boards with grain."""
    x, y = pixel_grid()
    inner = x % 64
    grain = smooth(x / 11.0, y / 0.77, 17)[..., None]
    colour = np.array([150.0, 106.0, 58.0]) + grain * np.array([44.0, 34.0, 22.0])
    gap = (y % 8 == 7)[..., None]
    colour = np.where(gap, colour * 0.55, colour)
    frame = ((inner < 5) | (inner >= 59))[..., None]
    colour = np.where(frame, np.array([112.0, 76.0, 42.0]) + grain * 26, colour)
    nail = (((inner == 2) | (inner == 61)) & (y % 8 == 3))[..., None]
    return np.asarray(np.where(nail, np.array([50.0, 48.0, 46.0]), colour) * speckle(23, 0.05))


def plaster() -> Floats:
    """Ceiling panels of 64x32 texels with a lamp's pale square in every other one."""
    x, y = pixel_grid()
    joint = ((x % 64 == 63) | (y == 31))[..., None]
    lamp = ((x % SIDE >= 76) & (x % SIDE < 116) & (y >= 8) & (y < 24))[..., None]
    colour = np.array([148.0, 152.0, 158.0]) + smooth(x / 6.0, y / 6.0, 29)[..., None] * 12
    colour = np.where(lamp, np.array([252.0, 246.0, 222.0]), colour * speckle(31, 0.03))
    return np.asarray(np.where(joint, np.array([96.0, 98.0, 104.0]), colour))


def room_texture() -> Texture:
    picture = np.concatenate([bricks(), tiles(), planks(), plaster()])
    return Texture(rgb565(np.clip(np.rint(picture), 0, 255).astype(np.uint8)))
