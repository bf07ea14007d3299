"""base/fixed: el_scale_i64 and el_shift_i64 round to nearest, ties up, for every value and each shift.

The value is given as its sign and the two words of its magnitude, so that the product with the factor is a sum of two
unknowns, high * factor and low * factor: all that the function does with them is linear.
"""

from __future__ import annotations

from typing import Any

import pytest

from proof import Fault, Machine, Number, Poly, Subject

FILE = "base/fixed.c"
MOST = 2**63 - 1


def any_value(machine: Machine, negative: bool) -> Number:
    """int64_t: all values >= 0, or all below."""
    high, low = machine.path.atom("high", 0, 2**31), machine.path.atom("low", 0, 2**32 - 1)
    magnitude = high * 2**32 + low
    machine.path.assume((2**63 if negative else MOST) - magnitude)
    if negative:
        machine.path.assume(magnitude - 1)
    return machine.exactly("int64_t", -magnitude if negative else magnitude)


def scale_domain(shift: int, negative: bool) -> Any:
    def domain(machine: Machine) -> list[Any]:
        value = any_value(machine, negative)
        return [value, machine.number("uint32_t", "factor"), machine.exactly("int32_t", shift)]

    return domain


def shift_domain(shift: int, negative: bool) -> Any:
    return lambda machine: [any_value(machine, negative), machine.exactly("int32_t", shift)]


def is_rounded(machine: Machine, exact: Poly, shift: int, result: Poly) -> None:
    """result = floor(exact / 2^shift + 1/2), or that saturated."""
    path = machine.path
    if shift < 0:
        exact, shift = exact * (1 << -shift), 0
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
    value, factor, shift = arguments
    is_rounded(machine, value.poly * factor.poly, shift.poly.constant, result.poly)


def shift_check(machine: Machine, arguments: list[Any], result: Number) -> None:
    value, shift = arguments
    is_rounded(machine, value.poly, shift.poly.constant, result.poly)


def bit_length(machine: Machine, arguments: list[Any]) -> Number:
    """el_bit_length_u64, as far as its callers ask: whether x << shift leaves 63 bits."""
    x = arguments[0].poly
    shift = machine.scopes[0]["shift"].content.poly.constant
    threshold = max(0, 31 + shift if machine.functions[-1] == "el_scale_i64" else 63 + shift)
    if threshold > 63 or machine.path.decide((1 << threshold) - 1 - x, x - (1 << threshold)):
        return machine.number("int32_t", "bits", 0, min(threshold, 64))
    return machine.number("int32_t", "bits", threshold + 1, 64)


CONTRACTS = {"el_bit_length_u64": bit_length}
SIGNS = pytest.mark.parametrize("negative", [False, True])


def scale(shift: int, negative: bool) -> Subject:
    return Subject(FILE, "el_scale_i64", scale_domain(shift, negative), scale_check, ["el_abs_u64"], CONTRACTS)


def shift_by(shift: int, negative: bool) -> Subject:
    return Subject(FILE, "el_shift_i64", shift_domain(shift, negative), shift_check, ["el_abs_u64"], CONTRACTS)


@SIGNS
def test_scale_for_each_shift(negative: bool) -> None:
    for shift in range(95):
        scale(shift, negative).prove()


@SIGNS
def test_shift_for_each_shift(negative: bool) -> None:
    for shift in range(-80, 80):
        shift_by(shift, negative).prove()


@SIGNS
@pytest.mark.parametrize("shift", [0, 1, 31, 32, 33, 64, 94])
def test_the_compiler_agrees_on_scale(negative: bool, shift: int) -> None:
    scale(shift, negative).agree(count=60)


@SIGNS
@pytest.mark.parametrize("shift", [-64, -33, -1, 0, 1, 63, 64])
def test_the_compiler_agrees_on_shift(negative: bool, shift: int) -> None:
    shift_by(shift, negative).agree(count=60)


@pytest.mark.parametrize(
    ("subject", "old", "new"),
    [
        (scale(20, True), "round_low -= 1;", "round_low -= 2;"),
        (scale(33, False), "1ULL << (shift - 33)", "1ULL << (shift - 32)"),
        (scale(5, False), "+ 32 - shift > 63", "+ 32 - shift > 64"),
        (shift_by(-1, True), "- shift > 63", "- shift > 65"),
        (shift_by(7, False), "(value >> (shift - 1)) & 1", "(value >> shift) & 1"),
    ],
    ids=lambda value: value.function if isinstance(value, Subject) else None,
)
def test_the_proof_can_fail(subject: Subject, old: str, new: str) -> None:
    if "el_bit_length_u64(magnitude)" not in old and subject.function == "el_shift_i64" and "> 63" in old:
        old, new = f"el_bit_length_u64(magnitude) {old}", f"el_bit_length_u64(magnitude) {new}"
    subject.fails_with(Fault(FILE, old, new))
