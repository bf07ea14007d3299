"""Codec 2: the numpy decoder against the plain one, on bands that are right, almost right and anything but."""

from __future__ import annotations

import random
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from edgeline import split
from edgeline.errors import WireError
from edgeline.protocol import Band, Codec

WIDTH, HEIGHT = 320, 240


def any_band(rng: random.Random, y0: int, lines: int, width: int) -> Band:
    """A band that breaks no rule, of tokens of all kinds."""
    joined = y0 > 0 and rng.random() < 0.7
    tokens = bytearray()
    literals = 0
    kinds = rng.sample(range(8), rng.randint(1, 8))
    for line in range(lines):
        x = 0
        while x < width:
            token = any_token(rng, rng.choice(kinds))
            pixels = width - x if token == split.SKIP_TO_END else split.length(token, width)
            slanted = split.ABOVE_LEFT <= token < split.SKIP
            first = x + (-1 if token < split.ABOVE_RIGHT else 1) if slanted else x
            copies = split.ABOVE <= token < split.SKIP
            if (
                x + pixels > width
                or (copies and ((line == 0 and not joined) or first < 0 or first + pixels > width))
                or (split.RECENT <= token < split.RUN and token - split.RECENT >= literals)
            ):
                token, pixels = rng.randrange(split.PAIRS), 1
            if token >= split.LITERALS:
                literals += pixels
            tokens.append(token)
            x += pixels
    lags = rng.randbytes(-(-lines // 8)) if rng.random() < 0.5 else b""
    return Band(7, y0, lines, Codec.SPLIT, bytes(tokens), rng.randbytes(2 * literals), lags, joined)


def any_token(rng: random.Random, kind: int) -> int:
    bounds = (0, split.PAIRS, split.RECENT, split.RUN, split.ABOVE, split.ABOVE_LEFT, split.SKIP, split.LITERALS, 256)
    return rng.randrange(bounds[kind], bounds[kind + 1])


def any_frame(rng: random.Random, width: int, height: int) -> list[Band]:
    bands = []
    y = rng.randint(0, 2)
    while y < height:
        lines = rng.randint(1, min(9, height - y))
        bands.append(any_band(rng, y, lines, width))
        y += lines + rng.choice((0, 0, 1, 3))
    return bands


def any_picture(rng: random.Random, width: int, height: int) -> split.Pixels:
    return np.frombuffer(rng.randbytes(2 * width * height), np.uint16).reshape(height, width)


def plainly(bands: list[Band], picture: split.Pixels) -> split.Pixels | None:
    shown = picture.copy()
    try:
        for band in bands:
            shown[band.y0 : band.y0 + band.lines] = split.decode_plainly(band, shown)
    except WireError:
        return None
    return shown


def at_once(bands: list[Band], picture: split.Pixels) -> split.Pixels | None:
    shown = picture.copy()
    try:
        split.decode(bands, shown)
    except WireError:
        assert np.array_equal(shown, picture), "a frame that was refused has left something"
        return None
    return shown


def check_agreement(bands: list[Band], picture: split.Pixels) -> bool:
    one, other = plainly(bands, picture), at_once(bands, picture)
    assert (one is None) == (other is None)
    if one is not None and other is not None:
        assert np.array_equal(one, other)
    return one is not None


@given(st.integers(0, 2**32), st.sampled_from((1, 2, 3, 4, 5, 63, 64, 65, 130)), st.integers(1, 20))
def test_right_frames_are_decoded_alike(seed: int, width: int, height: int) -> None:
    rng = random.Random(seed)
    bands = any_frame(rng, width, height)
    assert all(Band.decode(band.encode()) == band for band in bands)
    assert check_agreement(bands, any_picture(rng, width, height))


@given(st.integers(0, 2**32), st.integers(1, 70), st.integers(1, 8))
@settings(max_examples=300)
def test_almost_right_frames_are_judged_alike(seed: int, width: int, height: int) -> None:
    rng = random.Random(seed)
    picture = any_picture(rng, width, height)
    bands = any_frame(rng, width, height)
    if bands:
        at = rng.randrange(len(bands))
        body = bytearray(bands[at].encode())
        body[rng.randrange(4, len(body))] = rng.randrange(256)
        try:
            damaged = Band.decode(bytes(body))
        except WireError:
            return
        if damaged.codec is Codec.SPLIT and damaged.y0 == bands[at].y0 and damaged.lines == bands[at].lines:
            check_agreement([*bands[:at], damaged, *bands[at + 1 :]], picture)


@given(st.binary(min_size=8, max_size=60))
@settings(max_examples=500)
def test_any_bytes_are_judged_alike(body: bytes) -> None:
    try:
        band = Band.decode(
            body[:2] + b"\x01\0" + body[4:5] + bytes((body[5] & 0x18 | 2,)) + body[6:7] + b"\0" + body[8:]
        )
    except WireError:
        return
    check_agreement([band], np.zeros((6, 9), np.uint16))


@pytest.mark.parametrize(
    ("tokens", "literals", "joined", "message"),
    [
        (b"", b"", False, "add up"),
        (b"\xf7", b"", False, "add up"),
        (b"\xf7\xf7\xf7", b"", False, "add up"),
        (b"\xb1\xb1\xf7", b"", False, "across"),
        (b"\xd8\xf7", b"", False, "above its first line"),
        (b"\xd9\xb1\xf7", b"", True, "beyond"),
        (b"\xf7\xb1\xe6", b"", True, "beyond"),
        (b"\x7f\xb1\xf7", b"", False, "before its first"),
        (b"\xf8\x80\xb0\xf7", b"\1\0", False, "before its first"),
        (b"\xf9\xb0\xf7", b"\1\0", False, "literals"),
        (b"\xf8\xb1\xf7", b"\1\0\2\0", False, "literals"),
        (b"\xf8\xb1\xf7", b"\1\0\2", False, "half a pixel"),
        (b"\xf7\xf7", bytes(20), False, "can hold"),
    ],
)
def test_bands_that_break_a_rule_are_damage(tokens: bytes, literals: bytes, joined: bool, message: str) -> None:
    picture = np.zeros((3, 4), np.uint16)
    with pytest.raises(WireError, match=message):
        split.decode([Band(0, 1, 2, Codec.SPLIT, tokens, literals, b"", joined)], picture)


def test_nothing_is_above_the_picture() -> None:
    with pytest.raises(WireError, match="above the picture"):
        split.decode([Band(0, 0, 1, Codec.SPLIT, b"\xf7", b"", b"", True)], np.zeros((1, 4), np.uint16))


def test_the_example_of_the_document() -> None:
    """WIRE.md, "Split streams": two lines of 8 pixels."""
    band = Band.decode(bytes.fromhex("00 00 00 00 02 02 08 00 F8 B2 F9 80 B1 5A C5 1F E0 07 00 F8 A3 10"))
    picture = np.zeros((2, 8), np.uint16)
    split.decode([band], picture)
    navy, red, green = 0x10A3, 0xF800, 0x07E0
    assert picture.tolist() == [
        [navy] * 5 + [red, green, red],
        [navy] * 3 + [0x10C3, 0x10E3, red, green, green],
    ]


def test_no_band_takes_long() -> None:
    """The worst that fits into packets of a 320x240 device: every band may be refused or drawn, none takes 50 ms."""
    rng = random.Random(5401)
    picture = np.zeros((HEIGHT, WIDTH), np.uint16)
    for round_ in range(60):
        lines = rng.randint(1, HEIGHT)
        token = rng.randrange(256)
        tokens = bytes((token,)) * rng.randrange(1, 65000) if round_ % 2 else rng.randbytes(rng.randrange(1, 65000))
        band = Band(0, 0, lines, Codec.SPLIT, tokens, bytes(2 * rng.randrange(100)), b"", False)
        begin = time.process_time()
        at_once([band], picture)
        assert time.process_time() - begin < 0.05, f"round {round_}: token {token}, {lines} lines"
