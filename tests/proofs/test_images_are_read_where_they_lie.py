"""base/image: the byte that a pixel of an image has, and which of its bits, for all sizes and places.

Rows of half bytes and of bits begin with a byte of their own. The left pixel of two lies in the upper half, the left
one of eight in the highest bit. Nothing beyond the image's bytes is read, nor an entry that a palette does not have.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import pytest

from c_values import Memory
from proof import Fault, Machine, Number, Pointer, Poly, Subject
from symbolic import Path, require

FILE = "base/image.h"
RGB565, INDEX8, INDEX4, MASK = range(4)
BITS = {RGB565: 16, INDEX8: 8, INDEX4: 4, MASK: 1}
MOST = 32767
ALL = 256


@dataclass(frozen=True)
class Read(Memory):
    """Memory that keeps what was read, and where."""

    seen: list[tuple[Poly, Poly]] = field(default_factory=list)

    def element(self, path: Path, index: Poly) -> Poly:
        value = super().element(path, index)
        self.seen.append((index, value))
        return value


class Image:
    """Of any size; a pixel within it."""

    def __init__(self, kind: int) -> None:
        self.kind, self.bits = kind, BITS[kind]
        self.x = self.y = self.row = Poly.of(0)

    def domain(self, machine: Machine) -> list[Any]:
        path = machine.path
        width, height = path.atom("width", 1, MOST), path.atom("height", 1, MOST)
        self.x, self.y = path.atom("x", 0, MOST - 1), path.atom("y", 0, MOST - 1)
        path.assume(width - 1 - self.x)
        path.assume(height - 1 - self.y)
        # Values of a row, of 16 bits or of bytes.
        per_value = max(1, 8 // self.bits)
        self.row = path.floor(width + per_value - 1, per_value)
        path.assume_product(height - 1 - self.y, self.row)
        self.pixels = Read(machine.type_named("uint16_t" if self.kind == RGB565 else "uint8_t"), height * self.row)
        self.palette = Read(machine.type_named("uint16_t"), {RGB565: 0, INDEX8: 256, INDEX4: 16, MASK: 1}[self.kind])
        image = machine.struct("el_image", width=width, height=height, has_key=0, palette=self.palette, key=0)
        image.content["pixels"].content = self.pixels
        image.content["alpha"].content = machine.exactly("uint32_t", 0)
        colour = machine.array("uint16_t", [0])
        numbers = [machine.exactly("uint32_t", value) for value in (self.kind, self.x, self.y)]
        return [Pointer([image]), *numbers, colour]

    def check(self, machine: Machine, arguments: list[Any], result: Number) -> None:
        path = machine.path
        ((index, value),) = self.pixels.seen
        per_value = max(1, 8 // self.bits)
        path.prove(index - self.y * self.row - path.floor(self.x, per_value), "its byte", zero=True)
        # What is left of it, from the top.
        place = path.choose(self.x - path.floor(self.x, per_value) * per_value)
        upper = path.floor(value, 1 << self.bits * (per_value - 1 - place))
        pixel = upper - path.floor(upper, 1 << self.bits) * (1 << self.bits)
        colour = machine.poly(arguments[-1].cells[0])
        if self.kind == RGB565:
            path.prove(colour - pixel, "the colour", zero=True)
        else:
            ((entry, entry_value),) = self.palette.seen
            path.prove(entry - (0 if self.kind == MASK else pixel), "the palette's entry", zero=True)
            path.prove(colour - entry_value, "its colour", zero=True)
        if self.kind == MASK:
            path.prove(result.poly - pixel * ALL, "a bit shows, or does not", zero=True)
        else:
            require(result.poly.constant == ALL, "all of it shows")

    def subject(self) -> Subject:
        return Subject(FILE, "el_image_at", self.domain, self.check)


@pytest.mark.parametrize("kind", BITS)
def test_a_pixel_is_where_it_lies(kind: int) -> None:
    Image(kind).subject().prove()


@pytest.mark.parametrize(
    ("kind", "old", "new"),
    [
        (
            RGB565,
            "[y * image->width + x];\n        *colour = value;",
            "[x * image->width + y];\n        *colour = value;",
        ),
        (INDEX4, "(x & 1U) != 0 ? 0 : 4", "(x & 1U) != 0 ? 4 : 0"),
        (INDEX4, "((image->width + 1U) / 2U)", "(image->width / 2U)"),
        (INDEX4, ": 4) & 15U)", ": 4) & 31U)"),
        (MASK, "(7U - (x & 7U))", "(x & 7U)"),
        (MASK, "((image->width + 7U) / 8U)", "(image->width / 8U)"),
        (MASK, "shown = value != 0 ? 256 : 0;", "shown = value != 0 ? 255 : 0;"),
    ],
)
def test_the_proof_can_fail(kind: int, old: str, new: str) -> None:
    Image(kind).subject().fails_with(Fault(FILE, old, new))
