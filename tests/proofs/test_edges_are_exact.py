"""raster/edge: the stepped crossing is the exact one on every row, and intervals of it are the top-left rule.

With S = EL_SUBPIXELS, dx, dy > 0 an edge's direction and (x0, y0) its upper end, the edge function at the centre of
pixel (i, j) is E = S i dy - n, n = (x0 - S/2) dy + (S j + S/2 - y0) dx. Let m = floor((n + S dy - 1) / S).

* el_edge_make: x dy + rest = m and 0 <= rest < dy on its row, step dy + rest_step = dx and 0 <= rest_step < dy.
* el_edge_next_row keeps that: n grows by S dx from row to row, so m by dx. By induction it holds on every row.
* From it, i >= x if and only if E >= 0: x dy <= m < (x + 1) dy, so i >= x says (i + 1) dy > m, that is S i dy >= n.
  A left edge takes the pixels with E >= 0, a right edge leaves them: E = 0 belongs to left edges only.
* el_first_centre(a) <= j if and only if the centre of row j is not above a: with rows [first(top), first(bottom)), a
  centre on a top edge counts, one on a bottom edge does not.

The crossing lies between the edge's ends on its own rows, since 0 <= t = centre - y0 < dy there and x0 dy + t dx is
(dy - t) x0 + t x1. That is given to the path as the four products that are not negative.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import EVERY_PRECISION, Fault, Machine, Number, Pointer, Poly, ProofError, Subject

FILE = "raster/triangle.c"
EDGE = "raster/edge.h"


def limits(machine: Machine) -> tuple[int, int]:
    """S, and the guard band in sub-pixels."""
    return machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // 2040, machine.constant(
        machine.unit.constants["EL_GUARD_SUB"]
    )


class Ends:
    """An edge's ends and a row of its own."""

    def __init__(self, machine: Machine) -> None:
        path = machine.path
        self.scale, self.guard = limits(machine)
        s, guard = self.scale, self.guard
        self.x0, self.x1 = path.atom("x0", -guard, guard), path.atom("x1", -guard, guard)
        self.y0 = path.atom("y0", -guard, guard - 1)
        self.y1 = path.atom("y1", self.y0.constant + 1 if self.y0.constant is not None else -guard, guard)
        self.dx, self.dy = self.x1 - self.x0, self.y1 - self.y0
        path.assume(self.dy - 1)
        if self.y0.constant is not None and self.y1.constant is not None:
            self.row = path.atom("row", (self.y0.constant + s // 2 - 1) // s, (self.y1.constant + s // 2 - 1) // s - 1)
        else:
            self.row = path.atom("row", -2040, 2040)
        t = self.row * s + s // 2 - self.y0
        path.assume(t)
        path.assume(self.dy - 1 - t)
        for x, rest in ((self.x0, self.dy - t), (self.x1, t)):
            path.assume_product(x + guard, rest)
            path.assume_product(guard - x, rest)
        self.n = (self.x0 - s // 2) * self.dy + t * self.dx

    def arguments(self, machine: Machine, edge: Pointer) -> list[Any]:
        numbers = (self.x0, self.y0, self.x1, self.y1, self.row)
        return [edge, *(machine.exactly("int32_t", number) for number in numbers)]


ENDS: dict[int, Ends] = {}


def make_domain(machine: Machine) -> list[Any]:
    ends = Ends(machine)
    ENDS[id(machine.path)] = ends
    return ends.arguments(machine, Pointer([machine.struct("el_edge")]))


def members(machine: Machine, edge: Any) -> tuple[Poly, Poly, Poly, Poly, Poly]:
    names = ("x", "rest", "step", "rest_step", "height")
    x, rest, step, rest_step, height = (machine.poly(edge, name) for name in names)
    return x, rest, step, rest_step, height


def make_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    path = machine.path
    ends = ENDS.pop(id(path))
    x, rest, step, rest_step, height = members(machine, arguments[0].cell)
    s = ends.scale
    path.prove(height - ends.dy, "height = dy", zero=True)
    path.prove(rest, "0 <= rest")
    path.prove(ends.dy - 1 - rest, "rest < dy")
    path.prove(rest_step, "0 <= rest_step")
    path.prove(ends.dy - 1 - rest_step, "rest_step < dy")
    path.prove(step * ends.dy + rest_step - ends.dx, "step dy + rest_step = dx", zero=True)
    m = x * ends.dy + rest
    path.prove(ends.n + s * ends.dy - 1 - m * s, "m <= (n + S dy - 1) / S")
    path.prove(m * s + s - 1 - ends.n - s * ends.dy + 1, "(n + S dy - 1) / S < m + 1")
    path.prove(m + 2**31, "m fits 32 bits with every precision")
    path.prove(2**31 - 1 - m, "m fits 32 bits with every precision")
    # x = ceil(n / (S dy)) is within the guard band: x - 2041 would need a product with dy, which decides.
    for bound in (2041 - x, x + 2041):
        if not path.decide(bound, -bound - 1):
            path.assume_product(-bound - 1, ends.dy)
            path.prove(Poly.of(-1), "|x| <= 2041 on the edge's own rows")


def next_domain(machine: Machine) -> list[Any]:
    _, guard = limits(machine)
    path = machine.path
    height = path.atom("height", 1, 2 * guard)
    top = 2 * guard - 1 if height.constant is None else height.constant - 1
    rest, rest_step = path.atom("rest", 0, top), path.atom("rest_step", 0, top)
    path.assume(height - 1 - rest)
    path.assume(height - 1 - rest_step)
    x, step = path.atom("x", -2041, 2041), path.atom("step", -2 * guard, 2 * guard)
    edge = machine.struct("el_edge", x=x, rest=rest, step=step, rest_step=rest_step, height=height)
    BEFORE[id(path)] = (x, rest, step, rest_step, height)
    return [Pointer([edge])]


BEFORE: dict[int, tuple[Poly, Poly, Poly, Poly, Poly]] = {}


def next_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    path = machine.path
    x0, rest0, step, rest_step, height = BEFORE.pop(id(path))
    x, rest, *same = members(machine, arguments[0].cell)
    path.prove(rest, "0 <= rest")
    path.prove(height - 1 - rest, "rest < height")
    dx = step * height + rest_step
    path.prove(x * height + rest - (x0 * height + rest0) - dx, "m grows by dx", zero=True)
    for after, before in zip(same, (step, rest_step, height), strict=True):
        path.prove(after - before, "the rest of the edge is as it was", zero=True)


def centre_domain(machine: Machine) -> list[Any]:
    _, guard = limits(machine)
    return [machine.number("int32_t", "a", -guard, guard)]


def centre_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    s, _ = limits(machine)
    a, first = arguments[0].poly, result.poly
    machine.path.prove(first * s + s // 2 - a, "the centre of the first row is not above a")
    machine.path.prove(a - 1 - (first - 1) * s - s // 2, "the centre of the row above it is")


MAKE = Subject(FILE, "el_edge_make", make_domain, make_check)
NEXT = Subject(FILE, "el_edge_next_row", next_domain, next_check)
CENTRE = Subject(FILE, "el_first_centre", centre_domain, centre_check)
SUBJECTS = pytest.mark.parametrize("subject", [MAKE, NEXT, CENTRE], ids=lambda subject: subject.function)


@EVERY_PRECISION
@SUBJECTS
def test_every_edge(subject: Subject, bits: int) -> None:
    subject.prove(bits)


@EVERY_PRECISION
@SUBJECTS
def test_the_compiler_agrees(subject: Subject, bits: int) -> None:
    subject.agree(bits, count=200)


@EVERY_PRECISION
@pytest.mark.parametrize(
    ("subject", "old", "new"),
    [
        (MAKE, "EL_SUBPIXELS * dy - 1)", "EL_SUBPIXELS * dy)"),
        (MAKE, "if (rest < 0)", "if (rest < -1)"),
        (NEXT, "edge->rest >= edge->height", "edge->rest > edge->height"),
        (CENTRE, "EL_SUBPIXELS / 2 - 1)", "EL_SUBPIXELS / 2)"),
    ],
    ids=["bias", "rest", "carry", "centre"],
)
def test_the_proof_can_fail(subject: Subject, old: str, new: str, bits: int) -> None:
    subject.fails_with(Fault(EDGE, old, new), bits)


@pytest.mark.parametrize("bits", [6, 8])
def test_the_proof_finds_an_overflow(bits: int) -> None:
    """Of this product, which fits 32 bits with 4 bits of fraction only."""
    MAKE.fails_with(Fault(EDGE, "(int64_t)(x0 - half) * dy", "(x0 - half) * dy"), bits)


def coverage(bias: int) -> Subject:
    """Any state that the invariant allows, and any pixel: as two paths, E >= 0 and E < 0. The C's bias is 1."""

    def domain(machine: Machine) -> list[Any]:
        path = machine.path
        s, guard = limits(machine)
        dy = path.atom("dy", 1, 2 * guard)
        x, rest = path.atom("x", -2041, 2041), path.atom("rest", 0, 2 * guard - 1)
        path.assume(dy - 1 - rest)
        n, pixel = path.atom("n", -(2**42), 2**42), path.atom("pixel", 0, 2039)
        m = x * dy + rest
        path.assume(n + s * dy - bias - m * s)
        path.assume(m * s + s - 1 - n - s * dy + bias)
        edge_function = s * pixel * dy - n
        if path.decide(edge_function, -edge_function - 1):
            # i < x would say x - 1 - i >= 0, and with it (x - 1 - i) dy >= 0.
            if not path.decide(pixel - x, x - 1 - pixel):
                path.assume_product(x - 1 - pixel, dy)
                path.prove(Poly.of(-1), "E >= 0 and i < x exclude each other")
        elif path.decide(pixel - x, x - 1 - pixel):
            path.assume_product(pixel - x, dy)
            path.prove(Poly.of(-1), "E < 0 and i >= x exclude each other")
        return [machine.exactly("int32_t", 0)]

    return Subject(FILE, "el_first_centre", domain)


@EVERY_PRECISION
def test_intervals_are_the_top_left_rule(bits: int) -> None:
    coverage(bias=1).prove(bits)


@EVERY_PRECISION
@pytest.mark.parametrize("bias", [0, 2])
def test_the_proof_of_coverage_can_fail(bits: int, bias: int) -> None:
    """With one unit of bias more or less an edge value of 0 would be on the wrong side, or one of -1."""
    with pytest.raises(ProofError):
        coverage(bias).prove(bits)
