"""raster/texture_walk: the piece test's derivation, its logarithms, what rounding adds, and the widths of its numbers.

For u = U / W with U and W linear along a row, W > 0, J = U' W - U W' (the same all along the row), a piece of n pixels
from W0 to Wn, and t in [0, n], the distance from u to the chord is exactly

    u(t) - chord(t) = t (n - t) J W' / (W0 Wn W(t))

so at most n^2 |J W'| / (4 Wmin^3), Wmin being W at one end. The piece is good enough if

    3 log2 Wmin >= log2 |J W'| + 2 log2 n - 2 - log2 error

Every logarithm in the C is rounded against the piece, which is checked here in exact integer arithmetic:
2^(a / 256) >= b is 2^a >= b^256. J is made from whole parts of U and W, and from U' and W' with 4 bits of fraction:
what that cuts off, less than |U'| + |W'| and less than 2 W + 2 sixteenths, is added to it.

What the walk has for u is not the chord between exact values: knots are off by less than 3 units of 2^-16 texel, and a
step by at most 5/4 of one, in at most 63 pixels from a knot. That is less than 82 units, and a sixteenth of the
smallest error, which is left for it, is 128.

Knots are proven where 1 <= W < 2^31 and |U| <= W (test_texture_knots_keep_within_3_units). That holds at the corners,
so also at covered pixels, where planes are means of the corners'; but they are off by less than PLANE_ERROR there.
EL_W_MARGIN_Q32 makes up for the error of both planes. It moves u by no more than 2^(shift - 18) / W units; the rounding
of U at the corners may be 2^(shift - 9) / W.
"""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass, field
from typing import Any

import pytest

import contracts
from c_execution import Machine as AnyMachine
from c_source import parse
from contracts import MOST_KNOT, PLANE_ERROR
from proof import SMALL_CODE, Fault, Machine, Number, Pointer, Poly, Subject, congruent
from symbolic import Fact, Path, prove_over_reals, require

FILE = "raster/texture_walk.c"
STEP_ERROR = 1.25  # units of 2^-16 texel
WORD = 1 << 32


def constants(*names: str, fault: Fault | None = None) -> list[int]:
    machine = AnyMachine(parse(FILE, 4, fault), Path([]))
    return [machine.constant(machine.unit.constants[name]) for name in names]


@functools.cache
def table(name: str, fault: Fault | None = None) -> list[int]:
    machine = AnyMachine(parse(FILE, 4, fault), Path([]))
    machine.functions.append("")
    cells = machine.declared(machine.unit.variables[name]).content
    return [machine.poly(cell).constant or 0 for cell in cells]


# --- the error of a chord ---------------------------------------------------------------------------------------------


def chord_identity(factor: int) -> None:
    """u(t) - chord(t) = t (n - t) J W' / (W0 Wn W(t)), as polynomials over the common denominator W0 Wn W(t)."""
    path = Path([])
    u0, du, w0, dw, t, n = (path.atom(name, -(2**40), 2**40) for name in ("U0", "U'", "W0", "W'", "t", "n"))
    wt, wn, un = w0 + dw * t, w0 + dw * n, u0 + du * n
    j = du * w0 - u0 * dw
    # u(t) - chord(t), times n W0 Wn W(t).
    difference = (u0 + du * t) * n * w0 * wn - u0 * (n - t) * wn * wt - un * t * w0 * wt
    require((difference - t * (n - t) * j * dw * n * factor).constant == 0, "the chord's error")


def test_the_error_of_a_chord() -> None:
    chord_identity(1)
    with pytest.raises(AssertionError):
        chord_identity(2)


def chord_bound(quarter: int) -> None:
    """t (n - t) <= n^2 / 4, and W0 Wn W(t) >= Wmin^3 where W is linear and Wmin the smaller of its ends."""
    path = Path([])
    t, n = path.atom("t", 0, 64), path.atom("n", 1, 64)
    prove_over_reals(n * n - t * (n - t) * quarter, [Fact(n - t)], _atoms(t, n), "t (n - t) <= n^2 / 4")
    w0, wn, wt, least = (path.atom(name, 1, 2**31) for name in ("W0", "Wn", "Wt", "Wmin"))
    facts = [Fact(w0 - least), Fact(wn - least), Fact(wt - least)]
    prove_over_reals(w0 * wn * wt - least * least * least, facts, _atoms(w0, wn, wt, least), "W0 Wn Wt >= Wmin^3")


def _atoms(*polys: Poly) -> list[Any]:
    return [next(iter(poly.terms))[0] for poly in polys]


def test_the_bound_of_that_error() -> None:
    chord_bound(4)
    with pytest.raises(AssertionError):
        chord_bound(5)


# --- logarithms -------------------------------------------------------------------------------------------------------


def check_lengths(fault: Fault | None = None) -> None:
    lengths, logs = table("lengths", fault), table("length_q8", fault)
    count, most = constants("LENGTHS", "EL_MAX_PIECE", fault=fault)
    require(len(lengths) == len(logs) == count and lengths[-1] == most, "one logarithm per length")
    require(all(a < b for a, b in itertools.pairwise(lengths)), "lengths grow")
    # log >= 256 * 2/3 log2 n  is  2^(3 log) >= n^512, and the next smaller number is too small.
    require(all(2 ** (3 * log) >= n**512 for n, log in zip(lengths, logs, strict=True)), "2/3 log2 n, rounded up")
    require(all(2 ** (3 * log - 3) < n**512 for n, log in zip(lengths, logs, strict=True)), "no more than rounded up")


def check_reserve(fault: Fault | None = None) -> None:
    (reserve,) = constants("ROUNDING_RESERVE_Q8", fault=fault)
    require(2**reserve * 15**256 >= 16**256, "a sixteenth of the error is left for rounding")
    (most,) = constants("EL_MAX_PIECE", fault=fault)
    # Off at the knots, and by steps from there: no more than a sixteenth of the smallest error.
    rounding = contracts.KNOT_ERROR + (most - 1) * STEP_ERROR
    require(rounding <= 2**16 * 2**-5 / 16, "rounding fits the reserve")


def check_logarithm(fault: Fault | None = None) -> None:
    """log2_ceil_q8 looks at a number's power of two and the seven bits below it: at both ends of these segments, it is
    the same, and enough for the upper one."""
    unit = parse(FILE, 4, fault)
    for power in range(64):
        machine = AnyMachine(unit, Path([]), modular=["leading_zeros"])
        near = machine.array("uint32_t", [31 - power % 32])
        step = max(1, 1 << power >> 7)
        for start in range(1 << power, 2 << power, step):
            ends = (machine.exactly("uint64_t", x) for x in (start, start + step - 1))
            log, other = (machine.call("log2_ceil_q8", x, near).poly.known for x in ends)
            require(log == other, "constant on a segment")
            require(_log2_at_most(start + step - 1, power, log), f"log2_ceil_q8({start}) = {log}")


# x = 2^power * m / 2^k with a mantissa of few bits: exact powers of the mantissa alone.
def _log2_at_most(x: int, power: int, log: int) -> bool:
    """256 log2 x <= log."""
    return x**256 <= 1 << log if power < 8 else ((x >> power - 7) + 1) ** 256 <= 1 << log - 256 * (power - 7)


def test_lengths() -> None:
    check_lengths()
    with pytest.raises(AssertionError, match="2/3"):
        check_lengths(Fault(FILE, "542, 591, 632", "542, 590, 632"))


def test_the_reserve() -> None:
    check_reserve()
    with pytest.raises(AssertionError, match="sixteenth"):
        check_reserve(Fault(FILE, "ROUNDING_RESERVE_Q8 = 24", "ROUNDING_RESERVE_Q8 = 23"))


def test_the_logarithm_of_j_is_rounded_up() -> None:
    check_logarithm()
    with pytest.raises(AssertionError):
        check_logarithm(Fault(FILE, "+ 1U] + 1;", "+ 1U];"))


def check_normalised(fault: Fault | None = None) -> None:
    """Of W with its fraction: whatever its leading zeros are, the same on each of the 128 segments of what is left."""
    machine = AnyMachine(parse(FILE, 4, fault), Path([]))
    leading = machine.path.atom("leading", 0, 31)
    for i in range(128):
        x = machine.number("uint32_t", "x", 2**31 + (i << 24), 2**31 + (i + 1 << 24) - 1)
        found = machine.call("log2_of_normalised_q8", x, machine.exactly("unsigned", leading))
        log = found.poly - (31 - leading) * 256
        require(log.constant is not None, "constant on a segment, and less by 1 for each leading zero")
        require((128 + i) ** 256 >= 1 << log.known + 256 * 7, f"log2 of 1 + {i}/128")


def test_the_logarithm_of_w_is_rounded_down() -> None:
    check_normalised()
    with pytest.raises(AssertionError, match="log2 of 1"):
        check_normalised(Fault(FILE, "109, 111, 113", "109, 112, 113"))


# --- how far u may bend -----------------------------------------------------------------------------------------------


def log2_ceil(machine: Machine, arguments: list[Any]) -> Number:
    machine.path.prove(arguments[0].poly - 1, "log2_ceil_q8: x >= 1")
    return machine.number("int32_t", "log", 0, 64 * 256 + 1)


LOGS = {"log2_ceil_q8": log2_ceil}
STEEP = 1 << 59


def curvature_domain(machine: Machine) -> list[Any]:
    """U, W and gradients that are not steep, |dx| < 2^59 as Q32, each with what the C cuts off of it; |U| <= W."""
    path = machine.path
    numbers = {}
    for name, unit, least, most in (("u_step", 2**28, -(2**31), 2**31 - 1), ("w_step", 2**28, -(2**31), 2**31 - 1)):
        numbers[name] = path.atom(name, least, most), path.atom(f"rest of {name}", 0, unit - 1)
        path.decide(numbers[name][0], -numbers[name][0] - 1)
        exact = numbers[name][0] * unit + numbers[name][1]
        path.assume(exact + STEEP - 1)
        path.assume(STEEP - 1 - exact)
    for name, least in (("u", -(2**31)), ("w", 1)):
        numbers[name] = path.atom(name, least, 2**31 - 1), path.atom(f"rest of {name}", 0, WORD - 1)
    path.decide(numbers["u"][0], -numbers["u"][0] - 1)
    (u_step, u_step_rest), (w_step, w_step_rest), (u, u_rest), (w, w_rest) = numbers.values()
    exact_u, exact_w = u * WORD + u_rest, w * WORD + w_rest
    path.assume(exact_w - exact_u)
    path.assume(exact_w + exact_u)
    if u.constant is None:
        # What is cut off, times what it is multiplied with.
        for rest, unit, of in ((w_rest, WORD, u_step), (u_rest, WORD, w_step)):
            magnitude = of if path.holds(of) else -of
            path.assume_product(rest, magnitude)
            path.assume_product(unit - 1 - rest, magnitude)
        for rest in (u_step_rest, w_step_rest):
            path.assume_product(rest, exact_w)
            path.assume_product(2**28 - 1 - rest, exact_w)
        path.assume_product(w_step_rest, exact_w - exact_u)
        path.assume_product(w_step_rest, exact_w + exact_u)
    step = u_step * 2**28 + u_step_rest
    J_NUMERATOR[id(path)] = step * exact_w - exact_u * (w_step * 2**28 + w_step_rest)
    signs = [0 if path.holds(of) else 2**64 for of in (step, exact_u)]
    axis = machine.struct("el_texture_axis", value=exact_u + signs[1], dx=step + signs[0])
    machine.put(axis.content["down"], path.atom("down", 3, 30))
    machine.put(axis.content["curvature_shift"], path.atom("near", 0, 31))
    return [Pointer([axis]), machine.exactly("int32_t", w), machine.exactly("int32_t", w_step)]


J_NUMERATOR: dict[int, Poly] = {}


def curvature_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """The logarithm is of no less than 16 |J|."""
    path = machine.path
    j = J_NUMERATOR.pop(id(path))
    if result.poly.constant is not None:
        return  # a sample
    bound = machine.locals["curvature_q8.bound_q4"].poly
    path.prove(bound * 2**60 - j, "J is not above")
    path.prove(bound * 2**60 + j, "J is not below")


CURVATURE = Subject(FILE, "curvature_q8", curvature_domain, curvature_check, ["el_abs_u64"], LOGS)


# --- the same, mostly from upper words --------------------------------------------------------------------------------

EXACTLY = 17  # a number to know the exact way by


@dataclass
class Near:
    """What find_curvature_q8 is asked for on one path, and what it takes the logarithm of."""

    bound: Poly  # what curvature_q8 takes it of
    down: Poly
    normalised: Poly = field(default_factory=lambda: Poly.of(0))
    power: Poly = field(default_factory=lambda: Poly.of(0))


NEAR: dict[int, Near] = {}


def near_domain(machine: Machine) -> list[Any]:
    """Any U, W and gradients, as whole parts and with 4 bits of fraction."""
    path = machine.path
    u_step, w_step, u = (path.atom(name, -(2**31), 2**31 - 1) for name in ("u_step", "w_step", "u"))
    w = path.atom("w", 1, 2**31 - 1)
    signed = {}
    for name, of, unit in (("dx", u_step, 2**28), ("value", u, WORD)):
        exact = of * unit + path.atom(f"rest of {name}", 0, unit - 1)
        signed[name] = exact if path.decide(of, -of - 1) else exact + 2**64
    axis = machine.struct("el_texture_axis", **signed)
    down = path.atom("down", 3, 30)
    machine.put(axis.content["down"], down)
    machine.put(axis.content["curvature_shift"], path.atom("near", 0, 31))
    j = u_step * w - u * w_step
    magnitudes = [of if path.decide(of, -of - 1) else -of for of in (j, u_step, w_step)]
    asked = NEAR[id(path)] = Near(sum(magnitudes[1:], magnitudes[0]) + w * 2 + 2, down)

    def near(of: Machine, arguments: list[Any]) -> Number:
        """el_product_near_i32: a b / 2^32, too low by less than EL_PRODUCT_ERROR (test_products_are_exact)."""
        a, b = (argument.poly for argument in arguments)
        product = of.path.atom("product", -(2**30) - 2, 2**30)
        error = of.constant(of.unit.constants["EL_PRODUCT_ERROR"])
        of.path.assume(a * b - product * WORD)
        of.path.assume((product + error) * WORD - 1 - a * b)
        return of.exactly("int32_t", product)

    def leading(of: Machine, arguments: list[Any]) -> Number:
        return of.leading_zeros(arguments[0], 32, None)

    def logarithm(of: Machine, arguments: list[Any]) -> Number:
        asked.normalised, asked.power = (argument.poly for argument in arguments)
        return of.exactly("int32_t", LOG_OF_NEAR)

    machine.contracts = {
        "el_product_near_i32": near,
        "leading_zeros": leading,
        "log2_ceil_of_normalised_q8": logarithm,
        "curvature_q8": lambda of, _: of.exactly("int32_t", EXACTLY),
    }
    return [Pointer([axis]), machine.exactly("int32_t", w), machine.exactly("int32_t", w_step)]


LOG_OF_NEAR = 19  # a number to know it by


def near_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """curvature_q8's own result, or log2_ceil_of_normalised_q8 of numbers that log2_ceil_q8 would give it: of as many
    bits, of which the first eight, at which it looks, are the same."""
    path = machine.path
    asked = NEAR.pop(id(path))
    if result.poly.known == EXACTLY:
        return
    require(result.poly.known == LOG_OF_NEAR, "a logarithm")
    leading = machine.locals["find_curvature_q8.leading"].poly.known
    require((asked.power - (63 - leading + 30 - asked.down)).constant == 0, "of so many bits, times 2^shift")
    require(path.within(asked.normalised, 2**31, WORD - 1), "normalised")
    # Of the number itself, in units of 2^(56 - leading): from those eight bits on, and less than one more.
    first = path.floor(asked.normalised, 1 << 24)
    path.prove(asked.bound - first * (1 << 56 - leading), "no fewer than those eight bits")
    path.prove((first + 1) * (1 << 56 - leading) - 1 - asked.bound, "and no more")


NEARLY = Subject(FILE, "find_curvature_q8", near_domain, near_check, modular=["find_curvature_q8"])


def curvature_contract(machine: Machine, _: list[Any]) -> Number:
    """curvature_q8: a logarithm, and the shift of the coordinate."""
    return machine.number("int32_t", "curvature", 0, 64 * 256 + 1 + 27 * 256)


def steep_contract(machine: Machine, arguments: list[Any]) -> Number:
    """is_steep: |dx| >= 2^59; where it is not, the gradient is known to be that small."""
    dx = machine.poly(arguments[0].cell, "dx")
    if machine.path.decide(STEEP - 1 - dx, dx - STEEP):
        return machine.exactly("_Bool", 0)
    return machine.exactly("_Bool", 0 if machine.path.decide(dx - 2**64 + STEEP - 1, 2**64 - STEEP - dx) else 1)


def steep_domain(machine: Machine) -> list[Any]:
    return [Pointer([machine.struct("el_plane", dx=machine.path.atom("dx", 0, 2**64 - 1))])]


def steep_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    if result.poly.constant == 0:
        dx = machine.poly(arguments[0].cell, "dx")
        signed = dx if machine.path.decide(2**63 - 1 - dx, dx - 2**63) else dx - 2**64
        require(machine.path.within(signed, -STEEP + 1, STEEP - 1), "|dx| < 2^59")


STEEPNESS = Subject(FILE, "is_steep", steep_domain, steep_check, modular=["el_abs_u64"])

# --- the walk ---------------------------------------------------------------------------------------------------------


def step_domain(machine: Machine) -> list[Any]:
    """The difference of two knots, over each length."""
    difference = machine.number("int32_t", "difference", -2 * MOST_KNOT, 2 * MOST_KNOT)
    length = machine.path.choose(machine.path.atom("length", 2, 64))
    LENGTHS[id(machine.path)] = length
    return [difference, machine.call("reciprocal_of", machine.exactly("uint32_t", length))]


LENGTHS: dict[int, int] = {}


def step_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    length = LENGTHS.pop(id(machine.path))
    off = arguments[0].poly - result.poly * length
    machine.path.prove(int(STEP_ERROR * 4) * length - off * 4, "not too low by more than 5/4")
    machine.path.prove(int(STEP_ERROR * 4) * length + off * 4, "nor too high")


def step(core: str = "") -> Subject:
    return Subject(FILE, "el_multiply_high_i32_u32", step_domain, step_check, core=core)


FALLS, GROWS = 2**64 - 1, 1  # signs of W's gradient


def any_walk(machine: Machine, falls: int, length: int) -> Any:
    """A walk at any place of a span, with that length: what set_length leaves of any limit."""
    path = machine.path
    (never,) = (machine.constant(machine.unit.constants["NEVER_Q8"]),)
    here = path.atom("log2 W", 0, 32 * 256)
    walk = machine.struct("el_texture_walk", w_log2_q8=here, w_dx=FALLS if falls else GROWS)
    machine.put(walk.content["limit_q8"], path.atom("limit", -never, never))
    machine.call("set_length", Pointer([walk]), machine.exactly("uint32_t", length))
    return walk


def piece_domain(machine: Machine) -> list[Any]:
    """Where W grows, it is enough at the last knot for the length that there is, or that is one pixel.

    So begin leaves it, and each piece.
    """
    path = machine.path
    count = machine.constant(machine.unit.constants["LENGTHS"])
    falls = path.choose(path.atom("falls", 0, 1))
    length = path.choose(path.atom("length", 0, count - 1))
    walk = any_walk(machine, falls, length)
    if not falls and length > 0:
        path.assume(machine.poly(walk, "w_log2_q8") - machine.poly(walk, "limit_q8") - table("length_q8")[length])
    at, most = machine.number("uint32_t", "at", 0, 4079), machine.number("uint32_t", "most", 1, 4079)
    PIECES[id(path)] = Piece(at.poly, most.poly, machine.poly(walk, "w_log2_q8"), bool(falls))
    return [Pointer([walk]), at, most]


@dataclass
class Piece:
    """What is known of a piece, and what its proof comes to know."""

    at: Poly
    most: Poly
    here: Poly  # log2 of W at its beginning
    falls: bool
    there: Poly = field(default_factory=lambda: Poly.of(0))  # and at its end,
    asked: Poly = field(default_factory=lambda: Poly.of(0))  # so many pixels from the span's beginning
    length: Poly | None = None  # whose reciprocal is taken
    knots: list[tuple[Any, ...]] = field(default_factory=list)


PIECES: dict[int, Piece] = {}


def w_there(machine: Machine, arguments: list[Any]) -> None:
    """find_w: the logarithm there, no less than here where W grows, for rounding down keeps what is larger so."""
    piece, walk = PIECES[id(machine.path)], arguments[0].cell
    piece.asked = arguments[1].poly
    machine.path.prove(piece.asked - piece.at - 1, "further on")
    machine.path.prove(piece.most - (piece.asked - piece.at), "at a covered pixel")
    piece.there = machine.path.atom("log2 W there", 0, 32 * 256)
    if not piece.falls:
        machine.path.assume(piece.there - piece.here)
    machine.put(walk.content["w_log2_q8"], piece.there)
    machine.put(walk.content["w_shift"], machine.path.atom("shift", 1, 31))
    machine.put(walk.content["reciprocal"], machine.path.atom("reciprocal", 2**31, WORD - 1))


def reciprocal_of(machine: Machine, arguments: list[Any]) -> Number:
    """Of the piece's length; what it is for is proven of each length."""
    PIECES[id(machine.path)].length = arguments[0].poly
    return machine.number("uint32_t", "reciprocal", 0, 1 << 31)


def knot_there(machine: Machine, arguments: list[Any]) -> None:
    axis, walk, at, _ = arguments
    by = tuple(machine.poly(walk.cell, name) for name in ("w_shift", "reciprocal"))
    PIECES[id(machine.path)].knots.append((axis.cell, at.poly, *by))


def piece_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """1 <= length <= what there is at most, and W is enough for more than one pixel.

    The knots are at its end, where W was found last, and over its length; and the next piece finds what this one did.
    """
    path = machine.path
    walk = arguments[0].cell
    piece, lengths, logs = PIECES.pop(id(path)), table("lengths"), table("length_q8")
    path.prove(result.poly - 1, "a piece has a pixel")
    path.prove(machine.constant(machine.unit.constants["EL_MAX_PIECE"]) - result.poly, "not longer than EL_MAX_PIECE")
    path.prove(piece.most - result.poly, "the knot at its end is covered")
    path.prove(piece.asked - piece.at - result.poly, "W was found at its end", zero=True)
    require(piece.length is not None and (piece.length - result.poly).constant == 0, "over its length")
    for name, (axis, at, shift, reciprocal) in zip("uv", piece.knots, strict=True):
        require(axis is walk.content[name], f"the knot of {name}")
        path.prove(at - piece.at - result.poly, "at its end", zero=True)
        require((shift - machine.poly(walk, "w_shift")).constant == 0, "by W there")
        require((reciprocal - machine.poly(walk, "reciprocal")).constant == 0, "by W there")
    i, limit = machine.poly(walk, "length").known, machine.poly(walk, "limit_q8")
    least = piece.there if piece.falls else piece.here
    if path.decide(result.poly - 2, 1 - result.poly):
        path.prove(lengths[i] - result.poly, "no longer than the length that was tried")
        path.prove(least - limit - logs[i], "W is enough for it")
    after = machine.struct("el_texture_walk", w_dx=machine.poly(walk, "w_dx"), limit_q8=limit)
    machine.call("set_length", Pointer([after]), machine.exactly("uint32_t", i))
    for name in ("pixels", "more_q8", "enough_q8"):
        path.prove(machine.poly(after, name) - machine.poly(walk, name), f"{name} of that length", zero=True)
    if not piece.falls and i > 0:
        path.prove(piece.there - limit - logs[i], "W is enough for that length at the next knot")


PIECE = Subject(
    FILE,
    "el_texture_walk_piece",
    piece_domain,
    piece_check,
    contracts={"find_w": w_there, "find_knot": knot_there, "reciprocal_of": reciprocal_of},
)


def covered(machine: Machine) -> tuple[Poly, Poly]:
    """W and U as their planes have them at a covered pixel, in units of 2^-32."""
    path = machine.path
    w = path.atom("W", WORD - PLANE_ERROR, (2**31 - 1) * WORD + PLANE_ERROR)
    u = path.atom("U", -(2**63), 2**63 - 1)
    path.assume(w + 2 * PLANE_ERROR - u)
    path.assume(w + 2 * PLANE_ERROR + u)
    return w, u


def begin_domain(machine: Machine) -> list[Any]:
    """A row, at a column of which W and U are as at a covered pixel."""
    path = machine.path
    (never,) = (machine.constant(machine.unit.constants["NEVER_Q8"]),)
    planes, walk = machine.struct("el_perspective"), machine.struct("el_texture_walk")
    w, u = covered(machine)
    there = {"w": w, "u": u if path.decide(u, -u - 1) else u + 2**64, "v": path.atom("V", 0, 2**64 - 1)}
    x, pixels = machine.number("uint32_t", "x", 0, 4079), machine.number("uint32_t", "pixels", 1, 4080)
    curved = path.choose(path.atom("curved", 0, 1))
    for name in there:
        machine.put(planes.content[name].content["value"], path.atom(f"{name} in column 0", 0, 2**64 - 1))
    gradients = {"u": path.atom("u'", 0, 2**64 - 1), "v": path.atom("v'", 0, 2**64 - 1)}
    for name, gradient in gradients.items():
        machine.put(walk.content[name].content["dx"], gradient)
    falls = path.choose(path.atom("falls", 0, 1))
    gradients["w"] = Poly.of(FALLS if falls else GROWS)
    for name, gradient in gradients.items():
        machine.put(planes.content[name].content["dx"], gradient)
    for name, value in {
        "w_dx": gradients["w"],
        "is_curved": curved,
        "first_length": path.choose(path.atom("first", 0, machine.constant(machine.unit.constants["LENGTHS"]) - 1)),
        "limit_q8": path.atom("limit", -never, never),
    }.items():
        machine.put(walk.content[name], value)
    asked = iter("wuv")

    def further(of: Machine, arguments: list[Any]) -> Number:
        """el_multiply_u16: a gradient times x, which leads there."""
        name = next(asked)
        require((arguments[0].poly - gradients[name]).constant == 0, f"the gradient of {name}")
        require((arguments[1].poly - x.poly).constant == 0, "times the columns")
        turns = of.path.atom("turns", 0, 1)
        return of.exactly("uint64_t", there[name] - of.poly(planes, name, "value") + turns * 2**64)

    def found(of: Machine, arguments: list[Any]) -> None:
        """find_w, and what the knots rely on: 1 <= W < 2^31 and |U| <= W."""
        require(arguments[1].poly.constant == 0, "W here")
        here = of.poly(walk, "w")
        path.prove(here - WORD, "W >= 1")
        path.prove(2**63 - 1 - here, "W < 2^31")
        path.prove(here - u, "U <= W")
        path.prove(here + u, "-W <= U")
        of.put(walk.content["w_log2_q8"], of.path.atom("log2 W", 0, 32 * 256))
        of.put(walk.content["w_shift"], of.path.atom("shift", 1, 31))
        of.put(walk.content["reciprocal"], of.path.atom("reciprocal", 2**31, WORD - 1))

    def limit(of: Machine, _: list[Any]) -> None:
        of.put(walk.content["limit_q8"], of.path.atom("limit of the row", -never, never))

    machine.contracts = {
        "el_multiply_u16": further,
        "find_w": found,
        "find_limit": limit,
        "find_first_knot": lambda *_: None,
    }
    BEGINS[id(path)] = there
    return [Pointer([walk]), Pointer([planes]), x, pixels]


BEGINS: dict[int, dict[str, Poly]] = {}


def begin_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """The values are those there, and the length is as the pieces rely on."""
    path, walk = machine.path, arguments[0].cell
    there = BEGINS.pop(id(path))
    for name in "uv":
        congruent(machine.poly(walk, name, "value"), there[name], 2**64, f"{name} there")
    if path.holds(1 - arguments[3].poly):
        return  # no piece is asked for
    logs = table("length_q8")
    i = machine.poly(walk, "length").known
    room = machine.poly(walk, "w_log2_q8") - machine.poly(walk, "limit_q8")
    if i > 0:
        path.prove(room - logs[i], "W is enough for it")
    if i + 1 < len(logs):
        path.prove(logs[i + 1] - 1 - room, "and for none that is longer")


BEGIN = Subject(FILE, "el_texture_walk_begin", begin_domain, begin_check, modular=["el_texture_walk_begin", "plane_at"])


def start_domain(machine: Machine) -> list[Any]:
    """Planes with any gradients and shifts."""
    path = machine.path
    triangle = machine.struct("el_triangle")
    perspective = triangle.content["perspective"].content
    for name in "uv":
        machine.put(perspective[f"{name}_shift"], path.atom(f"{name}_shift", 0, 27))
        machine.put(perspective[f"{name}_base_q16"], path.atom(f"{name}_base", -(2**27), 2**27))
    for name in "uvw":
        machine.put(perspective[name].content["dx"], path.atom("dx", 0, 2**64 - 1))
    surface = triangle.content["surface"].content
    machine.put(surface["uv_error_log2"], path.choose(path.atom("uv_error_log2", 1, 5)))

    def log_of_step(of: Machine, arguments: list[Any]) -> Number:
        """log2_ceil_q8: of no less than 16 |W'|."""
        dw = of.poly(perspective["w"], "dx")
        signed = dw if path.holds(STEEP - 1 - dw) else dw - 2**64
        for magnitude in (signed, -signed):
            path.prove(arguments[0].poly * 2**28 - magnitude, "no less than 16 |W'|")
        return log2_ceil(of, arguments)

    machine.contracts = {"is_steep": steep_contract, "log2_ceil_q8": log_of_step}
    return [Pointer([machine.struct("el_texture_walk")]), Pointer([triangle])]


def start_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """Each coordinate has its own numbers; three times the limit, but for J, or a limit that is always or never met."""
    walk, perspective = arguments[0].cell, arguments[1].cell.content["perspective"].content
    for name in "uv":
        axis = walk.content[name]
        require((machine.poly(axis, "dx") - machine.poly(perspective[name], "dx")).constant == 0, "its gradient")
        require((machine.poly(axis, "base_q16") - machine.poly(perspective[f"{name}_base_q16"])).constant == 0, "base")
        require((machine.poly(axis, "down") + machine.poly(perspective[f"{name}_shift"])).constant == 30, "its shift")
    (never, reserve) = (machine.constant(machine.unit.constants[n]) for n in ("NEVER_Q8", "ROUNDING_RESERVE_Q8"))
    if not machine.poly(walk, "is_curved").known:
        is_flat = machine.path.holds(-machine.poly(perspective["w"], "dx"))
        require(machine.poly(walk, "limit_q8").known == (-never if is_flat else never), "always or never")
        return
    for name in "uvw":
        dx, path = machine.poly(perspective[name], "dx"), machine.path
        require(path.holds(STEEP - 1 - dx) or path.holds(dx - 2**64 + STEEP - 1), "no gradient is steep")
    # J and W' with 4 bits of fraction each, the error in Q16 texels.
    w_step = machine.locals["el_texture_walk_start.w_step"].poly
    error = machine.poly(arguments[1].cell, "surface", "uv_error_log2")
    exact = w_step - 256 * (4 + 4 + 16) - 256 * 2 + 256 * error + reserve
    machine.path.prove(machine.poly(walk, "without_j_q8") - exact, "log2 |W'| - 2 - log2 error", zero=True)


START = Subject(
    FILE, "el_texture_walk_start", start_domain, start_check, modular=["el_texture_walk_start", "el_abs_u64"]
)


def limit_domain(machine: Machine) -> list[Any]:
    """W at the row's beginning, and what start leaves."""
    path = machine.path
    walk = machine.struct("el_texture_walk")
    machine.put(walk.content["w"], path.atom("W", WORD, 2**63 - 1))
    falls = path.choose(path.atom("falls", 0, 1))
    least, most = (2**64 - STEEP + 1, 2**64 - 1) if falls else (0, STEEP - 1)
    machine.put(walk.content["w_dx"], path.atom("dw", least, most))
    most = 64 * 256 + 1 - 256 * (4 + 4 + 16) - 256 * 2 + 256 * 5 + 24
    machine.put(walk.content["without_j_q8"], path.atom("without J", most - 64 * 256 - 1 - 256 * 4, most))
    CURVATURES[id(path)] = []
    return [Pointer([walk])]


CURVATURES: dict[int, list[tuple[Any, Poly]]] = {}


def curvature_found(machine: Machine, arguments: list[Any]) -> Number:
    found: Number = curvature_contract(machine, arguments)
    CURVATURES[id(machine.path)].append((arguments[0].cell, found.poly))
    return found


def limit_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """3 limit >= 256 log2 |J W'| - 2 * 256 - 256 log2 error + reserve, of the larger J; the limit is in its range."""
    path, walk = machine.path, arguments[0].cell
    limit, without = machine.poly(walk, "limit_q8"), machine.poly(walk, "without_j_q8")
    (never,) = (machine.constant(machine.unit.constants["NEVER_Q8"]),)
    path.prove(limit + never, "limit >= -NEVER")
    path.prove(never - limit, "limit <= NEVER")
    found = CURVATURES.pop(id(path))
    for name, (axis, curvature) in zip("uv", found, strict=True):
        require(axis is walk.content[name], f"the curvature of {name}")
        path.prove(limit * 3 - curvature - without, "the limit is rounded up")
    u, v = (curvature for _, curvature in found)
    path.prove((u if path.decide(u - v, v - u - 1) else v) + without + 2 - limit * 3, "and no more than that")


LIMIT = Subject(
    FILE,
    "find_limit",
    limit_domain,
    limit_check,
    modular=["find_limit"],
    contracts={"find_curvature_q8": curvature_found},
)
SUBJECTS = {
    "curvature": CURVATURE,
    "curvature, from upper words": NEARLY,
    "steep": STEEPNESS,
    "step": step(),
    "step, small code": step(SMALL_CODE),
    "piece": PIECE,
    "begin": BEGIN,
    "start": START,
    "limit": LIMIT,
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize("name", ["curvature", "steep", "step"])
def test_the_compiler_agrees(name: str) -> None:
    subject = SUBJECTS[name]
    Subject(FILE, subject.function, subject.domain, modular=[*subject.modular, "leading_zeros"]).agree(count=200)


@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("curvature", FILE, "axis->dx >> 28", "axis->dx >> 27"),
        ("curvature", FILE, "= el_abs_u64(step_q4) + el_abs_u64(w_step_q4)", "= el_abs_u64(step_q4)"),
        ("curvature", FILE, "2U * ((uint64_t)(uint32_t)w + 1U)", "((uint64_t)(uint32_t)w + 1U)"),
        ("curvature, from upper words", FILE, "magnitude - 3U", "magnitude - 2U"),
        ("curvature, from upper words", FILE, "(7U << leading)", "(6U << leading)"),
        ("curvature, from upper words", FILE, "LEAST_UPPER = 1 << 11", "LEAST_UPPER = 1 << 9"),
        ("curvature, from upper words", FILE, "(normalised, 63 - (int32_t)", "(normalised, 64 - (int32_t)"),
        ("steep", FILE, "1ULL << (32 + STEEP_LOG2)", "1ULL << (33 + STEEP_LOG2)"),
        ("step", FILE, "477218589U", "477218689U"),
        ("step, small code", FILE, "0xFFFFFFFFU / length + 1U", "0xFFFFFFFFU / (length + 1U)"),
        ("piece", FILE, "walk->pixels < most ? walk->pixels : most", "walk->pixels"),
        (
            "piece",
            FILE,
            "i--;\n        length = lengths[i] < most ? lengths[i] : most",
            "i--;\n        length = lengths[i]",
        ),
        ("piece", FILE, "walk->w_log2_q8 < walk->enough_q8", "walk->w_log2_q8 < walk->enough_q8 - 1"),
        ("piece", FILE, "} while (i > 0 && walk->w_log2_q8", "} while (i > 0 && walk->w_log2_q8 + 1"),
        ("piece", FILE, "find_knot(&walk->v, walk, at + length", "find_knot(&walk->v, walk, at"),
        ("piece", FILE, "i > 0 ? walk->limit_q8 + length_q8[i] : INT32_MIN", "INT32_MIN"),
        ("piece", FILE, "more_q8 = walk->limit_q8 + length_q8[i + 1U]", "more_q8 = walk->limit_q8 + length_q8[i]"),
        ("begin", FILE, "+ EL_W_MARGIN_Q32", ""),
        ("begin", FILE, "while (i > 0 && walk->w_log2_q8 < walk->limit_q8 + length_q8[i]) {", "while (i > 9) {"),
        ("begin", "raster/texture_walk.h", "(1U << 14)", "(1U << 13)"),
        ("start", FILE, "el_abs_u64(w_step_q4) + 1U", "el_abs_u64(w_step_q4)"),
        ("start", FILE, "- 2 * 256 - error_q8", "- error_q8"),
        ("start", FILE, "is_steep(&p->u) || ", ""),
        ("limit", FILE, "* 4096 + 2)", "* 4096 + 1)"),
        ("limit", FILE, "curvature_q8(&walk->v, w", "curvature_q8(&walk->u, w"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(file, old, new))
