"""C's types, and the objects that hold values of them: numbers are symbolic, what is where is not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from symbolic import Path, Poly, ProofError


@dataclass(frozen=True)
class IntType:
    """An integer type; bool has one bit."""

    bits: int
    signed: bool

    @property
    def low(self) -> int:
        return -(1 << (self.bits - 1)) if self.signed else 0

    @property
    def high(self) -> int:
        return (1 << (self.bits - (1 if self.signed else 0))) - 1

    def __str__(self) -> str:
        return f"{'' if self.signed else 'u'}int{self.bits}_t"


@dataclass(frozen=True)
class StructType:
    name: str
    fields: tuple[tuple[str, Any], ...]


@dataclass(frozen=True)
class ArrayType:
    element: Any
    length: int


@dataclass(frozen=True)
class PointerType:
    target: Any


INT, UINT = IntType(32, True), IntType(32, False)
I64, U64 = IntType(64, True), IntType(64, False)
BOOL = IntType(1, False)


@dataclass(frozen=True)
class Number:
    """A value of an integer type."""

    type: IntType
    poly: Poly


@dataclass
class Cell:
    """An object in memory. Content: a Number, a Pointer, a dict of cells (struct), a list of cells (array), or None."""

    type: Any
    content: Any = None
    stands_for: Poly | None = None  # of an el_divisor that a contract made: what it divides by


@dataclass(frozen=True)
class Pointer:
    """To cells[index]; the cells are an array, or one object."""

    cells: list[Cell]
    index: int = 0

    @property
    def cell(self) -> Cell:
        if not 0 <= self.index < len(self.cells):
            raise ProofError(f"index {self.index} of {len(self.cells)}")
        return self.cells[self.index]


@dataclass(frozen=True)
class Memory:
    """An array of unknown content: only its length is known. Reading it gives any number of its type."""

    type: IntType
    length: int | Poly

    def element(self, path: Path, index: Poly) -> Poly:
        """What is at an index within it."""
        return path.atom(f"element {index}", self.type.low, self.type.high)


KEYWORDS = {
    "int": INT,
    "unsigned": UINT,
    "unsigned int": UINT,
    "_Bool": BOOL,
    "signed char": IntType(8, True),
    "unsigned char": IntType(8, False),
    "signed short": IntType(16, True),
    "unsigned short": IntType(16, False),
    "signed int": INT,
    "signed long long": I64,
    "unsigned long long": U64,
    "long long": I64,
    "void": "void",
    "char": IntType(8, True),
}
