"""base/fixed: el_scale_i64 and el_shift_i64 round to nearest, ties up, for every value and each shift.

The value is given as the two words that el_scale_i64 takes it apart into, so that the product with the factor is a sum
of two unknowns, high * factor and low * factor: all that the function does with them is linear.

One sum of el_scale_i64 wraps on purpose: a negative upper part, as an unsigned number, and the lower part that brings
it to 0 or above. Where it leaves 64 bits otherwise, the result is saturated; what is proven of the result covers both.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import Fault, Machine, Number, Poly, Subject

FILE = "base/fixed.c"
MOST = 2**63 - 1
SHIFTS = range(-80, 80)  # of el_shift_i64, one by one; those beyond are taken together


def any_value(machine: Machine) -> Number:
    """int64_t: all of them."""
    high, low = machine.path.atom("high", -(2**31), 2**31 - 1), machine.path.atom("low", 0, 2**32 - 1)
    return machine.exactly("int64_t", high * 2**32 + low)


def scale_domain(shift: int) -> Any:
    def domain(machine: Machine) -> list[Any]:
        return [any_value(machine), machine.number("uint32_t", "factor"), machine.exactly("int32_t", shift)]

    return domain


def shift_domain(least: int, most: int) -> Any:
    return lambda machine: [any_value(machine), machine.number("int32_t", "shift", least, most)]


def is_rounded(machine: Machine, exact: Poly, shift: int, result: Poly) -> None:
    """result = floor(exact / 2^shift + 1/2), or that saturated."""
    path = machine.path
    if shift < 0:
        exact, shift = exact * (1 << -shift), 0
    path.prove(result + MOST, "saturated below")
    if result.constant in (MOST, -MOST):
        beyond = exact * 2 + (1 << shift) - MOST * (2 << shift) if result.constant == MOST else -exact - (MOST << shift)
        if path.holds(beyond):
            return
    # Up or down: each is easy by itself.
    up = result - path.floor(exact, 1 << shift)
    path.decide(up - 1, -up)
    error = exact * 2 + (1 << shift) - result * (2 << shift)
    path.prove(error, "not above the rounded value")
    path.prove((2 << shift) - 1 - error, "not below the rounded value")


def scale_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """Besides, the product's upper part is exact: of it, nothing has wrapped."""
    value, factor, shift = arguments
    path, exact, high = machine.path, value.poly * factor.poly, machine.locals["el_scale_i64.high"].poly
    path.prove(exact - high * 2**32, "the upper part is not above the product")
    path.prove(high * 2**32 + 2**32 - 1 - exact, "nor below it")
    path.prove(2**63 - 2**31 - 1 - high, "it is below 2^63 - 2^31")
    is_rounded(machine, exact, shift.poly.known, result.poly)


def shift_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    """A shift by 64 leaves at most a half, and a longer one less; one by -63 saturates all but 0, as do those below."""
    value, shift = arguments
    least, most = machine.path.bounds(shift.poly)
    assert least == most or least >= 64 or most <= -63, "these shifts have no common result"
    is_rounded(machine, value.poly, least if least == most else 64 if least >= 64 else -63, result.poly)


def scale(shift: int) -> Subject:
    return Subject(FILE, "el_scale_i64", scale_domain(shift), scale_check, modular=["el_scale_i64"])


def shift_by(least: int, most: int | None = None) -> Subject:
    return Subject(FILE, "el_shift_i64", shift_domain(least, least if most is None else most), shift_check)


def test_scale_for_each_shift() -> None:
    for shift in range(95):
        scale(shift).prove()


def test_shift_for_each_shift() -> None:
    for shift in SHIFTS:
        shift_by(shift).prove()


@pytest.mark.parametrize(("least", "most"), [(-(2**31), SHIFTS.start - 1), (SHIFTS.stop, 2**31 - 1)])
def test_shift_for_all_longer_shifts(least: int, most: int) -> None:
    shift_by(least, most).prove()


@pytest.mark.parametrize("shift", [0, 1, 31, 32, 33, 64, 94])
def test_the_compiler_agrees_on_scale(shift: int) -> None:
    scale(shift).agree(count=120)


@pytest.mark.parametrize("shift", [-(2**31), -64, -63, -33, -1, 0, 1, 63, 64, 2**31 - 1])
def test_the_compiler_agrees_on_shift(shift: int) -> None:
    shift_by(shift).agree(count=120)


@pytest.mark.parametrize(
    ("subject", "old", "new"),
    [
        (scale(20), "((1ULL << shift) >> 1)", "((1ULL << shift) >> 2)"),
        (scale(20), "+ (int64_t)(low >> 32)", "+ (int64_t)(low >> 33)"),
        (scale(33), "shift - 32);", "shift - 31);"),
        (scale(5), "high >> (shift + 31) == sign", "high >> (shift + 32) == sign"),
        (scale(5), "high >> (shift + 31) == sign", "high >> (shift + 30) == sign"),
        (scale(5), " && sum != INT64_MIN", ""),
        (scale(5), "sign < 0 ?", "sign < -1 ?"),
        (shift_by(-64), "shift > -63 ?", "shift > -65 ?"),
        (shift_by(-(2**31), SHIFTS.start - 1), "shift > -63 ? -shift : 63", "-shift"),
        (shift_by(SHIFTS.stop, 2**31 - 1), "shift >= 64", "shift == 64"),
        (shift_by(-1), "INT64_MAX >> left", "INT64_MAX >> (left - 1)"),
        (shift_by(-1), "value < -limit ?", "value < -limit - 1 ?"),
        (shift_by(7), "(doubled & 1)", "(value & 1)"),
    ],
    ids=lambda value: value.function if isinstance(value, Subject) else None,
)
def test_the_proof_can_fail(subject: Subject, old: str, new: str) -> None:
    subject.fails_with(Fault(FILE, old, new))
