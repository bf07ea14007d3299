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
from proof import SMALL_CODE, Fault, Machine, Number, Pointer, Poly, Subject
from symbolic import Fact, Infeasible, Path, prove_over_reals, require

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


def check_logarithm(name: str, width: int, upwards: bool, fault: Fault | None = None) -> None:
    """The C is constant on 128 segments per power of two: a floor is checked at their starts, a ceil at their ends."""
    machine = AnyMachine(parse(FILE, 4, fault), Path([]))
    c_type = machine.type_named("uint64_t" if width == 64 else "uint32_t")
    for power in range(width):
        step = max(1, 1 << power >> 7)
        for start in range(1 << power, 2 << power, step):
            value = Number(c_type, machine.path.atom("x", start, start + step - 1))
            log = machine.call(name, value).poly.constant
            require(log is not None, "constant on a segment")
            end = start + step - 1
            ok = _log2_at_most(end, power, log) if upwards else _log2_at_least(start, power, log)
            require(ok, f"{name}({start}) = {log}")


# x = 2^power * m / 2^k with a mantissa of few bits: exact powers of the mantissa alone.
def _log2_at_least(x: int, power: int, log: int) -> bool:
    """256 log2 x >= log."""
    return x**256 >= 1 << log if power < 8 else (x >> power - 7) ** 256 >= 1 << log - 256 * (power - 7)


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


LOGARITHMS = pytest.mark.parametrize(
    ("name", "width", "upwards"), [("log2_floor_q8", 32, False), ("log2_ceil_q8", 64, True)]
)


@LOGARITHMS
def test_logarithms_are_rounded_against_the_piece(name: str, width: int, upwards: bool) -> None:
    check_logarithm(name, width, upwards)


@LOGARITHMS
def test_the_proof_of_logarithms_can_fail(name: str, width: int, upwards: bool) -> None:
    fault = Fault(FILE, "109, 111, 113", "109, 112, 113") if not upwards else Fault(FILE, "+ 1U] + 1;", "+ 1U];")
    with pytest.raises(AssertionError):
        check_logarithm(name, width, upwards, fault)


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


def logarithm(name: str) -> Any:
    top = 32 * 256 if name == "log2_floor_q8" else 64 * 256

    def contract(machine: Machine, arguments: list[Any]) -> Number:
        machine.path.prove(arguments[0].poly - 1, f"{name}: x >= 1")
        return machine.number("int32_t", "log", 0, top + 1)

    return contract


LOGS = {name: logarithm(name) for name in ("log2_floor_q8", "log2_ceil_q8")}
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
    plane = machine.struct("el_plane", dx=step + signs[0])
    numbers_of_w = machine.exactly("int32_t", w), machine.exactly("int32_t", w_step)
    shift = machine.number("uint8_t", "shift", 0, 27)
    return [machine.exactly("uint64_t", exact_u + signs[1]), Pointer([plane]), *numbers_of_w, shift]


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
    return [difference, machine.call("reciprocal_of", machine.exactly("int32_t", length))]


LENGTHS: dict[int, int] = {}


def step_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    length = LENGTHS.pop(id(machine.path))
    off = arguments[0].poly - result.poly * length
    machine.path.prove(int(STEP_ERROR * 4) * length - off * 4, "not too low by more than 5/4")
    machine.path.prove(int(STEP_ERROR * 4) * length + off * 4, "nor too high")


def step(core: str = "") -> Subject:
    return Subject(FILE, "el_multiply_high_i32_u32", step_domain, step_check, core=core)


def piece_domain(machine: Machine) -> list[Any]:
    """A walk at any place of any span, its limit as el_texture_walk_begin makes it.

    Where W grows, the length that is found depends on W alone, wherever the search begins: here it begins with that
    length, or with the longest. Where W falls, one that is not good enough, or too long for what is left of the span,
    leaves the search where it would be had it begun with the next shorter one: that is a path of its own.
    """
    path = machine.path
    never, count = (machine.constant(machine.unit.constants[name]) for name in ("NEVER_Q8", "LENGTHS"))
    limit, here = path.atom("limit", -never, never), path.atom("log2 W", 0, 32 * 256)
    start = path.choose(path.atom("length", 0, count - 1))
    falls = path.choose(path.atom("falls", 0, 1))
    # What is left of the span, by how it compares with the lengths.
    lengths, logs = table("lengths"), table("length_q8")
    ends = [1, 2, *(length + 2 for length in lengths), 2041]
    part = path.choose(path.atom("part", 0, len(ends) - 2))
    too_long = start > 0 and lengths[start - 1] >= ends[part + 1] - 2
    if too_long and (falls or start + 1 < count):
        raise Infeasible
    if not falls and start + 1 < count:
        path.assume(limit + logs[start + 1] - 1 - here)
    if not falls and start > 0 and not too_long:
        path.assume(here - limit - logs[start])
    walk = machine.struct("el_texture_walk", limit_q8=limit, length=start, w_log2_q8=here)
    for name in ("w", "u", "v"):
        machine.put(walk.content[name], path.atom(name, 0, 2**64 - 1))
    for name in ("next_u_q16", "next_v_q16"):
        machine.put(walk.content[name], path.atom(name, -MOST_KNOT, MOST_KNOT))
    planes = machine.struct("el_perspective")
    machine.put(planes.content["w"].content["dx"], path.atom("dw", falls * 2**63, 2**63 - 1 + falls * 2**63))
    walk.content["planes"].content = Pointer([planes])
    left = machine.number("int32_t", "left", ends[part], ends[part + 1] - 1)
    here_at = {name: machine.poly(walk, f"next_{name}_q16") for name in "uv"}
    PIECES[id(path)] = Piece(here_at, left.poly, here if not falls else None)
    return [Pointer([walk]), left]


@dataclass
class Piece:
    """What is known of a piece, and what its proof comes to know."""

    here: dict[str, Poly]  # u and v at its first pixel
    left: Poly
    least: Poly | None  # log2 of W where it is least on the piece
    asked: Poly | None = None  # so many pixels from here, if W falls
    gone: Poly | None = None
    steps: list[tuple[Poly, Poly]] = field(default_factory=list)  # a difference of two knots, a step


PIECES: dict[int, Piece] = {}


def w_there(machine: Machine, arguments: list[Any]) -> Number:
    """el_multiply_u16 of W's gradient, which is added to W: at a covered pixel, 1 <= W < 2^31 comes of it."""
    piece, pixels = PIECES[id(machine.path)], arguments[1].poly
    machine.path.prove(pixels - 1, "further on")
    machine.path.prove(piece.left - 1 - pixels, "at a covered pixel")
    walk = machine.scopes[0]["walk"].content.cell
    piece.asked = pixels
    there, turns = machine.path.atom("W there", WORD, 2**63 - 1), machine.path.atom("turns", 0, 1)
    return machine.exactly("uint64_t", there - machine.poly(walk, "w") + turns * 2**64)


def log_there(machine: Machine, arguments: list[Any]) -> Number:
    log: Number = LOGS["log2_floor_q8"](machine, arguments)
    piece = PIECES[id(machine.path)]
    if piece.least is not None:
        raise Infeasible  # where W falls, what was found for a longer piece says nothing of a shorter one
    piece.least = log.poly
    return log


def gone_on(machine: Machine, arguments: list[Any]) -> None:
    PIECES[id(machine.path)].gone = arguments[1].poly


def next_knots(machine: Machine, arguments: list[Any]) -> None:
    """find_knot: both, and the logarithm of W there."""
    walk = arguments[0].cell
    for name in "uv":
        machine.put(walk.content[f"next_{name}_q16"], machine.path.atom("knot", -MOST_KNOT, MOST_KNOT))
    machine.put(walk.content["w_log2_q8"], machine.path.atom("log2 W", 0, 32 * 256))


def reciprocal_of(machine: Machine, arguments: list[Any]) -> Number:
    """Of the piece's length; what it is for is proven of each length."""
    length = PIECES[id(machine.path)].gone
    require(length is not None and (arguments[0].poly - length).constant == 0, "of the piece's length")
    machine.path.prove(arguments[0].poly - 2, "a length of 2 and more")
    return machine.number("uint32_t", "reciprocal", 1 << 26, 1 << 31)


def step_contract(machine: Machine, arguments: list[Any]) -> Number:
    """el_multiply_high_i32_u32, of a difference and the reciprocal of the length."""
    found = machine.number("int32_t", "step", -2 * MOST_KNOT, 2 * MOST_KNOT)
    PIECES[id(machine.path)].steps.append((arguments[0].poly, found.poly))
    return found


def piece_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """1 <= length <= what is left of the span before its last pixel, and the longest piece.

    W is enough for more than one pixel; the walk goes on by it, and the steps are over the difference of its knots.
    """
    path = machine.path
    walk, left = arguments[0].cell, arguments[1].poly
    piece = PIECES.pop(id(path))
    path.prove(result.poly - 1, "a piece has a pixel")
    path.prove(machine.constant(machine.unit.constants["EL_MAX_PIECE"]) - result.poly, "not longer than EL_MAX_PIECE")
    for name, here in piece.here.items():
        require((machine.poly(walk, f"{name}_q16") - here).constant == 0, f"{name} is what the last knot was")
    if not path.decide(left - 2, 1 - left):
        return
    path.prove(left - 1 - result.poly, "the knot at its end is covered")
    require(piece.gone is not None and (piece.gone - result.poly).constant == 0, "the planes are at its end")
    if path.decide(result.poly - 2, 1 - result.poly):
        i = machine.poly(walk, "length").known
        path.prove(table("lengths")[i] - result.poly, "no longer than the length that was tried")
        assert piece.least is not None
        if piece.asked is not None:
            path.prove(piece.asked - result.poly, "W at its end was asked for", zero=True)
        path.prove(piece.least - machine.poly(walk, "limit_q8") - table("length_q8")[i], "W is enough for it")
        steps = piece.steps
    else:
        steps = [(machine.poly(walk, f"{name}_step_q16"),) * 2 for name in "uv"]
    for name, (difference, per_pixel) in zip("uv", steps, strict=True):
        exact = machine.poly(walk, f"next_{name}_q16") - piece.here[name]
        require((difference - exact).constant == 0, f"the difference of {name}")
        require((machine.poly(walk, f"{name}_step_q16") - per_pixel).constant == 0, f"the step of {name}")


PIECE = Subject(
    FILE,
    "el_texture_walk_piece",
    piece_domain,
    piece_check,
    modular=["el_texture_walk_piece", "piece_length"],
    contracts={
        "go_on": gone_on,
        "find_knot": next_knots,
        "log2_floor_q8": log_there,
        "el_multiply_u16": w_there,
        "reciprocal_of": reciprocal_of,
        "el_multiply_high_i32_u32": step_contract,
    },
    rough=True,
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
    """A row's first pixel, from which W and U are as at a covered pixel after those that are skipped, if any."""
    path = machine.path
    triangle = machine.struct("el_triangle")
    perspective = triangle.content["perspective"].content
    for name in "uv":
        machine.put(perspective[f"{name}_shift"], path.atom(f"{name}_shift", 0, 27))
    w, u = covered(machine)
    there = {"w": w, "u": u if path.decide(u, -u - 1) else u + 2**64, "v": path.atom("V", 0, 2**64 - 1)}
    skips = path.choose(path.atom("skips", 0, 1))
    for name, value in there.items():
        machine.put(perspective[name].content["value"], path.atom("value", 0, 2**64 - 1) if skips else value)
        machine.put(perspective[name].content["dx"], path.atom("dx", 0, 2**64 - 1))
    surface = triangle.content["surface"].content
    machine.put(surface["uv_error_log2"], path.choose(path.atom("uv_error_log2", 1, 5)))
    walk = machine.struct("el_texture_walk")

    def skip(of: Machine, arguments: list[Any]) -> None:
        """go_on: to there, with whatever was added to W before."""
        require((arguments[1].poly - skipped.poly).constant == 0, "by the pixels that are skipped")
        u64 = of.type_named("uint64_t")
        for name, value in there.items():
            added = of.poly(walk, name) - of.poly(perspective[name], "value")
            walk.content[name].content = Number(u64, of.reduce(value + added, u64))

    def knots(of: Machine, arguments: list[Any]) -> None:
        """find_knot: 1 <= W < 2^31 and |U| <= W, as it is proven for."""
        here = of.poly(walk, "w")
        path.prove(here - WORD, "W >= 1")
        path.prove(2**63 - 1 - here, "W < 2^31")
        path.prove(here - u, "U <= W")
        path.prove(here + u, "-W <= U")
        next_knots(of, arguments)

    def log_of_step(of: Machine, arguments: list[Any]) -> Number:
        """log2_ceil_q8: of no less than 16 |W'|."""
        dw = of.poly(perspective["w"], "dx")
        signed = dw if path.holds(STEEP - 1 - dw) else dw - 2**64
        for magnitude in (signed, -signed):
            path.prove(arguments[0].poly * 2**28 - magnitude, "no less than 16 |W'|")
        log: Number = LOGS["log2_ceil_q8"](of, arguments)
        return log

    machine.contracts = {**BEGIN_CONTRACTS, "go_on": skip, "find_knot": knots, "log2_ceil_q8": log_of_step}
    skipped = machine.number("int32_t", "skipped", skips, 4080 * skips)
    return [Pointer([walk]), Pointer([triangle]), skipped]


def begin_check(machine: Machine, arguments: list[Any], _: Any) -> None:
    """3 limit >= 256 log2 |J W'| - 2 * 256 - 256 log2 error + reserve, and the limit is in its range."""
    path = machine.path
    limit = machine.poly(arguments[0].cell, "limit_q8")
    (never, reserve) = (machine.constant(machine.unit.constants[n]) for n in ("NEVER_Q8", "ROUNDING_RESERVE_Q8"))
    path.prove(limit + never, "limit >= -NEVER")
    path.prove(never - limit, "limit <= NEVER")
    if "el_texture_walk_begin.curvature" not in machine.locals:
        return
    # J and W' with 4 bits of fraction each, the error in Q16 texels.
    curvature, w_step = (machine.locals[f"el_texture_walk_begin.{name}"].poly for name in ("curvature", "w_step"))
    error = machine.poly(arguments[1].cell, "surface", "uv_error_log2")
    exact = curvature + w_step - 256 * (4 + 4 + 16) - 256 * 2 + 256 * error + reserve
    path.prove(limit * 3 - exact, "the limit is rounded up")
    path.prove(exact + 2 - limit * 3, "and no more than that")


BEGIN_CONTRACTS = {"curvature_q8": curvature_contract, "is_steep": steep_contract}
BEGIN = Subject(
    FILE, "el_texture_walk_begin", begin_domain, begin_check, modular=["el_texture_walk_begin", "el_abs_u64"]
)
SUBJECTS = {
    "curvature": CURVATURE,
    "steep": STEEPNESS,
    "step": step(),
    "step, small code": step(SMALL_CODE),
    "piece": PIECE,
    "begin": BEGIN,
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


@pytest.mark.parametrize("name", ["curvature", "steep", "step"])
def test_the_compiler_agrees(name: str) -> None:
    subject = SUBJECTS[name]
    Subject(FILE, subject.function, subject.domain, modular=subject.modular).agree(count=200)


@pytest.mark.parametrize(
    ("name", "file", "old", "new"),
    [
        ("curvature", FILE, "plane->dx >> 28", "plane->dx >> 27"),
        ("curvature", FILE, "= el_abs_u64(step_q4) + el_abs_u64(w_step_q4)", "= el_abs_u64(step_q4)"),
        ("curvature", FILE, "2U * ((uint64_t)(uint32_t)w + 1U)", "((uint64_t)(uint32_t)w + 1U)"),
        ("steep", FILE, "1ULL << (32 + STEEP_LOG2)", "1ULL << (33 + STEEP_LOG2)"),
        ("step", FILE, "477218589U", "477218689U"),
        ("step, small code", FILE, "(uint32_t)length + 1U", "((uint32_t)length + 1U)"),
        ("piece", FILE, "piece_length(walk, left - 1)", "piece_length(walk, left)"),
        ("piece", FILE, "(least) >= walk->limit_q8 + length_q8[i])", "(least) >= walk->limit_q8)"),
        ("piece", FILE, "i >= 0 && room_q8 < length_q8[i]", "i >= 0 && room_q8 < 0"),
        ("piece", FILE, "walk->next_v_q16 - walk->v_q16", "walk->next_v_q16 - walk->u_q16"),
        ("begin", FILE, "el_abs_u64(w_step_q4) + 1U", "el_abs_u64(w_step_q4)"),
        ("begin", FILE, "+ EL_W_MARGIN_Q32", ""),
        ("begin", FILE, "* 4096 + 2)", "* 4096 + 1)"),
        ("begin", "raster/texture_walk.h", "(1U << 14)", "(1U << 13)"),
    ],
)
def test_the_proof_can_fail(name: str, file: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(file, old, new))
