"""base/rgb565: each channel of a blended pixel is the exactly rounded mix, for all colours and each alpha 0..256.

The three functions put several channels into one word and multiply them at once, modulo 2^32 in between. A pixel is
given as its channels, so that the result is a polynomial in these: that no channel runs over into another is that each
can be taken out of the sum again. All are proven equal to the same mix, hence to each other: two pixels at a time are
what they are one at a time, also where one colour lies over all.

An alpha of 0..255 becomes one of 0..256, and the same half of them passes a texture's test before and after.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from proof import Fault, Lemma, Machine, Number, Poly, Subject, as_unknown

FILE = "base/rgb565.h"
RED, GREEN, BLUE = range(3)
BITS = (5, 6, 5)
UNITS = (1 << 11, 1 << 5, 1)
MOST = 256


def any_pixel(machine: Machine, name: str) -> list[Poly]:
    return [machine.path.atom(f"{name}{i}", 0, (1 << bits) - 1) for i, bits in enumerate(BITS)]


def packed(channels: list[Poly]) -> Poly:
    return sum((channel * unit for channel, unit in zip(channels, UNITS, strict=True)), Poly.of(0))


class Blend:
    """`count` pixels with as many over them, or with `over` ones, which repeat.

    256 times a mixed channel, and the half that rounds, is one unknown, its sum. It is what the words that C has
    consist of, which is proven where they get their values.
    """

    def __init__(self, count: int, over: int) -> None:
        self.count, self.over = count, over
        self.alpha: Number | None = None
        self.pixels: list[tuple[list[Poly], list[Poly]]] = []
        self.sums: dict[tuple[int, int], Poly] = {}

    def words(self, machine: Machine, c_type: str) -> list[Number]:
        self.alpha = machine.number("uint32_t", "alpha", 0, MOST)
        self.sums.clear()
        under = [any_pixel(machine, f"under{i}") for i in range(self.count)]
        over = [any_pixel(machine, f"over{i}") for i in range(self.over)]
        self.pixels = [(under[i], over[i % self.over]) for i in range(self.count)]
        words = (sum((packed(p) * (1 << 16 * i) for i, p in enumerate(pixels)), Poly.of(0)) for pixels in (under, over))
        return [*(machine.exactly(c_type, word) for word in words), self.alpha]

    def sum(self, machine: Machine, pixel: int, channel: int) -> Poly:
        """under * (256 - alpha) + over * alpha + 128."""
        if (pixel, channel) not in self.sums:
            under, over = (channels[channel] for channels in self.pixels[pixel])
            assert self.alpha is not None
            exact = under * (MOST - self.alpha.poly) + over * self.alpha.poly + MOST // 2
            self.sums[pixel, channel] = as_unknown(machine, machine.exactly("uint32_t", exact)).poly
        return self.sums[pixel, channel]

    def lemma(self, word: Callable[[Machine, Blend], Poly]) -> Lemma:
        """A local is made of sums."""

        def rewritten(machine: Machine, value: Number) -> Number:
            of_sums = word(machine, self)
            machine.path.prove(value.poly - of_sums, "the word's sums", zero=True)
            return Number(value.type, of_sums)

        return rewritten

    def pair(self, channel: int) -> Lemma:
        """16 bits apart."""
        return self.lemma(lambda machine, b: b.sum(machine, 0, channel) + b.sum(machine, 1, channel) * (1 << 16))

    def check(self, machine: Machine, result: Number) -> None:
        floor = machine.path.floor
        mixed = [[floor(self.sum(machine, i, k), MOST) for k in range(len(BITS))] for i in range(self.count)]
        pixels = sum((packed(channels) * (1 << 16 * i) for i, channels in enumerate(mixed)), Poly.of(0))
        machine.path.prove(result.poly - pixels, "each channel is the rounded mix", zero=True)


def single() -> Subject:
    blend = Blend(1, 1)
    red_and_blue = blend.lemma(
        lambda machine, b: b.sum(machine, 0, RED) * (1 << 8) + machine.path.floor(b.sum(machine, 0, BLUE), 1 << 8)
    )
    green = blend.lemma(lambda machine, b: machine.path.floor(b.sum(machine, 0, GREEN), 1 << 3))
    return Subject(
        FILE,
        "el_rgb565_blend",
        lambda machine: blend.words(machine, "uint16_t"),
        lambda machine, _, result: blend.check(machine, result),
        modular=["el_rgb565_blend"],
        lemmas={"el_rgb565_blend.rb": red_and_blue, "el_rgb565_blend.g": green},
    )


def pair() -> Subject:
    blend = Blend(2, 2)
    return Subject(
        FILE,
        "el_rgb565_blend_pair",
        lambda machine: blend.words(machine, "uint32_t"),
        lambda machine, _, result: blend.check(machine, result),
        modular=["el_rgb565_blend_pair"],
        lemmas={f"el_rgb565_blend_pair.{name}": blend.pair(i) for i, name in enumerate("rgb")},
    )


def shares() -> Subject:
    """Of one colour's shares, as el_rgb565_share makes them."""
    blend = Blend(2, 1)

    def domain(machine: Machine) -> list[Any]:
        under, _, alpha = blend.words(machine, "uint32_t")
        ((_, over), _) = blend.pixels
        parts = [machine.call("el_rgb565_share", machine.exactly("uint32_t", channel), alpha) for channel in over]
        return [under, machine.exactly("uint32_t", MOST - alpha.poly), *parts]

    return Subject(
        FILE,
        "el_rgb565_blend_shares",
        domain,
        lambda machine, _, result: blend.check(machine, result),
        lemmas={f"el_rgb565_blend_shares.{name}": blend.pair(i) for i, name in enumerate("rgb")},
    )


SUBJECTS = [single, pair, shares]


@pytest.mark.parametrize("subject", SUBJECTS)
def test_each_channel_is_the_rounded_mix(subject: Any) -> None:
    subject().prove()


@pytest.mark.parametrize("subject", SUBJECTS)
def test_the_compiler_agrees(subject: Any) -> None:
    subject().agree(count=300)


def is_alpha(machine: Machine, arguments: list[Any], result: Number) -> None:
    """256 a / 255 to less than a unit, and 128 from 128 on, where the test of textures' alpha is."""
    path, alpha = machine.path, arguments[0].poly
    error = result.poly * 255 - alpha * MOST
    path.prove(error + 254, "not a unit too small")
    path.prove(254 - error, "not a unit too large")
    if path.decide(alpha - 128, 127 - alpha):
        path.prove(result.poly - 128, "what is shown")
    else:
        path.prove(127 - result.poly, "what is not shown")


def alpha_256() -> Subject:
    return Subject(FILE, "el_alpha_256", lambda machine: [machine.number("uint8_t", "alpha")], is_alpha)


def test_alpha_is_all_of_its_range() -> None:
    alpha_256().prove()
    alpha_256().agree(count=256)


@pytest.mark.parametrize(
    ("subject", "old", "new"),
    [
        (single, "alpha + 0x00800080U) >> 8;", "alpha + 0x00800000U) >> 8;"),
        (single, "alpha + 0x1000U) >> 8;", "alpha + 0x0FE0U) >> 8;"),
        (single, "under_rb = (under & 0xF800U) << 5", "under_rb = (under & 0xF800U) << 1"),
        (single, "(over_g - under_g) * alpha", "(over_g - under_g) * (alpha >> 1 << 1)"),
        (single, "| (rb & 0x1FU)", "| (rb & 0x0FU)"),
        (pair, "under_r = under >> 11 & 0x001F001FU", "under_r = under >> 10 & 0x001F001FU"),
        (pair, "((over & 0x001F001FU) - under_b) * alpha + 0x00800080U", "((over & 0x001F001FU) - under_b) * alpha"),
        (pair, "(over >> 5 & 0x003F003FU) - under_g", "(over >> 5 & 0x001F003FU) - under_g"),
        (shares, "channel * alpha * 0x10001U + 0x00800080U", "channel * alpha * 0x10001U + 0x00800040U"),
        (shares, "channel * alpha * 0x10001U", "channel * alpha * 0x10000U"),
        (shares, "(under >> 5 & 0x003F003FU) * rest", "(under >> 5 & 0x001F003FU) * rest"),
        (shares, "(under & 0x001F001FU) * rest + blue", "(under & 0x001F001FU) * rest + green"),
        (alpha_256, "alpha + (alpha >> 7)", "alpha + (alpha >> 6)"),
        (alpha_256, "alpha + (alpha >> 7)", "alpha"),
    ],
)
def test_the_proof_can_fail(subject: Any, old: str, new: str) -> None:
    subject().fails_with(Fault(FILE, old, new))
