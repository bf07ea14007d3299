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

Short edges are made in Q20 and are exact in the same way, with 2^20 for 2^32, 48 units less added first, and steps that
may be too high:

    short             D = e t + f dy + 47 g, -dy <= 2 e <= 3 dy

* From c, i >= c if and only if E >= 0: (c - 1) S dy < n <= c S dy. A left edge takes the pixels with E >= 0, a right
  edge leaves them: E = 0 belongs to left edges only.
* el_first_centre(a) <= j if and only if the centre of row j is not above a: with rows [first(top), first(bottom)), a
  centre on a top edge counts, one on a bottom edge does not.

Edges may have moved by up to half a pixel: of samples from their place to the centre, of wires to the border before it.
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

    def __init__(self, machine: Machine, moves: bool = False) -> None:
        path = machine.path
        self.scale, self.guard = limits(machine)
        s, guard = self.scale, self.guard
        # Where an edge moves, both of its ends do.
        self.reach = reach = guard + (s // 2 if moves else 0)
        self.x0, self.x1 = path.atom("x0", -reach, reach), path.atom("x1", -reach, reach)
        self.y0 = path.atom("y0", -reach, reach - 1)
        self.y1 = path.atom("y1", self.y0.constant + 1 if self.y0.constant is not None else -reach, reach)
        self.dx, self.dy = self.x1 - self.x0, self.y1 - self.y0
        path.assume(self.dy - 1)
        if moves:
            for room in (2 * guard - self.dy, 2 * guard - self.dx, 2 * guard + self.dx):
                path.assume(room)
        if self.y0.constant is not None and self.y1.constant is not None:
            self.row = path.atom("row", (self.y0.constant + s // 2 - 1) // s, (self.y1.constant + s // 2 - 1) // s - 1)
            return
        self.row = path.atom("row", -2041, 2041)
        self.t = self.row * s + s // 2 - self.y0
        path.assume(self.t)
        path.assume(self.dy - 1 - self.t)
        self._between_ends(path, self.t)
        # Steps to the right and to the left: numbers of one sign are congruent to unsigned ones in one way.
        path.decide(self.dx, -self.dx - 1)

    def _between_ends(self, path: Path, t: Poly) -> None:
        for x, rest in ((self.x0, self.dy - t), (self.x1, t)):
            path.assume_product(x + self.reach, rest)
            path.assume_product(self.reach - x, rest)

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
    ends = Ends(machine, moves=True)
    ENDS[id(machine.path)] = ends
    edge = Pointer([machine.struct("el_edge")])
    return [edge, *(machine.exactly("int32_t", n) for n in (ends.x0, ends.y0, ends.x1, ends.y1, ends.row))]


def step_of(machine: Machine, arguments: list[Any]) -> Number:
    """el_ratio_q32; and that a step has its edge's direction."""
    dx, dy = (argument.poly for argument in arguments)
    path = machine.path
    step = contracts.ratio_q32(machine, arguments)
    has_direction(path, step.poly if path.holds(dx) else -step.poly - 1, dy)
    return step


def has_direction(path: Path, forward: Poly, dy: Poly) -> None:
    """forward >= 0, from forward dy > -dy."""
    if not path.decide(forward, -forward - 1):
        path.assume_product(-forward - 1, dy)
        path.prove(Poly.of(-1), "a step has its edge's direction")
        raise Infeasible


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
    path.assume_product(dy - 1 - e, t if ends.scale == 16 else k)
    path.assume_product(dy, dy - 1 - t)
    path.assume_product(2 * ends.guard - dy, dy)
    path.assume_product(dy, 4079 - k)
    path.prove(WORD - grid - d, "D <= 2^32 - g")
    check_whole_part(machine, ends, machine.poly(edge, "x_q32") + step * k, WORD, (grid, number, n))


def check_whole_part(machine: Machine, ends: Ends, x: Poly, one: int, numbers: tuple[Poly, Poly, Poly]) -> None:
    """The whole part of x, in units of 1 / one, is the first pixel that is not left of the edge."""
    path, dy = machine.path, ends.dy
    grid, number, n = numbers
    c, fraction = path.atom("c", -(2**40), 2**40), path.atom("F", 0, one - 1)
    path.assume(x - c * one - fraction, zero=True)
    path.assume((x - c * one - fraction) * dy, zero=True)
    path.assume_product(fraction, dy)
    path.assume_product(one - 1 - fraction, dy)
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


SHORT = ("EL_EDGE_SHORT", "EL_EDGE_NARROW")
Q20 = 1 << 20


def short_domain(machine: Machine) -> list[Any]:
    ends = Ends(machine)
    path = machine.path
    short, narrow = (machine.constant(machine.unit.constants[name]) for name in SHORT)
    for bound in (short - ends.dy, narrow - ends.dx, narrow + ends.dx):
        path.assume(bound)
    ENDS[id(path)] = ends
    edge = Pointer([machine.struct("el_edge")])
    return [edge, *(machine.exactly("int32_t", n) for n in (ends.x0, ends.y0, ends.x1, ends.y1, ends.row))]


def assume_cut_off(path: Path, ends: Ends, reciprocal: Poly, cut_off: Poly, unit: int) -> None:
    """A step is dx times a reciprocal, of which 2^31 - r dy is lacking, without a part below a unit."""
    magnitude = ends.dx if path.holds(ends.dx) else -ends.dx
    lacks = 2**31 - reciprocal * ends.dy
    path.assume_product(magnitude, lacks - 1)
    path.assume_product(magnitude, ends.dy - lacks)
    path.assume_product(cut_off, ends.dy)
    path.assume_product(unit - 1 - cut_off, ends.dy)


def expect_forward(path: Path, ends: Ends, forward: Poly, least: int) -> None:
    """Steps go the edge's way, by `least` at least: between its rows as between its ends."""
    path.prove(forward - least, "a step has its edge's direction")
    path.assume_product(forward, ends.dy - 1 - ends.t)
    path.assume_product(forward, ends.t)
    path.assume_product(ends.dy, ends.dy - 1 - ends.t)


def short_step_lemma(machine: Machine, step_q20: Number) -> Number:
    """2^11 e = dx (2^31 - r dy) + dy (dx r - 2^11 step): what the reciprocal lacks, and what is cut off."""
    path, step = machine.path, step_q20.poly
    if step.constant is not None:
        return step_q20
    ends = ENDS[id(path)]
    dx, dy = ends.dx, ends.dy
    ((reciprocal, _),) = ((Poly({(atom,): 1}), of) for atom, (_, of) in path.quotients.items() if of.terms == dy.terms)
    right = path.holds(dx)
    magnitude = dx if right else -dx
    assume_cut_off(path, ends, reciprocal, dx * reciprocal - 2**11 * step, 2**11)
    narrow = machine.constant(machine.unit.constants["EL_EDGE_NARROW"])
    path.assume_product(narrow - magnitude, dy)
    e = dx * Q20 - step * dy
    for bound in (2 * e + dy, 3 * dy - 2 * e):
        path.prove(bound, "-dy <= 2 e <= 3 dy")
        path.assume(bound)
        path.assume_product(bound, ends.t)
    path.prove(reciprocal - 1, "a reciprocal is not 0")
    path.assume_product(magnitude if right else magnitude - 1, reciprocal)
    expect_forward(path, ends, step if right else -step, 0 if right else 1)
    path.assume_product(511 - dy, dy)
    return step_q20


def short_aside_lemma(machine: Machine, aside: Number) -> Number:
    """The first x is within the guard band, which its product with dy decides."""
    path = machine.path
    if aside.poly.constant is not None:
        return aside
    ends = ENDS[id(path)]
    step = machine.locals["el_edge_make_q20.step_q20"].poly
    f = step * ends.t - aside.poly * 16
    path.assume_product(f, ends.dy)
    path.assume_product(15 - f, ends.dy)
    x = (ends.x0 + 8) * 2**16 + aside.poly
    for bound in (2042 * Q20 - x, x + 2042 * Q20):
        if not path.decide(bound, -bound - 1):
            path.assume_product(-bound - 1, ends.dy)
            path.prove(Poly.of(-1), "the first x is within the guard band")
            raise Infeasible
    return aside


def short_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    path = machine.path
    ends = ENDS.pop(id(path))
    edge = arguments[0].cell
    x, step, aside = (machine.locals[f"el_edge_make_q20.{name}"].poly for name in ("x_q20", "step_q20", "aside"))
    path.prove(machine.poly(edge, "x_q32") - x * 2**12, "x in Q32", zero=True)
    path.prove(machine.poly(edge, "step_q32") - step * 2**12, "the step in Q32", zero=True)
    k, t, n = ends.stepped(machine)
    dx, dy = ends.dx, ends.dy
    grid = dy * 16
    e, f = dx * Q20 - step * dy, step * ends.t - aside * 16
    d = n * Q20 + grid * (Q20 - 1) - grid * (x + step * k)
    path.prove(d - e * t - f * dy - 47 * grid, "D is the sum of what is cut off", zero=True)
    for bound in (2 * e + dy, 3 * dy - 2 * e):
        path.assume_product(bound, t)
    path.assume_product(dy, dy - 1 - t)
    short = machine.constant(machine.unit.constants["EL_EDGE_SHORT"])
    path.assume_product(short - 1 - t, dy)
    path.prove(d, "D >= 0")
    path.prove(Q20 - grid - d, "D <= 2^20 - g")
    check_whole_part(machine, ends, x + step * k, Q20, (grid, n, n))


def q20_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    machine.path.prove(result.poly - arguments[0].poly * 2**12, "the same number", zero=True)


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
        "el_ratio_q32": step_of,
        "el_multiply_u16": times,
        "el_wide_ratio_q32": contracts.ratio_q32,
    },
)
MAKE_SHORT = Subject(
    FILE,
    "el_edge_make_short",
    short_domain,
    short_check,
    contracts={
        "el_reciprocal_of_short": contracts.reciprocal_of_short,
        "el_product_down_11": contracts.product_down_11,
        "el_q20_to_q32": lambda machine, arguments: machine.exactly("int64_t", arguments[0].poly * 2**12),
    },
    lemmas={
        "el_edge_make_q20.step_q20": short_step_lemma,
        "el_edge_make_q20.aside": short_aside_lemma,
    },
)
WIDEN = Subject(
    FILE, "el_q20_to_q32", lambda machine: [machine.number("int32_t", "a_q20")], q20_check, ["el_q20_to_q32"]
)
NEXT = Subject(FILE, "el_edge_next_row", next_domain, next_check)
WHOLE = Subject(FILE, "el_edge_x", x_domain, x_check)
CENTRE = Subject(FILE, "el_first_centre", centre_domain, centre_check)
SUBJECTS = pytest.mark.parametrize("subject", [MAKE, NEXT, WHOLE, CENTRE], ids=lambda subject: subject.function)


@EVERY_PRECISION
@SUBJECTS
def test_every_edge(subject: Subject, bits: int) -> None:
    subject.prove(bits)


def test_every_short_edge() -> None:
    MAKE_SHORT.prove()
    WIDEN.prove()


@EVERY_PRECISION
@SUBJECTS
def test_the_compiler_agrees(subject: Subject, bits: int) -> None:
    subject.agree(bits, count=200)


def test_the_compiler_agrees_on_short_edges() -> None:
    MAKE_SHORT.agree(count=200)
    WIDEN.agree(count=200)


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
        ("+ aside - 48;", "+ aside - 14;"),
        ("+ aside - 48;", "+ aside - 82;"),
        ("EL_EDGE_SHORT = 511", "EL_EDGE_SHORT = 800"),
        ("EL_EDGE_NARROW = 1023", "EL_EDGE_NARROW = 2047"),
    ],
    ids=["less", "more", "too long", "too wide"],
)
def test_the_proof_of_short_edges_can_fail(old: str, new: str) -> None:
    MAKE_SHORT.fails_with(Fault(EDGE, old, new))


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
