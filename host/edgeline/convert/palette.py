"""From 8 bits per channel to what a texture holds: RGB565, a palette, or a bit; with dithering, in exact integers.

Distances are those of sRGB's levels, all channels alike. Pillow chooses palettes; the nearest colour is
found here, exactly, and so that every machine finds the same. Of its methods "maximum coverage" with k-means has about
the least root mean square error, and by far the smallest largest one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from PIL import Image

from edgeline.colour import to_rgb
from edgeline.convert.mesh import Ints

DITHERS = ("none", "ordered", "floyd-steinberg")

Bytes = npt.NDArray[np.uint8]


def rgb565(rgb: npt.NDArray[np.integer]) -> npt.NDArray[np.uint16]:
    """RGB565 (...) out of 8-bit colours (..., 3), each channel rounded to nearest."""
    red, green, blue = (rgb[..., i].astype(np.uint32) for i in range(3))
    r5, g6, b5 = (red * 31 + 127) // 255, (green * 63 + 127) // 255, (blue * 31 + 127) // 255
    return (r5 << 11 | g6 << 5 | b5).astype(np.uint16)


@dataclass(frozen=True)
class Colours:
    """What there is to choose from: the value for colours (k, 3) of 0 to 255, what each value shows, (n, 3), and how
    far apart neighbours are in each channel, Q8."""

    nearest: Callable[[Ints], Ints]
    seen: Ints
    step_q8: Ints


def all_of_rgb565() -> Colours:
    seen = to_rgb(np.arange(65536, dtype=np.uint16)).astype(np.int64)
    steps = np.array([31, 63, 31])
    return Colours(lambda rgb: rgb565(rgb).astype(np.int64), seen, 255 * 256 // steps)


def those_of(palette: npt.NDArray[np.uint16]) -> Colours:
    """A palette's; of equally near ones the first."""
    seen = to_rgb(palette).astype(np.int64)
    # |a - b|^2 without |a|^2. All numbers are whole and below 2^24: 32-bit floats hold them, in any order of sums.
    towards, lengths = seen.astype(np.float32).T * -2, (seen * seen).sum(axis=1).astype(np.float32)

    def nearest(rgb: Ints) -> Ints:
        return np.asarray((rgb.astype(np.float32) @ towards + lengths).argmin(axis=1))

    apart = np.abs(seen[:, None] - seen[None]).max(axis=2)
    np.fill_diagonal(apart, 255)
    step = int(apart.min(axis=1).mean() * 256) if len(seen) > 1 else 0
    return Colours(nearest, seen, np.array([step] * 3))


def palette_of(rgb: Bytes, most: int) -> npt.NDArray[np.uint16]:
    """At most so many RGB565 colours for 8-bit colours (k, 3), ascending: exactly theirs where they are that few."""
    own = np.unique(rgb565(rgb))
    if len(own) <= most:
        return own
    image = Image.fromarray(np.ascontiguousarray(rgb[None]))
    table = image.quantize(most, Image.Quantize.MAXCOVERAGE, kmeans=max(1, len(rgb) // 256), dither=Image.Dither.NONE)
    chosen = np.array(table.getpalette(), dtype=np.uint8).reshape(-1, 3)[:most]
    return np.unique(rgb565(chosen))


BAYER = np.zeros((1, 1), np.int64)
for _ in range(3):
    BAYER = np.block([[4 * BAYER, 4 * BAYER + 2], [4 * BAYER + 3, 4 * BAYER + 1]])
"""8 x 8 thresholds, each of 0 to 63 once."""


def _ordered(rgb: Bytes, colours: Colours) -> Ints:
    height, width, _ = rgb.shape
    thresholds = np.tile(BAYER, (height // 8 + 1, width // 8 + 1))[:height, :width, None]
    moved = rgb.astype(np.int64) * 256 + (2 * thresholds - 63) * colours.step_q8 // 128
    return np.asarray(np.clip((moved + 128) >> 8, 0, 255))


def _diffused(rgb: Bytes, colours: Colours, shown: npt.NDArray[np.bool_]) -> Ints:
    """Values by Floyd's and Steinberg's weights. Pixels of one x + 2 y do not depend on each other: they are done
    together."""
    height, width, _ = rgb.shape
    wanted_q8 = np.zeros((height + 1, width + 2, 3), np.int64)
    wanted_q8[:-1, 1:-1] = rgb.astype(np.int64) << 8
    values = np.zeros((height, width), np.int64)
    for front in range(width + 2 * height - 2):
        y = np.arange(max(0, (front - width + 2) // 2), min(height, front // 2 + 1))
        x = front - 2 * y
        if len(y) == 0:
            continue
        here = np.clip(wanted_q8[y, x + 1], 0, 255 << 8)
        values[y, x] = colours.nearest((here + 128) >> 8)
        error = np.where(shown[y, x, None], here - (colours.seen[values[y, x]] << 8), 0)
        right, left, down = error * 7 >> 4, error * 3 >> 4, error * 5 >> 4
        wanted_q8[y, x + 2] += right
        wanted_q8[y + 1, x] += left
        wanted_q8[y + 1, x + 1] += down
        wanted_q8[y + 1, x + 2] += error - right - left - down
    return values


def chosen_values(rgb: Bytes, colours: Colours, dither: str, shown: npt.NDArray[np.bool_]) -> Ints:
    """The value of each pixel (height, width) of `rgb` (height, width, 3). What is not shown passes no error on."""
    if dither == "floyd-steinberg":
        return _diffused(rgb, colours, shown)
    wanted = _ordered(rgb, colours) if dither == "ordered" else rgb.astype(np.int64)
    flat = wanted.reshape(-1, 3)
    chunks = [colours.nearest(flat[i : i + 4096]) for i in range(0, len(flat), 4096)]
    return np.concatenate(chunks).reshape(rgb.shape[:2])
