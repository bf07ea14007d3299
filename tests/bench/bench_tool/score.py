"""Errors of the alternatives, from the files that their native run leaves: exact coverage, depth, colour and texture
coordinates of every covered pixel, in integers or in longdouble.

Weights l_k are the edge functions of the opposite edges; depth and colour are sum l_k a_k / sum l_k, texture
coordinates sum l_k w_k u_k / sum l_k w_k (Heckbert and Moreton, "Interpolation for polygon texture mapping and
shading", 1991).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .machines import BenchError

Ints = npt.NDArray[np.int64]
Errors = dict[str, float]

WIDTH, HEIGHT, PICTURES = 320, 240, 10
FINE_BITS, SUBPIXEL_BITS = 12, 4
LARGE_TRIANGLES = (2400, 2558)
# Triangles of the three texture groups, as alternatives/alternatives.h counts them.
TEXTURE_RANGES = {"texture_small": (0, 2400), "texture_walls": (2400, 2479), "texture_steep": (2479, 2558)}

# struct bench_triangle of alternatives/alternatives.h, as x86-64 and AArch64 lay it out.
CORNER = np.dtype(
    {
        "names": ["x", "y", "z", "w", "u_q16", "v_q16", "rgb_q8"],
        "formats": ["<i4", "<i4", "<u2", "<u4", "<i4", "<i4", ("<u2", 3)],
        "offsets": [0, 4, 8, 12, 16, 20, 24],
        "itemsize": 32,
    }
)
TRIANGLE = np.dtype([("fine_x", "<i4", 3), ("fine_y", "<i4", 3), ("corners", CORNER, 3), ("picture", "<u4")])


@dataclass(frozen=True)
class Samples:
    """The pixels that triangles cover: triangle, place in the pictures, weights of the corners with shape (n, 3)."""

    triangle: Ints
    place: Ints
    weights: Ints

    def of_triangles(self, begin: int, end: int) -> Samples:
        chosen = (self.triangle >= begin) & (self.triangle < end)
        return Samples(self.triangle[chosen], self.place[chosen], self.weights[chosen])


def cover(x: Ints, y: Ints, bits: int, triangle: int, picture: int) -> Samples:
    """The pixels of one triangle with corners in 2^-bits px, by the top-left rule. Edge values are below 2^44."""
    if (x[1] - x[0]) * (y[2] - y[0]) < (x[2] - x[0]) * (y[1] - y[0]):
        back = cover(x[[0, 2, 1]], y[[0, 2, 1]], bits, triangle, picture)
        return Samples(back.triangle, back.place, back.weights[:, [0, 2, 1]])
    one, half = 1 << bits, 1 << (bits - 1)
    columns = np.arange(int(x.min()) >> bits, (int(x.max()) >> bits) + 1)
    rows = np.arange(int(y.min()) >> bits, (int(y.max()) >> bits) + 1)
    centre_x, centre_y = np.meshgrid(columns * one + half, rows * one + half)
    weights = []
    inside = np.full(centre_x.shape, (x[1] - x[0]) * (y[2] - y[0]) != (x[2] - x[0]) * (y[1] - y[0]))
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        dx, dy = x[b] - x[a], y[b] - y[a]
        value = dx * (centre_y - y[a]) - dy * (centre_x - x[a])
        inside &= value >= (0 if dy < 0 or (dy == 0 and dx > 0) else 1)
        weights.append(value)
    at_row, at_column = np.nonzero(inside)
    place = (picture * HEIGHT + rows[at_row]) * WIDTH + columns[at_column]
    found = np.stack([w[inside] for w in weights], axis=1)
    return Samples(np.full(len(place), triangle), place, found)


class Reference:
    """The exact values of all inputs that a native run of the alternatives left in `folder`."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        size = (folder / "input.triangles").stat().st_size
        if size % TRIANGLE.itemsize != 0:
            raise BenchError(f"triangles of {TRIANGLE.itemsize} bytes do not fill {size} bytes; this ABI is unknown")
        self.triangles = np.fromfile(folder / "input.triangles", TRIANGLE)
        if len(self.triangles) != TEXTURE_RANGES["texture_steep"][1]:
            raise BenchError(f"score.py knows other ranges than the {len(self.triangles)} triangles of alternatives.h")

    def _samples(self, x: Ints, y: Ints, bits: int) -> Samples:
        parts = [
            cover(x[i].astype(np.int64), y[i].astype(np.int64), bits, i, int(self.triangles["picture"][i]))
            for i in range(len(self.triangles))
        ]
        return Samples(
            np.concatenate([p.triangle for p in parts]),
            np.concatenate([p.place for p in parts]),
            np.concatenate([p.weights for p in parts]),
        )

    @cached_property
    def samples(self) -> Samples:
        """Of the snapped triangles."""
        corners = self.triangles["corners"]
        return self._samples(corners["x"], corners["y"], SUBPIXEL_BITS)

    @cached_property
    def unsnapped(self) -> Samples:
        return self._samples(self.triangles["fine_x"], self.triangles["fine_y"], FINE_BITS)

    def _read(self, group: str, name: str, kind: str, values: int) -> npt.NDArray[Any]:
        found = np.fromfile(self.folder / f"{group}.{name}", kind)
        return found.reshape(PICTURES * HEIGHT * WIDTH, values)

    def score(self, group: str, name: str) -> Errors:
        """The errors of one way, by name; the first is the one to compare by."""
        if group == "edges":
            return self._coverage(group, name, self.samples)
        if group == "subpixel":
            return self._coverage(group, name, self.unsnapped)
        if group == "depth":
            return self._depth(name)
        if group == "gouraud":
            return self._colour(name)
        if group == "dither":
            return self._blocks(name)
        if group in TEXTURE_RANGES:
            return self._texture(group, name)
        if group == "reciprocal":
            return self._reciprocal(name)
        if group == "smoothing":
            return self._smoothing(name)
        raise BenchError(f"no reference for the group '{group}'")

    def units(self, group: str) -> tuple[str, int]:
        """What a cost is divided by: its name and how many there are."""
        if group in ("edges", "subpixel"):
            return "triangle", len(self.triangles)
        if group == "reciprocal":
            return "reciprocal", (self.folder / "input.reciprocals").stat().st_size // 4
        if group == "smoothing":
            return "frame of 320x240", 1
        if group == "dither":
            return "pixel", len(self.samples.of_triangles(*LARGE_TRIANGLES).place)
        if group in TEXTURE_RANGES:
            return "pixel", len(self.samples.of_triangles(*TEXTURE_RANGES[group]).place)
        return "pixel", len(self.samples.place)

    def _smoothing(self, name: str) -> Errors:
        """Of the worst channel of each pixel, in 8-bit levels."""
        values = np.fromfile(self.folder / f"smoothing.{name}", "<i4").reshape(-1, 4).astype(np.float64)
        pixel = values[:, 0]
        found = np.stack([pixel // 2048, pixel // 32 % 64, pixel % 32], axis=1)
        error = (np.abs(found - values[:, 1:] / 256) * (255 / np.array([31, 63, 31]))).max(axis=1)
        return {"rms_255ths": float(np.sqrt((error**2).mean())), "max_255ths": float(error.max())}

    def _coverage(self, group: str, name: str, samples: Samples) -> Errors:
        wanted = np.zeros(PICTURES * HEIGHT * WIDTH, bool)
        wanted[samples.place] = True
        found = self._read(group, name, "<u2", 1)[:, 0] != 0
        wrong = int((wanted != found).sum())
        # Edge pixels: covered, with a neighbour that is not.
        shape = wanted.reshape(PICTURES, HEIGHT, WIDTH)
        padded = np.pad(shape, ((0, 0), (1, 1), (1, 1)))
        kernel = padded[:, :-2, 1:-1] & padded[:, 2:, 1:-1] & padded[:, 1:-1, :-2] & padded[:, 1:-1, 2:]
        edge = int((shape & ~kernel).sum())
        return {"wrong_per_1000_edge_pixels": 1000 * wrong / edge, "wrong_pixels": wrong}

    def _depth(self, name: str) -> Errors:
        weights, corners = self.samples.weights, self.triangles["corners"][self.samples.triangle]
        area = weights.sum(axis=1)
        exact = (2 * (weights * corners["z"].astype(np.int64)).sum(axis=1) + area) // (2 * area)
        found = self._read("depth", name, "<u2", 1)[self.samples.place, 0].astype(np.int64)
        off = np.abs(found - exact)
        return {"not_nearest_per_million": 1e6 * float((off > 0).mean()), "max_units": int(off.max())}

    def _colour(self, name: str) -> Errors:
        weights, corners = self.samples.weights, self.triangles["corners"][self.samples.triangle]
        found = self._read("gouraud", name, "<u4", 3)[self.samples.place]
        exact_q8 = (weights[:, :, None] * corners["rgb_q8"].astype(np.int64)).sum(axis=1)
        exact = exact_q8 / weights.sum(axis=1)[:, None] / 256
        off = np.abs(found / 2.0**24 - 0.5 - exact)
        drop = np.array([3, 2, 3])
        wrong = (found >> 24 >> drop) != ((exact + 0.5).astype(np.int64) >> drop)
        return {
            "max_255ths": float(off.max()),
            "p99_255ths": float(np.percentile(off, 99)),
            "wrong_rgb565_per_million": 1e6 * float(wrong.any(axis=1).mean()),
        }

    def _blocks(self, name: str) -> Errors:
        """Means over aligned 4x4 blocks inside one triangle, of what is shown and of the exact colours."""
        samples = self.samples.of_triangles(*LARGE_TRIANGLES)
        corners = self.triangles["corners"][samples.triangle]
        exact_q8 = (samples.weights[:, :, None] * corners["rgb_q8"].astype(np.int64)).sum(axis=1)
        wanted = np.full((PICTURES * HEIGHT * WIDTH, 3), np.nan)
        wanted[samples.place] = exact_q8 / samples.weights.sum(axis=1)[:, None] / 256
        pixels = self._read("dither", name, "<u2", 1)[:, 0].astype(np.int64)
        levels = np.array([31, 63, 31])
        shown = ((pixels[:, None] >> np.array([11, 5, 0])) & levels) / levels * 255
        shape = (PICTURES * HEIGHT // 4, 4, WIDTH // 4, 4, 3)
        off = np.abs(shown.reshape(shape).mean(axis=(1, 3)) - wanted.reshape(shape).mean(axis=(1, 3)))
        found = off[~np.isnan(off)]
        return {"max_block_255ths": float(found.max()), "mean_block_255ths": float(found.mean())}

    def _texture(self, group: str, name: str) -> Errors:
        samples = self.samples.of_triangles(*TEXTURE_RANGES[group])
        corners = self.triangles["corners"][samples.triangle]
        share = samples.weights.astype(np.longdouble) * corners["w"]
        found = self._read(group, name, "<i4", 2)[samples.place]
        off = np.zeros(len(samples.place), np.longdouble)
        for column, coordinate in enumerate(("u_q16", "v_q16")):
            exact = (share * corners[coordinate]).sum(axis=1) / share.sum(axis=1)
            off = np.maximum(off, np.abs(found[:, column] - exact) / 65536)
        return {"max_texels": float(off.max()), "p99_texels": float(np.percentile(off.astype(np.float64), 99))}

    def _reciprocal(self, name: str) -> Errors:
        given = np.fromfile(self.folder / "input.reciprocals", "<u4").astype(np.uint64)
        exact = np.uint64(1 << 63) // given
        found = np.fromfile(self.folder / f"reciprocal.{name}", "<u4").astype(np.uint64)
        off = np.abs(found.astype(np.int64) - exact.astype(np.int64))
        return {"max_ulp": int(off.max()), "mean_ulp": float(off.mean())}
