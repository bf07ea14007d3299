"""raster/samples: a pixel becomes the mean of its 4 or 8 samples, each channel rounded to nearest and halves up, at the
depth of the nearest.

Its samples are words of their own, or two of them and a mask that says which have the first; then the mean is that of
as many of either. Sums of the three channels lie in one word, modulo 2^32 in between.

The nearest is found by el_min_u32, which gives one of two: it is not farther than any of those that it was found among.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import Fault, Machine, Number, Poly, Subject
from symbolic import require

FILE = "raster/samples.c"
BITS = (5, 6, 5)
UNITS = (1 << 11, 1 << 5, 1)


class Resolve:
    """The samples of a pixel, by their channels and depths: two words and any mask but 0, or `count` words."""

    def __init__(self, count: int, masked: bool) -> None:
        self.count, self.masked = count, masked
        self.samples: list[list[Poly]] = []
        self.depths: list[Poly] = []
        self.mask = Poly.of(0)
        self.words: list[Poly] = []  # samples, and those of them that are the nearer of others

    def domain(self, machine: Machine) -> list[Any]:
        path, words = machine.path, 2 if self.masked else self.count
        self.samples = [
            [path.atom(f"sample{i}.{k}", 0, (1 << bits) - 1) for k, bits in enumerate(BITS)] for i in range(words)
        ]
        self.depths = [path.atom(f"depth{i}", 0, 65535) for i in range(words)]
        if self.masked:
            self.mask = sum((path.atom(f"mask{i}", 0, 15) * (1 << 4 * i) for i in range(self.count // 4)), Poly.of(0))
            path.assume(self.mask - 1)
        self.words = [
            depth * (1 << 16) + packed(sample) for depth, sample in zip(self.depths, self.samples, strict=True)
        ]
        return [
            machine.array("uint16_t", [self.mask]),
            machine.array("uint16_t", [0]),
            machine.array("uint32_t", list(self.words)),
            machine.exactly("uint32_t", self.count),
        ]

    def nearer(self, machine: Machine, arguments: list[Any]) -> Number:
        """el_min_u32 of two of those words."""
        path = machine.path
        for argument in arguments:
            require(any(argument.poly.terms == word.terms for word in self.words), "the nearer of samples")
        found = path.atom("nearer", 0, 2**32 - 1)
        for argument in arguments:
            path.assume(argument.poly - found)
        self.words.append(found)
        return machine.exactly("uint32_t", found)

    def check(self, machine: Machine, arguments: list[Any], _: Any) -> None:
        path, count = machine.path, self.count
        parts = [1] * count
        if self.masked:
            inside = path.choose(self.mask).bit_count()
            parts = [inside, count - inside]
        sums = [
            sum((sample[k] * part for sample, part in zip(self.samples, parts, strict=True)), Poly.of(0))
            for k in range(len(BITS))
        ]
        mean = packed([path.floor(channel + count // 2, count) for channel in sums])
        path.prove(machine.poly(arguments[0].cell) - mean, "each channel is the rounded mean", zero=True)
        nearest = machine.poly(arguments[1].cell)
        for depth in self.depths:
            path.prove(depth - nearest, "no sample is nearer")
        require(any((path.floor(word, 1 << 16) - nearest).constant == 0 for word in self.words), "one is as near")

    def subject(self) -> Subject:
        return Subject(
            FILE, "resolve", self.domain, self.check, modular=["resolve"], contracts={"el_min_u32": self.nearer}
        )


def packed(channels: list[Poly]) -> Poly:
    return sum((channel * unit for channel, unit in zip(channels, UNITS, strict=True)), Poly.of(0))


@pytest.mark.parametrize("masked", [False, True])
@pytest.mark.parametrize("count", [4, 8])
def test_a_pixel_is_the_rounded_mean(count: int, masked: bool) -> None:
    Resolve(count, masked).subject().prove()


@pytest.mark.parametrize("masked", [False, True])
@pytest.mark.parametrize("count", [4, 8])
def test_the_compiler_agrees(count: int, masked: bool) -> None:
    Resolve(count, masked).subject().agree(count=100)


@pytest.mark.parametrize(
    ("count", "masked", "old", "new"),
    [
        (4, False, "const uint32_t half = count / 2U;", "const uint32_t half = count / 4U;"),
        (4, True, "rest * count;", "rest * 4U - rest;"),
        (8, True, "bits_of[mask & 15U] + bits_of[mask >> 4]", "bits_of[mask & 15U] + bits_of[mask >> 5]"),
        (
            4,
            True,
            "{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4}",
            "{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 2, 4}",
        ),
        (4, True, "nearest = el_min_u32(nearest, outside);", ""),
        (4, False, "for (uint32_t k = 1; k < count; k++)", "for (uint32_t k = 1; k < count - 1U; k++)"),
        (4, False, "half | half << 11 | half << 21", "half | half << 11 | half << 20"),
    ],
)
def test_the_proof_can_fail(count: int, masked: bool, old: str, new: str) -> None:
    Resolve(count, masked).subject().fails_with(Fault(FILE, old, new))
