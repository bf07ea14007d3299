"""Codec 2: the numpy decoder against the plain one, on bands that are right, almost right and anything but."""

from __future__ import annotations

import random
import time
from dataclasses import replace

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
    copied: int | None = None  # how a stretch of copies is slanted that may go on
    tokens = bytearray()
    literals = 0
    kinds = rng.sample(range(9), rng.randint(1, 9))
    for line in range(lines):
        x = 0
        going = False
        while x < width:
            token = any_token(rng, rng.choice(kinds))
            pixels = split.length(token) or width - x
            first = x + split.slant(token)
            copies = split.ABOVE <= token < split.MORE
            more = split.MORE <= token < split.SKIP
            if more and going and copied is not None:
                copies, first = True, x + copied
            if (
                x + pixels > width
                or (copies and ((line == 0 and not joined) or first < 0 or first + pixels > width))
                or (split.RECENT <= token < split.RUN and token - split.RECENT >= literals)
                or (more and not going)
            ):
                token, pixels = rng.randrange(split.PAIRS), 1
            if token >= split.LITERALS:
                literals += pixels
            if not split.MORE <= token < split.SKIP:
                going = split.RUN <= token < split.LITERALS
                copied = split.slant(token) if split.ABOVE <= token < split.MORE else None
            tokens.append(token)
            x += pixels
    lags = rng.randbytes(-(-lines // 8)) if rng.random() < 0.5 else b""
    return Band(7, y0, lines, Codec.SPLIT, bytes(tokens), rng.randbytes(2 * literals), lags, joined)


def any_token(rng: random.Random, kind: int) -> int:
    bounds = (
        *(0, split.PAIRS, split.RECENT, split.RUN, split.ABOVE, split.ABOVE_LEFT, split.MORE, split.SKIP),
        *(split.LITERALS, 256),
    )
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
        (b"\xf9", b"", False, "add up"),
        (b"\xf9\xf9\xf9", b"", False, "add up"),
        (b"\xb1\xb1\xf9", b"", False, "across"),
        (b"\xbf\xb1\xf9", b"", False, "above its first line"),
        (b"\xcf\xb1\xf9", b"", True, "beyond"),
        (b"\xf9\xb0\xe0", b"", True, "beyond"),
        (b"\xf9\xdf\xf7", b"", True, "beyond"),
        (b"\xf7\xf9", b"", False, "go on"),
        (b"\xf9\xf7", b"", False, "go on"),
        (b"\xb2\xf7", b"", False, "go on"),
        (b"\x00\xf7\xf9", b"", False, "go on"),
        (b"\xfa\xf7\xf9", b"\1\0", False, "go on"),
        (b"\x7f\xb1\xf9", b"", False, "before its first"),
        (b"\xfa\x80\xb0\xf9", b"\1\0", False, "before its first"),
        (b"\xfb\xb0\xf9", b"\1\0", False, "literals"),
        (b"\xfa\xb1\xf9", b"\1\0\2\0", False, "literals"),
        (b"\xfa\xb1\xf9", b"\1\0\2", False, "half a pixel"),
        (b"\xf9\xf9", bytes(20), False, "can hold"),
    ],
)
def test_bands_that_break_a_rule_are_damage(tokens: bytes, literals: bytes, joined: bool, message: str) -> None:
    picture = np.zeros((3, 4), np.uint16)
    with pytest.raises(WireError, match=message):
        split.decode([Band(0, 1, 2, Codec.SPLIT, tokens, literals, b"", joined)], picture)


def test_nothing_is_above_the_picture() -> None:
    with pytest.raises(WireError, match="above the picture"):
        split.decode([Band(0, 0, 1, Codec.SPLIT, b"\xf9", b"", b"", True)], np.zeros((1, 4), np.uint16))


def test_the_example_of_the_document() -> None:
    """WIRE.md, "Split streams": two lines of 20 pixels."""
    band = Band.decode(bytes.fromhex("00 00 00 00 02 02 0A 00 FA B2 FB 80 B6 F7 AF 5A C6 F7 E0 07 00 F8 A3 10"))
    picture = np.zeros((2, 20), np.uint16)
    split.decode([band], picture)
    navy, red, green = 0x10A3, 0xF800, 0x07E0
    assert picture.tolist() == [
        [navy] * 5 + [red, green] + [red] * 13,
        [navy, 0x10C3, 0x10E3, navy, navy, red, green] + [red] * 13,
    ]


def seconds_of(band: Band, picture: split.Pixels) -> float:
    """Process time that the band takes, drawn or refused; the least of three."""
    least = 1.0
    for _ in range(3):
        begin = time.process_time()
        at_once([band], picture)
        least = min(least, time.process_time() - begin)
    return least


def test_no_band_takes_long() -> None:
    """Whatever a packet for a 320x240 device holds, it is refused or drawn, in less than 50 ms."""
    rng = random.Random(5401)
    picture = np.zeros((HEIGHT, WIDTH), np.uint16)
    for round_ in range(60):
        lines = rng.randint(1, HEIGHT)
        token = rng.randrange(256)
        tokens = bytes((token,)) * rng.randrange(1, 65000) if round_ % 2 else rng.randbytes(rng.randrange(1, 65000))
        band = Band(0, 0, lines, Codec.SPLIT, tokens, bytes(2 * rng.randrange(100)), b"", False)
        assert seconds_of(band, picture) < 0.05, f"round {round_}: token {token}, {lines} lines"


@pytest.mark.parametrize(
    ("line", "used"),
    [
        (bytes((split.SKIP_TO_END,)), 0),
        (bytes((split.SKIP,)) * 31 + bytes((split.SKIP_TO_END,)), 0),
        (bytes((split.ABOVE, split.ABOVE_RIGHT + 15, split.MORE_TO_END - 1)) * 14 + bytes((split.RUN + 9,)), 0),
        (bytes((split.ABOVE - 1,)) * 127 + bytes((split.RUN + 7,)), 0),
        (bytes((split.LITERALS + 5,)) * 340, 2040),
        (bytes((split.PAIRS + 9,)) * 1020, 0),
    ],
    ids=["skips", "skipped segments", "copies", "runs", "literals", "pairs"],
)
def test_no_band_of_the_widest_picture_takes_long(line: bytes, used: int) -> None:
    """As many lines of 2040 pixels as a packet can have, with the lag that takes longest."""
    lines = min(255, 65535 // len(line))
    band = Band(0, 1, lines, Codec.SPLIT, line * lines, bytes(2 * used * lines), b"\xff" * -(-lines // 8), True)
    picture = np.zeros((lines + 1, 2040), np.uint16)
    assert plainly([replace(band, lines=1, tokens=line, literals=bytes(2 * used), lags=b"\1")], picture) is not None
    assert seconds_of(band, picture) < 0.05
