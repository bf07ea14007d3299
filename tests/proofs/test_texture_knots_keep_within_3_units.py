"""raster/texture_walk: knots are off by less than 3 units of 2^-16 texel, from a reciprocal that is only near.

U and W have 1 <= W < 2^31 and |U| <= W: at the corners that is proven here, of what is made from them in
test_texture_walk_keeps_its_error.

With s the leading zeros of W's whole part, B = 2^s W and A = 2^(s - 1) U, in units of 2^-32, the knot is
2^(shift + 1) A / B from its base. The C takes whole parts, N = floor(B / 2^32) and M = floor(A / 2^32), and r near
2^63 / N: k = 2^63 - r N, 1 <= k < E N, E = EL_RECIPROCAL_ERROR. M r = 2^32 ratio + f gives

    2^32 (N ratio - 2^31 M) = -M k - f N,     |2 M| <= N + 2,

so ratio B - 2^31 A is above -(E / 2 + 3) B and below (E / 2 + 2) B: ratio is off by less than 12 units of 2^-30, which
become less than 2 when at least 3 bits are cut off, and cutting them off is less than one more.
"""

from __future__ import annotations

from typing import Any

import pytest

import contracts
from contracts import MOST_KNOT, TEXELS
from proof import Fault, Machine, Number, Pointer, Poly, Subject, congruent, quotient_of
from symbolic import require

FILE, TRIANGLE = "raster/texture_walk.c", "raster/triangle.c"
WORD = 1 << 32

# --- U at the corners -------------------------------------------------------------------------------------------------


def corners_domain(machine: Machine) -> list[Any]:
    """Texture coordinates of three corners, 16 bits with 4 of fraction, and 1/w there."""
    path = machine.path
    u = [path.atom(f"u{i}", -TEXELS << 16, (TEXELS << 16) - (1 << 12)) for i in range(3)]
    w = [path.atom(f"w{i}", 1, 2**31 - 1) for i in range(3)]
    results = machine.array("int32_t", [0]), machine.array("uint8_t", [0]), machine.array("int64_t", [0] * 3)
    return [machine.array("int32_t", u), machine.array("uint32_t", w), *results]


def product_lemma(machine: Machine, product: Number) -> Number:
    """Of a corner: |u - base| < 2^shift, times w."""
    path, scope = machine.path, machine.scopes
    values = {name: cell for level in scope for name, cell in level.items()}
    i = machine.poly(values["i"]).known
    w = machine.poly(values["w"].content.cells[i])
    aside = machine.poly(values["coordinates_q16"].content.cells[i]) - machine.poly(values["base_q16"].content.cell)
    most = (1 << machine.poly(values["shift"].content.cell).known) - 1
    path.assume_product(most - aside, w)
    path.assume_product(most + aside, w)
    return product


def rounded(machine: Machine, arguments: list[Any]) -> Number:
    """el_shift_i64 of a shift that is not negative (test_scaling_rounds_to_nearest)."""
    value, shift = (argument.poly for argument in arguments)
    machine.path.prove(shift, "not to the left")
    return machine.exactly("int64_t", machine.path.floor(value * 2 + (1 << shift.known), 2 << shift.known))


def corners_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """|U| <= W with the bits of fraction that U has, and U is (u - base) w / 2^shift to the nearest."""
    path = machine.path
    u, w, base, shift, values = ([machine.poly(cell) for cell in pointer.cells] for pointer in arguments)
    fraction = machine.constant(machine.unit.constants["EL_PLANE_FRACTION_BITS"])
    require(fraction <= shift[0].known <= 27, "the shift's range")
    require(path.within(base[0], -TEXELS << 16, TEXELS << 16), "the base is within the texels")
    for at, of, value in zip(u, w, values, strict=True):
        path.prove(of * (1 << fraction) - value, "U <= W")
        path.prove(of * (1 << fraction) + value, "-W <= U")
        error = value * (2 << shift[0].known - fraction) - (at - base[0]) * of * 2
        path.prove((1 << shift[0].known - fraction) - error, "not rounded up by more than 1/2")
        path.prove((1 << shift[0].known - fraction) + error, "not rounded down by more than 1/2")


CORNERS = Subject(
    TRIANGLE,
    "divide_texture_coordinate",
    corners_domain,
    corners_check,
    contracts={"el_shift_i64": rounded},
    lemmas={"divide_texture_coordinate.product": product_lemma},
)


# --- a knot -----------------------------------------------------------------------------------------------------------


def knot_domain(machine: Machine) -> list[Any]:
    """B and A of a W and a U that the walk can have: M comes from upper_word, N as the reciprocal's divisor."""
    path = machine.path
    n, below = path.atom("N", 2**31, WORD - 1), path.atom("rest of B", 0, WORD - 1)
    m, rest = path.atom("M", -(2**31), 2**31 - 1), path.atom("rest of A", 0, WORD - 1)
    a, b = m * WORD + rest, n * WORD + below
    path.assume(b - a * 2)
    path.assume(b + a * 2)
    path.decide(m, -m - 1)
    magnitude = m if path.holds(m) else -m
    r = contracts.reciprocal_near(machine, [machine.exactly("uint32_t", n)]).poly
    k, error = 2**63 - r * n, machine.constant(machine.unit.constants["EL_RECIPROCAL_ERROR"])
    # |M k| < E N (N + 2) / 2, and N < 2^32.
    path.prove(n + 2 - magnitude * 2, "|2 M| <= N + 2")
    path.assume_product(magnitude, k - 1)
    path.assume_product(magnitude, n * error - 1 - k)
    path.assume_product(n + 2 - magnitude * 2, n)
    path.assume_product(WORD - 1 - n, n)
    KNOTS[id(path)] = (m, rest, n, below, r)
    shift = path.choose(path.atom("shift", 0, 27))
    base = machine.number("int32_t", "base", -TEXELS << 16, TEXELS << 16)
    numbers = machine.exactly("unsigned", path.atom("s", 1, 31)), machine.exactly("uint32_t", r)
    return [machine.number("uint64_t", "U"), *numbers, machine.exactly("uint8_t", shift), base]


KNOTS: dict[int, tuple[Poly, Poly, Poly, Poly, Poly]] = {}


def upper_half(machine: Machine, arguments: list[Any]) -> Number:
    """upper_word of U and s - 1: M, modulo 2^32."""
    u, s = (machine.scopes[0][name].content.poly for name in ("u_q32", "w_shift"))
    require((arguments[0].poly - u).constant == 0, "of U")
    require((arguments[1].poly - s).constant == -1, "moved up by one bit less than W")
    m = KNOTS[id(machine.path)][0]
    return machine.exactly("uint32_t", m if machine.path.holds(m) else m + WORD)


def ratio_lemma(machine: Machine, value: Number) -> Number:
    """N ratio - 2^31 M in its bounds, and |ratio| <= 2^30 + 4."""
    path, ratio = machine.path, value.poly
    m, _, n, below, r = KNOTS[id(path)]
    f, k = m * r - ratio * WORD, 2**63 - r * n
    path.prove(f, "f >= 0")
    path.prove(WORD - 1 - f, "f < 2^32")
    path.assume_product(f, n)
    path.assume_product(WORD - 1 - f, n)
    off = n * ratio - m * 2**31
    require((off * WORD + m * k + f * n).constant == 0, "2^32 (N ratio - 2^31 M) = -M k - f N")
    for bound in (2**30 + 4 - ratio, 2**30 + 4 + ratio):
        quotient_of(path, bound, n, "|ratio| <= 2^30 + 4")
        path.assume_product(bound, below)
    return value


def knot_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """Off by less than KNOT_ERROR units; and within the base and 2^27, so that the difference of two fits 32 bits."""
    path = machine.path
    m, rest, n, below, _ = KNOTS.pop(id(path))
    shift, base = arguments[3].poly.known, arguments[4].poly
    a, b = m * WORD + rest, n * WORD + below
    ratio = machine.locals["knot.ratio_q30"].poly
    error = machine.constant(machine.unit.constants["EL_RECIPROCAL_ERROR"])
    path.prove(ratio * b - a * 2**31 + b * (error // 2 + 3), "ratio is not lower by more")
    path.prove(b * (error // 2 + 2) - ratio * b + a * 2**31, "ratio is not higher by more")
    # What is cut off, times B.
    cut_off = ratio - (result.poly - base) * (1 << 30 - shift)
    path.prove(cut_off, "cut off")
    path.prove((1 << 30 - shift) - 1 - cut_off, "cut off")
    path.assume_product(cut_off, b)
    path.assume_product((1 << 30 - shift) - 1 - cut_off, b)
    off = ((result.poly - base) * b - a * (2 << shift)) * (1 << 30 - shift)
    path.prove(off + b * (contracts.KNOT_ERROR << 30 - shift) - 1, "not too low by 3 units")
    path.prove(b * (contracts.KNOT_ERROR << 30 - shift) - 1 - off, "nor too high")
    for bound in (result.poly + MOST_KNOT, MOST_KNOT - result.poly):
        path.prove(bound, "|knot| <= 2^28 + 1")


KNOT = Subject(
    FILE,
    "knot",
    knot_domain,
    knot_check,
    modular=["knot"],
    contracts={"upper_word": upper_half},
    lemmas={"knot.ratio_q30": ratio_lemma},
)


def upper_domain(machine: Machine) -> list[Any]:
    x = machine.path.atom("high", 0, WORD - 1) * WORD + machine.path.atom("low", 0, WORD - 1)
    shift = machine.path.choose(machine.path.atom("shift", 0, 31))
    return [machine.exactly("uint64_t", x), machine.exactly("unsigned", shift)]


def upper_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """floor(2^shift x / 2^32) modulo 2^32."""
    x, shift = (argument.poly for argument in arguments)
    exact = machine.path.floor(x * (1 << shift.known), WORD)
    difference = exact - result.poly
    machine.path.prove(difference - machine.path.floor(difference, WORD) * WORD, "the upper word", zero=True)


UPPER = Subject(FILE, "upper_word", upper_domain, upper_check)


# --- both knots of a walk, and on to the next -------------------------------------------------------------------------


def find_domain(machine: Machine) -> list[Any]:
    """A walk at a W and a U that it can have."""
    path = machine.path
    planes, walk = machine.struct("el_perspective"), machine.struct("el_texture_walk")
    w = path.atom("W", 1, 2**31 - 1) * WORD + path.atom("fraction", 0, WORD - 1)
    machine.put(walk.content["w"], w)
    wanted = []
    for name in "uv":
        u, shift = path.atom(name, 0, 2**64 - 1), path.atom(f"{name}_shift", 0, 27)
        base = path.atom(f"{name}_base", -TEXELS << 16, TEXELS << 16)
        machine.put(walk.content[name], u)
        machine.put(planes.content[f"{name}_shift"], shift)
        machine.put(planes.content[f"{name}_base_q16"], base)
        wanted.append((u, shift, base))
    walk.content["planes"].content = Pointer([planes])
    machine.contracts = Found(w, wanted).contracts()
    return [Pointer([walk])]


class Found:
    """What find_knot asks for on one path: N, its reciprocal, and the knot of u and then of v, each with its own."""

    def __init__(self, w: Poly, wanted: list[tuple[Poly, Poly, Poly]]) -> None:
        self.w, self.wanted = w, wanted
        self.shift, self.n, self.reciprocal = 0, Poly.of(0), Poly.of(0)

    def contracts(self) -> dict[str, Any]:
        return {
            "upper_word": self.upper_word,
            "log2_of_normalised_q8": self.logarithm,
            "el_reciprocal_near": self.near,
            "knot": self.knot,
        }

    def upper_word(self, machine: Machine, arguments: list[Any]) -> Number:
        require((arguments[0].poly - self.w).constant == 0, "the upper word of W")
        self.shift = arguments[1].poly.known
        require(self.shift >= 1, "W < 2^31")
        require(machine.path.within(self.w * (1 << self.shift), 2**63, 2**64 - 1), "W's leading zeros")
        self.n = machine.path.floor(self.w * (1 << self.shift), WORD)
        return machine.exactly("uint32_t", self.n)

    def logarithm(self, machine: Machine, arguments: list[Any]) -> Number:
        for argument, of in zip(arguments, (self.n, Poly.of(self.shift)), strict=True):
            require((argument.poly - of).constant == 0, "the logarithm of W")
        return machine.exactly("int32_t", LOG_OF_W)

    def near(self, machine: Machine, arguments: list[Any]) -> Number:
        require((arguments[0].poly - self.n).constant == 0, "the reciprocal of N")
        number = contracts.reciprocal_near(machine, arguments)
        self.reciprocal = number.poly
        return number

    def knot(self, machine: Machine, arguments: list[Any]) -> Number:
        u, w_shift, reciprocal, shift, base = (argument.poly for argument in arguments)
        exact = (*self.wanted.pop(0), Poly.of(self.shift), self.reciprocal)
        for found, of in zip((u, shift, base, w_shift, reciprocal), exact, strict=True):
            require((found - of).constant == 0, "a knot of its own numbers")
        return machine.exactly("int32_t", len(self.wanted))


LOG_OF_W = 7  # a number to know it by


def find_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    require(machine.poly(arguments[0].cell, "w_log2_q8").known == LOG_OF_W, "the logarithm of W")
    for i, name in enumerate("vu"):
        require(machine.poly(arguments[0].cell, f"next_{name}_q16").known == i, f"the next knot of {name}")


FIND = Subject(FILE, "find_knot", find_domain, find_check)


def go_on_domain(machine: Machine) -> list[Any]:
    path = machine.path
    planes, walk = machine.struct("el_perspective"), machine.struct("el_texture_walk")
    for name in "wuv":
        machine.put(planes.content[name].content["dx"], path.atom(f"d{name}", 0, 2**64 - 1))
        machine.put(walk.content[name], path.atom(name, 0, 2**64 - 1))
    walk.content["planes"].content = Pointer([planes])
    BEFORE[id(path)] = {name: machine.poly(walk, name) for name in "wuv"}
    return [Pointer([walk]), machine.number("uint32_t", "pixels", 0, 4080)]


BEFORE: dict[int, dict[str, Poly]] = {}


def go_on_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    walk, pixels = arguments[0].cell, arguments[1].poly
    planes = walk.content["planes"].content.cell
    for name, before in BEFORE.pop(id(machine.path)).items():
        moved = before + machine.poly(planes, name, "dx") * pixels
        congruent(machine.poly(walk, name), moved, 2**64, f"{name} there")


GO_ON = Subject(FILE, "go_on", go_on_domain, go_on_check, ["go_on"], {"el_multiply_u16": contracts.multiply_u64})

SUBJECTS = {
    "corners": CORNERS,
    "upper word": UPPER,
    "knot": KNOT,
    "find knot": FIND,
    "go on": GO_ON,
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


def test_corners_without_bits_of_fraction() -> None:
    CORNERS.prove(6)


@pytest.mark.parametrize("name", ["corners", "upper word"])
def test_the_compiler_agrees(name: str) -> None:
    subject = SUBJECTS[name]
    Subject(subject.file, subject.function, subject.domain).agree(count=200)


@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("corners", TRIANGLE, "(least + most) >> 1", "(least + most) >> 2"),
        ("upper word", FILE, ">> 1 >> (31U - shift)", ">> (31U - shift)"),
        ("knot", FILE, "upper_word(u_q32, w_shift - 1U)", "upper_word(u_q32, w_shift)"),
        ("knot", FILE, "ratio_q30 >> (30 - shift)", "ratio_q30 >> (31 - shift)"),
        ("knot", "base/divide.h", "EL_RECIPROCAL_ERROR = 18", "EL_RECIPROCAL_ERROR = 32"),
        ("find knot", FILE, "w_shift, reciprocal, p->v_shift", "w_shift, reciprocal, p->u_shift"),
        ("find knot", FILE, "el_reciprocal_near(normalised)", "el_reciprocal_near(normalised | 1U)"),
        ("go on", FILE, "walk->v += el_multiply_u16(p->v.dx", "walk->v += el_multiply_u16(p->u.dx"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(file, old, new))
