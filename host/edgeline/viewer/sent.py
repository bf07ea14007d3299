"""Which pixels a frame carried, and which the host already had: the overlay "not sent".

Whole lines that no band covers were not sent; neither were those pixels of a band of codec 2 that it skips (WIRE.md,
"Split streams").
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from edgeline import split
from edgeline.events import Frame
from edgeline.protocol import Codec


def sent(frame: Frame) -> npt.NDArray[np.bool_]:
    """(h, w): True where the pixel came with this frame."""
    height, width = frame.picture.shape
    came = np.zeros((height, width), np.bool_)
    for band in frame.bands:
        rows = slice(band.y0, band.y0 + band.lines)
        came[rows] = True if band.codec is not Codec.SPLIT else split.carried(band, width)
    return came
