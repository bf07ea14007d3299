"""raster/plane: depth, 1/w and coordinates over it, as planes in Q32 modulo 2^64, and colours in 8.24 modulo 2^32.

With A = |doubled area|, S = EL_SUBPIXELS, f = 2^(32 - fraction_bits), and X, Y from the first corner to a pixel's
centre, the plane through the corners' values is f (v0 A + a X + b Y) / A. What the C has at pixel (i, j) is,
modulo 2^64,

    Z = f v0 + Qo + Qx (i - column) + Qy (j - row)

where Qo, Qx, Qy are quotients by A, truncated: its value at the first pixel, dx to the side, and dy down. From
X = S (i - column) + to_centre_x, Z A differs from the plane by eo + ex (i - column) + ey (j - row), where an e is what
a truncation cut off, below A: Z is off by less than 1 + 4080 + 4080 units of 2^-32 on any pixel of the largest screen.

At a covered pixel the plane's value is a mean of the corners' with weights that are not negative, the edge functions
over A, so it lies between the corners' values, which fit 32 bits: that is why the modulus loses nothing.

Of small triangles, quotients are per sub-pixel, f a / A and f b / A, and Z = f v0 + Qx X + Qy Y: times A it differs
from the plane by ex X + ey Y. X and Y are means of the corners' at covered pixels, too, so at most EL_SMALL_SUB: Z is
off by less than 2046 units.

Of colours, 8.8, each of the three that the C has, the offset and those per pixel and row, is rounded to 2^-24. In these
units each is off by at most 1/2 and what truncation cut off, and the value by less than 8160 / 2 < 2^12.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import pytest

import contracts
from c_source import ARMV6M
from c_values import IntType
from proof import (
    EVERY_PRECISION,
    SMALL_CODE,
    Fault,
    Machine,
    Number,
    Pointer,
    Poly,
    Subject,
    as_unknown,
    congruent,
)
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
    return [Pointer([frame]), machine.array("int32_t", x), machine.array("int32_t", y)]


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
    """|area|, as a divisor or as a number, is the doubled area; a small frame has small differences."""
    frame = arguments[0].cell.content
    if machine.poly(frame["small"]).known:
        most = machine.constant(machine.unit.constants["EL_SMALL_SUB"])
        for name in ("dx1", "dy1", "dx2", "dy2"):
            machine.path.prove(most - machine.poly(frame[name]), f"{name} is small")
            machine.path.prove(most + machine.poly(frame[name]), f"{name} is small")
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
    """The contract of `divide` and el_divide_small_q32: value f / A, truncated, modulo 2^64; it remembers both."""

    def __init__(self, area: Poly) -> None:
        self.area = area
        self.made: list[tuple[Poly, Poly]] = []

    def divide(self, machine: Machine, arguments: list[Any]) -> Number:
        value = arguments[0].poly
        path = machine.path
        path.prove(2 ** (arguments[0].type.bits - 1) - 1 + value, "not the least of its type")
        quotient = path.atom("Q", -(2**95), 2**95)
        self.made.append((value, quotient))
        return machine.exactly("uint64_t", quotient - path.atom("k", -(2**31), 2**31) * RING)

    def digits(self, machine: Machine, arguments: list[Any]) -> Any:
        """The contract of el_divide_small: the same in three digits."""
        whole_bit, high_bit = (machine.constant(machine.unit.constants[f"EL_{name}_BIT"]) for name in ("WHOLE", "HIGH"))
        made = machine.struct("el_small_quotient")
        value, quotient = arguments[0].poly, Poly.of(0)
        for name, bit, most in (
            ("whole", whole_bit, 2**31 - 1),
            ("high", high_bit, 2**high_bit),
            ("low", 0, 2**high_bit),
        ):
            digit = machine.path.atom(name, -most, most)
            machine.put(made.content[name], digit)
            quotient += digit * 2**bit
        self.made.append((value, quotient))
        return made


@dataclass(frozen=True)
class State:
    """What a plane is made from."""

    x: list[Poly]
    y: list[Poly]
    values: list[Poly]
    first_x: Poly
    first_row: Poly
    area: Poly
    quotients: Quotients
    by_parts: bool  # quotients per sub-pixel


STATES: dict[int, State] = {}


def anchored(machine: Machine, arguments: list[Any]) -> Any:
    """anchor_of, executed; the way to its pixel's centre as two unknowns, half a pixel at most."""
    others = machine.contracts
    machine.contracts = {}
    cell = machine.call("anchor_of", *arguments)
    machine.contracts = others
    half = machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // SCREEN // 2
    ways = []
    for name in ("to_centre_x", "to_centre_y"):
        way = as_unknown(machine, cell.content[name].content, 1 - half, half)
        machine.put(cell.content[name], way)
        ways.append(way.poly)
    CENTRES[id(machine.path)] = ways
    return cell


CENTRES: dict[int, list[Poly]] = {}


def frame_of(
    machine: Machine, x: list[Poly], y: list[Poly], area: Poly, small: bool
) -> tuple[Any, tuple[Poly, Poly, Poly]]:
    """A frame at any first pixel."""
    path = machine.path
    first = path.atom("first_x", -2041, 2041), path.atom("first_row", 0, SCREEN - 1)
    if area.constant is not None:
        path.assume(area * area - 1)
        frame = machine.struct("el_plane_frame")
        machine.call("el_plane_frame_make", Pointer([frame]), machine.array("int32_t", x), machine.array("int32_t", y))
        sign = 1 if area.known > 0 else -1
    else:
        sign = path.choose(path.atom("half", 0, 1)) * 2 - 1
        frame = machine.struct("el_plane_frame", x0=x[0], y0=y[0], sign=sign, small=int(small))
        for i in (1, 2):
            machine.put(frame.content[f"dx{i}"], x[i] - x[0])
            machine.put(frame.content[f"dy{i}"], y[i] - y[0])
    for name, value in zip(("x", "row"), first, strict=True):
        machine.put(frame.content[name], value)
    return frame, (*first, area * sign)


def prepared(machine: Machine, values: list[Poly], corner: Any, small: bool) -> Any:
    """The frame; what was made from it is kept for the check."""
    x, y, area = corner
    frame, numbers = frame_of(machine, x, y, area, small)
    quotients = Quotients(numbers[2])
    exact = {
        "anchor_of": anchored,
        "divide": quotients.divide,
        "el_plane_times": contracts.plane_times,
        "el_multiply_u64": contracts.multiply_u64,
    }
    machine.contracts = {} if area.constant is not None else exact
    STATES[id(machine.path)] = State(x, y, values, *numbers, quotients, small)
    return frame


def plane_domain(fraction: bool) -> Any:
    def domain(machine: Machine) -> list[Any]:
        bits = machine.constant(machine.unit.constants["EL_PLANE_FRACTION_BITS"]) if fraction else 0
        most = (1 << (31 + bits)) - 1
        values = [machine.path.atom(f"v{i}", -most, most) for i in range(3)]
        frame = prepared(machine, values, corners(machine), small=False)
        plane = machine.struct("el_plane")
        array = machine.array("int64_t", values)
        return [Pointer([plane]), Pointer([frame]), array, machine.exactly("uint32_t", bits)]

    return domain


def small_corners(machine: Machine) -> Any:
    """A small triangle: only differences count, and where the first corner is in its pixel."""
    path = machine.path
    x, y, _ = corners(machine)
    most = machine.constant(machine.unit.constants["EL_SMALL_SUB"])
    differences = [path.atom(name, -most, most) for name in ("dx1", "dx2", "dy1", "dy2")]
    x = [x[0], x[0] + differences[0], x[0] + differences[1]]
    y = [y[0], y[0] + differences[2], y[0] + differences[3]]
    return x, y, (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])


def short_domain(struct: str, most: int, small: bool) -> Any:
    """Depth and colours, of small triangles and of others."""

    def domain(machine: Machine) -> list[Any]:
        values = [machine.path.atom(f"v{i}", 0, most) for i in range(3)]
        frame = prepared(machine, values, small_corners(machine) if small else corners(machine), small)
        return [Pointer([machine.struct(struct)]), Pointer([frame]), machine.array("uint16_t", values)]

    return domain


def gradient_lemma(machine: Machine, value: Number) -> Number:
    return as_unknown(machine, value)


@dataclass(frozen=True)
class Sum:
    """Z = first + offset + dx columns + dy rows, of a pixel that lies so far from the first corner's."""

    offset: Poly
    dx: Poly
    dy: Poly
    columns: Poly
    rows: Poly


def check_quotients(machine: Machine, frame: Any, f: int) -> Sum:
    """What was divided is what the derivation says, and what is made from the quotients is off by no more than it says.

    Z A is the plane times A but for what the truncations cut off, in exact polynomials.
    """
    path = machine.path
    state = STATES[id(path)]
    x, y, values, area = state.x, state.y, state.values, state.area
    scale = machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // SCREEN
    (for_x, qx), (for_y, qy), *others = state.quotients.made
    column, row = path.floor(x[0], scale), path.floor(y[0], scale)
    to_x, to_y = CENTRES.pop(id(path))
    path.prove(to_x - (column * scale + scale // 2 - x[0]), "to_centre_x", zero=True)
    path.prove(to_y - (row * scale + scale // 2 - y[0]), "to_centre_y", zero=True)
    sign = machine.poly(frame, "sign").known
    d = [value - values[0] for value in values]
    a = (d[1] * (y[2] - y[0]) - d[2] * (y[1] - y[0])) * sign
    b = (d[2] * (x[1] - x[0]) - d[1] * (x[2] - x[0])) * sign
    a_unknown, b_unknown = (
        next(number.poly for name, number in machine.locals.items() if name.endswith(f"_gradient.{axis}"))
        for axis in "ab"
    )
    path.prove(a_unknown - a, "a", zero=True)
    path.prove(b_unknown - b, "b", zero=True)
    per_pixel = 1 if state.by_parts else scale
    path.prove(for_x - a_unknown * per_pixel, "the dividend of dx", zero=True)
    path.prove(for_y - b_unknown * per_pixel, "the dividend of dy", zero=True)

    columns, rows = path.atom("i", 0, SCREEN - 1) - column, path.atom("j", 0, SCREEN - 1) - row
    aside, down = columns * scale + to_x, rows * scale + to_y
    plane_at = (values[0] * area + a_unknown * aside + b_unknown * down) * f
    cut_off_x, cut_off_y = qx * area - for_x * f, qy * area - for_y * f
    # Each is below A.
    if state.by_parts:
        made = Sum(qx * to_x + qy * to_y, qx * scale, qy * scale, columns, rows)
        error = cut_off_x * aside + cut_off_y * down
        furthest = 2 * machine.constant(machine.unit.constants["EL_SMALL_SUB"])
    else:
        ((for_offset, qo),) = others
        require((for_offset - a_unknown * to_x - b_unknown * to_y).constant == 0, "the offset's dividend")
        made = Sum(qo, qx, qy, columns, rows)
        error = qo * area - for_offset * f + cut_off_x * columns + cut_off_y * rows
        furthest = 1 + sum(max(-path.bounds(part)[0], path.bounds(part)[1]) for part in (columns, rows))
        require(furthest <= MOST_PIXELS, "the furthest pixel")
    z = values[0] * f + made.offset + made.dx * columns + made.dy * rows
    require((z * area - plane_at - error).constant == 0, "Z A is the plane and what was cut off")
    require(furthest < contracts.PLANE_ERROR < 2 ** (32 - 19), "the error is below 2^-19")

    # The plane goes through the corners, and is their mean with the edge functions as weights.
    px, py = path.atom("px", -(2**20), 2**20), path.atom("py", -(2**20), 2**20)
    weights = [((x[k] - px) * (y[m] - py) - (x[m] - px) * (y[k] - py)) * sign for k, m in ((1, 2), (2, 0), (0, 1))]
    require((sum(weights, Poly.of(0)) - area).constant == 0, "its weights add up to 1")
    value = values[0] * area + a * (px - x[0]) + b * (py - y[0])
    for at, of in ((value, values), (px * area, x), (py * area, y)):
        mean = sum((weight * corner for weight, corner in zip(weights, of, strict=True)), Poly.of(0))
        require((at - mean).constant == 0, "values, and places, are means of the corners'")
    return made


# 1 + columns + rows from the first corner's pixel to any of the screen.
MOST_PIXELS = 1 + 2 * (2 * SCREEN - 1)


def at_pixel(machine: Machine, plane: Any, made: Sum) -> Poly:
    """What the C has at that pixel."""
    path, state = machine.path, STATES[id(machine.path)]
    scale = machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // SCREEN
    column, row = path.floor(state.x[0], scale), path.floor(state.y[0], scale)
    dx, dy = machine.poly(plane["dx"]), machine.poly(plane["dy"])
    aside = dx * (made.columns + column - state.first_x)
    return machine.poly(plane["value"]) + aside + dy * (made.rows + row - state.first_row)


def plane_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """What is at pixel (i, j) is Z modulo 2^64."""
    plane, frame = arguments[0].cell.content, arguments[1].cell
    f = 1 << (32 - (arguments[3].poly.known if len(arguments) > 3 else 0))
    made = check_quotients(machine, frame, f)
    value = at_pixel(machine, plane, made)
    first = STATES.pop(id(machine.path)).values[0]
    z = first * f + made.offset + made.dx * made.columns + made.dy * made.rows
    congruent(value, z, RING, "the value is Z modulo 2^64")


def channel_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """The three numbers are Z's, each rounded to 2^-24, and the value has its half."""
    path = machine.path
    channel, frame = arguments[0].cell.content, arguments[1].cell
    made = check_quotients(machine, frame, WORD)
    value = at_pixel(machine, channel, made)
    state = STATES.pop(id(path))
    exact = (made.offset, made.dx, made.dy)
    rounded = [path.floor(part + 2**15, 2**16) for part in exact]
    for part, whole in zip(exact, rounded, strict=True):
        path.prove(whole * 2**16 - part + 2**15, "rounded down by 1/2 at most")
        path.prove(part + 2**15 - whole * 2**16, "rounded up by 1/2 at most")
    offset, dx, dy = rounded
    z = state.values[0] * 2**16 + HALF_Q24 + offset + dx * made.columns + dy * made.rows
    congruent(value, z, WORD, "the value is Z, rounded, modulo 2^32")
    # In units of 2^-24: 1/2 for each column and row and the offset, and what truncation cuts off, of each or in all.
    small = machine.constant(machine.unit.constants["EL_SMALL_SUB"])
    scale = machine.constant(machine.unit.constants["EL_GUARD_SUB"]) // SCREEN
    pixels = 1 + 2 * (small // scale + 1) if state.by_parts else MOST_PIXELS
    cut_off = 2 * small if state.by_parts else MOST_PIXELS
    require(pixels * 2**15 + cut_off < CHANNEL_ERROR * 2**16, "the error is below 2^-25 * 8160")


WORD = 1 << 32
HALF_Q24 = 1 << 23  # EL_CHANNEL_HALF
CHANNEL_ERROR = 4080


# Their own proofs are elsewhere; samples execute them.
DIVISION = [
    "divide", "el_divide_q32", "el_divide_wide_q32", "magnitude_of", "el_abs_u64",
    "el_divide_words", "el_reciprocal_word", "room_within_small", "el_plane_times", "el_multiply_u64",
]  # fmt: skip


# The sum of two parts is meant modulo 2^64.
GRADIENTS = ["wide_gradient"]
LEMMAS = {f"wide_gradient.{name}": gradient_lemma for name in "ab"}


def plane(fraction: bool) -> Subject:
    return Subject(
        FILE, "el_plane_make", plane_domain(fraction), plane_check, ["start_plane", *DIVISION], lemmas=LEMMAS
    )


# Of which each kind of code has its own way.
CODES = pytest.mark.parametrize("core", ["", SMALL_CODE], ids=["fast", "small"])


def depth(small: bool, core: str = "") -> Subject:
    domain = short_domain("el_plane", 65535, small)
    modular = ["start_plane", *GRADIENTS, *DIVISION]
    return Subject(FILE, "el_plane_make_u16", domain, plane_check, modular, lemmas=LEMMAS, core=core)


def colour(small: bool, core: str = "") -> Subject:
    domain = short_domain("el_channel", 255 * 256, small)
    modular = ["el_channel_make", "el_q32_to_q24", *GRADIENTS, *DIVISION]
    return Subject(FILE, "el_channel_make", domain, channel_check, modular, lemmas=LEMMAS, core=core)


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
@CODES
@pytest.mark.parametrize("make", [depth, colour])
def test_every_depth_and_colour(bits: int, make: Any, core: str) -> None:
    make(small=False, core=core).prove(bits)


@CODES
@pytest.mark.parametrize("make", [depth, colour])
def test_every_depth_and_colour_by_parts(make: Any, core: str) -> None:
    make(small=True, core=core).prove()


@EVERY_PRECISION
@FRACTION
def test_the_compiler_agrees(bits: int, fraction: bool) -> None:
    plane(fraction).agree(bits, count=100)


@EVERY_PRECISION
@CODES
@pytest.mark.parametrize("make", [depth, colour])
def test_the_compiler_agrees_on_depth_and_colour(bits: int, make: Any, core: str) -> None:
    make(small=False, core=core).agree(bits, count=50)


@CODES
@pytest.mark.parametrize("make", [depth, colour])
def test_the_compiler_agrees_on_small_triangles(make: Any, core: str) -> None:
    make(small=True, core=core).agree(count=50)


@EVERY_PRECISION
def test_the_proof_can_fail(bits: int) -> None:
    # A wrong row, a width too small, and a column too many.
    plane(False).fails_with(Fault(FILE, ".rows = frame->row - row,", ".rows = frame->row - row - 1,"), bits)
    plane(True).fails_with(Fault(FILE, "int64_t a = (d1 * frame->dy2", "int64_t a = 8 * (d1 * frame->dy2"), bits)
    plane(False).fails_with(Fault(FILE, "(g->dx, at->columns)", "(g->dx, at->columns + 1)"), bits)
    colour(False).fails_with(Fault("raster/plane.h", "(value + 0x8000U) >> 16", "(value + 0x7FFFU) >> 16"), bits)
    DIVIDE.fails_with(Fault(FILE, "value >> fraction_bits", "value / (1 << fraction_bits) + 1"), bits)


def test_the_proof_of_small_triangles_can_fail() -> None:
    """Four times the size would be off by too much; a term too few is found as in the wide way."""
    depth(True).fails_with(Fault("raster/plane.h", "4 ? 1023 : -1", "4 ? 4096 : -1"))
    FRAME.fails_with(Fault(FILE, "(EL_SMALL_SUB + difference)", "(EL_SMALL_SUB + 1 + difference)"))
    text = "+ el_multiply_u64(g->dy, at->to_centre_y)"
    depth(True).fails_with(Fault(FILE, text, text.replace("centre_y", "centre_x")))
    depth(True, SMALL_CODE).fails_with(Fault(FILE, "by_parts ? 1 : EL_SUBPIXELS", "EL_SUBPIXELS"))
    colour(True).fails_with(Fault(FILE, "g->dy <<= EL_SUBPIXEL_BITS", "g->dy <<= 5"))


# --- the short way of small triangles: Z as by parts ------------------------------------------------------------------

SMALL_FILE = "raster/triangle.c"


def small_frame(machine: Machine, values: list[Poly]) -> Pointer:
    """A small shape anywhere in the guard band, from one of its rows on."""
    path = machine.path
    guard, short, narrow = (
        machine.constant(machine.unit.constants[name]) for name in ("EL_GUARD_SUB", "EL_EDGE_SHORT", "EL_EDGE_NARROW")
    )
    dy2 = path.atom("dy2", 1, short)
    dx1, dx2 = (path.atom(name, -narrow, narrow) for name in ("dx1", "dx2"))
    dy1 = path.atom("dy1", 0, short)
    path.assume(dy2 - dy1)
    x0, y0, row = path.atom("x0", -guard, guard), path.atom("y0", -guard, guard), path.atom("row", -SCREEN, SCREEN)
    below = row * 16 + 8 - y0
    path.assume(below)
    path.assume(dy2 - 1 - below)
    shape = machine.struct("el_small_shape", dx1=dx1, dy1=dy1, dx2=dx2, dy2=dy2)
    frame = machine.struct("el_small_frame", x0=x0, y0=y0, row=row)
    machine.put(frame.content["shape"], shape)
    area = dx1 * dy2 - dx2 * dy1
    if area.constant is not None:
        path.assume(area * area - 1)
        machine.put(frame.content["area"], machine.call("el_small_divisor_make", machine.exactly("int32_t", area)))
        return Pointer([frame])
    quotients = Quotients(area)
    machine.contracts = {
        "el_divide_small_q32": quotients.divide,
        "el_divide_small": quotients.digits,
        "el_multiply_u64": contracts.multiply_u64,
        "el_multiply_u16": contracts.multiply_u16,
    }
    d = [value - values[0] for value in values]
    SMALL[id(path)] = Small(quotients, (d[1] * dy2 - d[2] * dy1, d[2] * dx1 - d[1] * dx2), (x0, y0, row), values[0])
    return Pointer([frame])


@dataclass(frozen=True)
class Small:
    quotients: Quotients
    dividends: tuple[Poly, Poly]
    start: tuple[Poly, Poly, Poly]  # the top corner, and the first row
    first: Poly  # the value there


SMALL: dict[int, Small] = {}


def small_domain(struct: str, most: int) -> Any:
    def domain(machine: Machine) -> list[Any]:
        values = [machine.path.atom(f"v{i}", 0, most) for i in range(3)]
        frame = small_frame(machine, values)
        numbers = [machine.exactly("int32_t", value) for value in values]
        return [Pointer([machine.struct(struct)]), frame, *numbers]

    return domain


def small_parts(machine: Machine, small: Small) -> tuple[list[Poly], list[Poly], list[Poly]]:
    """The two quotients, the first corner's pixel, and the way from there to its centre."""
    for (asked, _), dividend in zip(small.quotients.made, small.dividends, strict=True):
        machine.path.prove(asked - dividend, "the dividend, of the sign that it has by the area", zero=True)
    pixel = [machine.path.floor(at, 16) for at in small.start[:2]]
    to_centre = [at * 16 + 8 - corner for at, corner in zip(pixel, small.start[:2], strict=True)]
    return [quotient for _, quotient in small.quotients.made], pixel, to_centre


def small_plane_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    small = SMALL.pop(id(machine.path))
    (qx, qy), _, _ = small_parts(machine, small)
    plane = arguments[0].cell.content
    x0, y0, row = small.start
    i, j = machine.path.atom("i", 0, SCREEN - 1), machine.path.atom("j", 0, SCREEN - 1)
    dx, dy = machine.poly(plane["dx"]), machine.poly(plane["dy"])
    z = small.first * WORD + qx * (i * 16 + 8 - x0) + qy * (j * 16 + 8 - y0)
    congruent(machine.poly(plane["value"]) + dx * i + dy * (j - row), z, RING, "the value is Z modulo 2^64")


def small_channel_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    small = SMALL.pop(id(machine.path))
    (qx, qy), (column, first_row), (to_x, to_y) = small_parts(machine, small)
    channel = arguments[0].cell.content
    i, j = machine.path.atom("i", 0, SCREEN - 1), machine.path.atom("j", 0, SCREEN - 1)
    # The lemma's unknowns, for the products with them.
    ways = [machine.locals[f"el_small_channel_make_from.to_centre_{axis}"].poly for axis in "xy"]
    machine.path.prove(ways[0] - to_x, "the way to its centre", zero=True)
    machine.path.prove(ways[1] - to_y, "the way to its centre", zero=True)
    to_x, to_y = ways
    offset, across, down = (
        machine.path.floor(part + 2**15, 2**16) for part in (qx * to_x + qy * to_y, qx * 16, qy * 16)
    )
    dx, dy = machine.poly(channel["dx"]), machine.poly(channel["dy"])
    got = machine.poly(channel["value"]) + dx * i + dy * (j - small.start[2])
    z = small.first * 2**16 + HALF_Q24 + offset + across * (i - column) + down * (j - first_row)
    congruent(got, z, WORD, "the value is Z, rounded, modulo 2^32")


def to_centre_lemma(machine: Machine, value: Number) -> Number:
    """As one unknown, half a pixel at most."""
    return as_unknown(machine, value, -7, 8)


# Differences of small numbers are signed, and fit; sums of products are meant modulo 2^64.
SMALL_MODULAR = [
    "el_small_plane_make",
    "el_small_channel_make",
    "el_small_channel_make_from",
    "el_quotient_per_pixel",
    "el_quotients_times",
    "el_divide_small_q32",
    "el_divide_small",
    "el_multiply_u64",
    "el_multiply_u16",
]
SMALL_DEPTH = Subject(
    SMALL_FILE, "el_small_plane_make", small_domain("el_plane", 65535), small_plane_check, SMALL_MODULAR
)
SMALL_COLOUR = Subject(
    SMALL_FILE,
    "el_small_channel_make",
    small_domain("el_channel", 255 * 256),
    small_channel_check,
    SMALL_MODULAR,
    lemmas={f"el_small_channel_make_from.to_centre_{axis}": to_centre_lemma for axis in "xy"},
)
SHORT_WAYS = pytest.mark.parametrize("subject", [SMALL_DEPTH, SMALL_COLOUR], ids=["depth", "colour"])
# In the digits of a core without a divider.
COLOUR_BY_TABLE = replace(SMALL_COLOUR, core=ARMV6M)


def shape_domain(machine: Machine) -> list[Any]:
    most = 2 * machine.constant(machine.unit.constants["EL_GUARD_SUB"])
    path = machine.path
    dx1, dx2 = (path.atom(name, -most, most) for name in ("dx1", "dx2"))
    dy1, dy2 = path.atom("dy1", 0, most), path.atom("dy2", 1, most)
    path.assume(dy2 - dy1)
    return [Pointer([machine.struct("el_small_shape", dx1=dx1, dy1=dy1, dx2=dx2, dy2=dy2)])]


def shape_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """What is small has short edges, and an area that is at most their box: with v = (1 - dy1 / dy2), ..., a mean."""
    if result.poly.known == 0:
        return
    path = machine.path
    dx1, dy1, dx2, dy2 = (machine.poly(arguments[0].cell, name) for name in ("dx1", "dy1", "dx2", "dy2"))
    narrow, short, bits = (
        machine.constant(machine.unit.constants[name])
        for name in ("EL_EDGE_NARROW", "EL_EDGE_SHORT", "EL_SMALL_DIVISOR_BITS")
    )
    for dx in (dx1, dx2, dx2 - dx1):
        path.prove(narrow - dx, "narrow")
        path.prove(narrow + dx, "narrow")
    path.prove(short - dy2, "short")
    # The area is dx1 (dy2 - dy1) + (dx1 - dx2) dy1: a mean of widths, times dy2.
    for sign in (1, -1):
        path.assume_product(narrow - dx1 * sign, dy2 - dy1)
        path.assume_product(narrow - (dx1 - dx2) * sign, dy1)
        path.prove(2**bits - 1 - (dx1 * dy2 - dx2 * dy1) * sign, "the area is a small divisor")


SHAPE = Subject(SMALL_FILE, "el_shape_is_small", shape_domain, shape_check, ["el_shape_is_small"])


@SHORT_WAYS
def test_every_small_plane(subject: Subject) -> None:
    subject.prove()


def test_every_small_channel_without_a_divider() -> None:
    COLOUR_BY_TABLE.prove()


@SHORT_WAYS
def test_the_compiler_agrees_on_small_planes(subject: Subject) -> None:
    subject.agree(count=100)


def test_what_is_small() -> None:
    SHAPE.prove()
    SHAPE.agree()


def test_the_proof_of_small_planes_can_fail() -> None:
    header = "raster/small_plane.h"
    SMALL_DEPTH.fails_with(Fault(header, "- EL_SUBPIXELS / 2);\n}", "+ EL_SUBPIXELS / 2);\n}"))
    SMALL_DEPTH.fails_with(Fault(header, "d1 * frame->shape.dy2 -", "d1 * frame->shape.dy1 -"))
    SMALL_COLOUR.fails_with(Fault(header, "(frame->row - row)", "frame->row"))
    SMALL_COLOUR.fails_with(Fault(header, "(low + 0x8000)", "(low + 0x7FFF)"))
    COLOUR_BY_TABLE.fails_with(Fault(header, "(1 << (drop - 1))", "(1 << drop)"))
    SHAPE.fails_with(Fault(header, "shape->dy2 <= EL_EDGE_SHORT", "shape->dy2 <= 2 * EL_EDGE_SHORT"))


def test_the_proof_finds_an_area_beyond_32_bits() -> None:
    """With 6 bits of fraction the area would not fit the divisor of 4 bits."""
    FRAME.fails_with(Fault("geometry/limits.h", "EL_GUARD_PX = 2040", "EL_GUARD_PX = 2060"), 4)
