"""Noise that is the same on every machine: an integer hash, and a smooth field between its values."""

from __future__ import annotations

import numpy as np

from edgeline.convert.mesh import Floats, Ints


def hashed(x: Ints, y: Ints, seed: int) -> Ints:
    """16 well-mixed bits for each (x, y), in the manner of Wang's integer hash, modulo 2^32."""
    mask = 0xFFFFFFFF
    h = (x * 0x1F1F1F1F ^ y * 0x27D4EB2D ^ seed * 0x165667B1) & mask
    h = (h ^ (h >> 15)) * 0x2C1B3C6D & mask
    h = (h ^ (h >> 12)) * 0x297A2D39 & mask
    return np.asarray((h ^ (h >> 15)) >> 16)


def smooth(x: Floats, y: Floats, seed: int) -> Floats:
    """Value noise, 0 to 1: hashes at whole coordinates, a cubic blend between them."""
    left, low = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    fx, fy = x - left, y - low
    wx, wy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    at = [[hashed(left + i, low + j, seed) / 65535 for i in (0, 1)] for j in (0, 1)]
    rows = [row[0] + (row[1] - row[0]) * wx for row in at]
    return np.asarray(rows[0] + (rows[1] - rows[0]) * wy)


def fractal(x: Floats, y: Floats, octaves: int, seed: int) -> Floats:
    """A sum of noises, each twice as fine and half as high as the one before, 0 to 1."""
    total = sum(smooth(x * 2**i, y * 2**i, seed + i) / 2**i for i in range(octaves))
    return np.asarray(total / (2 - 2 ** (1 - octaves)))
