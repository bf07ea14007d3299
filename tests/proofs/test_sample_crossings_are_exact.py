"""Where a short edge passes the samples of a row (firmware/src/raster/small_sampled_setup.c), for every short edge.

From a corner, t units above a sample, the edge has gone t dx / dy units to the side. What is computed of that in
2^-20 of a pixel is step q + part (r + y): step = floor(dx R / 2^11) with R = floor((2^31 - 1) / dy), part =
floor(step / 16), y from the row's centre to the sample, and t - y = 16 q + r. The crossing, to which a pixel less 48
units is added, has the right whole part as long as the error is below 48 units, and not below 48 less a step of the
grid that crossings lie on, 2^20 / 16 dy: edge.h has the reason. Errors are linear in q, so the first and the last two
rows of each edge are enough.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import numpy.typing as npt

SOURCE = Path(__file__).resolve().parents[2] / "firmware/src/raster"
HIGH, WIDE = 511, 1023
ADDED = 48


def _offsets() -> set[int]:
    """Of the samples from the pixel's centre, up and down."""
    text = (SOURCE / "samples.h").read_text(encoding="utf-8")
    places = re.findall(r"AT\((-?\d+), (-?\d+)\)", text)
    assert len(places) == 12
    return {int(y) for _, y in places}


def _errors(dx: npt.NDArray[np.int64], dy: int, t: int, y: int) -> tuple[int, int]:
    """The least and the largest, in units of 2^-20, times 16 dy, less what may be; exact."""
    step = dx * ((2**31 - 1) // dy) >> 11
    part = step >> 4
    q, r = (t - y) >> 4, (t - y) & 15
    error = (step * q + part * (r + y)) * 16 * dy - (dx * t << 20)
    return int(error.min()), int(error.max())


def test_every_short_edge_at_every_sample() -> None:
    dx = np.arange(-WIDE, WIDE + 1, dtype=np.int64)
    for y in sorted(_offsets()):
        for dy in range(1, HIGH + 1):
            for t in {*range(min(dy, 32)), *range(max(0, dy - 32), dy)}:
                least, most = _errors(dx, dy, t, y)
                assert most < ADDED * 16 * dy, (y, dy, t)
                assert least >= ADDED * 16 * dy - 2**20, (y, dy, t)


def test_the_source_is_what_was_checked() -> None:
    text = (SOURCE / "small_sampled_setup.c").read_text(encoding="utf-8")
    for line in (
        "const int32_t step = el_product_down_11(to->x - from->x, el_reciprocal_of_short(to->y - from->y));",
        "const int32_t part = step >> EL_SUBPIXEL_BITS;",
        "<< (20 - EL_SUBPIXEL_BITS)) - 48U +",
        "(uint32_t)step * (uint32_t)(down >> EL_SUBPIXEL_BITS) + (uint32_t)(part * (down & (EL_SUBPIXELS - 1)));",
        "const int32_t at = part * points[k].y - points[k].x * (1 << (20 - EL_SUBPIXEL_BITS));",
    ):
        assert line in text, line
