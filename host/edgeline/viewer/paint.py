"""Pixels for the window, by numpy: the magnified picture with its grid, and the charts. Checked without a window."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from PIL import Image

from edgeline.codec import Pixels
from edgeline.colour import to_image, to_rgb
from edgeline.viewer.history import Track
from edgeline.viewer.viewport import Patch

Rgb = npt.NDArray[np.uint8]
"""(height, width, 3)."""

Mask = npt.NDArray[np.bool_]
"""(height, width) of the picture."""

GRID_FROM = 6
"""The least scale at which a grid leaves more of a pixel than it covers."""

_GRID_DARK, _GRID_LIGHT = 56, 80
"""What a grid line takes from bright pixels or adds to dark ones: it has to be seen on white and on black."""

DIMMED = 4
"""Dimmed pixels keep one part in so many of their brightness, as a grey ..."""

_DIM_TINT = np.array((34, 14, 44))
"""... on a ground that no dark picture has by itself."""


def magnify(picture: Pixels, patch: Patch, grid: bool = False, mask: Mask | None = None) -> Image.Image:
    """The picture's `patch`, each pixel a square, as an image of `patch.width` by `patch.height`.

    `grid` lines take the upper row and the left column of each square. The pixels that are False in `mask` are dimmed.
    """
    window = slice(patch.y0, patch.y1), slice(patch.x0, patch.x1)
    part = picture[window]
    image = to_image(part) if mask is None else Image.fromarray(_dim(to_rgb(part), mask[window]))
    large = image.resize((patch.width, patch.height), Image.Resampling.NEAREST)
    if not grid or patch.scale < GRID_FROM:
        return large
    pixels = np.array(large)
    pixels[:: patch.scale] = _grid(pixels[:: patch.scale])
    rows = np.arange(patch.height) % patch.scale != 0  # where lines cross, once is enough
    columns = slice(None, None, patch.scale)
    pixels[rows, columns] = _grid(pixels[rows, columns])
    return Image.fromarray(pixels)


def _grid(line: Rgb) -> Rgb:
    bright = line.max(axis=-1, keepdims=True) > 127
    darker, lighter = np.maximum(line, _GRID_DARK) - _GRID_DARK, np.minimum(line, 255 - _GRID_LIGHT) + _GRID_LIGHT
    return np.where(bright, darker, lighter).astype(np.uint8)


def _dim(part: Rgb, mask: Mask) -> Rgb:
    grey = part.mean(axis=-1, keepdims=True) / DIMMED + _DIM_TINT
    return np.where(mask[..., None], part, grey).astype(np.uint8)


def chart(
    track: Track,
    failures: npt.NDArray[np.int64],
    size: tuple[int, int],
    top: float,
    colours: tuple[tuple[int, int, int], tuple[int, int, int], tuple[int, int, int]],
) -> Rgb:
    """A series from left, ten seconds ago, to right, now; `size` is (width, height), `top` the value at the upper edge.

    `colours`: the ground, the line, and the marks at the foot where a frame failed. In each column a vertical bar goes
    from the least to the greatest value; the line of means is brighter, the area below it fainter. A column without
    a frame repeats the one before it, up to the last frame.
    """
    width, height = size
    ground, line, failed = (np.array(colour, np.float64) for colour in colours)
    column = np.arange(width) * len(track.mean) // width
    filled = np.flatnonzero(~np.isnan(track.mean))
    image = np.empty((height, width, 3))
    image[:] = ground
    image[height // 2] = ground * 0.7 + 255 * 0.06
    if filled.size:
        before = np.searchsorted(filled, column, side="right") - 1
        there = (before >= 0) & (column <= filled[-1])
        source = filled[np.maximum(before, 0)]
        rows = [_row(values[source], top, height) for values in (track.high, track.mean, track.low)]
        high, mean, low = (np.where(there, row, height) for row in rows)
        y = np.arange(height)[:, None]
        _mix(image, (y > mean) & there, line, 0.22)
        _mix(image, (y >= high) & (y <= low) & there, line, 0.45)
        # The line joins a column's mean with that of the column before it.
        previous = np.where(np.roll(there, 1), np.roll(mean, 1), mean)
        previous[0] = mean[0]
        _mix(image, (y >= np.minimum(mean, previous)) & (y <= np.maximum(mean, previous)) & there, line, 1.0)
    image[height - 3 :, failures[column] > 0] = failed
    return image.astype(np.uint8)


def _row(values: npt.NDArray[np.float64], top: float, height: int) -> npt.NDArray[np.int64]:
    """The rows of values 0 .. `top`, cut off there: the lowest row for 0."""
    share = np.clip(np.nan_to_num(values) / top, 0, 1)
    return np.rint((1 - share) * (height - 1)).astype(np.int64)


def _mix(
    image: npt.NDArray[np.float64], where: npt.NDArray[np.bool_], colour: npt.NDArray[np.float64], share: float
) -> None:
    image[where] = image[where] * (1 - share) + colour * share
