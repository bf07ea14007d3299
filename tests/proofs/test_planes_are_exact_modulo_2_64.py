"""raster/plane: depth, colours, 1/w and coordinates over it, as planes in Q32 modulo 2^64.

With A = |doubled area|, S = EL_SUBPIXELS, f = 2^(32 - fraction_bits), and X, Y from the first corner to a pixel's
centre, the plane through the corners' values is f (v0 A + a X + b Y) / A. What the C has at pixel (i, j) is,
modulo 2^64,

    Z = f v0 + Qo + Qx (i - column) + Qy (j - row)

where Qo, Qx, Qy are quotients by A, truncated. From X = S (i - column) + to_centre_x, Z A differs from the plane by
eo + ex (i - column) + ey (j - row), where an e is what a truncation cut off, below A: Z is off by less than
1 + 4080 + 4080 units of 2^-32 on any pixel of the largest screen.

At a covered pixel the plane's value is a mean of the corners' with weights that are not negative, the edge functions
over A, so it lies between the corners' values, which fit 32 bits: that is why the modulus loses nothing.
"""

from __future__ import annotations

from typing import Any

import pytest

from c_values import IntType
from proof import EVERY_PRECISION, Fault, Machine, Number, Pointer, Poly, Subject, as_unknown
from symbolic import require

FILE = "raster/plane.c"
RING = 1 << 64
SCREEN = 2040


def corners(machine: Machine) -> tuple[list[Poly], list[Poly], Poly]:
    """Any triangle in the guard band, and its doubled area."""
    path = machine.path
    guard = machine.constant(machine.unit.constants["EL_GUARD_SUB"])
    x = [path.atom(f"x{i}", -guard, guard) for i in range(3)]
    y = [path.atom(f"y{i}", -guard, guard) for i in range(3)]
    area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
    return x, y, area


def frame_domain(machine: Machine) -> list[Any]:
    x, y, area = corners(machine)
    if area.constant is not None:
        machine.path.assume(area * area - 1)
    elif not machine.path.decide(area - 1, -area):
        machine.path.assume(-area - 1)
    frame = machine.struct("el_plane_frame")
    row = machine.number("int32_t", "row", 0, SCREEN - 1)
    return [Pointer([frame]), machine.array("int32_t", x), machine.array("int32_t", y), row]


def area_lemma(machine: Machine, area: Number) -> Number:
    """The area as one unknown. Affine in each coordinate, it has its extremes at the corners of the guard band."""
    exact = area.poly
    path = machine.path
    guard = machine.constant(machine.unit.constants["EL_GUARD_SUB"])
    most = (2 * guard) ** 2
    if path.holds(exact - 1):
        return as_unknown(machine, area, 1, most)
    return as_unknown(machine, area, -most, -1)


def frame_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """|area|, as a divisor or as a number, is the doubled area."""
    frame = arguments[0].cell.content
    area = frame["area"]
    stands_for = area.stands_for if isinstance(area.content, dict) else machine.poly(area)
    signed = machine.locals["el_plane_frame_make.area"].poly
    sign = machine.poly(frame["sign"])
    machine.path.prove(stands_for * sign - signed, "area * sign = doubled area", zero=True)


def make_divisor(machine: Machine, arguments: list[Any]) -> Any:
    cell = machine.allocate(machine.type_named("el_divisor"))
    cell.stands_for = arguments[0].poly
    machine.path.prove(arguments[0].poly - 1, "el_divisor_make: d >= 1")
    return cell


FRAME = Subject(
    FILE,
    "el_plane_frame_make",
    frame_domain,
    frame_check,
    ["el_abs_u64"],
    {"el_divisor_make": make_divisor},
    {"el_plane_frame_make.area": area_lemma},
)


class Quotients:
    """The contract of `divide`: value f / A, truncated, modulo 2^64; it remembers what was divided and the quotient."""

    def __init__(self, area: Poly) -> None:
        self.area = area
        self.made: list[tuple[Poly, Poly]] = []

    def divide(self, machine: Machine, arguments: list[Any]) -> Number:
        value = arguments[0].poly
        path = machine.path
        path.prove(2**63 - 1 + value, "not INT64_MIN")
        quotient = path.atom("Q", -(2**95), 2**95)
        self.made.append((value, quotient))
        return machine.exactly("uint64_t", quotient - path.atom("k", -(2**31), 2**31) * RING)


STATES: dict[int, tuple[list[Poly], list[Poly], list[Poly], Poly, Poly, Quotients]] = {}


def plane_domain(fraction: bool) -> Any:
    def domain(machine: Machine) -> list[Any]:
        path = machine.path
        x, y, area = corners(machine)
        bits = machine.constant(machine.unit.constants["EL_PLANE_FRACTION_BITS"]) if fraction else 0
        most = (1 << (31 + bits)) - 1
        values = [path.atom(f"v{i}", -most, most) for i in range(3)]
        row = path.atom("first_row", 0, SCREEN - 1)
        sampled = area.constant is not None
        if sampled:
            path.assume(area * area - 1)
            sign = 1 if area.known > 0 else -1
            frame = machine.struct("el_plane_frame")
            arrays = machine.array("int32_t", x), machine.array("int32_t", y)
            machine.call("el_plane_frame_make", Pointer([frame]), *arrays, machine.exactly("int32_t", row))
        else:
            sign = path.choose(path.atom("half", 0, 1)) * 2 - 1
            frame = machine.struct("el_plane_frame", x0=x[0], y0=y[0], row=row, sign=sign)
            for i in (1, 2):
                machine.put(frame.content[f"dx{i}"], x[i] - x[0])
                machine.put(frame.content[f"dy{i}"], y[i] - y[0])
        quotients = Quotients(area * sign)
        machine.contracts = {"divide": quotients.divide} if not sampled else {}
        STATES[id(path)] = (x, y, values, row, area * sign, quotients)
        plane = machine.struct("el_plane")
        array = machine.array("int64_t", values)
        return [Pointer([plane]), Pointer([frame]), array, machine.exactly("uint32_t", bits)]

    return domain


def gradient_lemma(machine: Machine, value: Number) -> Number:
    return as_unknown(machine, value)


def to_centre_lemma(machine: Machine, value: Number) -> Number:
    scale = machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // SCREEN
    return as_unknown(machine, value, -scale // 2 + 1, scale // 2)


def plane_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    path = machine.path
    x, y, values, first_row, area, quotients = STATES.pop(id(path))
    plane = arguments[0].cell.content
    bits = arguments[3].poly.known
    scale = machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // SCREEN
    f = 1 << (32 - bits)
    local = {name: machine.locals[f"el_plane_make.{name}"].poly for name in ("a", "b", "column", "row")}
    (for_x, qx), (for_y, qy), (for_offset, qo) = quotients.made
    a, b = local["a"], local["b"]
    to_x, to_y = (machine.locals[f"el_plane_make.to_centre_{axis}"].poly for axis in "xy")

    # What was divided is what the derivation says.
    path.prove(for_x - a * scale, "the dividend of dx", zero=True)
    path.prove(for_y - b * scale, "the dividend of dy", zero=True)
    path.prove(for_offset - a * to_x - b * to_y, "the offset's dividend", zero=True)
    path.prove(to_x - (local["column"] * scale + scale // 2 - x[0]), "to_centre_x", zero=True)
    path.prove(to_y - (local["row"] * scale + scale // 2 - y[0]), "to_centre_y", zero=True)

    # What is at pixel (i, j) is Z modulo 2^64.
    i, j = path.atom("i", 0, SCREEN - 1), path.atom("j", 0, SCREEN - 1)
    at_pixel = sum(
        (machine.poly(plane["dx"]) * i, machine.poly(plane["dy"]) * (j - first_row)), machine.poly(plane["row"])
    )
    columns, rows = i - local["column"], j - local["row"]
    z = values[0] * f + qo + qx * columns + qy * rows
    require(all(factor % RING == 0 for factor in (at_pixel - z).terms.values()), "the value is Z modulo 2^64")

    # Z A is the plane times A but for what the truncations cut off, in exact polynomials.
    exact_x, exact_y = columns * scale + to_x, rows * scale + to_y
    plane_at = (values[0] * area + a * exact_x + b * exact_y) * f
    cut_off = [quotient * area - dividend * f for dividend, quotient in ((for_offset, qo), (for_x, qx), (for_y, qy))]
    error = cut_off[0] + cut_off[1] * columns + cut_off[2] * rows
    require((z * area - plane_at - error).constant == 0, "Z A is the plane and what was cut off")
    # Each is below A: the error is below 1 + |columns| + |rows|, and the header says 2^-19.
    furthest = 1 + sum(max(-path.bounds(part)[0], path.bounds(part)[1]) for part in (columns, rows))
    require(furthest <= 1 + 2 * (2 * SCREEN) < 2 ** (32 - 19), "the error is below 2^-19")

    # The plane goes through the corners, and is their mean with the edge functions as weights.
    sign = machine.poly(arguments[1].cell, "sign").known
    d = [value - values[0] for value in values]
    a_exact = (d[1] * (y[2] - y[0]) - d[2] * (y[1] - y[0])) * sign
    b_exact = (d[2] * (x[1] - x[0]) - d[1] * (x[2] - x[0])) * sign
    path.prove(a - a_exact, "a", zero=True)
    path.prove(b - b_exact, "b", zero=True)
    px, py = path.atom("px", -(2**20), 2**20), path.atom("py", -(2**20), 2**20)
    weights = [((x[k] - px) * (y[m] - py) - (x[m] - px) * (y[k] - py)) * sign for k, m in ((1, 2), (2, 0), (0, 1))]
    mean = sum((weight * value for weight, value in zip(weights, values, strict=True)), Poly.of(0))
    value = values[0] * area + a_exact * (px - x[0]) + b_exact * (py - y[0])
    require((value - mean).constant == 0, "the plane is the mean of the corners")
    require((sum(weights, Poly.of(0)) - area).constant == 0, "its weights add up to 1")


# Their own proofs are elsewhere; samples execute them.
DIVISION = [
    "divide", "el_divide_q32", "el_divide_wide_q32", "magnitude_of", "el_abs_u64", "el_divide_words", "reciprocal_word"
]  # fmt: skip


def plane(fraction: bool) -> Subject:
    return Subject(
        FILE,
        "el_plane_make",
        plane_domain(fraction),
        plane_check,
        ["el_plane_make", *DIVISION],
        lemmas={
            "el_plane_make.a": gradient_lemma,
            "el_plane_make.b": gradient_lemma,
            "el_plane_make.to_centre_x": to_centre_lemma,
            "el_plane_make.to_centre_y": to_centre_lemma,
        },
    )


FRACTION = pytest.mark.parametrize("fraction", [False, True])


@EVERY_PRECISION
def test_the_area_of_every_triangle(bits: int) -> None:
    FRAME.prove(bits)


@EVERY_PRECISION
@FRACTION
def test_every_plane(bits: int, fraction: bool) -> None:
    plane(fraction).prove(bits)


def divide_domain(machine: Machine) -> list[Any]:
    path = machine.path
    bits = machine.constant(machine.unit.constants["EL_PLANE_FRACTION_BITS"])
    value = path.atom("value", -(2**63) + 1, 2**63 - 1)
    area = path.atom("area", 1, 2**32 - 1 if bits else 2**40)
    is_number = isinstance(machine.type_named("el_area"), IntType)
    pointer = machine.array("uint64_t", [area]) if is_number else Pointer([machine.struct("el_divisor")])
    count = path.choose(path.atom("with_fraction", 0, 1)) * bits
    return [machine.exactly("int64_t", value), machine.exactly("uint32_t", count), pointer]


def dividend_contract(machine: Machine, arguments: list[Any]) -> Number:
    """el_divide_q32 and el_divide_wide_q32: what matters here is what they are asked to divide."""
    value, bits = (machine.scopes[0][name].content.poly for name in ("value", "fraction_bits"))
    asked = arguments[0].poly * 2**32 + arguments[1].poly
    machine.path.prove(asked - value * (1 << (32 - bits.known)), "the dividend is value f", zero=True)
    return machine.number("int64_t", "quotient")


DIVIDE = Subject(
    FILE,
    "divide",
    divide_domain,
    contracts={"el_divide_q32": dividend_contract, "el_divide_wide_q32": dividend_contract},
)


@EVERY_PRECISION
def test_what_is_divided(bits: int) -> None:
    DIVIDE.prove(bits)


@EVERY_PRECISION
@FRACTION
def test_the_compiler_agrees(bits: int, fraction: bool) -> None:
    plane(fraction).agree(bits, count=100)


@EVERY_PRECISION
def test_the_proof_can_fail(bits: int) -> None:
    # A term too few, a wrong row, and a width too small.
    plane(False).fails_with(Fault(FILE, "a * to_centre_x + b * to_centre_y", "a * to_centre_x + b * to_centre_x"), bits)
    plane(False).fails_with(Fault(FILE, "(frame->row - row)", "(frame->row - row - 1)"), bits)
    plane(True).fails_with(Fault(FILE, "a * EL_SUBPIXELS", "a * 8 * EL_SUBPIXELS"), bits)
    DIVIDE.fails_with(Fault(FILE, "value >> fraction_bits", "value / (1 << fraction_bits) + 1"), bits)


def test_the_proof_finds_an_area_beyond_32_bits() -> None:
    """With 6 bits of fraction the area would not fit the divisor of 4 bits."""
    FRAME.fails_with(Fault("geometry/limits.h", "EL_GUARD_PX = 2040", "EL_GUARD_PX = 2060"), 4)
