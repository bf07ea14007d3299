"""raster/edge: one addition per row keeps the first pixel exact, and intervals of it are the top-left rule.

With S = EL_SUBPIXELS, dx, dy > 0 an edge's direction and (x0, y0) its upper end, the edge function at the centre of
pixel (i, j) is E = S i dy - n, n = (x0 - S/2) dy + t dx, t = S j + S/2 - y0. The first pixel that is not left of the
edge is c = ceil(n / (S dy)), a grid of g = S dy steps per pixel. Where n is first divided by S and rounded up (6 and 8
bits), c = ceil(m / dy) with m = ceil(n / S), a grid of g = dy.

After k rows the C has X = x_q32 + k step, an integer. Of what it cuts off, g times,

    D = 2^32 n + g (2^32 - 1) - g X        (m for n with 6 and 8 bits)

is shown to satisfy 0 <= D <= 2^32 - g. Then the whole part of X is c: with X = 2^32 c + F, 0 <= F < 2^32,

    2^32 (g c - n) = g (2^32 - 1 - F) - D > -2^32,      2^32 (g (c - 1) - n) = -g (1 + F) - D < 0.

D has a part for each thing that is cut off: e, of each step, 2^32 dx - step dy, and what the first row loses.

    4 bits            D = e t + f dy, t that of row k, 0 <= f <= 15
    6 and 8 bits      D = e k + f, 0 <= f < dy

* From c, i >= c if and only if E >= 0: (c - 1) S dy < n <= c S dy. A left edge takes the pixels with E >= 0, a right
  edge leaves them: E = 0 belongs to left edges only.
* el_first_centre(a) <= j if and only if the centre of row j is not above a: with rows [first(top), first(bottom)), a
  centre on a top edge counts, one on a bottom edge does not.

The crossing lies between the edge's ends on its own rows, since 0 <= t < dy there and x0 dy + t dx is
(dy - t) x0 + t x1. That is given to the path as the four products that are not negative.
"""

from __future__ import annotations

from typing import Any

import pytest

import contracts
from proof import EVERY_PRECISION, Fault, Machine, Number, Pointer, Poly, ProofError, Subject, congruent
from symbolic import Infeasible, Path

FILE = "raster/triangle.c"
EDGE = "raster/edge.h"
WORD = 1 << 32
RING = 1 << 64


def limits(machine: Machine) -> tuple[int, int]:
    """S, and the guard band in sub-pixels."""
    guard = machine.constant(machine.unit.constants["EL_GUARD_SUB"])
    return guard // 2040, guard


class Ends:
    """An edge's ends, a row of its own that it is made for, and one that it is stepped to."""

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
            return
        self.row = path.atom("row", -2040, 2040)
        self.t = self.row * s + s // 2 - self.y0
        path.assume(self.t)
        path.assume(self.dy - 1 - self.t)
        self._between_ends(path, self.t)
        # Steps to the right and to the left: numbers of one sign are congruent to unsigned ones in one way.
        path.decide(self.dx, -self.dx - 1)

    def _between_ends(self, path: Path, t: Poly) -> None:
        for x, rest in ((self.x0, self.dy - t), (self.x1, t)):
            path.assume_product(x + self.guard, rest)
            path.assume_product(self.guard - x, rest)

    def stepped(self, machine: Machine) -> tuple[Poly, Poly, Poly]:
        """Another row of the edge: k, its t and n."""
        path, s = machine.path, self.scale
        k = path.atom("k", 0, 4079)
        t = self.t + k * s
        path.assume(self.dy - 1 - t)
        self._between_ends(path, t)
        return k, t, (self.x0 - s // 2) * self.dy + t * self.dx


ENDS: dict[int, Ends] = {}


def make_domain(machine: Machine) -> list[Any]:
    ends = Ends(machine)
    ENDS[id(machine.path)] = ends
    edge = Pointer([machine.struct("el_edge")])
    return [edge, *(machine.exactly("int32_t", n) for n in (ends.x0, ends.y0, ends.x1, ends.y1, ends.row))]


def step_of(machine: Machine, arguments: list[Any]) -> Number:
    """el_edge_step_q32, proven below: of its edge's direction, and too low by e."""
    dx, dy = (argument.poly for argument in arguments)
    path = machine.path
    step = path.atom("step", -(2**63), 2**63 - 1)
    for bound in _step_errors(machine, dx, dy, step):
        path.assume(bound)
    path.assume(step if path.holds(dx) else -step - 1)
    return machine.exactly("int64_t", step)


SHORT = ("EL_EDGE_SHORT", "EL_EDGE_NARROW")


def is_short(machine: Machine, dx: Poly, dy: Poly) -> bool:
    path = machine.path
    short, narrow = (machine.constant(machine.unit.constants[name]) for name in SHORT)
    return (
        path.decide(short - dy, dy - short - 1)
        and path.decide(narrow - dx, dx - narrow - 1)
        and path.decide(dx + narrow, -dx - narrow - 1)
    )


def _step_errors(machine: Machine, dx: Poly, dy: Poly, step: Poly) -> list[Poly]:
    """What is not negative about e = 2^32 dx - step dy: it is below dy, or, of a short edge, at most |dx| dy."""
    path = machine.path
    e = dx * WORD - step * dy
    if not is_short(machine, dx, dy):
        return [e, dy - 1 - e]
    magnitude = dx if path.holds(dx) else -dx
    return [e, magnitude * dy - e]


def times(machine: Machine, arguments: list[Any]) -> Number:
    """el_multiply_u16 of a step and rows: the product is below 2^49 and of the step's sign."""
    path = machine.path
    ends = ENDS[id(path)]
    step, down = machine.poly(machine.scopes[0]["edge"].content.cell, "step_q32"), arguments[1].poly
    congruent(arguments[0].poly, step, RING, "the step")
    path.prove(2**16 - 1 - down, "el_multiply_u16: below 2^16")
    right = path.holds(ends.dx)
    path.assume_product(step if right else -step, ends.dy - 1 - down)
    path.assume_product(step if right else -step, down)
    product = path.atom("product", *((0, 2**49) if right else (-(2**49), 0)))
    path.prove(2**49 - step * down, "a product below 2^49")
    path.prove(2**49 + step * down, "a product above -2^49")
    path.assume(product - step * down, zero=True)
    if right or not path.decide(-product - 1, product):
        return machine.exactly("uint64_t", product)
    return machine.exactly("uint64_t", product + RING)


def cut_off(machine: Machine, ends: Ends, edge: Any, stepped: tuple[Poly, Poly, Poly]) -> tuple[Poly, Poly, Poly]:
    """g, the number that it divides, and D; that D has the parts that it should."""
    k, t, n = stepped
    x_q32, step = machine.poly(edge, "x_q32"), machine.poly(edge, "step_q32")
    dx, dy, s, path = ends.dx, ends.dy, ends.scale, machine.path
    e = dx * WORD - step * dy
    if s == 16:
        grid, number = dy * s, n
        aside = machine.locals["el_edge_make.aside"].poly
        f = step * ends.t - aside * s
        path.assume_product(e, t)
    else:
        m = machine.locals["el_edge_make.m"].poly
        path.prove(m * s - n + k * dx * s, "m >= n / S")
        path.prove(n - k * dx * s + s - 1 - m * s, "m < n / S + 1")
        path.prove(2**33 - m, "m is below 2^33")
        path.prove(2**33 + m, "m is above -2^33")
        grid, number = dy, m + k * dx
        f = m * WORD - (x_q32 - (WORD - 1)) * dy
        path.assume_product(e, k)
    d = number * WORD + grid * (WORD - 1) - grid * (x_q32 + step * k)
    parts = e * t + f * dy if s == 16 else e * k + f
    if s == 16:
        path.prove(f, "f >= 0")
        path.prove(s - 1 - f, "f <= 15")
        path.assume_product(f, dy)
        path.assume_product(s - 1 - f, dy)
        path.prove(step * ends.t - f - aside * s, "what the shift cuts off", zero=True)
    else:
        path.prove(f, "f >= 0")
        path.prove(dy - 1 - f, "f < dy")
    path.prove(d - parts, "D is the sum of what is cut off", zero=True)
    return grid, number, d


def make_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    path = machine.path
    ends = ENDS.pop(id(path))
    edge = arguments[0].cell
    k, t, n = ends.stepped(machine)
    dx, dy = ends.dx, ends.dy
    grid, number, d = cut_off(machine, ends, edge, (k, t, n))
    path.prove(d, "D >= 0")
    step = machine.poly(edge, "step_q32")
    e = dx * WORD - step * dy
    if ends.scale == 16 and is_short(machine, dx, dy):
        # e t <= |dx| dy (dy - 1).
        short, narrow = (machine.constant(machine.unit.constants[name]) for name in SHORT)
        magnitude = dx if path.holds(dx) else -dx
        area = path.atom("|dx| dy", 0, narrow * short)
        path.assume_product(narrow - magnitude, dy)
        path.prove(narrow * short - magnitude * dy, "|dx| dy")
        path.assume(area - magnitude * dy, zero=True)
        path.assume_product(area - e, t)
        path.assume_product(narrow * short - area, t)
        path.prove(short - 1 - t, "t < dy")
    else:
        path.assume_product(dy - 1 - e, t if ends.scale == 16 else k)
        path.assume_product(dy, dy - 1 - t)
        path.assume_product(2 * ends.guard - dy, dy)
        path.assume_product(dy, 4079 - k)
    path.prove(WORD - grid - d, "D <= 2^32 - g")

    # The whole part.
    x = machine.poly(edge, "x_q32") + step * k
    c, fraction = path.atom("c", -(2**40), 2**40), path.atom("F", 0, WORD - 1)
    path.assume(x - c * WORD - fraction, zero=True)
    path.assume((x - c * WORD - fraction) * dy, zero=True)
    path.assume_product(fraction, dy)
    path.assume_product(WORD - 1 - fraction, dy)
    path.prove(grid * c - number, "c is not left of the edge")
    path.prove(number - 1 - grid * (c - 1), "c - 1 is")
    s = ends.scale
    path.prove(dy * c * s - n, "n <= c S dy")
    path.prove(n - 1 - dy * (c - 1) * s, "(c - 1) S dy < n")
    for bound in (2041 - c, c + 2041):
        # |c| <= 2041, for c - 2041 would need a product with dy, which decides.
        if not path.decide(bound, -bound - 1):
            path.assume_product(-bound - 1, dy)
            path.prove(Poly.of(-1), "|c| <= 2041 on the edge's own rows")


def step_domain(machine: Machine) -> list[Any]:
    path = machine.path
    _, guard = limits(machine)
    dx, dy = path.atom("dx", -2 * guard, 2 * guard), path.atom("dy", 1, 2 * guard)
    path.decide(dx, -dx - 1)
    is_short(machine, dx, dy)
    return [machine.exactly("int32_t", dx), machine.exactly("uint32_t", dy)]


def step_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    dx, dy = (argument.poly for argument in arguments)
    path, step = machine.path, result.poly
    forward = step if path.holds(dx) else -step - 1
    if not path.decide(forward, -forward - 1):
        path.assume_product(-forward - 1, dy)
        path.prove(Poly.of(-1), "a step has its edge's direction")
        raise Infeasible
    for reciprocal, (_, of) in path.quotients.items():
        if of.terms == dy.terms:
            # Of a short edge: 1 <= 2^32 - r dy <= dy, times |dx|.
            rest = WORD - Poly({(reciprocal,): 1}) * dy
            path.assume_product(dx if path.holds(dx) else -dx, rest - 1)
            path.assume_product(dx if path.holds(dx) else -dx, dy - rest)
    for bound in _step_errors(machine, dx, dy, step):
        path.prove(bound, "0 <= e, and not above what it may be")


def next_domain(machine: Machine) -> list[Any]:
    x, step = machine.path.atom("x_q32", -(2**61), 2**61), machine.path.atom("step_q32", -(2**61), 2**61)
    BEFORE[id(machine.path)] = (x, step)
    return [Pointer([machine.struct("el_edge", x_q32=x, step_q32=step)])]


BEFORE: dict[int, tuple[Poly, Poly]] = {}


def next_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    x, step = BEFORE.pop(id(machine.path))
    edge = arguments[0].cell
    machine.path.prove(machine.poly(edge, "x_q32") - x - step, "a step further", zero=True)
    machine.path.prove(machine.poly(edge, "step_q32") - step, "the step is as it was", zero=True)


def x_domain(machine: Machine) -> list[Any]:
    return [Pointer([machine.struct("el_edge", x_q32=machine.path.atom("x_q32", -(2**63), 2**63 - 1))])]


def x_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    fraction = machine.poly(arguments[0].cell, "x_q32") - result.poly * WORD
    machine.path.prove(fraction, "the whole part")
    machine.path.prove(WORD - 1 - fraction, "the whole part")


def centre_domain(machine: Machine) -> list[Any]:
    _, guard = limits(machine)
    return [machine.number("int32_t", "a", -guard, guard)]


def centre_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    s, _ = limits(machine)
    a, first = arguments[0].poly, result.poly
    machine.path.prove(first * s + s // 2 - a, "the centre of the first row is not above a")
    machine.path.prove(a - 1 - (first - 1) * s - s // 2, "the centre of the row above it is")


MAKE = Subject(
    FILE,
    "el_edge_make",
    make_domain,
    make_check,
    modular=["el_multiply_u16"],
    contracts={
        "el_edge_step_q32": step_of,
        "el_multiply_u16": times,
        "el_wide_ratio_q32": contracts.ratio_q32,
    },
)
STEP = Subject(
    FILE,
    "el_edge_step_q32",
    step_domain,
    step_check,
    contracts={"el_ratio_q32": contracts.ratio_q32, "el_reciprocal_of_short": contracts.reciprocal_of_short},
)
NEXT = Subject(FILE, "el_edge_next_row", next_domain, next_check)
WHOLE = Subject(FILE, "el_edge_x", x_domain, x_check)
CENTRE = Subject(FILE, "el_first_centre", centre_domain, centre_check)
SUBJECTS = pytest.mark.parametrize("subject", [MAKE, NEXT, WHOLE, CENTRE], ids=lambda subject: subject.function)


@EVERY_PRECISION
@SUBJECTS
def test_every_edge(subject: Subject, bits: int) -> None:
    subject.prove(bits)


def test_every_step_of_an_edge() -> None:
    STEP.prove()


@EVERY_PRECISION
@SUBJECTS
def test_the_compiler_agrees(subject: Subject, bits: int) -> None:
    subject.agree(bits, count=200)


def test_the_compiler_agrees_on_steps() -> None:
    STEP.agree(count=200)


@EVERY_PRECISION
@pytest.mark.parametrize(
    ("subject", "old", "new"),
    [
        (NEXT, "edge->x_q32 += edge->step_q32", "edge->x_q32 += edge->step_q32 + 1"),
        (CENTRE, "EL_SUBPIXELS / 2 - 1)", "EL_SUBPIXELS / 2)"),
    ],
    ids=["step", "centre"],
)
def test_the_proof_can_fail(subject: Subject, old: str, new: str, bits: int) -> None:
    subject.fails_with(Fault(EDGE, old, new), bits)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("aside + 0xFFFFFFFFLL", "aside + 0x100000000LL"),
        ("aside + 0xFFFFFFFFLL", "aside + 0xFFFFF000LL"),
        ("down) >> EL_SUBPIXEL_BITS;\n    edge", "down) / EL_SUBPIXELS;\n    edge"),
    ],
    ids=["bias", "less", "towards 0"],
)
def test_the_proof_can_fail_with_4_bits(old: str, new: str) -> None:
    MAKE.fails_with(Fault(EDGE, old, new))


@pytest.mark.parametrize("bits", [6, 8])
@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("el_wide_ratio_q32(m, dy) + 0xFFFFFFFFLL", "el_wide_ratio_q32(m, dy) + 0x100000000LL"),
        ("n + EL_SUBPIXELS - 1", "n + EL_SUBPIXELS"),
        ("(int64_t)(x0 - half) * dy", "(x0 - half) * dy"),
    ],
    ids=["bias", "round up", "an overflow"],
)
def test_the_proof_can_fail_with_more_bits(old: str, new: str, bits: int) -> None:
    MAKE.fails_with(Fault(EDGE, old, new), bits)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("-(int64_t)(product + aside)", "-(int64_t)product"),
        ("EL_EDGE_SHORT = 511", "EL_EDGE_SHORT = 512"),
    ],
    ids=["to the left", "too long"],
)
def test_the_proof_of_steps_can_fail(old: str, new: str) -> None:
    STEP.fails_with(Fault(EDGE, old, new))


def coverage(bias: int) -> Subject:
    """Any edge and any pixel: as two paths, E >= 0 and E < 0. Rounding up n / (S dy) takes a bias of 1."""

    def domain(machine: Machine) -> list[Any]:
        path = machine.path
        s, guard = limits(machine)
        dy, x = path.atom("dy", 1, 2 * guard), path.atom("x", -2041, 2041)
        n, pixel = path.atom("n", -(2**42), 2**42), path.atom("pixel", 0, 2039)
        path.assume(n + s * dy - bias - x * s * dy)
        path.assume((x + 1) * s * dy - 1 - n - s * dy + bias)
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
