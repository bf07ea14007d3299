"""A small encoder of codec 2 for the fake device: literals, runs, copies from above, skips."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np
import numpy.typing as npt

from edgeline import split
from edgeline.codec import Pixels
from edgeline.protocol import Band, Codec


def encode_split(
    frame: int, y0: int, pixels: Pixels, kept: npt.NDArray[np.bool_], above: list[int] | None = None
) -> Band:
    """`pixels`, (lines, width), as one band, joined to the line `above` if there is one.

    `kept`, of the same shape, has the pixels that the host has already: whole segments of a line.
    """
    encoder = _Encoder()
    joined = above is not None
    for line, keep in zip(pixels.tolist(), kept.tolist(), strict=True):
        encoder.line(line, keep, above)
        above = line
    stored = b"".join(value.to_bytes(2, "little") for value in reversed(encoder.literals))
    return Band(frame, y0, len(pixels), Codec.SPLIT, bytes(encoder.tokens), stored, joined=joined)


class _Encoder:
    def __init__(self) -> None:
        self.tokens = bytearray()
        self.literals: list[int] = []

    def line(self, line: list[int], keep: list[bool], above: list[int] | None) -> None:
        width = len(line)
        for begin in range(0, width, split.SEGMENT):
            end = begin + split.SEGMENT
            if keep[begin]:
                self.tokens.append(split.SKIP if end <= width else split.SKIP_TO_END)
            else:
                self._segment(line, begin, min(end, width), above)

    def _segment(self, line: list[int], x: int, end: int, above: list[int] | None) -> None:
        while x < end:
            same = _equal(line, x, end, above, x) if above is not None else 0
            run = _equal(line, x, end, line, x - 1) if x else 0
            if same > run:
                size, token = _longest(split.ABOVE, split.ABOVE_LEFT, same)
            elif run:
                size, token = _longest(split.RUN, split.ABOVE, run)
            else:
                size, token = 1, split.LITERALS
                self.literals.append(line[x])
            self.tokens.append(token)
            x += size


def _equal(line: Sequence[int], x: int, end: int, other: Sequence[int], at: int) -> int:
    """How many pixels of line[x:end] are those of `other` from `at` on."""
    size = 0
    while x + size < end and line[x + size] == other[at + size]:
        size += 1
    return size


@cache
def _longest(first: int, last: int, most: int) -> tuple[int, int]:
    """Length and number of the longest of the tokens first .. last - 1 that is no longer than `most`."""
    sizes = [(split.length(token), token) for token in range(first, last)]
    return max(item for item in sizes if item[0] <= most)
