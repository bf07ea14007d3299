"""Codec 2, split streams (WIRE.md, "Split streams"): all bands of a frame at once, in numpy.

A line depends on the one above, so lines are drawn one after the other, but in one look-up and one addition each. All
else is known beforehand: every pixel is either said (a literal, a kept one), or one of the line above, or its left
neighbour plus a difference. Following the neighbours back to the first pixel of another kind, their anchor, leaves

    pixel = (line above, or 0)[source] + sum of differences, modulo 2^16

Anchors and sums are found token by token, and pixel by pixel only for the lines with lag 4, where four chains are woven
into each other. `decode_plainly` follows the text of WIRE.md and is what the tests hold `decode` against.
"""

from __future__ import annotations

import bisect
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from edgeline.errors import WireError
from edgeline.protocol import Band

Pixels = npt.NDArray[np.uint16]
_Ints = npt.NDArray[np.int64]

PAIRS, RECENT, RUN, ABOVE, ABOVE_LEFT, ABOVE_RIGHT, MORE, MORE_TO_END, SKIP, SKIP_TO_END, LITERALS = (
    *(63, 127, 175, 191, 207, 223, 239, 247, 248, 249, 250),
)
"""The first token of each kind; deltas begin with 0."""

PAIR_CLASSES = ((0, 0, 0), (-1, -1, 0), (0, -1, 0), (0, 1, 0), (1, 1, 0), (-1, -1, -1), (1, 1, 1), (-1, 0, 0))
"""(dr, dg, db) of the deltas that a pair is made of."""

STRETCH = 16
"""The pixels of the longest run and copy, and the unit of MORE."""

SEGMENT = 64
DITHER_LAG = 4

_DELTA, _PAIR, _RECENT, _RUN, _COPY, _MORE, _SKIP, _LITERAL = range(8)


def delta(token: int) -> int:
    """What a delta token adds to L."""
    green = token // 9 - 3
    half = green // 2
    return 2048 * (token // 3 % 3 - 1 + half) + 32 * green + token % 3 - 1 + half


def length(token: int) -> int:
    """The pixels of a token; 0 for MORE_TO_END and SKIP_TO_END, whose length depends on where they stand."""
    if token in (MORE_TO_END, SKIP_TO_END):
        return 0
    if token >= LITERALS:
        return token - LITERALS + 1
    if token >= MORE:
        return SEGMENT if token == SKIP else STRETCH * (token - MORE + 1)
    if token >= RUN:
        return (token - RUN) % STRETCH + 1
    return 2 if PAIRS <= token < RECENT else 1


def slant(token: int) -> int:
    """How far to the right of the pixel above a copy begins."""
    return -1 if ABOVE_LEFT <= token < ABOVE_RIGHT else int(ABOVE_RIGHT <= token < MORE)


def _pair(token: int) -> tuple[int, int]:
    sums = [2048 * red + 32 * green + blue for red, green, blue in PAIR_CLASSES]
    return sums[(token - PAIRS) // len(sums)], sums[(token - PAIRS) % len(sums)]


_BOUNDS = (PAIRS, RECENT, RUN, ABOVE, MORE, SKIP, LITERALS)
# bytes.translate is the fastest look-up there is.
_KINDS = bytes(bisect.bisect(_BOUNDS, token) for token in range(256))
_LENGTHS = bytes(map(length, range(256)))
_SLANTS = bytes(slant(token) + 1 for token in range(256))
_USED = bytes(max(token - LITERALS + 1, 0) for token in range(256))
_SECOND = np.array([_pair(t)[1] if PAIRS <= t < RECENT else 0 for t in range(256)]).astype(np.uint16)
_SUMS = np.array([delta(t) if t < PAIRS else sum(_pair(t)) if t < RECENT else 0 for t in range(256)]).astype(np.uint16)
"""What a token adds to its left neighbour, both of its pixels together."""
_IS_LEFT_KIND = np.isin(np.arange(8), (_DELTA, _PAIR, _RUN))
"""Whether a kind's pixels are made of their left neighbours."""
_GOES_ON = np.isin(np.arange(8), (_RUN, _COPY, _SKIP))
"""Whether MORE may follow."""


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


def carried(band: Band, width: int) -> npt.NDArray[np.bool_]:
    """(lines, width): True for the pixels that a band brought, False for those that it let the host keep. The band must
    be one that could be decoded."""
    kinds = np.frombuffer(bytearray(band.tokens.translate(_KINDS)), np.uint8)
    more, before = _find_more(kinds)
    kinds[more] = kinds[before]
    return np.repeat(kinds != _SKIP, _lengths_of(band.tokens, width)).reshape(band.lines, width)


def _lengths_of(tokens: bytes, width: int) -> _Ints:
    """The pixels of each token, those that reach to the end of their line too."""
    lengths = np.frombuffer(tokens.translate(_LENGTHS), np.uint8).astype(np.int64)
    to_end = np.flatnonzero(lengths == 0)
    if to_end.size:
        # Behind such a token a line begins, so what stands since the last one tells how far it has to reach.
        since = np.diff(np.cumsum(lengths)[to_end], prepend=0)
        lengths[to_end] = width - since % width
    return lengths


def _find_more(kinds: npt.NDArray[np.uint8]) -> tuple[_Ints, _Ints]:
    """The tokens that are a MORE, and for each the one that it goes on with; -1 if there is none."""
    more = np.flatnonzero(kinds == _MORE)
    is_first = np.diff(more, prepend=-2) != 1  # of those that follow each other
    return more, (more[is_first] - 1)[np.cumsum(is_first) - 1]


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
        self.text = b"".join(band.tokens for band in bands)
        self.tokens = np.frombuffer(self.text, np.uint8)
        counts = np.array([len(band.tokens) for band in bands])
        self.first_tokens = np.cumsum(counts) - counts
        lines = np.array([band.lines for band in bands])
        self.lines = int(lines.sum())
        self.first_lines = np.cumsum(lines) - lines
        self.rows = np.concatenate([np.arange(band.y0, band.y0 + band.lines) for band in bands])
        self.joined = np.ones(self.lines, bool)
        self.joined[self.first_lines] = [band.joined for band in bands]
        self._place_tokens(counts, lines)
        self._go_on()
        self._check_copies()
        self._number_literals(counts)

    def _place_tokens(self, counts: _Ints, lines: _Ints) -> None:
        """Finds `lengths` and `starts`, which count pixels through all bands, and the first token of each line."""
        width = self.width
        lengths = _lengths_of(self.text, width)
        ends = np.cumsum(lengths)
        expected = (self.first_lines + lines) * width
        last = self.first_tokens + counts - 1
        if (counts == 0).any() or (ends[last] != expected).any():
            raise WireError(f"a BAND whose tokens do not add up to lines of {width} pixels")
        self.lengths = lengths
        self.starts = ends - lengths
        begins = np.arange(self.lines) * width
        self.line_tokens = np.searchsorted(self.starts, begins)
        if (self.starts[self.line_tokens] != begins).any():
            raise WireError("a BAND with a token across the end of a line")

    def _go_on(self) -> None:
        """Makes each MORE what it goes on with."""
        self.kinds = np.frombuffer(bytearray(self.text.translate(_KINDS)), np.uint8)
        self.slants = np.frombuffer(bytearray(self.text.translate(_SLANTS)), np.uint8)
        more, before = _find_more(self.kinds)
        if (self.starts[more] % self.width == 0).any() or not _GOES_ON[self.kinds[before]].all():
            raise WireError("a BAND that goes on with what cannot go on")
        self.kinds[more] = self.kinds[before]
        self.slants[more] = self.slants[before]

    def _check_copies(self) -> None:
        """Finds the `copies`, and in which column of the line above they begin."""
        copies = np.flatnonzero(self.kinds == _COPY)
        starts = self.starts[copies]
        if not self.joined[starts // self.width].all():
            raise WireError("a BAND with a copy from above its first line")
        columns = starts % self.width + self.slants[copies] - 1
        if copies.size and (columns.min() < 0 or (columns + self.lengths[copies]).max() > self.width):
            raise WireError("a BAND with a copy from beyond the line above")
        self.copies, self.copy_columns = copies, columns

    def _number_literals(self, counts: _Ints) -> None:
        """Finds the `literals` in the order of their use, how many are `used` up to each token, and which is named by
        those that name a recent one."""
        used = np.frombuffer(self.text.translate(_USED), np.uint8)
        self.used = np.cumsum(used, dtype=np.int64)
        totals = np.diff(self.used[self.first_tokens + counts - 1], prepend=0)
        sizes = np.array([len(band.literals) // 2 for band in self.bands])
        if (totals != sizes).any():
            at = int(np.flatnonzero(totals != sizes)[0])
            raise WireError(f"a BAND with {sizes[at]} literals where its tokens use {totals[at]}")
        self.literals = np.frombuffer(b"".join(band.literals for band in reversed(self.bands)), "<u2")[::-1]
        self.recent = np.flatnonzero(self.kinds == _RECENT)
        self.named = self.used[self.recent] - 1 - (self.tokens[self.recent] - RECENT)
        first_literals = np.cumsum(sizes) - sizes
        if (self.named < first_literals[np.searchsorted(self.first_tokens, self.recent, "right") - 1]).any():
            raise WireError("a BAND that names a literal before its first")

    def draw(self) -> None:
        width = self.width
        sources, added = self._follow()
        drawn = np.zeros((self.lines, width + 1), np.uint16)  # the 0 is for pixels that need no line above
        above = np.zeros(width + 1, np.uint16)
        y = 0
        for band, first in zip(self.bands, self.first_lines.tolist(), strict=True):
            if band.joined and band.y0 != y:
                above = np.append(self.picture[band.y0 - 1], np.uint16(0))
            for line in range(first, first + band.lines):
                row = drawn[line]
                np.add(above.take(sources[line]), added[line], out=row[:width])
                above = row
            y = band.y0 + band.lines
        for band, first in zip(self.bands, self.first_lines, strict=True):
            self.picture[band.y0 : band.y0 + band.lines] = drawn[first : first + band.lines, :width]

    def _follow(self) -> tuple[_Ints, Pixels]:
        """For each pixel, the column of the line above that it is made of (`width`: none), and what is added to it."""
        width, kinds, starts, lengths = self.width, self.kinds, self.starts, self.lengths
        is_left = _IS_LEFT_KIND.take(kinds)
        differences = _SUMS.take(self.tokens)
        is_anchor = ~is_left
        heads = self.line_tokens[is_left[self.line_tokens]]  # they go on from the line above
        is_anchor[heads] = True

        # Of each anchor's last pixel, which left neighbours go on from.
        sources = np.full(len(kinds), width)
        sources[heads] = np.where(self.joined[starts[heads] // width], 0, width)
        sources[self.copies] = self.copy_columns + lengths[self.copies] - 1
        added = np.zeros(len(kinds), np.uint16)
        added[heads] = differences[heads]
        added[self.recent] = self.literals[self.named]
        literal = np.flatnonzero(kinds == _LITERAL)
        added[literal] = self.literals[self.used[literal] - 1]
        skips = np.flatnonzero(kinds == _SKIP)
        lines = starts[skips] // width
        kept_values = self.picture.take(_pixels_of(starts[skips] + (self.rows[lines] - lines) * width, lengths[skips]))
        added[skips] = kept_values[np.cumsum(lengths[skips]) - 1]
        sources, added = _from_anchors(is_anchor, differences, sources, added)

        # From tokens to pixels. A copy's columns count up, from its own first one.
        sources[self.copies] = self.copy_columns - starts[self.copies]
        token_of = np.repeat(np.arange(len(kinds)), lengths)
        pixel_sources = sources.take(token_of) + np.arange(len(token_of)) * (kinds == _COPY).take(token_of)
        pixel_added = added.take(token_of)
        pairs = np.flatnonzero(kinds == _PAIR)
        seconds = _SECOND[self.tokens[pairs]]
        pixel_added[starts[pairs]] -= seconds
        pixel_added[_pixels_of(starts[literal], lengths[literal])] = self.literals
        pixel_added[_pixels_of(starts[skips], lengths[skips])] = kept_values
        grids = pixel_sources.reshape(-1, width), pixel_added.reshape(-1, width)

        lagging = self._lagging_lines()
        if lagging.size:
            steps = np.zeros(len(token_of), np.uint16)
            steps[starts] = differences
            steps[starts[pairs]] -= seconds
            steps[starts[pairs] + 1] = seconds
            self._follow_lagging(lagging, is_left.take(token_of).reshape(-1, width), steps.reshape(-1, width), *grids)
        return grids

    def _follow_lagging(
        self, lagging: _Ints, is_left: npt.NDArray[np.bool_], steps: Pixels, sources: _Ints, added: Pixels
    ) -> None:
        """The same for lines with lag 4, pixel by pixel; what is not made of its left neighbour is there already."""
        for column in range(min(DITHER_LAG, self.width)):
            # Every fourth pixel: they are each other's neighbours.
            woven = (lagging, slice(column, None, DITHER_LAG))
            is_anchor = ~is_left[woven]
            differences, chain_sources, chain_added = steps[woven], sources[woven], added[woven]
            heads = np.flatnonzero(~is_anchor[:, 0])
            is_anchor[:, 0] = True
            chain_sources[heads, 0] = np.where(self.joined[lagging[heads]], column, self.width)
            chain_added[heads, 0] = differences[heads, 0]
            found, summed = _from_anchors(
                is_anchor.ravel(), differences.ravel(), chain_sources.ravel(), chain_added.ravel()
            )
            sources[woven] = found.reshape(is_anchor.shape)
            added[woven] = summed.reshape(is_anchor.shape)

    def _lagging_lines(self) -> _Ints:
        has_lag = np.zeros(self.lines, np.uint8)
        for band, first in zip(self.bands, self.first_lines, strict=True):
            if band.lags:
                bits = np.unpackbits(np.frombuffer(band.lags, np.uint8), bitorder="little", count=band.lines)
                has_lag[first : first + band.lines] = bits
        return np.flatnonzero(has_lag)


def _from_anchors(
    is_anchor: npt.NDArray[np.bool_], differences: Pixels, sources: _Ints, added: Pixels
) -> tuple[_Ints, Pixels]:
    """Gives each item what the anchor at or before it has, and adds the differences since."""
    anchors = np.flatnonzero(is_anchor)
    chain = np.cumsum(is_anchor) - 1
    sums = np.cumsum(differences, dtype=np.uint16)
    return sources[anchors].take(chain), (added[anchors] - sums[anchors]).take(chain) + sums


def _pixels_of(starts: _Ints, lengths: _Ints) -> _Ints:
    """Numbers counting up from each start, as many as its length says."""
    before = np.cumsum(lengths) - lengths
    return np.repeat(starts - before, lengths) + np.arange(lengths.sum())


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

    going = None  # the token that a MORE goes on with
    for token in band.tokens:
        if len(lines) == band.lines:
            raise WireError("a token too many")
        pixels = length(token) or width - len(row)
        if len(row) + pixels > width:
            raise WireError("a token across the end of a line")
        kind: int | None = going if MORE <= token < SKIP else token
        if kind is None:
            raise WireError("nothing that could go on")
        if kind < PAIRS:
            row.append(left() + delta(kind) & 0xFFFF)
        elif kind < RECENT:
            for difference in _pair(kind):
                row.append(left() + difference & 0xFFFF)
        elif kind < RUN:
            if kind - RECENT >= used:
                raise WireError("a literal that never was")
            row.append(literals[used - 1 - (kind - RECENT)])
        elif kind < ABOVE:
            for _ in range(pixels):
                row.append(left())
        elif kind < MORE:
            first = len(row) + slant(kind)
            if above is None or first < 0 or first + pixels > width:
                raise WireError("a copy of what is not there")
            row += above[first : first + pixels]
        elif kind < LITERALS:
            row += kept[len(lines)][len(row) : len(row) + pixels]
        else:
            if used + pixels > len(literals):
                raise WireError("too few literals")
            row += literals[used : used + pixels]
            used += pixels
        going = kind if RUN <= kind < LITERALS and len(row) < width else None
        if len(row) == width:
            lines.append(row)
            above, row = row, []
    if len(lines) != band.lines or used != len(literals):
        raise WireError("lengths")
    return np.array(lines, np.uint16)
