"""The host's copy of what the device shows, how a frame's bands are drawn into it, and which of its lines are in doubt.

A line is in doubt from the moment that a packet with it may have been lost until it comes again whole, or a digest
proves the picture. Doubt spreads as codec 2 does: downwards into bands that are joined to a doubtful line, and into
what skips. So after a loss the host asks for what it lacks, not for everything, and knows what is proven all the same.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from edgeline import codec, split
from edgeline.codec import PIXEL, Pixels
from edgeline.errors import WireError
from edgeline.protocol import Band, Codec

BATCH_PIXELS = 1 << 17
"""Bands of codec 2 are decoded together, which is what their decoder is quick at; but no more than this, and none that
is larger is put off, which bounds the time that one packet can take."""

MOST_STRETCHES = 4
"""KEYs that are sent at once; where more would be needed, one for all that lies between the first and the last line."""


@dataclass
class Assembly:
    """The frame that is arriving. Its bands never overlap, so they hold no more than 3 bytes for each of its pixels."""

    frame: int
    bands: list[Band] = field(default_factory=list)
    next_y: int = 0
    lines: int = 0
    broken: bool = False
    """a band did not keep to the rules"""
    waiting: list[Band] = field(default_factory=list)
    """those of `bands` that are not drawn yet"""
    waiting_pixels: int = 0


_DIGEST_FACTOR = np.uint32(0x9E3779B1)
"""CRCs of CRCs are linear: without a product, two neighbouring lines that are wrong alike, the lower one two pixels
further to the left, cancel out, and stale slanted edges are like that."""


def digest_of(pixels: Pixels) -> int:
    """The digest that FRAME_END has for this picture."""
    return _digest(np.array([zlib.crc32(line) for line in np.ascontiguousarray(pixels, PIXEL)], "<u4"))


def _digest(line_crcs: npt.NDArray[np.uint32]) -> int:
    return zlib.crc32((line_crcs * _DIGEST_FACTOR).astype("<u4").tobytes())


class Picture:
    """RGB565 `pixels` of shape (height, width), black at first and all in doubt."""

    def __init__(self, width: int, height: int) -> None:
        self.pixels: Pixels = np.zeros((height, width), PIXEL)
        self.in_doubt = np.ones(height, bool)
        self._line_crcs = np.full(height, zlib.crc32(bytes(2 * width)), "<u4")
        self._asked = np.zeros(height, np.uint8)

    @property
    def width(self) -> int:
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        return int(self.pixels.shape[0])

    def digest(self) -> int:
        """FRAME_END's proof of a whole picture."""
        return _digest(self._line_crcs)

    def copy(self) -> Pixels:
        """Of the pixels, read-only."""
        pixels: Pixels = self.pixels.copy()
        pixels.flags.writeable = False
        return pixels

    def take(self, band: Band, assembly: Assembly) -> None:
        """Draws the band, or notes it for `finish`. Raises WireError if it, or one before it, breaks a rule."""
        if band.y0 < assembly.next_y or band.y0 + band.lines > self.height:
            assembly.broken = True
            raise WireError(f"a band of {band.lines} lines at line {band.y0} is out of place")
        assembly.next_y = band.y0 + band.lines
        assembly.lines += band.lines
        assembly.bands.append(band)
        size = band.lines * self.width
        try:
            if band.codec is not Codec.SPLIT:
                self.finish(assembly)
                self._draw_alone(band)
                return
            split.check_size(band, self.width)
            if assembly.waiting_pixels + size > BATCH_PIXELS:
                self.finish(assembly)
            assembly.waiting.append(band)
            assembly.waiting_pixels += size
            if size > BATCH_PIXELS:
                self.finish(assembly)
        except WireError:
            assembly.broken = True
            self.lose(band.y0, assembly.next_y)
            raise

    def finish(self, assembly: Assembly) -> None:
        """Draws what waits. Raises WireError if it breaks a rule; all of it is in doubt then."""
        bands, assembly.waiting, assembly.waiting_pixels = assembly.waiting, [], 0
        if not bands:
            return
        try:
            split.decode(bands, self.pixels)
        except WireError:
            assembly.broken = True
            self.lose(bands[0].y0, bands[-1].y0 + bands[-1].lines)
            raise
        for band in bands:
            end = band.y0 + band.lines
            for y in range(band.y0, end):
                self._line_crcs[y] = zlib.crc32(self.pixels[y])
            doubt = self._first_doubtful(band)
            self.in_doubt[band.y0 : doubt] = False
            self.in_doubt[doubt:end] = True

    def _draw_alone(self, band: Band) -> None:
        end = band.y0 + band.lines
        self.pixels[band.y0 : end] = codec.decode(band, self.width)
        for y in range(band.y0, end):
            self._line_crcs[y] = zlib.crc32(self.pixels[y])
        self.in_doubt[band.y0 : end] = False

    def _first_doubtful(self, band: Band) -> int:
        """The line from which on the band depends on one in doubt; that behind its last one if none does."""
        end = band.y0 + band.lines
        if band.joined and self.in_doubt[band.y0 - 1]:
            return band.y0
        before = self.in_doubt[band.y0 : end]
        if not before.any():
            return end
        skips = ~split.carried(band, self.width).all(axis=1)
        at = np.flatnonzero(before & skips)
        return band.y0 + int(at[0]) if at.size else end

    def lose(self, y0: int, y1: int) -> None:
        """Lines y0 .. y1 - 1 may not be what the device sent last."""
        self.in_doubt[y0:y1] = True

    def lose_all(self) -> None:
        self.in_doubt[:] = True

    def prove(self) -> None:
        """The digest is right."""
        self.in_doubt[:] = False
        self._asked[:] = 0

    def ask(self, frames: int) -> list[tuple[int, int]]:
        """Stretches (first line, how many) of those in doubt, as far as they were not asked for `frames` frames ago."""
        wanted = self.in_doubt & (self._asked == 0)
        if not wanted.any():
            return []
        steps = np.flatnonzero(np.diff(wanted, prepend=False, append=False))
        if len(steps) > 2 * MOST_STRETCHES:
            steps = steps[[0, -1]]
        stretches = [(int(first), int(end - first)) for first, end in steps.reshape(-1, 2)]
        for first, lines in stretches:
            self._asked[first : first + lines] = frames
        return stretches

    def frame_passed(self) -> None:
        """A frame has ended, one way or the other."""
        self._asked[self._asked > 0] -= 1
