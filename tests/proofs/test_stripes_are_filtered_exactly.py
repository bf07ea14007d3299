"""raster/stripes: a pixel's channels are the means of five stripes, weighted 1, 2, 3, 2, 1, each rounded to nearest.

A pixel of three stripes has seven around it: of its first channel the mean is taken about the third of them, of green
about the fourth, of its last channel about the fifth; that is at x - 1/3, x and x + 1/3 of the pixel at x.

Lines are filtered in their place, and what is flat is left out: of short ones every pattern of two colours is tried, of
longer ones many of few colours, against the definition.
"""

from __future__ import annotations

import ctypes
import itertools
import random
from collections.abc import Iterator
from pathlib import Path as FilePath
from typing import Any

import pytest

from c_execution import Machine as AnyMachine
from c_source import SOURCES, faulty_tree, parse
from proof import Fault, Machine, Number, Poly, ProofError, Subject, compile_c
from symbolic import Path, require

FILE = "raster/stripes.c"
BITS = (5, 6, 5)
UNITS = (1 << 11, 1 << 5, 1)
WEIGHTS = (1, 2, 3, 2, 1)
STRIPES = 7
MOST_SUM = 9 * 63


class Filter:
    """Seven stripes, by their channels: anything, or all the same."""

    def __init__(self, blue_first: bool, flat: bool = False) -> None:
        self.blue_first, self.flat = blue_first, flat
        self.stripes: list[list[Poly]] = []

    def domain(self, machine: Machine) -> list[Any]:
        self.stripes = [
            [machine.path.atom(f"stripe{i}.{k}", 0, (1 << bits) - 1) for k, bits in enumerate(BITS)]
            for i in range(1 if self.flat else STRIPES)
        ] * (STRIPES if self.flat else 1)
        return [
            machine.array("uint16_t", [self.pixel(stripe) for stripe in self.stripes]),
            machine.boolean(self.blue_first),
        ]

    @staticmethod
    def pixel(channels: list[Poly]) -> Poly:
        return sum((channel * unit for channel, unit in zip(channels, UNITS, strict=True)), Poly.of(0))

    def check(self, machine: Machine, _: list[Any], result: Number) -> None:
        wanted = []
        for k in range(len(BITS)):
            first = 2 - k if self.blue_first else k
            nine = sum((self.stripes[first + i][k] * weight for i, weight in enumerate(WEIGHTS)), Poly.of(0))
            wanted.append(machine.path.floor(nine + 4, 9))
        machine.path.prove(result.poly - self.pixel(wanted), "each channel is the rounded mean", zero=True)
        if self.flat:
            machine.path.prove(result.poly - self.pixel(self.stripes[0]), "what is flat stays as it is", zero=True)

    def subject(self) -> Subject:
        return Subject(FILE, "filtered", self.domain, self.check, contracts={"ninth": ninth})


def ninth(machine: Machine, arguments: list[Any]) -> Number:
    """Pre: a sum of nine channels."""
    total = arguments[0].poly
    machine.path.prove(MOST_SUM - total, "ninth: of nine channels")
    return machine.exactly("uint32_t", machine.path.floor(total + 4, 9))


def each_ninth(fault: Fault | None = None) -> None:
    unit = parse(FILE, fault=fault)
    for total in range(MOST_SUM + 1):
        machine = AnyMachine(unit, Path([]))
        made = machine.call("ninth", machine.exactly("uint32_t", total)).poly.known
        require(made == (total + 4) // 9, f"a ninth of {total} is {made}")


def test_each_ninth_is_rounded() -> None:
    each_ninth()


@pytest.mark.parametrize(("old", "new"), [("7282U >> 16", "7281U >> 16"), ("sum + 4U", "sum + 5U")])
def test_a_wrong_ninth_is_found(old: str, new: str) -> None:
    with pytest.raises(ProofError):
        each_ninth(Fault(FILE, old, new))


@pytest.mark.parametrize("flat", [False, True])
@pytest.mark.parametrize("blue_first", [False, True])
def test_each_channel_is_the_rounded_mean(blue_first: bool, flat: bool) -> None:
    Filter(blue_first, flat).subject().prove()


@pytest.mark.parametrize("blue_first", [False, True])
def test_the_compiler_agrees(blue_first: bool) -> None:
    Filter(blue_first).subject().agree()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("b + c + left + middle", "b + c + left + right"),
        ("const uint32_t right = d + e + f;", "const uint32_t right = d + d + f;"),
        ("(blue_first ? last : first) >> 11", "(blue_first ? first : last) >> 11"),
        ("& 0x3FFU", "& 0xFFU"),
        ("& 0x7FFU", "& 0xFFU"),
        ("red << 11 | green << 5", "red << 11 | green << 4"),
    ],
)
def test_the_proof_can_fail(old: str, new: str) -> None:
    Filter(blue_first=False).subject().fails_with(Fault(FILE, old, new))


# --- lines ------------------------------------------------------------------------------------------------------------

Words = list[int]


def wanted_pixel(line: Words, x: int, blue_first: bool) -> int:
    """By the definition; beyond the sides the last stripe goes on."""
    pixel = 0
    for k, (bits, unit) in enumerate(zip(BITS, UNITS, strict=True)):
        middle = 3 * x + (2 - k if blue_first else k)
        places = (min(max(middle + i - 2, 0), len(line) - 1) for i in range(len(WEIGHTS)))
        nine = sum((line[at] // unit % (1 << bits)) * weight for at, weight in zip(places, WEIGHTS, strict=True))
        pixel += (nine + 4) // 9 * unit
    return pixel


def any_lines() -> Iterator[list[Words]]:
    """Lines of the same width that lie one behind the other, in stripes."""
    for width in range(1, 4):
        for pattern in itertools.product((0x0000, 0xFFFF), repeat=3 * width):
            yield [list(pattern)]
    rng = random.Random(7)
    for _ in range(300):
        width, colours = rng.randint(1, 9), [rng.getrandbits(16) for _ in range(rng.randint(1, 3))]
        yield [[rng.choice(colours) for _ in range(3 * width)] for _ in range(rng.randint(1, 4))]


def filter_lines(folder: FilePath, tree: FilePath = SOURCES) -> None:
    library = folder / "stripes.so"
    compile_c('#include "raster/stripes.c"\n', library, "-shared", "-fPIC", tree=tree)
    filtered = ctypes.CDLL(str(library)).el_stripes_filter
    rng = random.Random(8)
    for lines in any_lines():
        stripes, width = list(itertools.chain(*lines)), len(lines[0]) // 3
        depths = [rng.getrandbits(16) for _ in stripes]
        pixels, depth = ((ctypes.c_uint16 * len(stripes))(*values) for values in (stripes, depths))
        blue_first = bool(rng.getrandbits(1))
        filtered(pixels, depth, width, len(lines), ctypes.c_bool(blue_first))
        wanted = [wanted_pixel(line, x, blue_first) for line in lines for x in range(width)]
        require(list(pixels)[: len(wanted)] == wanted, f"{lines} filtered")
        require(list(depth)[: len(wanted)] == depths[1::3], "the depths of the middle stripes")


def test_lines_are_filtered_in_their_place(tmp_path: FilePath) -> None:
    filter_lines(tmp_path)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("was_flat = is_flat;", "was_flat = true;"),
        ("s[4] == colour && s[5] == colour && s[6] == colour", "s[4] == colour && s[5] == colour"),
        ("first - 2 + i, end - 1), 0)", "first - 2 + i, end - 2), 0)"),
        ("    to[width - 1] = at_end;\n", ""),
        ("middle = depth + 1;", "middle = depth;"),
    ],
)
def test_a_line_that_is_filtered_wrongly_is_found(tmp_path: FilePath, old: str, new: str) -> None:
    with pytest.raises(ProofError):
        filter_lines(tmp_path, faulty_tree(tmp_path / "src", Fault(FILE, old, new)))
