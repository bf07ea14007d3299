"""GIF89a, frame by frame.

Pillow's own animation writer keeps all frames until the end, so Pillow compresses the frames here, and the container, a
few fixed records, is written by hand.
"""

from __future__ import annotations

import struct

import numpy as np
from PIL import GifImagePlugin, Image

from edgeline.codec import Pixels
from edgeline.colour import to_image, to_rgb
from edgeline.exports.animation import Animation, Ticks, changed

_TICK_US = 10_000
_SHORTEST = 2
"""Viewers take a delay of less than 2/100 s for a mistake and show the frame for 10/100 s."""

_COLOURS = 256


class GifRecorder(Animation):
    """A GIF that repeats, each frame with a palette of its own (GIF89a specification, sections 18 to 23).

    Exact where the rectangle that changed has at most 256 colours; otherwise the colours are quantised: record an
    animated PNG if every pixel counts. Delays are whole 1/100 s, 2 at least; their rounding does not add up.
    """

    def __init__(self, path: str) -> None:
        super().__init__(path)
        self._shown: Pixels | None = None
        self._ticks = Ticks(_TICK_US, _SHORTEST)

    def _frame(self, picture: Pixels, duration_us: int) -> None:
        stream = self._file.stream
        if self._shown is None:
            stream.write(b"GIF89a" + struct.pack("<HHBBB", picture.shape[1], picture.shape[0], 0x70, 0, 0))
            stream.write(b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")
        x0, y0, x1, y1 = changed(self._shown, picture)
        image = _with_palette(picture[y0:y1, x0:x1])
        delay_ms = self._ticks.of(duration_us) * 10
        blocks = GifImagePlugin.getdata(image, (x0, y0), duration=delay_ms, disposal=1, include_color_table=True)
        stream.write(b"".join(blocks))
        self._shown = picture

    def _end(self) -> None:
        self._file.stream.write(b"\x3b")


def _with_palette(part: Pixels) -> Image.Image:
    colours, indices = np.unique(part, return_inverse=True)
    if colours.size > _COLOURS:
        return to_image(part).quantize(_COLOURS, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    image = Image.frombytes("P", (part.shape[1], part.shape[0]), indices.astype(np.uint8).tobytes())
    image.putpalette(to_rgb(colours.reshape(1, -1)).tobytes())
    return image
