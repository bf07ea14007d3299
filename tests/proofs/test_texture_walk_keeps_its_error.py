"""raster/texture_walk: the piece test's derivation, its logarithms, and the widths of its numbers.

For u = U / W with U and W linear along a row, W > 0, J = U' W - U W' (the same all along the row), a piece of n pixels
from W0 to Wn, and t in [0, n], the distance from u to the chord is exactly

    u(t) - chord(t) = t (n - t) J W' / (W0 Wn W(t))

so at most n^2 |J W'| / (4 Wmin^3), Wmin being W at one end. The piece is good enough if

    3 log2 Wmin >= log2 |J W'| + 2 log2 n - 2 - log2 error

Every logarithm in the C is rounded against the piece, which is checked here in exact integer arithmetic:
2^(a / 256) >= b is 2^a >= b^256.
"""

from __future__ import annotations

import functools
import itertools
from typing import Any

import pytest

import contracts
from c_execution import Machine as AnyMachine
from c_source import parse
from proof import EVERY_PRECISION, Fault, Machine, Number, Pointer, Poly, Subject, as_unknown
from symbolic import Fact, Infeasible, Path, prove_over_reals, require

FILE = "raster/texture_walk.c"
TEXELS = 2048  # |u|, |v| in texels, below


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
    # Steps are cut off below 2^-16 per pixel, knots floored below 2^-16: a sixteenth of the smallest error.
    require((most + 1) * 2**-16 <= 2**-5 / 16, "rounding fits the reserve")


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


# --- widths -----------------------------------------------------------------------------------------------------------


def logarithm(name: str) -> Any:
    top = 32 * 256 if name == "log2_floor_q8" else 64 * 256

    def contract(machine: Machine, arguments: list[Any]) -> Number:
        machine.path.prove(arguments[0].poly - 1, f"{name}: x >= 1")
        return machine.number("int32_t", "log", 0, top + 1)

    return contract


LOGS = {name: logarithm(name) for name in ("log2_floor_q8", "log2_ceil_q8")}
STEEP = 1 << 59


def curvature_domain(machine: Machine) -> list[Any]:
    """Gradients that are not steep, |dx| < 2^59 as Q32; W below 2^31; U any 32 bits."""
    path = machine.path
    dx = path.atom("dx", -STEEP + 1, STEEP - 1)
    as_unsigned = dx if path.decide(dx, -dx - 1) else dx + 2**64
    plane = machine.struct("el_plane", dx=as_unsigned)
    dw = path.atom("w_step_q4", -(2**31) + 1, 2**31 - 1)
    numbers = (
        machine.number("int32_t", "w", 1),
        machine.exactly("int32_t", dw),
        machine.number("uint8_t", "shift", 0, 27),
    )
    return [machine.number("uint64_t", "value_q32"), Pointer([plane]), *numbers]


def bounded(machine: Machine, value: Number) -> Number:
    return as_unknown(machine, value, value.type.low, value.type.high)


CURVATURE = Subject(
    FILE,
    "curvature_q8",
    curvature_domain,
    modular=["el_abs_u64"],
    contracts=LOGS,
    lemmas={"curvature_q8.value": bounded, "curvature_q8.step_q4": bounded},
)


def knot_domain(machine: Machine) -> list[Any]:
    """U and W at a covered pixel: |U| 2^shift / W <= 2^28 in Q16 texels (see test_the_quotient_of_a_knot)."""
    path = machine.path
    # Only the sum of the two shifts counts, here as in the C.
    total = path.choose(path.atom("total", -31, 27))
    shift, w_shift = max(total, 0), 32 + min(total, 0)
    # W >= 1/2 as Q32, so w_shift <= 32; its upper 32 bits, of which the rest cuts off less than one.
    upper = path.atom("upper", 2**31, 2**32 - 1)
    numerator = path.atom("U", -(2**63), 2**63 - 1)
    # |U_q32| 2^shift <= 2^28 w_q32 and w_q32 < (upper + 1) 2^(32 - w_shift).
    reach = (upper + 1) * (1 << 60 - w_shift)
    path.assume(reach - numerator * (1 << shift))
    path.assume(reach + numerator * (1 << shift))
    value = numerator if path.decide(numerator, -numerator - 1) else numerator + 2**64
    if upper.constant is None:
        divisor = contracts.divisor_make(machine, [machine.exactly("uint32_t", upper)])
    else:
        divisor = machine.call("el_divisor_make", machine.exactly("uint32_t", upper))
    base = machine.number("int32_t", "base", -TEXELS << 16, TEXELS << 16)
    numbers = machine.exactly("uint64_t", value), machine.exactly("uint8_t", shift), base
    return [*numbers, Pointer([divisor]), machine.exactly("int32_t", w_shift)]


def knot_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """Within the base and 2^28 (and a unit), so that the difference of two knots fits 32 bits."""
    path = machine.path
    for bound in (result.poly + KNOT, KNOT - result.poly):
        path.prove(bound, "|knot| < 2^29.2")


KNOT = (TEXELS << 16) + 2**28 + 2


def knot_quotient(machine: Machine, arguments: list[Any]) -> Number:
    """el_divide_floor_i64, and that its quotient is within 2^28 and a unit."""
    quotient = contracts.divide_floor(machine, arguments)
    for bound in (quotient.poly + 2**28 + 1, 2**28 + 1 - quotient.poly):
        machine.path.prove(bound, "|quotient| <= 2^28 + 1")
        machine.path.assume(bound)
    return quotient


KNOTS = Subject(
    FILE,
    "knot",
    knot_domain,
    knot_check,
    modular=["knot", "reciprocal_word", "el_divide_words"],
    contracts={**contracts.DIVISION, "el_divide_floor_i64": knot_quotient},
)


def piece_domain(machine: Machine) -> list[Any]:
    """A walk at any place of any span, its limit as el_texture_walk_begin makes it.

    Where W grows the walk begins with the length at which it goes on to look: had it begun with a shorter one, it would
    have come to the same, and would know more.
    """
    path = machine.path
    never, count = (machine.constant(machine.unit.constants[name]) for name in ("NEVER_Q8", "LENGTHS"))
    limit, here = path.atom("limit", -never, never), path.atom("log2 W", 0, 32 * 256)
    start = path.choose(path.atom("length", 0, count - 1))
    falls = path.choose(path.atom("falls", 0, 1))
    if not falls and start + 1 < count:
        path.assume(limit + table("length_q8")[start + 1] - 1 - here)
    HERE[id(path)] = here
    walk = machine.struct("el_texture_walk", limit_q8=limit, length=start)
    for name in ("w", "u", "v"):
        machine.put(walk.content[name], path.atom(name, 0, 2**64 - 1))
    for name in ("u_q16", "v_q16"):
        machine.put(walk.content[name], path.atom(name, -KNOT, KNOT))
    triangle = machine.struct("el_triangle")
    perspective = triangle.content["perspective"].content
    machine.put(perspective["w"].content["dx"], path.atom("dw", falls * 2**63, 2**63 - 1 + falls * 2**63))
    # What is left of the span, by how it compares with the lengths.
    ends = [1, 2, *(length + 2 for length in table("lengths")), 2041]
    part = path.choose(path.atom("part", 0, len(ends) - 2))
    if falls and start > 0 and table("lengths")[start - 1] >= ends[part + 1] - 2:
        raise Infeasible  # skipped at once for the next shorter length, which is a path of its own
    return [Pointer([walk]), Pointer([triangle]), machine.number("int32_t", "left", ends[part], ends[part + 1] - 1)]


HERE: dict[int, Poly] = {}


def piece_logarithm(machine: Machine, _: list[Any]) -> Number:
    """log2_floor_q8: first of W here, then of W at any other place."""
    here = HERE.pop(id(machine.path), None)
    log = machine.path.atom("log", 0, 32 * 256) if here is None else here
    return machine.exactly("int32_t", log)


def exact_knots(machine: Machine, arguments: list[Any]) -> None:
    for pointer in arguments[3:5]:
        machine.put(pointer.cell, machine.path.atom("knot", -KNOT, KNOT))


def piece_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """1 <= length <= what is left of the span before its last pixel, and the longest piece."""
    path = machine.path
    left = arguments[2].poly
    path.prove(result.poly - 1, "a piece has a pixel")
    path.prove(machine.constant(machine.unit.constants["EL_MAX_PIECE"]) - result.poly, "not longer than EL_MAX_PIECE")
    if path.decide(left - 2, 1 - left):
        path.prove(left - 1 - result.poly, "the knot at its end is covered")


PIECE = Subject(
    FILE,
    "el_texture_walk_piece",
    piece_domain,
    piece_check,
    modular=["el_texture_walk_piece"],
    contracts={
        "exact": exact_knots,
        "log2_floor_q8": piece_logarithm,
        "whole": lambda machine, _: machine.number("uint32_t", "w", 1),
    },
    rough=True,
)


def begin_domain(machine: Machine) -> list[Any]:
    path = machine.path
    triangle = machine.struct("el_triangle")
    perspective = triangle.content["perspective"].content
    for name in "uv":
        machine.put(perspective[f"{name}_shift"], path.atom(f"{name}_shift", 0, 27))
    for name in "wuv":
        machine.put(perspective[name].content["value"], path.atom("value", 0, 2**64 - 1))
        machine.put(perspective[name].content["dx"], path.atom("dx", 0, 2**64 - 1))
    surface = triangle.content["surface"].content
    machine.put(surface["uv_error_log2"], path.choose(path.atom("uv_error_log2", 1, 5)))
    walk = machine.struct("el_texture_walk")
    return [Pointer([walk]), Pointer([triangle]), machine.number("int32_t", "skipped", 0, 4080)]


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


def curvature_contract(machine: Machine, _: list[Any]) -> Number:
    """curvature_q8, proven above: a logarithm, and the shift of the coordinate."""
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
BEGIN = Subject(
    FILE,
    "el_texture_walk_begin",
    begin_domain,
    begin_check,
    modular=["el_texture_walk_begin", "el_abs_u64", "el_plane_times", "el_multiply_u64"],
    contracts={
        "exact": lambda machine, arguments: exact_knots(machine, [None, *arguments[1:]]),
        "curvature_q8": curvature_contract,
        "is_steep": steep_contract,
        # At covered pixels 1/w is below 2^31 (test_planes_are_exact_modulo_2_64: between the corners').
        "whole": lambda machine, _: machine.number("uint32_t", "w", 1, 2**31 - 1),
        **LOGS,
    },
)
SUBJECTS = {
    "curvature": CURVATURE,
    "knot": KNOTS,
    "piece": PIECE,
    "steep": STEEPNESS,
    "begin": BEGIN,
}


@pytest.mark.parametrize("name", SUBJECTS)
def test_all_values(name: str) -> None:
    SUBJECTS[name].prove()


@EVERY_PRECISION
def test_the_quotient_of_a_knot(bits: int) -> None:
    """|U| 2^shift / W stays below 2^28 at covered pixels, in Q16 texels.

    The corners' u are within 2^shift - 1 of the base; U at a corner is rounded to 2^-F, F = EL_PLANE_FRACTION_BITS, and
    the planes of U and W are off by less than 2^-19. W >= 1. So |U| <= (2^shift - 1) W / 2^shift + 2^-F / 2 + 2^-19,
    and what the walk has for W is above W - 2^-19.
    """
    (fraction,) = constants_of("raster/plane.c", bits, "EL_PLANE_FRACTION_BITS")
    unit = 2**19
    for shift in range(fraction, 28):
        for w in (1, 2, 2**31 - 1):
            numerator = (2**shift - 1) * w * unit + 2**shift * (unit >> fraction + 1) + 2**shift
            assert numerator <= 2**28 * (w * unit - 1), f"shift {shift}, W {w}"


def constants_of(file: str, bits: int, *names: str) -> list[int]:
    machine = AnyMachine(parse(file, bits), Path([]))
    return [machine.constant(machine.unit.constants[name]) for name in names]


@pytest.mark.parametrize("name", ["curvature", "knot", "steep"])
def test_the_compiler_agrees(name: str) -> None:
    subject = SUBJECTS[name]
    Subject(FILE, subject.function, subject.domain, modular=subject.modular).agree(count=200)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("curvature", "plane->dx >> 28", "plane->dx >> 27"),
        ("knot", "int total = shift + w_shift - 32", "int total = shift + w_shift - 28"),
        ("piece", "most = left - 1;", "most = left;"),
        ("steep", "1ULL << (32 + STEEP_LOG2)", "1ULL << (33 + STEEP_LOG2)"),
        ("begin", "3 * NEVER_Q8 + 2) / 3", "3 * NEVER_Q8 + 1) / 3"),
    ],
)
def test_the_proof_can_fail(name: str, old: str, new: str) -> None:
    SUBJECTS[name].fails_with(Fault(FILE, old, new))
