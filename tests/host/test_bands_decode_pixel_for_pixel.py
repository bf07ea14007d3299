"""The numpy decoder against the plain one and the picture that went in; every way to be wrong is refused by both."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from edgeline.codec import PIXEL, Pixels, decode, decode_plainly, encode_raw, encode_runs
from edgeline.colour import to_image, to_rgb
from edgeline.errors import WireError
from edgeline.protocol import Band, Codec


@st.composite
def pictures(draw: st.DrawFn) -> Pixels:
    """Few colours, so that runs happen; widths on both sides of the longest run (129) and literal (128) token."""
    width, lines = draw(st.integers(1, 300)), draw(st.integers(1, 4))
    colours = draw(st.integers(1, 4))
    seed = draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    palette = rng.integers(0, 65536, colours, np.uint16)
    if draw(st.booleans()):
        return rng.integers(0, 65536, (lines, width), np.uint16).astype(PIXEL)
    return np.repeat(palette[rng.integers(0, colours, (lines, width))], draw(st.integers(1, 40)), axis=1)[:, :width]


@given(pictures())
def test_pictures_come_back(picture: Pixels) -> None:
    for encode in (encode_raw, encode_runs):
        band = Band.decode(encode(7, 0, picture).encode())
        assert np.array_equal(decode(band, picture.shape[1]), picture)
        assert np.array_equal(decode_plainly(band, picture.shape[1]), picture)


def test_runs_are_these_bytes() -> None:
    picture = np.array([[1, 2, 3, 3, 3], [5, 5, 5, 5, 5]], PIXEL)
    band = encode_runs(0, 0, picture)
    assert band.tokens == bytes((1, 129, 131))
    assert band.literals == bytes.fromhex("0100020003000500")


@given(st.binary(max_size=30), st.binary(max_size=60), st.integers(1, 12), st.integers(1, 3), st.sampled_from(Codec))
def test_both_decoders_agree_on_any_bytes(tokens: bytes, literals: bytes, width: int, lines: int, codec: Codec) -> None:
    band = Band(0, 0, lines, codec, tokens, literals)
    assert outcome(decode, band, width) == outcome(decode_plainly, band, width)


@given(st.lists(st.integers(0, 5), max_size=8), st.integers(0, 12), st.integers(1, 6), st.integers(1, 3))
def test_both_decoders_agree_on_almost_right_bands(tokens: list[int], literals: int, width: int, lines: int) -> None:
    mixed = bytes(token if token < 3 else 125 + token for token in tokens)
    band = Band(0, 0, lines, Codec.RUNS, mixed, bytes(range(2 * literals)))
    assert outcome(decode, band, width) == outcome(decode_plainly, band, width)


def outcome(decoder: object, band: Band, width: int) -> list[list[int]] | None:
    try:
        pixels: list[list[int]] = decoder(band, width).tolist()  # type: ignore[operator]
    except WireError:
        return None
    return pixels


@pytest.mark.parametrize(
    ("tokens", "literals", "message"),
    [
        (b"", b"", "add up"),
        (b"\x82", b"\1\0", "add up"),
        (b"\x84\x84\x80", b"\1\0\2\0\3\0", "add up"),
        (b"\x83\x81", b"\1\0\2\0", "across"),
        (b"\x82\x82", b"\1\0", "literals"),
        (b"\x82\x82", b"\1\0\2\0\3\0", "literals"),
        (b"\x82\x82", b"\1\0\2\0\3", "half a pixel"),
    ],
)
def test_bands_that_break_a_rule_are_damage(tokens: bytes, literals: bytes, message: str) -> None:
    with pytest.raises(WireError, match=message):
        decode(Band(0, 0, 2, Codec.RUNS, tokens, literals), 4)


def test_raw_bands_have_no_tokens_and_all_pixels() -> None:
    with pytest.raises(WireError, match="tokens"):
        decode(Band(0, 0, 1, Codec.RAW, b"\0", bytes(8)), 4)
    with pytest.raises(WireError, match="3 pixels"):
        decode(Band(0, 0, 1, Codec.RAW, b"", bytes(6)), 4)


def test_every_colour_comes_back_from_rgb() -> None:
    every = np.arange(65536, dtype=PIXEL).reshape(256, 256)
    rgb = to_rgb(every).astype(np.uint16)
    assert np.array_equal(rgb[..., 0] >> 3 << 11 | rgb[..., 1] >> 2 << 5 | rgb[..., 2] >> 3, every)
    assert rgb[0, 0].tolist() == [0, 0, 0]
    assert rgb[-1, -1].tolist() == [255, 255, 255]
    assert np.array_equal(np.asarray(to_image(every)), rgb)
