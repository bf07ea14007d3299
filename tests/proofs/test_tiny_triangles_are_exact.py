"""raster/tiny.h: depth in 32 bits is the rounded depth, and edges in Q18 are exact.

Of a triangle with the doubled area A in a box of W x H sub-pixels, X and Y the way from its top corner to the centre
of pixel (i, j), depth is z0 + (a X + b Y) / A. Gradients are whole numbers G with |G A - 2^24 a| < A: 2^-24 per
sub-pixel, 2^-20 per pixel. What the C has at the pixel is, modulo 2^32,

    V = 2^20 (2048 + 1/2) + K + floor((Gx X + Gy Y) / 16),      K = floor((W + H) / 16) + 2,

and it is beyond 2^20 (depth - base + 1/2), with base = z0 - 2048, by some excess with 0 < 16 A excess < 2^23. Depth
and 1/2 is a multiple of 1 / 2A, which is 2^23 / 16 A in these units: V 2^-20 and depth - base + 1/2 have one whole
part. A plane with quotients per sub-pixel, truncated at 2^-32, is off by W + H units at most, with 2^13 added: beyond
as well, and by less than 1 / 2A. So both have the same whole part at every covered pixel.

Edges are as short ones (test_edges_are_exact), with 2^18 for 2^20 and 24 units less added first:

    D = e t + f dy + 23 g,      -17 dy <= 16 e <= 17 dy, 0 <= f <= 15.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest

import contracts
from c_source import ARMV6M
from proof import Fault, Machine, Number, Pointer, Poly, Subject, congruent
from test_division_is_exact import digit, small_divisor
from test_edges_are_exact import Ends, assume_cut_off, check_whole_part, expect_forward

FILE = "raster/tiny_triangle.c"
HEADER = "raster/tiny.h"
WORD = 1 << 32
SCREEN = 2040
CORES = pytest.mark.parametrize("core", ["", ARMV6M], ids=["divider", "digits"])


# --- a gradient -------------------------------------------------------------------------------------------------------


def gradient_domain(machine: Machine) -> list[Any]:
    path = machine.path
    dividend = machine.number("int32_t", "dividend", 1 - 2**22, 2**22 - 1)
    divisor = small_divisor(machine)
    magnitude = divisor.cell.stands_for
    assert magnitude is not None
    path.assume(2**14 - 1 - magnitude)
    if "el_divide_digit" in machine.unit.functions:
        # el_tiny_is_steep
        path.decide(dividend.poly, -dividend.poly - 1)
        for sign in (1, -1):
            path.assume(magnitude * 256 - 1 - dividend.poly * sign)
    return [dividend, divisor]


def gradient_check(machine: Machine, arguments: list[Any], result: Any) -> None:
    """|G A - 2^24 a| < A, with the rest of a's sign."""
    path = machine.path
    a, divisor = arguments[0].poly, arguments[1].cell
    upper, lower = (machine.poly(result, name) for name in ("upper", "lower"))
    rest = a * 2**24 - (upper * 2**16 + lower) * machine.poly(divisor, "d")
    magnitude = divisor.stands_for
    scale = 1
    if "el_divide_digit" in machine.unit.functions:
        scale = 1 << path.choose(machine.poly(divisor, "shift"))
    for sign in (1, -1):
        path.prove((magnitude - rest * sign) * scale - 1, "cut off is less than A")
        path.prove(2**16 - 1 - lower * sign, "the lower part has 16 bits")


def gradient(core: str) -> Subject:
    own = ["el_tiny_gradient_make"]
    if core:
        return Subject(FILE, own[0], gradient_domain, gradient_check, own, {"el_divide_digit": digit}, core=core)
    return Subject(FILE, own[0], gradient_domain, gradient_check)


# --- the plane --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Shape:
    """What a plane is made from, and the gradients that it asked for: each one's dividend, and G."""

    x0: Poly
    y0: Poly
    row: Poly
    z0: Poly
    width: Poly
    height: Poly
    corners: list[tuple[Poly, Poly, Poly]]  # the others: the way there, and how much deeper they are
    area: Poly
    gradients: list[tuple[Poly, Poly]]


SHAPES: dict[int, Shape] = {}


def within_box(path: Any, depths: Any, across: Any, down: Any, width: Poly) -> None:
    """Depths that were not refused, times sides of the box."""
    for d, other in zip(depths, reversed(range(2)), strict=True):
        for sign in (1, -1):
            path.prove(2048 - d * sign, "a depth that fits")
            path.assume_product(2048 - d * sign, down[other])
            path.assume_product(2048 - d * sign, width + across[other] * sign)
            path.assume_product(2048 - d * sign, width - across[other] * sign)


def plane_domain(machine: Machine) -> list[Any]:
    path = machine.path
    constants = machine.unit.constants
    high, long, screen = (
        machine.constant(constants[name]) for name in ("EL_TINY_HIGH", "EL_TINY_LONG", "EL_TINY_SCREEN")
    )
    dx1, dx2 = (path.atom(name, -long, long) for name in ("dx1", "dx2"))
    dy1, dy2 = path.atom("dy1", 0, high), path.atom("dy2", 1, high)
    width = path.atom("W", 0, long)
    for bound in (dy2 - dy1, long - width - dy2, width - dx1, width + dx1, width - dx2, width + dx2):
        path.assume(bound)
    x0, row, down = path.atom("x0", 0, screen * 16), path.atom("row", 0, SCREEN - 1), path.atom("down", 0, high - 1)
    y0 = row * 16 + 8 - down
    path.assume(dy2 - 1 - down)
    path.assume(y0)
    z0, d1, d2 = path.atom("z0", 0, 65535), path.atom("d1", -65535, 65535), path.atom("d2", -65535, 65535)
    area = dx1 * dy2 - dx2 * dy1
    shape = machine.struct("el_tiny_shape", dx1=dx1, dy1=dy1, dx2=dx2, dy2=dy2, area=area, width_height=width + dy2)
    gradients: list[tuple[Poly, Poly]] = []
    if area.constant is not None:
        path.assume(area * area - 1)
        path.assume(2**14 - 1 - area)
        path.assume(2**14 - 1 + area)
    else:

        def make(machine: Machine, arguments: list[Any]) -> Any:
            dividend = arguments[0].poly
            within_box(machine.path, (d1, d2), (dx1, dx2), (dy1, dy2), width)
            for sign in (1, -1):
                machine.path.prove(2**22 - 1 - dividend * sign, "el_tiny_gradient_make: a dividend of 22 bits")
            upper = machine.path.atom("upper", -(2**31) + 1, 2**31 - 1)
            lower = machine.path.atom("lower", -(2**16) + 1, 2**16 - 1)
            gradients.append((dividend, upper * 2**16 + lower))
            return machine.struct("el_tiny_gradient", upper=upper, lower=lower)

        machine.contracts = {
            "el_tiny_gradient_make": make,
            "el_small_divisor_make": lambda machine, arguments: machine.struct("el_small_divisor", d=arguments[0].poly),
        }
    corners = [(dx1, dy1, d1), (dx2, dy2, d2)]
    SHAPES[id(path)] = Shape(x0, y0, row, z0, width, dy2, corners, area, gradients)
    numbers = [machine.exactly("int32_t", number) for number in (x0, y0, row, z0, d1, d2)]
    return [Pointer([machine.struct("el_tiny_plane")]), Pointer([shape]), *numbers]


def plane_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """V, and that it is beyond by as much as it may be."""
    path = machine.path
    shape = SHAPES.pop(id(path))
    if result.poly.known == 0:
        return
    plane = arguments[0].cell
    i, j = path.atom("i", 0, SCREEN - 1), path.atom("j", 0, SCREEN - 1)
    (a, gx), (b, gy) = shape.gradients
    for x, y, deeper in shape.corners:
        path.prove(a * x + b * y - deeper * shape.area, "the plane through the corners", zero=True)
    value, dx, dy, base = (machine.poly(plane, name) for name in ("value", "dx", "dy", "base"))
    path.prove(base - shape.z0 + 2048, "the base", zero=True)
    size = path.floor(shape.width + shape.height, 16) + 2
    cut = gx * (8 - shape.x0) + gy * (shape.row * 16 + 8 - shape.y0)
    whole = 2**31 + 2**19 + size + path.floor(cut, 16) + gx * i + gy * (j - shape.row)
    congruent(value + dx * i + dy * (j - shape.row), whole, WORD, "the value is V modulo 2^32")

    # Within the box, with a quotient's error e: 16 A excess = 16 A K + ex X + ey Y - cut off A.
    area = path.atom("A", 1, 2**17)
    most = machine.constant(machine.unit.constants["EL_TINY_MOST"])
    width, height = shape.width, shape.height
    path.assume(most - 1 - (width + height + 32) * area)
    lost, way_x, way_y = path.atom("lost", 0, 15), path.atom("X", -511, 511), path.atom("Y", 0, 511)
    error_x, error_y = path.atom("ex", -(2**17), 2**17), path.atom("ey", -(2**17), 2**17)
    for way, side in ((way_x, width), (way_y, height)):
        path.assume(side - way)
        path.assume(side + way)
    for way, side, error in ((way_x, width, error_x), (way_y, height, error_y)):
        path.assume(area - 1 - error)
        path.assume(area - 1 + error)
        for sign in (1, -1):
            path.assume_product(area - 1 - error * sign, side + way * sign)
            path.assume_product(area - 1 - error * sign, side - way * sign)
    bits = size * 16 - width - height
    path.assume_product(bits - 17, area)
    path.assume_product(32 - bits, area)
    path.assume_product(15 - lost, area)
    path.assume_product(lost, area)
    path.assume_product(area, width + height)
    excess = area * size * 16 + error_x * way_x + error_y * way_y - lost * area
    path.prove(excess - 1, "it is beyond")
    path.prove(2**23 - 1 - excess, "by less than 1 / 2A")
    # The other planes' excess, in units of 2^-32: 2^13, and W + H at most to either side.
    path.assume_product(511 - width - height, area)
    path.prove(2**31 - 1 - (2**13 + width + height) * area, "the others are beyond by less than 1 / 2A")
    path.prove(2**13 - 1 - width - height, "and not below")


PLANE = Subject(
    FILE,
    "el_tiny_plane_make",
    plane_domain,
    plane_check,
    ["el_tiny_plane_make", "el_tiny_per_pixel"],
)


# --- edges ------------------------------------------------------------------------------------------------------------

Q18 = 1 << 18
ENDS: dict[int, Ends] = {}


def edge_domain(machine: Machine) -> list[Any]:
    ends = Ends(machine)
    path = machine.path
    high, long = (machine.constant(machine.unit.constants[name]) for name in ("EL_TINY_HIGH", "EL_TINY_LONG"))
    screen = machine.constant(machine.unit.constants["EL_TINY_SCREEN"]) * 16
    for bound in (high - ends.dy, long - ends.dx, long + ends.dx, ends.x0, ends.x1, screen - ends.x0, screen - ends.x1):
        path.assume(bound)
    ENDS[id(path)] = ends
    return [machine.exactly("int32_t", n) for n in (ends.x0, ends.y0, ends.x1, ends.y1, ends.row)]


def step_lemma(machine: Machine, value: Number) -> Number:
    """-17 dy <= 16 e <= 17 dy, e = 2^18 dx - step dy."""
    path, step = machine.path, value.poly
    if step.constant is not None:
        return value
    ends = ENDS[id(path)]
    dx, dy = ends.dx, ends.dy
    right = path.holds(dx)
    magnitude = dx if right else -dx
    long = machine.constant(machine.unit.constants["EL_TINY_LONG"])
    path.assume_product(long - magnitude, dy)
    if "el_edge_make_q18.reciprocal" in machine.locals:
        reciprocal = machine.locals["el_edge_make_q18.reciprocal"].poly
        cut_off = dx * reciprocal - 2**13 * step
        path.prove(cut_off, "cut off downwards")
        path.prove(2**13 - 1 - cut_off, "by less than a unit")
        assume_cut_off(path, ends, reciprocal, cut_off, 2**13)
    e = dx * Q18 - step * dy
    for bound in (16 * e + 17 * dy, 17 * dy - 16 * e):
        path.prove(bound, "-17 dy <= 16 e <= 17 dy")
        path.assume(bound)
        path.assume_product(bound, ends.t)
    if "el_edge_make_q18.reciprocal" in machine.locals:
        path.prove(reciprocal - 1, "a reciprocal is not 0")
        path.assume_product(magnitude if right else magnitude - 1, reciprocal)
    expect_forward(path, ends, step if right else -step, 0)
    path.assume_product(255 - dy, dy)
    return value


def aside_lemma(machine: Machine, value: Number) -> Number:
    path, aside = machine.path, value.poly
    if aside.constant is not None:
        return value
    ends = ENDS[id(path)]
    f = machine.locals["el_edge_make_q18.step"].poly * ends.t - aside * 16
    path.assume_product(f, ends.dy)
    path.assume_product(15 - f, ends.dy)
    return value


def edge_check(machine: Machine, arguments: list[Any], result: Any) -> None:
    path = machine.path
    ends = ENDS.pop(id(path))
    step, aside = (machine.locals[f"el_edge_make_q18.{name}"].poly for name in ("step", "aside"))
    x = (ends.x0 + 8) * 2**14 + aside - 24
    congruent(machine.poly(result, "x"), x, WORD, "x modulo 2^32")
    congruent(machine.poly(result, "step"), step, WORD, "the step modulo 2^32")
    k, t, n = ends.stepped(machine)
    dx, dy = ends.dx, ends.dy
    grid = dy * 16
    e, f = dx * Q18 - step * dy, step * ends.t - aside * 16
    d = n * Q18 + grid * (Q18 - 1) - grid * (x + step * k)
    path.prove(d - e * t - f * dy - 23 * grid, "D is the sum of what is cut off", zero=True)
    for bound in (16 * e + 17 * dy, 17 * dy - 16 * e):
        path.assume_product(bound, t)
    path.assume_product(dy, dy - 1 - t)
    path.assume_product(254 - t, dy)
    path.prove(d, "D >= 0")
    path.prove(Q18 - grid - d, "D <= 2^18 - g")
    check_whole_part(machine, ends, x + step * k, Q18, (grid, n, n))


def edge(core: str) -> Subject:
    return Subject(
        FILE,
        "el_edge_make_q18",
        edge_domain,
        edge_check,
        contracts={
            "el_reciprocal_of_short": contracts.reciprocal_of_short,
            "el_product_down_11": contracts.product_down_11,
        },
        lemmas={"el_edge_make_q18.step": step_lemma, "el_edge_make_q18.aside": aside_lemma},
        core=core,
    )


# --- all of it --------------------------------------------------------------------------------------------------------


@CORES
def test_every_gradient(core: str) -> None:
    gradient(core).prove()


def test_every_plane() -> None:
    PLANE.prove()


@CORES
def test_every_edge(core: str) -> None:
    edge(core).prove()


@CORES
def test_the_compiler_agrees_on_gradients(core: str) -> None:
    gradient(core).agree(count=100)


def test_the_compiler_agrees_on_planes_and_edges() -> None:
    PLANE.agree(count=100)
    edge("").agree(count=200)


@pytest.mark.parametrize(
    ("subject", "file", "old", "new"),
    [
        (gradient(""), HEADER, "dividend * (1 << 8);", "dividend * (1 << 9);"),
        (gradient(ARMV6M), HEADER, "(8 + area->shift)", "(7 + area->shift)"),
        (gradient(ARMV6M), HEADER, "g.upper = -g.upper", "g.upper = ~g.upper"),
        (PLANE, HEADER, "EL_SUBPIXEL_BITS) + 2U", "EL_SUBPIXEL_BITS) + 1U"),
        (PLANE, HEADER, "d1 * shape->dy2 -", "d1 * shape->dy1 -"),
        (PLANE, HEADER, "EL_TINY_MOST = 1 << 22", "EL_TINY_MOST = 1 << 23"),
        (PLANE, "raster/plain.h", "EL_TINY_SCREEN = (1 << 14) / 17", "EL_TINY_SCREEN = (1 << 16) / 17"),
        (edge(""), HEADER, "+ aside - 24", "+ aside - 16"),
        (edge(""), HEADER, "+ aside - 24", "+ aside - 50"),
        (edge(ARMV6M), HEADER, "reciprocal) >> 2", "reciprocal) / 4 - 1"),
        (edge(""), HEADER, "EL_TINY_HIGH = 255", "EL_TINY_HIGH = 511"),
    ],
)
def test_the_proof_can_fail(subject: Subject, file: str, old: str, new: str) -> None:
    subject.fails_with(Fault(file, old, new))
