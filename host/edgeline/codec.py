"""The pixels of a band: raw, or runs and literals (WIRE.md, "BAND").

`decode` works on whole bands in numpy; `decode_plainly` follows the text of WIRE.md token by token and is what the
tests hold it against. Encoding is the devices' part; the host does it for its tests and for captures made by hand.

Pixels are RGB565 in arrays of the type PIXEL, shape (lines, width).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from edgeline.errors import WireError
from edgeline.protocol import Band, Codec

PIXEL = np.dtype("<u2")
"""Little-endian on every machine, so that an array's bytes are the bytes that the CRCs cover."""

Pixels = npt.NDArray[np.uint16]

_RUN = 128
_RUN_BIAS = 126
_LONGEST_LITERALS = 128
_LONGEST_RUN = 129


def decode(band: Band, width: int) -> Pixels:
    """The band's pixels, a new array. Raises WireError if it breaks a rule."""
    if len(band.literals) % 2:
        raise WireError("a BAND with half a pixel at its end")
    literals = np.frombuffer(band.literals, PIXEL)
    if band.codec is Codec.RAW:
        if band.tokens:
            raise WireError("a raw BAND with tokens")
        if literals.size != band.lines * width:
            raise WireError(f"a raw BAND of {literals.size} pixels where {band.lines} lines have {band.lines * width}")
        return np.array(literals.reshape(band.lines, width))
    return _decode_runs(np.frombuffer(band.tokens, np.uint8).astype(np.int64), literals, band.lines, width)


def _decode_runs(tokens: npt.NDArray[np.int64], literals: Pixels, lines: int, width: int) -> Pixels:
    is_run = tokens >= _RUN
    lengths = np.where(is_run, tokens - _RUN_BIAS, tokens + 1)
    used = np.where(is_run, 1, lengths)
    ends = np.cumsum(lengths)
    if tokens.size == 0 or ends[-1] != lines * width:
        raise WireError(f"a BAND whose tokens do not add up to {lines} lines of {width} pixels")
    if ((ends - lengths) // width != (ends - 1) // width).any():
        raise WireError("a BAND with a token across the end of a line")
    if used.sum() != literals.size:
        raise WireError(f"a BAND with {literals.size} literals where its tokens use {used.sum()}")
    repeats = np.ones(literals.size, np.int64)
    first_literal = np.cumsum(used) - used
    repeats[first_literal[is_run]] = lengths[is_run]
    return np.repeat(literals, repeats).reshape(lines, width)


def decode_plainly(band: Band, width: int) -> Pixels:
    """As `decode`, one token after the other."""
    if len(band.literals) % 2:
        raise WireError("half a pixel")
    literals = [int.from_bytes(band.literals[i : i + 2], "little") for i in range(0, len(band.literals), 2)]
    pixels: list[int] = []
    taken = 0
    if band.codec is Codec.RAW:
        if band.tokens:
            raise WireError("tokens")
        pixels, taken = literals, len(literals)
    for token in band.tokens:
        run = token >= _RUN
        length = token - _RUN_BIAS if run else token + 1
        used = 1 if run else length
        if len(pixels) % width + length > width:
            raise WireError("a token across the end of a line")
        if taken + used > len(literals):
            raise WireError("too few literals")
        pixels += literals[taken : taken + used] * (length if run else 1)
        taken += used
    if len(pixels) != band.lines * width or taken != len(literals):
        raise WireError("lengths")
    return np.array(pixels, PIXEL).reshape(band.lines, width)


def encode_raw(frame: int, y0: int, pixels: Pixels) -> Band:
    """`pixels` as a raw band."""
    return Band(frame, y0, len(pixels), Codec.RAW, b"", pixels.astype(PIXEL).tobytes())


def encode_runs(frame: int, y0: int, pixels: Pixels) -> Band:
    """`pixels` as runs wherever two neighbours are equal, literals elsewhere."""
    begins = np.ones(pixels.shape, bool)
    begins[:, 1:] = pixels[:, 1:] != pixels[:, :-1]
    starts = np.flatnonzero(begins)
    sizes = np.diff(starts, append=pixels.size)
    line_begins = starts % pixels.shape[1] == 0
    tokens = bytearray()
    stored: list[int] = []
    alone = 0  # literals that have no token yet
    for value, size, at_begin in zip(
        pixels.ravel()[starts].tolist(), sizes.tolist(), line_begins.tolist(), strict=True
    ):
        if at_begin or size >= 2:
            tokens += _literal_tokens(alone)
            alone = 0
        runs, rest = divmod(size, _LONGEST_RUN)
        tokens += bytes((_LONGEST_RUN + _RUN_BIAS,)) * runs
        if rest >= 2:
            tokens.append(rest + _RUN_BIAS)
        alone += rest == 1
        stored += [value] * (runs + (rest > 0))
    tokens += _literal_tokens(alone)
    return Band(frame, y0, len(pixels), Codec.RUNS, bytes(tokens), np.array(stored, PIXEL).tobytes())


def _literal_tokens(count: int) -> bytes:
    whole, rest = divmod(count, _LONGEST_LITERALS)
    return bytes((_LONGEST_LITERALS - 1,)) * whole + (bytes((rest - 1,)) if rest else b"")
