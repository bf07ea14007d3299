"""What depth, colour and texture coordinates a pixel's centre has in a triangle, exactly.

With the barycentric weights l_k = (edge function of the opposite edge) / (twice the area), z and colour are
sum l_k a_k, and u, v are (sum l_k w_k u_k) / (sum l_k w_k) with w = 1/w of the vertices: Heckbert and Moreton,
"Interpolation for polygon texture mapping and shading" (1991). All sums are integers: on a covered pixel the weights
are not negative and add up to twice the area, below 2^34, so that sums over 16-bit attributes stay below 2^50 and
int64 and float64 hold them; sums over w u need 66 bits and are Python's integers. The one rounding is that of the
final quotient to float64, 2^-53 of its value.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sim_commands import SUBPIXELS, Ints

Floats = npt.NDArray[np.float64]


def weights(vertices: npt.NDArray[Any], x: Ints, y: Ints) -> Ints:
    """The barycentric weights, not divided by their sum, of the pixels (x[k], y[k]) in the triangles vertices[k]."""
    px, py = SUBPIXELS * x + SUBPIXELS // 2, SUBPIXELS * y + SUBPIXELS // 2
    vx, vy = vertices["x"].astype(np.int64), vertices["y"].astype(np.int64)
    columns = []
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        columns.append((vx[:, b] - vx[:, a]) * (py - vy[:, a]) - (vy[:, b] - vy[:, a]) * (px - vx[:, a]))
    found = np.stack(columns, axis=1)
    found *= np.sign(found.sum(axis=1, keepdims=True))
    assert (found >= 0).all(), "a sample outside of its triangle"
    return found


def exact(vertices: npt.NDArray[Any], x: Ints, y: Ints) -> Floats:
    """z, r, g, b, u, v at each pixel, shape (n, 6), in the units of the simulator's `attributes`."""
    weight = weights(vertices, x, y)
    area = weight.sum(axis=1)
    columns = [(weight * vertices["z"].astype(np.int64)).sum(axis=1) / area]
    columns += [(weight * vertices["rgb"][:, :, channel].astype(np.int64)).sum(axis=1) / area for channel in range(3)]
    share = weight * vertices["w"].astype(np.int64)
    whole = share.sum(axis=1).astype(object)
    for axis in range(2):
        products = share.astype(object) * vertices["uv"][:, :, axis].astype(np.int64).astype(object)
        columns.append((products.sum(axis=1) / (whole * 16)).astype(np.float64))
    return np.stack(columns, axis=1)


def rounded_depth(vertices: npt.NDArray[Any], x: Ints, y: Ints) -> Ints:
    """The exact depth rounded to nearest, ties up."""
    weight = weights(vertices, x, y)
    area = weight.sum(axis=1)
    return np.asarray((2 * (weight * vertices["z"].astype(np.int64)).sum(axis=1) + area) // (2 * area))
