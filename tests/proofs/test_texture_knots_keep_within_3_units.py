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
    return [machine.number("uint64_t", "U"), *numbers, machine.exactly("unsigned", 30 - shift), base]


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
    shift, base = 30 - arguments[3].poly.known, arguments[4].poly
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


# --- what a knot is made of -------------------------------------------------------------------------------------------


def leading_domain(machine: Machine) -> list[Any]:
    """x of any length, and where its leading zeros may have been."""
    length, near = machine.path.choose(machine.path.atom("length", 1, 32)), machine.path.atom("near", 0, 31)
    return [
        machine.number("uint32_t", "x", 1 << length - 1, (1 << length) - 1),
        machine.exactly("unsigned", machine.path.choose(near)),
    ]


def leading_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    x = arguments[0].poly * (1 << result.poly.known)
    require(machine.path.within(x, 2**31, WORD - 1), "the top bit is set, and nothing lost")


LEADING = Subject(FILE, "leading_zeros", leading_domain, leading_check, ["leading_zeros"])


def find_w_domain(machine: Machine) -> list[Any]:
    """A walk, and pixels to where it has a W that it can have."""
    path = machine.path
    walk = machine.struct("el_texture_walk")
    for name in ("w", "w_dx"):
        machine.put(walk.content[name], path.atom(name, 0, 2**64 - 1))
    machine.put(walk.content["w_shift"], path.atom("shift before", 0, 31))
    there = path.atom("W", 1, 2**31 - 1) * WORD + path.atom("fraction", 0, WORD - 1)
    pixels = machine.number("uint32_t", "pixels", 0, 4080)
    machine.contracts = FoundW(machine, walk, pixels, there).contracts()
    return [Pointer([walk]), pixels]


class FoundW:
    """What find_w asks for on one path."""

    def __init__(self, machine: Machine, walk: Any, pixels: Number, there: Poly) -> None:
        self.machine, self.walk, self.pixels, self.there = machine, walk, pixels.poly, there
        self.shift, self.n = 0, Poly.of(0)

    def contracts(self) -> dict[str, Any]:
        return {
            "el_multiply_u16": self.further,
            "leading_zeros": self.leading,
            "upper_word": self.upper_word,
            "log2_of_normalised_q8": self.logarithm,
            "el_reciprocal_near": self.near,
        }

    def further(self, machine: Machine, arguments: list[Any]) -> Number:
        """What is added to W: so many times its gradient."""
        for found, of in zip(arguments, (machine.poly(self.walk, "w_dx"), self.pixels), strict=True):
            require((found.poly - of).constant == 0, "W's gradient times the pixels")
        turns = machine.path.atom("turns", 0, 1)
        return machine.exactly("uint64_t", self.there - machine.poly(self.walk, "w") + turns * 2**64)

    def leading(self, machine: Machine, arguments: list[Any]) -> Number:
        """leading_zeros, proven above, of W's whole part."""
        x = arguments[0].poly
        require((x - machine.path.floor(self.there, WORD)).constant == 0, "W's whole part")
        self.shift = machine.leading_zeros(arguments[0], 32, None).poly.known
        return machine.exactly("unsigned", self.shift)

    def upper_word(self, machine: Machine, arguments: list[Any]) -> Number:
        require((arguments[0].poly - self.there).constant == 0, "the upper word of W")
        require(arguments[1].poly.constant == self.shift >= 1, "W < 2^31")
        require(machine.path.within(self.there * (1 << self.shift), 2**63, 2**64 - 1), "W's leading zeros")
        self.n = machine.path.floor(self.there * (1 << self.shift), WORD)
        return machine.exactly("uint32_t", self.n)

    def logarithm(self, machine: Machine, arguments: list[Any]) -> Number:
        for argument, of in zip(arguments, (self.n, Poly.of(self.shift)), strict=True):
            require((argument.poly - of).constant == 0, "the logarithm of W")
        return machine.exactly("int32_t", LOG_OF_W)

    def near(self, machine: Machine, arguments: list[Any]) -> Number:
        require((arguments[0].poly - self.n).constant == 0, "the reciprocal of N")
        SHIFTS[id(machine.path)] = self.shift
        return machine.exactly("uint32_t", RECIPROCAL)


LOG_OF_W, RECIPROCAL = 7, 2**31 + 5  # numbers to know them by
SHIFTS: dict[int, int] = {}


def find_w_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    walk = arguments[0].cell
    wanted = {"w_log2_q8": LOG_OF_W, "reciprocal": RECIPROCAL, "w_shift": SHIFTS.pop(id(machine.path))}
    for name, value in wanted.items():
        require(machine.poly(walk, name).known == value, name)


FIND_W = Subject(FILE, "find_w", find_w_domain, find_w_check, modular=["find_w"])


def find_knot_domain(machine: Machine) -> list[Any]:
    """u or v anywhere, and the last knot."""
    path = machine.path
    axis = machine.struct("el_texture_axis")
    for name in ("value", "dx"):
        machine.put(axis.content[name], path.atom(name, 0, 2**64 - 1))
    machine.put(axis.content["down"], path.atom("down", 3, 30))
    machine.put(axis.content["base_q16"], path.atom("base", -TEXELS << 16, TEXELS << 16))
    machine.put(axis.content["next_q16"], path.atom("before", -MOST_KNOT, MOST_KNOT))
    before = {name: machine.poly(axis, name) for name in ("value", "dx", "down", "base_q16", "next_q16")}
    pixels = machine.number("uint32_t", "pixels", 0, 4080)
    shift, reciprocal = machine.number("unsigned", "s", 1, 31), machine.number("uint32_t", "reciprocal", 2**31)
    step_reciprocal = machine.number("uint32_t", "step reciprocal")
    walk = machine.struct("el_texture_walk", w_shift=shift.poly, reciprocal=reciprocal.poly)
    asked = (shift.poly, reciprocal.poly, before["down"], before["base_q16"])
    added: list[Number] = []

    def further(of: Machine, arguments: list[Any]) -> Number:
        """el_multiply_u16: the gradient times the pixels."""
        require((arguments[0].poly - before["dx"]).constant == 0, "its own gradient")
        require((arguments[1].poly - pixels.poly).constant == 0, "times the pixels")
        added.append(of.number("uint64_t", "further", 0, 2**64 - 1))
        return added[0]

    def knot_there(of: Machine, arguments: list[Any]) -> Number:
        congruent(arguments[0].poly, before["value"] + added[0].poly, 2**64, "at its plane's value there")
        for found, exact in zip(arguments[1:], asked, strict=True):
            require((found.poly - exact).constant == 0, "a knot of its own numbers")
        return of.number("int32_t", "knot", -MOST_KNOT, MOST_KNOT)

    def step(of: Machine, arguments: list[Any]) -> Number:
        difference = of.poly(axis, "next_q16") - before["next_q16"]
        require((arguments[0].poly - difference).constant == 0, "the difference of the two knots")
        require((arguments[1].poly - step_reciprocal.poly).constant == 0, "over their distance")
        return of.exactly("int32_t", STEP)

    machine.contracts = {"el_multiply_u16": further, "knot": knot_there, "el_multiply_high_i32_u32": step}
    BEFORE[id(path)] = before
    return [Pointer([axis]), Pointer([walk]), pixels, step_reciprocal]


STEP = 11  # a number to know it by
BEFORE: dict[int, dict[str, Poly]] = {}


def find_knot_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """The piece begins where the last knot was; the step is that of the difference."""
    axis, before = arguments[0].cell, BEFORE.pop(id(machine.path))
    require((machine.poly(axis, "q16") - before["next_q16"]).constant == 0, "from the knot before")
    require(machine.poly(axis, "step_q16").known == STEP, "the step")
    require((machine.poly(axis, "value") - before["value"]).constant == 0, "the span's beginning stays")


FIND_KNOT = Subject(FILE, "find_knot", find_knot_domain, find_knot_check, modular=["find_knot"])

SUBJECTS = {
    "corners": CORNERS,
    "upper word": UPPER,
    "knot": KNOT,
    "leading zeros": LEADING,
    "find W": FIND_W,
    "find knot": FIND_KNOT,
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
        ("knot", FILE, "ratio_q30 >> down", "ratio_q30 >> (down + 1U)"),
        ("knot", "base/divide.h", "EL_RECIPROCAL_ERROR = 18", "EL_RECIPROCAL_ERROR = 32"),
        ("leading zeros", FILE, "x << near < 0x80000000U", "x << near < 0x40000000U"),
        ("leading zeros", FILE, "x << near >> near != x", "x << near >> near == 0"),
        ("find W", FILE, "el_reciprocal_near(normalised)", "el_reciprocal_near(normalised | 1U)"),
        ("find W", FILE, "upper_word(w, shift)", "upper_word(w, walk->w_shift)"),
        (
            "find knot",
            FILE,
            "axis->value + el_multiply_u16(axis->dx, pixels)",
            "axis->value - el_multiply_u16(axis->dx, pixels)",
        ),
        ("find knot", FILE, "to_q16 - from_q16, step", "from_q16 - to_q16, step"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(file, old, new))
