"""Codec 2, split streams (WIRE.md, "Split streams"): all bands of a frame at once, in numpy.

A line depends on the one above, so lines are decoded one after the other, but in one look-up and one addition each. All
else is known beforehand: every pixel is either said (a literal, a kept one), or one of the line above, or its left
neighbour plus a difference. Following the neighbours back to the first pixel of another kind, their anchor, leaves

    pixel = (line above, or 0)[source] + sum of differences, modulo 2^16

`decode_plainly` follows the text of WIRE.md token by token and is what the tests hold `decode` against.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from edgeline.errors import WireError
from edgeline.protocol import Band

Pixels = npt.NDArray[np.uint16]
_Ints = npt.NDArray[np.int64]

PAIRS, RECENT, RUN, ABOVE, ABOVE_LEFT, ABOVE_RIGHT, SKIP, SKIP_TO_END, LITERALS = (
    *(63, 127, 175, 196, 217, 230, 243, 247, 248),
)
"""The first token of each kind; deltas begin with 0."""

PAIR_CLASSES = ((0, 0, 0), (-1, -1, 0), (0, -1, 0), (0, 1, 0), (1, 1, 0), (-1, -1, -1), (1, 1, 1), (-1, 0, 0))
"""(dr, dg, db) of the deltas that a pair is made of."""

RUN_LENGTHS = (1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, 32, 48, 64, 96, 128)
"""Of runs and copies from above; one more is the line's width."""

SLANT_LENGTHS = (1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 24, 32, 64)
SEGMENT = 64
DITHER_LAG = 4

_DELTA, _PAIR, _RECENT, _RUN, _ABOVE, _SKIP, _SKIP_TO_END, _LITERAL = range(8)
"""Kinds of tokens; copies are one kind that differs in where it copies from."""


def delta(token: int) -> int:
    """What a delta token adds to L."""
    green = token // 9 - 3
    half = green // 2
    return 2048 * (token // 3 % 3 - 1 + half) + 32 * green + token % 3 - 1 + half


def length(token: int, width: int) -> int:
    """The pixels of a token in a line of `width`; 0 for SKIP_TO_END, whose length depends on where it stands."""
    if RUN <= token < ABOVE_LEFT:
        return (*RUN_LENGTHS, width)[(token - RUN) % (ABOVE - RUN)]
    if ABOVE_LEFT <= token < SKIP:
        return SLANT_LENGTHS[(token - ABOVE_LEFT) % len(SLANT_LENGTHS)]
    if SKIP <= token < SKIP_TO_END:
        return SEGMENT * (token - SKIP + 1)
    if token >= LITERALS:
        return token - LITERALS + 1
    return 0 if token == SKIP_TO_END else 2 if PAIRS <= token < RECENT else 1


def _pair(token: int) -> tuple[int, int]:
    sums = [2048 * red + 32 * green + blue for red, green, blue in PAIR_CLASSES]
    return sums[(token - PAIRS) // len(sums)], sums[(token - PAIRS) % len(sums)]


_BOUNDS = (PAIRS, RECENT, RUN, ABOVE, SKIP, SKIP_TO_END, LITERALS)
_KINDS = np.searchsorted(_BOUNDS, np.arange(256), side="right").astype(np.uint8)
_LENGTHS = np.array([length(token, 0) for token in range(256)], np.int64)
_IS_WIDTH = np.isin(np.arange(256), (ABOVE - 1, ABOVE_LEFT - 1))
_FIRST = np.array([delta(t) if t < PAIRS else _pair(t)[0] if t < RECENT else 0 for t in range(256)]).astype(np.uint16)
_SECOND = np.array([_pair(t)[1] if PAIRS <= t < RECENT else 0 for t in range(256)]).astype(np.uint16)
_SLANT = np.array([-1 if ABOVE_LEFT <= t < ABOVE_RIGHT else ABOVE_RIGHT <= t < SKIP for t in range(256)], np.int64)
_USED = np.array([max(t - LITERALS + 1, 0) for t in range(256)], np.int64)
_IS_LEFT_KIND = np.isin(np.arange(8), (_DELTA, _PAIR, _RUN))
"""Whether a kind's pixels are made of their left neighbours."""


def check_size(band: Band, width: int) -> None:
    """Raises WireError if the band cannot be right because it has more than its lines can hold, or half a pixel."""
    if len(band.literals) % 2:
        raise WireError("a BAND with half a pixel at its end")
    if max(len(band.tokens), len(band.literals) // 2) > band.lines * width:
        raise WireError(f"a BAND with more than {band.lines} lines of {width} pixels can hold")


def decode(bands: Sequence[Band], picture: Pixels) -> None:
    """Draws a frame's bands, in ascending order, into `picture`, (height, width), which holds the frame before.

    Raises WireError if one of them breaks a rule; `picture` is as it was then.
    """
    if bands:
        _Frame(bands, picture).draw()


class _Frame:
    """The tokens of a frame's bands, one after the other, and the pixels that they stand for, as one array of lines."""

    def __init__(self, bands: Sequence[Band], picture: Pixels) -> None:
        height, self.width = picture.shape
        self.bands = bands
        self.picture = picture
        y = 0
        for band in bands:
            if band.y0 < y or band.y0 + band.lines > height:
                raise WireError(f"a BAND of {band.lines} lines at line {band.y0} is out of place")
            if band.joined and band.y0 == 0:
                raise WireError("a BAND that needs the line above the picture")
            check_size(band, self.width)
            y = band.y0 + band.lines
        self.tokens = np.frombuffer(b"".join(band.tokens for band in bands), np.uint8)
        self.kinds = _KINDS[self.tokens]
        counts = np.array([len(band.tokens) for band in bands])
        self.first_tokens = np.cumsum(counts) - counts
        self.lines = np.array([band.lines for band in bands])
        self.first_lines = np.cumsum(self.lines) - self.lines
        self._place_tokens(counts)
        self._number_literals(counts)

    def _place_tokens(self, counts: _Ints) -> None:
        """Finds `lengths` and `starts`; the latter count pixels through all bands."""
        width = self.width
        lengths = _LENGTHS[self.tokens]
        lengths[_IS_WIDTH[self.tokens]] = width
        to_end = np.flatnonzero(self.kinds == _SKIP_TO_END)
        if to_end.size:
            # Behind such a token a line begins, so what stands since the last one tells how far it has to reach.
            since = np.diff(np.cumsum(lengths)[to_end], prepend=0)
            lengths[to_end] = width - since % width
        ends = np.cumsum(lengths)
        self.lengths = lengths
        self.starts = ends - lengths
        expected = (self.first_lines + self.lines) * width
        last = self.first_tokens + counts - 1
        if (counts == 0).any() or (ends[last] != expected).any():
            raise WireError(f"a BAND whose tokens do not add up to lines of {width} pixels")
        self.token_lines = self.starts // width
        if (self.token_lines != (ends - 1) // width).any():
            raise WireError("a BAND with a token across the end of a line")
        self._check_copies()

    def _check_copies(self) -> None:
        copies = np.flatnonzero(self.kinds == _ABOVE)
        lines = self.token_lines[copies]
        alone = self.first_lines[[not band.joined for band in self.bands]]
        if alone.size and np.isin(lines, alone).any():
            raise WireError("a BAND with a copy from above its first line")
        slant = _SLANT[self.tokens[copies]]
        first = self.starts[copies] - lines * self.width + slant
        if copies.size and (first.min() < 0 or (first + self.lengths[copies]).max() > self.width):
            raise WireError("a BAND with a copy from beyond the line above")

    def _number_literals(self, counts: _Ints) -> None:
        """Finds the `literals` in the order of their use and, for tokens that name a recent one, which it is."""
        used = _USED[self.tokens]
        before = np.cumsum(used) - used
        totals = np.add.reduceat(used, self.first_tokens)
        sizes = np.array([len(band.literals) // 2 for band in self.bands])
        if (totals != sizes).any():
            at = int(np.flatnonzero(totals != sizes)[0])
            raise WireError(f"a BAND with {sizes[at]} literals where its tokens use {totals[at]}")
        self.literals = np.concatenate([np.frombuffer(band.literals, "<u2")[::-1] for band in self.bands])
        self.recent = np.flatnonzero(self.kinds == _RECENT)
        named = before[self.recent] - 1 - (self.tokens[self.recent] - RECENT)
        first_literals = np.cumsum(sizes) - sizes
        if (named < np.repeat(first_literals, counts)[self.recent]).any():
            raise WireError("a BAND that names a literal before its first")
        self.named = named

    def draw(self) -> None:
        width = self.width
        sources, sums = self._follow()
        drawn = np.zeros((len(sources), width + 1), np.uint16)  # the 0 is for pixels that need no line above
        above = np.zeros(width + 1, np.uint16)
        y = 0
        for band, first in zip(self.bands, self.first_lines, strict=True):
            if band.joined and band.y0 != y:
                above = np.append(self.picture[band.y0 - 1], np.uint16(0))
            for line in range(first, first + band.lines):
                np.take(above, sources[line], out=drawn[line, :width], mode="clip")
                drawn[line, :width] += sums[line]
                above = drawn[line]
            y = band.y0 + band.lines
        for band, first in zip(self.bands, self.first_lines, strict=True):
            self.picture[band.y0 : band.y0 + band.lines] = drawn[first : first + band.lines, :width]

    def _follow(self) -> tuple[npt.NDArray[np.intp], Pixels]:
        """For each pixel, the column of the line above that it is made of (`width`: none), and what is added to it."""
        width = self.width
        tokens, starts, lengths = self.tokens, self.starts, self.lengths
        total = int(self.lines.sum()) * width
        differences = np.zeros(total, np.uint16)
        differences[starts] = _FIRST[tokens]
        pairs = np.flatnonzero(self.kinds == _PAIR)
        differences[starts[pairs] + 1] = _SECOND[tokens[pairs]]

        kinds = np.repeat(self.kinds, lengths)
        is_left = _IS_LEFT_KIND[kinds]
        columns = np.tile(np.arange(width), total // width)
        sources = np.full(total, width, np.intp)
        said = np.zeros(total, np.uint16)
        said[kinds == _LITERAL] = self.literals
        said[starts[self.recent]] = self.literals[self.named]
        kept = np.flatnonzero((kinds == _SKIP) | (kinds == _SKIP_TO_END))
        if kept.size:
            rows = np.concatenate([np.arange(band.y0, band.y0 + band.lines) for band in self.bands])
            said[kept] = self.picture[rows[kept // width], columns[kept]]
        copies = np.flatnonzero(kinds == _ABOVE)
        slants = np.repeat(_SLANT[tokens], lengths)[copies] if copies.size else copies
        sources[copies] = columns[copies] + slants

        lagging = self._lagging_lines()
        grid = is_left.reshape(-1, width)
        heads = np.zeros_like(grid)
        heads[:, 0] = True
        heads[lagging, :DITHER_LAG] = True
        heads &= grid
        at = np.flatnonzero(heads)
        joined = np.ones(total // width, bool)
        joined[self.first_lines] = [band.joined for band in self.bands]
        sources[at] = np.where(joined[at // width], columns[at], width)
        said[at] = differences[at]
        is_left[at] = False
        return _from_anchors(is_left.reshape(grid.shape), differences, sources, said, lagging)

    def _lagging_lines(self) -> npt.NDArray[np.intp]:
        bits = [
            np.unpackbits(np.frombuffer(band.lags, np.uint8), bitorder="little", count=band.lines)
            if band.lags
            else np.zeros(band.lines, np.uint8)
            for band in self.bands
        ]
        return np.flatnonzero(np.concatenate(bits))


def _from_anchors(
    is_left: npt.NDArray[np.bool_],
    differences: Pixels,
    sources: npt.NDArray[np.intp],
    said: Pixels,
    lagging: npt.NDArray[np.intp],
) -> tuple[npt.NDArray[np.intp], Pixels]:
    """Gives every pixel that is made of its left neighbour what its anchor has, and the differences in between."""
    lines, width = is_left.shape
    places = np.arange(lines * width)
    if lagging.size:
        # Pixels that hang together next to each other: first those of columns 0, 4, 8, ..., then those of 1, 5, 9, ...
        order = np.argsort(np.arange(width) % DITHER_LAG, kind="stable")
        grid = places.reshape(lines, width)
        grid[lagging] = grid[lagging][:, order]
        is_left = is_left.ravel()[places]
        sums = np.cumsum(differences[places], dtype=np.uint16)
    else:
        is_left = is_left.ravel()
        sums = np.cumsum(differences, dtype=np.uint16)
    anchors = np.maximum.accumulate(np.where(is_left, 0, np.arange(lines * width)))
    total = sums - sums[anchors]
    if lagging.size:
        anchors = places[anchors]
        found = np.empty_like(sources)
        added = np.empty_like(said)
        found[places] = sources[anchors]
        added[places] = said[anchors] + total
    else:
        found = sources[anchors]
        added = said[anchors] + total
    return found.reshape(lines, width), added.reshape(lines, width)


def decode_plainly(band: Band, picture: Pixels) -> Pixels:
    """One band's lines, token by token; `picture` holds what the host has so far and stays as it is."""
    height, width = picture.shape
    if band.y0 + band.lines > height or (band.joined and band.y0 == 0) or len(band.literals) % 2:
        raise WireError("out of place, or half a pixel")
    stored = [int.from_bytes(band.literals[i : i + 2], "little") for i in range(0, len(band.literals), 2)]
    literals = stored[::-1]
    used = 0
    kept = picture[band.y0 : band.y0 + band.lines].tolist()
    above: list[int] | None = picture[band.y0 - 1].tolist() if band.joined else None
    lines: list[list[int]] = []
    row: list[int] = []

    def left() -> int:
        lag = DITHER_LAG if band.lags and band.lags[len(lines) // 8] >> len(lines) % 8 & 1 else 1
        if len(row) >= lag:
            return row[-lag]
        return above[len(row)] if above is not None else 0

    for token in band.tokens:
        if len(lines) == band.lines:
            raise WireError("a token too many")
        pixels = width - len(row) if token == SKIP_TO_END else length(token, width)
        if len(row) + pixels > width:
            raise WireError("a token across the end of a line")
        if token < PAIRS:
            row.append(left() + delta(token) & 0xFFFF)
        elif token < RECENT:
            for difference in _pair(token):
                row.append(left() + difference & 0xFFFF)
        elif token < RUN:
            if token - RECENT >= used:
                raise WireError("a literal that never was")
            row.append(literals[used - 1 - (token - RECENT)])
        elif token < ABOVE:
            for _ in range(pixels):
                row.append(left())
        elif token < SKIP:
            first = len(row) + (-1 if ABOVE_LEFT <= token < ABOVE_RIGHT else token >= ABOVE_RIGHT)
            if above is None or first < 0 or first + pixels > width:
                raise WireError("a copy of what is not there")
            row += above[first : first + pixels]
        elif token < LITERALS:
            row += kept[len(lines)][len(row) : len(row) + pixels]
        else:
            if used + pixels > len(literals):
                raise WireError("too few literals")
            row += literals[used : used + pixels]
            used += pixels
        if len(row) == width:
            lines.append(row)
            above, row = row, []
    if len(lines) != band.lines or used != len(literals):
        raise WireError("lengths")
    return np.array(lines, np.uint16)
